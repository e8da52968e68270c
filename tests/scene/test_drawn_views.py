"""Textures that a program draws of the body: `sssgen render` supplies them, and shells and reflection say how."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from folders import EXAMPLES
from lamp_scene import largest_difference
from sssgen.bake.bake_light import BakeLight
from sssgen.ir.frame_passes import BACK_FACES, EYE_LAYERS, FAR, FRAME_PASSES, LAYERS
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import all_targets, compile
from sssgen.run import backends
from sssgen.run.backends import Backend, Drawing, Text
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.render import pixel_mesh, unity_values
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.run.render.shell_values import Shell
from sssgen.scene.camera import Camera
from sssgen.scene.drawn_views import TEXELS, eye_layers, light_depth
from sssgen.scene.geometry import Ball, Box, Geometry, Mesh, Torus, Union
from sssgen.scene.light_view import point_view
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.registry import load as load_target

SHOWN = """
thickness light_path(world_position P, world_direction L);

/** Shows the length along the eye's ray, and the length towards the light from half of it.
role: translucency
*/
vec3 shown(view_thickness d, world_position P, world_direction V, world_direction L)
{
    return vec3(0.25 * d, 0.25 * light_path(world_position(P - 0.5 * d * V), L), 0.2);
}
"""
MATERIAL = """
[material]
name = "shown"
shading = "lit"
[thickness]
technique = "back_face_thickness"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
[translucency]
technique = "shown.sss"
bind = { light_path = "depth_map_path" }
"""
RADIUS, EYE = 0.8, (0.4, 0.9, 3.0)
HEAD = f'material = "shown.toml"\nsamples = 1\n[camera]\nposition = {list(EYE)}\n'
LIGHT = "[[light]]\ndirection = [1.0, 2.0, -0.5]\ncolor = [1.0, 1.0, 1.0]\n"
BALL = f'[geometry]\nkind = "ball"\nradius = {0.5 * RADIUS}\nscale = 2.0\nrotation = [10, 20, 30]\n'
TORUS = '[geometry]\nkind = "torus"\nmajor = 0.7\nminor = 0.3\nrotation = [50, 20, 10]\nposition = [0.2, -0.3, 0.0]\n'
SIZE = (48, 36)
DRAWING = ["gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "unity", "unity-urp", "metal"]


def write_material(folder: Path) -> Path:
    (folder / "shown.sss").write_text(SHOWN, encoding="utf-8")
    (folder / "shown.toml").write_text(MATERIAL, encoding="utf-8")
    return folder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the material."""
    return write_material(tmp_path)


@pytest.fixture(scope="module")
def torus_oracle(tmp_path_factory: pytest.TempPathFactory) -> RenderedPicture:
    """The torus by the oracle."""
    return picture(TORUS + LIGHT, write_material(tmp_path_factory.mktemp("torus")), backends.get("numpy"))


def picture(text: str, folder: Path, machine: Backend) -> RenderedPicture:
    return render(parse_scene(HEAD + text, folder / "scene.toml"), machine, SIZE)


def test_a_ball_in_closed_form(folder: Path) -> None:
    """The chord of the eye's ray, and the way to the light from its middle; the maps have 11 bits and 512 texels."""
    scene = parse_scene(HEAD + BALL + LIGHT, folder / "scene.toml")
    result = render(scene, backends.get("numpy"), SIZE)
    origin, rays = scene.camera.rays(*SIZE)
    middle = origin + (-rays @ origin)[:, None] * rays
    half = np.sqrt(np.maximum(RADIUS**2 - (middle * middle).sum(axis=1), 0.0))
    towards = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5])
    along = middle @ towards
    ahead = np.sqrt(np.maximum(along**2 + RADIUS**2 - (middle * middle).sum(axis=1), 0.0)) - along
    expected = 0.25 * np.stack([2.0 * half, ahead], axis=1).reshape(SIZE[1], SIZE[0], 2)[::-1]
    unlit = (middle - half[:, None] * rays) @ towards < 0.0  # elsewhere is a highlight
    inner = ((half > 0.3 * RADIUS) & unlit).reshape(SIZE[1], SIZE[0])[::-1]
    assert inner.sum() > 30
    np.testing.assert_allclose(result.linear[inner][:, :2], expected[inner], atol=2e-3)


@pytest.mark.parametrize("name", DRAWING)
def test_every_back_end_reads_the_same_texels(
    name: str, backend: Callable[[str], Backend], folder: Path, torus_oracle: RenderedPicture
) -> None:
    """Whichever way the rows of its framebuffer are counted."""
    result = picture(TORUS + LIGHT, folder, backend(name))
    assert largest_difference(result, torus_oracle) < 1.0
    assert torus_oracle.linear[..., 0].max() > 0.1 and torus_oracle.linear[..., 1].max() > 0.05
    assert np.abs(torus_oracle.linear - torus_oracle.linear[::-1]).max() > 0.1


SHAPES = {
    "ball": Ball(radius=0.7, position=(0.1, 0.0, 0.2), scale=1.3),
    "torus": Torus(major=0.7, minor=0.3, rotation=(50.0, 20.0, 10.0)),
    "two boxes": Union((Box(position=(-0.7, 0.0, 0.0), scale=0.5), Box(position=(0.7, 0.0, 0.3), scale=0.6))),
}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
@pytest.mark.parametrize("light", [(0.6, 0.0, 0.8, 0.0), (2.0, 1.0, 2.5, 1.0)], ids=["from afar", "point"])
def test_a_light_sees_the_surface(shape: Geometry, light: tuple[float, ...]) -> None:
    """The depth at the texel of a point that the light sees is the point's depth, and the view contains the body."""
    view, depth = light_depth(shape, np.array(light))
    hits = [
        shape.hits(start, ray[None]) for start, ray in zip(view.origins[::997], view.directions[::997], strict=True)
    ]
    seen = np.array([hit.hit[0] for hit in hits])
    assert seen.mean() > 0.1
    np.testing.assert_array_equal(depth.ravel()[::997] == view.far, ~seen)
    assert (depth[[0, -1]] == view.far).all() and (depth[:, [0, -1]] == view.far).all()
    for number, hit in enumerate(hits):
        if hit.hit[0]:
            u, v, z, w = view.matrix @ [*hit.position[0], 1.0]
            row, column = divmod(997 * number, TEXELS)
            np.testing.assert_allclose([u / w, v / w], [(column + 0.5) / TEXELS, (row + 0.5) / TEXELS], atol=1e-6)
            assert depth[row, column, 0] == pytest.approx(z, abs=1e-6)


def test_a_light_sees_three_layers() -> None:
    """First entry, first exit and second entry; a texel without one of them has the depth of the body's end."""
    shape = SHAPES["two boxes"]  # from -0.95 to -0.45 and from 0.4 to 1 in x; the second is thinner and farther up in z
    view, depth = light_depth(shape, np.array([-1.0, 0.0, 0.0, 0.0]), FRAME_PASSES[LAYERS].layers)
    assert depth.shape == (TEXELS, TEXELS, 3)
    _, first = light_depth(shape, np.array([-1.0, 0.0, 0.0, 0.0]))
    np.testing.assert_array_equal(depth[..., :1], first)
    expected = {(0.1, 0.1): (-0.95, -0.45, 0.4), (0.1, -0.1): (-0.95, -0.45, 1.0), (0.1, 0.5): (0.4, 1.0, 1.0)}
    for (y, z), planes in expected.items():
        u, v, _, _ = view.matrix @ [0.0, y, z, 1.0]
        along = [(view.matrix @ [x, y, z, 1.0])[2] for x in planes]
        np.testing.assert_allclose(depth[int(v * TEXELS), int(u * TEXELS)], along, atol=1e-9)
    assert (depth[0, 0] == view.far).all()


@pytest.mark.parametrize("name", ["gl", "webgpu"])
def test_a_gap_is_not_matter(name: str, backend: Callable[[str], Backend], folder: Path) -> None:
    """Two boxes, one in the shadow of the other: the length towards the light is that of the march through both."""
    gap = folder / "gap.toml"
    gap.write_text(
        MATERIAL.replace("depth_map_path", "depth_layers_path").replace('"shown"', '"gap"'), encoding="utf-8"
    )
    parts = "".join(
        f'[[geometry.part]]\nkind = "box"\nsize = [0.5, 1.0, 1.0]\nposition = [{x}, 0.0, 0.0]\n' for x in (-0.6, 0.6)
    )
    text = f'[geometry]\nkind = "union"\n{parts}[[light]]\ndirection = [-1.0, 0.0, 0.0]\n'
    scene = parse_scene((HEAD + text).replace("shown.toml", "gap.toml"), folder / "scene.toml")
    oracle = render(scene, backends.get("numpy"), SIZE)
    assert largest_difference(render(scene, backend(name), SIZE), oracle) < 1.0
    origin, rays = scene.camera.rays(*SIZE)
    assert scene.geometry is not None
    hits = scene.geometry.hits(origin, rays)
    middle = 0.5 * (hits.position + origin + eye_layers(scene.geometry, origin, rays, BACK_FACES) * rays)
    behind = hits.hit & (middle[:, 0] > 0.36) & (np.abs(middle[:, 1:]).max(axis=1) < 0.48)  # the filter blurs edges
    length = (0.5 + middle[:, 0] - 0.35).reshape(SIZE[1], SIZE[0])[::-1]
    inner = behind.reshape(SIZE[1], SIZE[0])[::-1]
    assert inner.sum() > 30
    np.testing.assert_allclose(oracle.linear[inner][:, 1], 0.25 * length[inner], atol=2e-3)


def test_the_nearest_back_face() -> None:
    """The first exit and not the last; 0 for a ray that misses, or that leaves the body behind the eye."""
    shape = SHAPES["two boxes"]
    rays = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    before, behind = np.array([-3.0, 0.1, 0.1]), np.array([3.0, 0.1, 0.1])
    np.testing.assert_allclose(eye_layers(shape, before, rays, BACK_FACES), [[2.55], [0.0]], atol=1e-12)
    np.testing.assert_allclose(eye_layers(shape, behind, rays, BACK_FACES), [[0.0], [0.0]])


def test_the_layers_that_the_eye_sees() -> None:
    """First exit, second entrance, second exit of two boxes; far beside them and where there is no second box."""
    shape = SHAPES["two boxes"]
    rays = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    before, between = np.array([-3.0, 0.1, 0.1]), np.array([0.0, 0.1, 0.1])
    seen = [[2.55, 3.4, 4.0], [FAR] * 3]
    np.testing.assert_allclose(eye_layers(shape, before, rays, EYE_LAYERS), seen, atol=1e-12)
    np.testing.assert_allclose(eye_layers(shape, between, rays[:1], EYE_LAYERS), [[1.0, FAR, FAR]], atol=1e-12)


def test_the_first_exit_of_a_ring() -> None:
    """The distance is 0 there and below 0 everywhere before it."""
    shape, eye = Torus(major=0.8, minor=0.3), np.array([0.3, 1.5, 2.5])
    target = np.random.default_rng(3).uniform(-1.0, 1.0, (500, 3)) * [1.0, 0.2, 1.0]
    rays = (target - eye) / np.linalg.norm(target - eye, axis=1, keepdims=True)
    hits = shape.hits(eye, rays)
    rays, entry = rays[hits.hit], np.linalg.norm(hits.position[hits.hit] - eye, axis=1)
    leaves = eye_layers(shape, eye, rays, BACK_FACES)[:, 0]
    assert len(rays) > 200 and (leaves > entry).all()
    assert np.abs(shape.distance(eye + leaves[:, None] * rays)).max() < 1e-9
    for part in np.linspace(0.02, 0.98, 25):
        way = entry + part * (leaves - entry)
        assert (shape.distance(eye + way[:, None] * rays) < 0.0).all()


def test_an_open_mesh_has_no_back_face(tmp_path: Path) -> None:
    """Its view thickness is 0, and not an error."""
    text = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n"
    (tmp_path / "sheet.obj").write_text(text, encoding="utf-8")
    ray = np.array([[0.1, 0.2, -3.0]]) / np.linalg.norm([0.1, 0.2, -3.0])
    distance = eye_layers(Mesh(path=str(tmp_path / "sheet.obj")), np.array([0.0, 0.0, 3.0]), ray, BACK_FACES)
    np.testing.assert_array_equal(distance, [[0.0]])


def test_the_pass_of_the_builtin_pipeline_writes_the_distance(backend: Callable[[str], Backend], folder: Path) -> None:
    """The pass of the emitted shader that draws the back faces, alone, on a mesh with one vertex per pixel.

    Those for URP have a test with the feature that draws them (`run/test_unity_passes.py`).
    """
    machine = backend("unity")
    assert isinstance(machine, UnityHLSL)
    files = compile(load_material(str(folder / "shown.toml")), machine.target.name).files
    (text,) = [text for file, text in files.items() if file.endswith(".shader")]
    head, *passes = re.split(r"^(?=        Pass \{$)", text, flags=re.MULTILINE)
    (drawn,) = [part for part in passes if '"BackFaceDistance"' in part]
    assert "Cull Front" in drawn and "ZTest" not in drawn and "ZWrite" not in drawn  # the nearest is kept by default
    drawn += "" if drawn is passes[-1] else passes[-1][passes[-1].rindex("    FallBack") :]
    shader = Text(head.partition("        CGPROGRAM")[0] + drawn)
    camera, (width, height) = Camera(position=EYE), SIZE
    origin, rays = camera.rays(*SIZE)
    hits = Ball(radius=3.5).hits(origin, rays)  # the eye is inside, so there is a hit in each pixel
    points = pixel_mesh.vertices(hits, origin, rays, np.eye(4), SIZE)
    matrix = camera.view_projection(width / height, zero_to_one=True)
    values = unity_values._engine(Shell(matrix, EYE), SIZE)
    vertex, fragment = (machine.forward(shader, stage, ()) for stage in ("vertex", "fragment"))
    mesh = {"vertices": points, "triangles": pixel_mesh.triangles(SIZE)}
    picture = machine.whole.draw(Drawing(SIZE, fragment, vertex, floats=True, values=values, **mesh))
    expected = np.linalg.norm(hits.position - origin, axis=1).reshape(height, width)
    inner = slice(1, -1), slice(1, -1)
    np.testing.assert_allclose(picture[..., 0][inner], expected[inner], rtol=1e-5)
    assert np.ptp(expected) > 0.05


def test_an_opengl_program_draws_the_same(backend: Callable[[str], Backend], tmp_path: Path) -> None:
    """The example program draws both textures as the shell's comment says, by rasterising a mesh of triangles."""
    gl, size = backend("gl"), 160
    for name, text in compile(load_material("jade_ring"), "glsl-330").files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    arguments = [str(tmp_path / "jade_ring"), str(tmp_path / "picture.ppm")]
    program = f"import sys; sys.path.insert(0, {str(EXAMPLES / 'opengl_program')!r})\nimport program\n"
    program += f"program.to_picture(*{arguments}, ({size}, {size}))"
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)
    head, _, texels = (tmp_path / "picture.ppm").read_bytes().partition(b" 255\n")
    assert head == f"P6 {size} {size}".encode()
    drawn = np.frombuffer(texels, np.uint8).reshape(size, size, 3)
    text = f'material = "jade_ring"\nsamples = 1\nsize = [{size}, {size}]\nambient = [0.05, 0.05, 0.06]\n'
    text += '[geometry]\nkind = "ball"\n[camera]\nposition = [0.0, 0.6, 3.4]\n[[light]]\ncolor = [2.4, 2.2, 1.9]\n'
    text += f"direction = [{1.6 * np.sin(0.4)}, 0.6, {-1.6 * np.cos(0.4)}]\n"
    expected = render(parse_scene(text, tmp_path / "scene.toml"), gl)
    inner = expected.covered == 1.0
    difference = np.abs(255.0 * expected.encoded - drawn).max(axis=2)[inner]
    assert np.median(difference) < 1.0 and np.percentile(difference, 95.0) < 2.0
    assert np.ptp(drawn[inner], axis=0).min() > 100


def test_a_light_that_is_missing(folder: Path) -> None:
    lamp = "[[light]]\nposition = [1.0, 2.0, 3.0]\ncolor = [1.0, 1.0, 1.0]\n"
    for lights, hint in (("", "direction"), (lamp, "direction")):
        with pytest.raises(SssgenError, match=rf"light_depth_map.* drawn from a light[^$]*{hint}"):
            picture(BALL + lights, folder, backends.get("numpy"))


def test_a_texture_of_the_scene_is_not_drawn(folder: Path) -> None:
    """Neither back faces nor the light's view."""
    np.save(folder / "far.npy", np.full((4, 4, 1), 50.0, np.float32))
    files = '[textures]\nback_face_map = "far.npy"\n'
    result = picture(BALL + LIGHT + files, folder, backends.get("numpy"))
    assert result.linear[SIZE[1] // 2, SIZE[0] // 2, 0] > 10.0


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("threejs", "drawn by the material itself"),
        ("babylonjs", "drawn by the material itself"),
        ("playcanvas", "drawn by the material itself"),
        ("godot", "drawn by the node of skin_passes.gd below the body"),
        ("unity-urp", "drawn by the renderer feature of SssgenPasses.cs"),
        ("unity-builtin", "draw the translucent body alone from the eye with a white matt material"),
    ],
)
def test_the_head_says_who_draws_light_on_the_body(target: str, said: str, tmp_path: Path) -> None:
    """Not what draws distances, where that does not draw light."""
    path = tmp_path / "skin.toml"
    path.write_text('[material]\nname = "skin"\n[[surface]]\ntechnique = "screen_diffusion"\n', encoding="utf-8")
    texts = compile(load_material(str(path)), target).files.values()
    heads = [re.sub(r"\n// ", " ", text) for text in texts]
    assert any(re.search(rf"(?i)matt_?light_?map: {said}", head) for head in heads)


@pytest.mark.parametrize("target", [target for target in all_targets() if not load_target(target).channels])
@pytest.mark.parametrize("form", ["shader", "functions"])
def test_shells_and_reflection_say_how(target: str, form: str, folder: Path) -> None:
    compiled = compile(load_material(str(folder / "shown.toml")), target, form=form)
    drawn = {texture["source_name"]: texture["drawn"] for texture in compiled.reflection["textures"]}
    assert drawn["back_face_map"] == "back_faces" and drawn["light_depth_map"] == "distant_light_depth"
    assert drawn["base_color_texture"] is None
    names = {
        texture["source_name"]: texture.get("property") or texture["name"]
        for texture in compiled.reflection["textures"]
    }
    files = [file for file in load_target(target).files[form] if file.sources or file.needs]
    others = {file.name.replace("{material}", "shown") for file in files}  # no shaders
    drawer = load_target(target).draws_passes.format(material="shown") if form == "shader" else ""
    how = {"back_face_map": "alone with its front faces culled", "light_depth_map": "alone from the light, which"}
    for name, text in compiled.files.items():
        commented = not name.endswith((".json", ".txt", ".shadersubgraph", ".meta"))
        if commented and name not in others:
            mark = "# " if target == "numpy" else "// "
            comment = " ".join(line.removeprefix(mark) for line in text.splitlines() if line.startswith(mark))
            for texture, words in how.items():
                said = f"drawn by {drawer}." if drawer else f"draw the translucent body {words}"
                assert f"{names[texture]}: {said}" in comment


@pytest.mark.parametrize("place", [(0.1, 0.0, 0.2), (0.0, 0.0, 0.0)])
def test_a_lamp_in_the_box_sees_what_is_before_it(place: tuple[float, float, float]) -> None:
    """As the views of engines; a bake, whose map must have the whole body, refuses it."""
    corners = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-0.3, 0.3) for z in (-1.0, 1.0)])
    view = point_view(corners, np.array(place), (8, 8))
    assert np.isfinite(view.matrix).all() and np.isfinite(view.directions).all() and view.far > 0.0
    ahead = view.matrix[3, :3]
    *_, depth, w = view.matrix @ np.append(np.array(place) + 0.5 * ahead, 1.0)
    assert depth == pytest.approx(0.5) and w == pytest.approx(0.5)
    with pytest.raises(SssgenError, match="inside the body or next to it"):
        BakeLight(np.array(place), False).view(corners, (8, 8))
