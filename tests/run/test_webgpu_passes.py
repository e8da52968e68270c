"""The passes of a material in a page that draws with WebGPU itself, in Chromium, compared with NumPy's pipeline."""

from __future__ import annotations

import base64
import dataclasses
import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import sssgen
from engine_cases import HEAD
from folders import ROOT
from relit_cases import write_body
from scene_cases import check_light, scene_case
from sssgen.material.material_loading import load_material
from sssgen.run.backends import Array
from sssgen.run.render import shade_numpy
from sssgen.run.render.scene_render import PlacedMesh, place_mesh
from sssgen.run.render.scene_values import shell_of
from sssgen.run.render.shell_values import inverse
from sssgen.scene import scene_loading
from sssgen.scene.drawn_views import TEXELS
from sssgen.scene.geometry import Mesh
from sssgen.scene.solids import Torus
from sssgen.targets import registry
from sssgen.targets.reflection_record import Reflection
from static_host import serving
from torus_cases import PICTURES, SEVERAL, inner_pixels, torus_mesh, torus_scene
from webgpu_browser import READ, STAND_IN, browser

__all__ = ["browser"]
DRAW = """async ({ name, camera, body, lights, ambient, size, halves, copies, parameters, given, others, inner }) => {
    const { Material, load } = await import('/page/material.js');
    const { mesh } = await import('/page/geometry.js');
    const adapter = await navigator.gpu.requestAdapter();
    const device = await adapter.requestDevice({ requiredFeatures: halves ? [] : ['float32-filterable'] });
    const made = await load('/out', name), material = new Material(device, made, 'rgba32float');
    for (const [name, value] of Object.entries(parameters)) material.set(name, value);
    const bytes = (text) => Uint8Array.from(atob(text), (one) => one.charCodeAt(0)).buffer;
    const meshOf = ({ vertices, triangles, box, model }) =>
      mesh(device, new Float32Array(bytes(vertices)), new Uint32Array(bytes(triangles)), box, model);
    for (const [name, { size, dimension, data }] of Object.entries(given)) {
      const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
      const texture = device.createTexture({ size, dimension, format: 'rgba16float', usage });
      device.queue.writeTexture({ texture }, bytes(data), { bytesPerRow: 8 * size[0], rowsPerImage: size[1] }, size);
      material.texture(name, texture);
    }
    const shown = meshOf(body), file = inner && { data: bytes(inner.data), facts: inner.facts };
    const passes = made.createPasses(device, made.reflection, file ? { inner_light: file } : {});
    while (file && !passes.responses.loaded('inner_light')) await new Promise((resume) => setTimeout(resume));
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
    const textureOf = (format) => device.createTexture({ size, format, usage });
    const target = textureOf('rgba32float'), depth = textureOf('depth24plus');
    const read = async (texture, step = 1) => {
      const { width, height, format } = texture, isHalf = format === 'rgba16float';
      const row = 256 * Math.ceil((width * (isHalf ? 8 : 16)) / 256);
      const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
      const buffer = device.createBuffer({ size: row * height, usage });
      const encoder = device.createCommandEncoder();
      encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: row }, [width, height]);
      device.queue.submit([encoder.finish()]);
      await buffer.mapAsync(GPUMapMode.READ);
      const all = new (isHalf ? Float16Array : Float32Array)(buffer.getMappedRange());
      const [w, h] = [Math.floor(width / step), Math.floor(height / step)], some = new Float32Array(w * h * 4);
      for (let y = 0; y < h; y++)
        for (let x = 0; x < w; x++) {
          const at = ((y * step + (step >> 1)) * row) / (isHalf ? 2 : 4) + 4 * (x * step + (step >> 1));
          some.set(all.subarray(at, at + 4), 4 * (y * w + x));
        }
      const url = await new Promise((done) => {
        const reader = Object.assign(new FileReader(), { onload: () => done(reader.result) });
        reader.readAsDataURL(new Blob([some]));
      });
      return { size: [h, w, 4], data: url.split(',')[1] };
    };
    const errors = [];
    device.addEventListener('uncapturederror', ({ error }) => errors.push(error.message));
    let drawn;
    for (let frame = 0; frame < 2; frame++) { // the second has the pictures of the first
      material.view({ ...camera, time: 0, model: body.model, inverseModel: body.inverseModel, ambient, lights });
      const encoder = device.createCommandEncoder();
      const around = { ambient, others: others.map(meshOf) };
      material.show((drawn = passes.draw(encoder, shown, { ...camera, size }, lights, around)));
      for (const model of copies) passes.draw(encoder, { ...shown, model }, { ...camera, size }, lights, around);
      const pass = encoder.beginRenderPass({
        colorAttachments: [{ view: target.createView(), loadOp: 'clear', storeOp: 'store' }],
        depthStencilAttachment: {
          view: depth.createView(), depthClearValue: 1, depthLoadOp: 'clear', depthStoreOp: 'discard',
        },
      });
      material.draw(pass, shown);
      pass.end();
      device.queue.submit([encoder.finish()]);
    }
    const picture = await read(target), textures = {};
    for (const [name, texture] of Object.entries(drawn.textures).filter(([, { dimension }]) => dimension === '2d'))
      textures[name] = await read(texture, texture.width >= 1024 ? 4 : 1);
    passes.destroy();
    device.destroy();
    return { errors, picture, textures, values: drawn.values };
}"""
SHADOWED = """
[material]
name = "made"

[[surface]]
technique = "base_color"

[shadow]
technique = "shadow_map"
shadow_bias = 0.03
"""


TWO_FRAMES = """
    let left = 2;
    const ask = requestAnimationFrame;
    globalThis.requestAnimationFrame = (draw) => (left-- > 0 ? ask(draw) : 0);"""
"""A frame takes seconds here."""


DARK = HEAD.format("lighting") + "vec3 dark(world_direction N) { return 0.0 * vec3(N); }\n"
"""A surface that reflects no light."""


class Case(NamedTuple):
    """A body as the page draws it."""

    material: str
    """The file of its material."""
    mesh: PlacedMesh
    vertices: Array
    triangles: Array


def torus_case(folder: Path, lights: str, material: str = "") -> Case:
    """The ring of jade_ring; `material` replaces the one that it has."""
    path = torus_scene(folder, lights)
    if material:
        Path(path).with_name("jade.toml").write_text(material, encoding="utf-8")
    scene = dataclasses.replace(scene_loading.load(path), samples=1, size=(160, 120))
    assert isinstance(scene.geometry, Torus)
    compiled = sssgen.compile(scene.material, "numpy")
    shell = shell_of(scene, load_material(scene.material), compiled.reflection)
    mesh = place_mesh(scene, compiled, shell, registry.load("numpy"), scene.size)
    return Case(scene.material, mesh, *torus_mesh(scene.geometry, 384, 192))


class Drawn(NamedTuple):
    """What the page has drawn; row 0 is at the top."""

    picture: Array
    textures: dict[str, Array]
    values: dict[str, Array]
    """Matrices (4, 4), for column vectors; numbers (1,)"""


def text_of(values: Array, kind: Any) -> str:
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode()


def texels(data: Any) -> Array:
    result: Array = np.frombuffer(base64.b64decode(data["data"]), np.float32).reshape(data["size"])
    return result


def body_of(vertices: Array, triangles: Array, model: Array) -> dict[str, Any]:
    packed = np.zeros((len(vertices), 12), np.float32)
    packed[:] = vertices[:, :12]
    box = [packed[:, :3].min(axis=0).tolist(), packed[:, :3].max(axis=0).tolist()]
    matrices = {"model": model.T.ravel().tolist(), "inverseModel": inverse(model).T.ravel().tolist()}
    return {"vertices": text_of(packed, np.float32), "triangles": text_of(triangles, np.uint32), "box": box, **matrices}


class Host:
    """The page's own modules, and what `emit` wrote."""

    def __init__(self, browser: Any, folder: Path, url: str) -> None:
        self.folder, self.page = folder, browser.new_page()
        self.page.goto(f"{url}empty.html")

    def emit(self, material: str) -> Reflection:
        compiled = sssgen.compile(material, "wgsl")
        for file, text in compiled.files.items():
            (self.folder / "out" / file).write_text(text, encoding="utf-8")
        return compiled.reflection

    def draw(
        self,
        case: Case,
        halves: bool = False,
        copies: tuple[Array, ...] = (),
        others: tuple[Any, ...] = (),
        response: Path | None = None,
    ) -> Drawn:
        """`copies`: the matrices of other bodies in the same frame; `others`: those that cast shadows; `response`: the
        file of the light inside the body."""
        reflection, shell = self.emit(case.material), case.mesh.shell
        matrix = shell.view_projection.copy()
        matrix[2] = 0.5 * (matrix[2] + matrix[3])  # depths from 0 to 1
        files = {
            texture["name"]: shell.textures[texture["source_name"]]
            for texture in reflection["textures"]
            if texture["source_name"] in shell.textures and not texture["drawn"]
        }
        given = {
            "name": reflection["material"], "body": body_of(case.vertices, case.triangles, shell.model),
            "size": [*case.mesh.size], "halves": halves, "others": [*others],
            "inner": response and {
                "data": base64.b64encode(response.read_bytes()).decode(),
                "facts": json.loads(Path(f"{response}.json").read_text("utf-8")),
            },
            "copies": [model.T.ravel().tolist() for model in copies],
            "ambient": [*map(float, shell.ambient)],
            "camera": {
                "viewProjection": matrix.T.ravel().tolist(),
                "inverseViewProjection": inverse(matrix).T.ravel().tolist(),
                "position": [*map(float, shell.camera_position)],
            },
            "lights": [
                {"position": position.tolist(), "color": color.tolist()}
                for position, color in zip(shell.light_positions, shell.light_colors, strict=True)
            ],
            "parameters": {
                uniform["name"]: [*map(float, shell.parameters[uniform["source_name"]])]
                for uniform in reflection["uniforms"]
                if uniform["source_name"] in shell.parameters and not uniform["drawn"]
            },
            "given": {
                name: {
                    "size": [*texture.size()], "dimension": texture.dim.lower(),
                    "data": text_of(texture.levels[0], np.float16),
                }
                for name, texture in files.items()
            },
        }  # fmt: skip
        drawn = self.page.evaluate(DRAW, given)
        assert drawn["errors"] == []
        values = {name: np.array(numbers) for name, numbers in drawn["values"].items()}
        return Drawn(
            texels(drawn["picture"]),
            {name: texels(texture) for name, texture in drawn["textures"].items()},
            {name: value.reshape(4, 4).T if len(value) == 16 else value for name, value in values.items()},
        )


@pytest.fixture(scope="module")
def host(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Host]:
    folder = tmp_path_factory.mktemp("served")
    shutil.copytree(ROOT / "examples" / "webgpu_page", folder / "page")
    (folder / "out").mkdir()
    (folder / "empty.html").write_text("<!doctype html>", encoding="utf-8")
    with serving(folder) as url:
        yield Host(browser, folder, url)


def reached(drawn: Drawn, case: Case, share: float) -> float:
    """The largest difference from NumPy on a share of the body's pixels but those at its edge, in 255ths of light."""
    mesh, inner = case.mesh, inner_pixels(case.mesh.hit)
    expected = shade_numpy.shade(sssgen.compile(case.material, "numpy"), mesh.shell, mesh.size, mesh.points, "float64")
    assert inner.sum() > 2000 and expected[inner][:, :3].mean() > 0.03
    apart = np.clip(drawn.picture[::-1], 0.0, 1.0) - np.clip(expected, 0.0, 1.0)
    return 255.0 * float(np.quantile(np.abs(apart)[..., :3].max(axis=-1)[inner], share))


@pytest.mark.parametrize("halves", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["floats", "halves"])
def test_the_depth_map_of_a_light(host: Host, tmp_path: Path, halves: bool) -> None:
    """Another body in the same frame has pictures of its own."""
    case = torus_case(tmp_path, "")
    assert reached(host.draw(case, halves, copies=(np.diag([0.5, 2.0, 1.0, 1.0]),)), case, 0.99) < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("halves", [False, True], ids=["floats", "halves"])
def test_the_layers_of_three_lights(host: Host, tmp_path: Path, halves: bool) -> None:
    """The oracle's maps have fewer texels, which shows where a second part of the ring begins."""
    case = torus_case(tmp_path, SEVERAL)
    assert reached(host.draw(case, halves), case, 0.98) < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("name", ["jade_ring", "marble_idol"])
def test_a_scene(host: Host, tmp_path: Path, name: str) -> None:
    """Whole scenes as in engines: docs/engines.md has the figures."""
    scene, material = scene_case(name, tmp_path), tmp_path / name / "under_sky.toml"
    (tmp_path / name / "dark.sss").write_text(DARK, encoding="utf-8")
    with material.open("a", encoding="utf-8") as file:
        file.write('\n[lighting]\ntechnique = "dark.sss"\n')
    drawn = host.draw(Case(str(material), scene.mesh, scene.vertices, scene.triangles))
    check_light(drawn.picture[::-1], scene, f"{name}, a WebGPU page")


@pytest.mark.parametrize("ior", [1.0, pytest.param(1.4, marks=pytest.mark.slow)])
def test_the_light_inside_a_body(host: Host, tmp_path: Path, ior: float) -> None:
    """Of two lamps and ambient light; the parameters of the technique come from the file, for the body's place."""
    write_body(tmp_path, ior)
    scene = dataclasses.replace(scene_loading.load(str(tmp_path / "scene.toml")), samples=1, size=(160, 120))
    assert isinstance(scene.geometry, Mesh)
    compiled = sssgen.compile(scene.material, "numpy")
    shell = shell_of(scene, load_material(scene.material), compiled.reflection)
    mesh = place_mesh(scene, compiled, shell, registry.load("numpy"), scene.size)
    triangles = scene.geometry.triangles
    vertices = np.zeros((len(triangles.places), 12), np.float32)
    vertices[:, :3], vertices[:, 3:6] = triangles.places, triangles.normals
    case = Case(scene.material, mesh, vertices, np.asarray(triangles.corners))
    assert reached(host.draw(case, response=tmp_path / "body.bin"), case, 0.95) < 2.0
    assert reached(host.draw(case), case, 0.95) > 20.0  # without the file the body is dark


@pytest.mark.slow
def test_pictures(host: Host, tmp_path: Path) -> None:
    """Each picture is that of the pipeline; row 0 of those in the page is at the top."""
    case = torus_case(tmp_path, SEVERAL, PICTURES)
    drawn, shell, hit = host.draw(case), case.mesh.shell, case.mesh.hit
    backs, expected = drawn.textures["back_face_map"][::-1, :, 0], shell.screens["back_face_map"].levels[0][..., 0]
    assert np.quantile(np.abs(backs - expected)[hit], 0.98) < 4e-3  # the pipeline's has 16-bit floats
    assert ((backs > 0.0) == hit).mean() > 0.98
    matt, expected = drawn.textures["matt_light_map"][::-1], shell.textures["matt_light_map"].levels[0]
    # the body does not shadow itself in the page: it does in some places of the ring
    assert np.quantile(np.abs(matt - expected)[..., :3].max(axis=-1)[hit], 0.6) < 0.01
    assert ((matt - expected)[..., :3][hit] > -0.02).mean() > 0.97
    assert np.quantile(np.abs(matt - expected)[..., 3][hit], 0.98) < 5e-3
    assert (matt[inner_pixels(~hit), 3] > 100.0).all()
    picture, expected = drawn.textures["light_layer_map"], shell.textures["light_layer_map"].levels[0]
    side, seconds = picture.shape[0] // 2, 0
    step = TEXELS // side
    for number, name in enumerate(("light_matrix", "light_matrix_2", "light_matrix_3")):
        row, column = divmod(number, 2)
        own, cast = drawn.values[name], np.reshape(shell.parameters[name], (4, 4)).T
        np.testing.assert_allclose(own[0], cast[0], atol=1e-5)
        np.testing.assert_allclose(own[1], (0.5 + row) * cast[3] - cast[1], atol=1e-5)
        seen = picture[row * side : (row + 1) * side, column * side : (column + 1) * side]
        texture = expected[row * TEXELS : (row + 1) * TEXELS, column * TEXELS : (column + 1) * TEXELS]
        texture = texture[::-1][step // 2 :: step, step // 2 :: step]
        surface = texture < texture.max() - 1e-3
        start = (cast[2] - own[2])[3]  # distances in the page count from the body's nearest corner
        assert surface[..., 0].sum() > 1000
        assert np.quantile(np.abs(seen + start - texture)[surface], 0.9) < 0.03
        assert ((seen < seen.max() - 1e-3) == surface).mean() > 0.95
        seconds += surface[..., 3].sum()
    assert seconds > 50
    assert not drawn.values["light_matrix_4"].any()


@pytest.mark.slow
def test_a_shadow_map(host: Host, tmp_path: Path) -> None:
    case = torus_case(tmp_path, "", SHADOWED)
    page = host.draw(case)
    assert page.values["shadow_map_texels"] == 1024
    assert reached(page, case, 0.9) < 1.0
    # a sheet between the light and the body takes its light
    towards = case.mesh.shell.light_positions[0, :3]
    z = towards / np.linalg.norm(towards)
    x = np.cross([0.0, 1.0, 0.0], z) / np.hypot(z[0], z[2])
    model = np.eye(4)
    model[:3] = np.stack([4.0 * x, 4.0 * np.cross(z, x), z, 2.5 * z], axis=-1)
    corners = np.zeros((4, 12))
    corners[:, :2], corners[:, 5] = [[-1, -1], [1, -1], [1, 1], [-1, 1]], 1.0
    sheet = body_of(corners, np.array([[0, 1, 2], [0, 2, 3]]), model)
    dark = host.draw(case, others=(sheet,))
    inner = inner_pixels(case.mesh.hit)[::-1]
    assert dark.picture[inner][:, :3].mean() < 0.1 * page.picture[inner][:, :3].mean()


@pytest.mark.slow
def test_the_page_draws_a_material_with_passes(host: Host, browser: Any) -> None:
    """The example as it is: no pass is written in it."""
    host.emit("jade_ring")
    page = browser.new_page()
    complaints: list[str] = []
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.add_init_script(STAND_IN + TWO_FRAMES)
    page.goto(host.page.url.replace("empty.html", "page/?material=jade_ring&folder=../out"))
    # not by frames, of which there are two
    page.wait_for_function("() => globalThis.shown", timeout=60_000, polling=100)
    picture = np.array(page.evaluate(READ)).reshape(640, 640, 4)
    assert page.inner_text("#message") == ""
    assert [text for text in complaints if "favicon" not in text and "404" not in text] == []
    page.close()
    ball = picture[200:440, 200:440, :3].mean(axis=(0, 1))
    assert ball[1] > 60 and ball[1] > 1.2 * ball[0]  # green light comes through
    assert picture[:30, :30, :3].max() < 40  # beside it
