"""`sssgen render`: complete shaders drawn on every back end, compared with the same shells in NumPy."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamp_scene import BALL, LAMP, RIBS, SIZE, largest_difference
from slow_cases import diagonal
from sssgen.cli.main import main
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render import pixel_mesh
from sssgen.run.render.scene_render import render, with_samples
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball
from sssgen.scene.pictures import images
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

DRAWING = ["gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "metal"]

PROBE = """
uniform float shade : hint_range(0.0, 1.0) = 0.5;
uniform vec3 mixed : source_color = vec3(1.0, 0.5, 0.25);
uniform mat2 turn = mat2(1.0, 2.0, 3.0, 4.0);
uniform int steps : hint_range(1, 8) = 3;
uniform sampler2D marks : source_color, default_white;

/** Shows what a shell gives.
role: surface
*/
void probe(uv_position uv, world_position P, world_direction V, world_direction N, object_position P_object, float time,
    vec2 screen_uv, float eye_distance,
    out vec3 albedo, out float alpha, out vec3 emission) {
    albedo = texture(marks, uv).rgb * shade;
    alpha = P_object.y > 0.6 ? 0.25 : 1.0;
    vec2 turned = turn * vec2(0.01, 0.02);
    emission = 0.25 + 0.25 * vec3(N.x, dot(N, V), P.y) + vec3(turned, time * 0.01) + mixed * 0.05 * float(steps);
    emission += vec3(0.2 * screen_uv.x, 0.2 * abs(screen_uv.y - 0.5), 0.02 * eye_distance);
}
"""


@pytest.fixture
def scene(tmp_path: Path) -> Callable[..., str]:
    """Writes a scene."""

    def write(text: str, name: str = "scene.toml") -> str:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    return write


@pytest.fixture
def probe(tmp_path: Path) -> Callable[..., Path]:
    """Writes a texture, and a material whose colour depends on all inputs of its shell."""

    def write(alpha_mode: str = "opaque") -> Path:
        (tmp_path / "probe.sss").write_text(PROBE, encoding="utf-8")
        images.write_png(tmp_path / "marks.png", np.random.default_rng(5).random((8, 16, 3)))
        material = tmp_path / "probe.toml"
        head = f'[material]\nname = "probe"\nshading = "lit"\nalpha_mode = "{alpha_mode}"\n'
        material.write_text(f'{head}[surface]\ntechnique = "probe.sss"\n', encoding="utf-8")
        return material

    return write


@pytest.mark.parametrize(("name", "alpha_mode"), diagonal(DRAWING, ["opaque", "mask", "blend"]))
def test_every_input_of_a_shell(
    name: str, alpha_mode: str, backend: Callable[[str], Backend], scene: Callable[..., str], probe: Callable[..., Path]
) -> None:
    """Positions, frames, matrices, uniform blocks, textures, lights, time and alpha are as in NumPy."""
    probe(alpha_mode)
    values = "[parameters]\nshade = 0.75\nmixed = [0.1, 0.9, 0.4]\nturn = [1, 0, 0.5, 2]\nsteps = 5\n"
    text = f'material = "probe.toml"\nsamples = 2\ntime = 3.0\nambient = [0.2, 0.3, 0.4]\n{BALL}{LAMP}{values}'
    described = load(scene(text + '[textures]\nmarks = "marks.png"\n'))
    oracle = render(described, backends.get("numpy"), SIZE)
    assert oracle.encoded[SIZE[1] // 2, SIZE[0] // 2].std() > 0.01
    assert largest_difference(render(described, backend(name), SIZE), oracle) < 0.2
    covered = oracle.covered.mean()
    assert covered == pytest.approx({"opaque": 0.262, "mask": 0.2, "blend": 0.22}[alpha_mode], abs=0.03)


@pytest.mark.parametrize("name", DRAWING)
def test_how_near_each_light_is(
    name: str, backend: Callable[[str], Backend], scene: Callable[..., str], tmp_path: Path
) -> None:
    """1 over the distance of a lamp, 0 for a light from afar; a lamp's colour falls off with its square."""
    text = "/** Shows it.\nrole: translucency\n*/\nvec3 shown(float light_nearness) {\n"
    text += "    return vec3(1.0, light_nearness, light_nearness * light_nearness);\n}\n"
    (tmp_path / "shown.sss").write_text(text, encoding="utf-8")
    material = '[material]\nname = "shown"\nshading = "lit"\n[translucency]\ntechnique = "shown.sss"\n'
    (tmp_path / "shown.toml").write_text(material, encoding="utf-8")
    lamp = "[[light]]\nposition = [0.3, 0.5, 1.6]\ncolor = [0.5, 0.5, 0.5]\n"
    sun = "[[light]]\ndirection = [0.0, 0.0, 1.0]\ncolor = [0.5, 0.5, 0.5]\n"
    for lights in (lamp, sun, lamp + sun):
        described = load(scene(f'material = "shown.toml"\nsamples = 1\n{BALL}{lights}'))
        oracle = render(described, backends.get("numpy"), SIZE)
        assert largest_difference(render(described, backend(name), SIZE), oracle) < 0.5
        shown = oracle.linear[oracle.covered == 1.0]
        assert shown.shape[0] > 100 and np.ptp(shown[:, 1]) > (0.02 if lamp in lights else -1.0)


@pytest.mark.parametrize(
    ("name", "material"), diagonal(DRAWING, ["paper_lantern", "ice", "resin_inlay", "jelly_cubes"])
)
def test_examples_equal_numpy(
    name: str, material: str, backend: Callable[[str], Backend], scene: Callable[..., str]
) -> None:
    surface = "" if material == "jelly_cubes" else BALL
    textures = RIBS if material == "paper_lantern" else ""
    described = load(scene(f'material = "{material}"\nsamples = 1\n{surface}{LAMP}{textures}'))
    oracle = render(described, backends.get("numpy"), SIZE)
    assert largest_difference(render(described, backend(name), SIZE), oracle) < 0.5
    assert oracle.encoded.std() > 0.05


def test_the_ball_is_where_the_camera_sees_it(backend: Callable[[str], Backend], scene: Callable[..., str]) -> None:
    """A ball at the upper right, lit from above, appears at the upper right of the picture."""
    ball = '[geometry]\nkind = "ball"\nradius = 0.5\nposition = [0.6, 0.4, 0.0]\n'
    light = "[[light]]\ndirection = [0.0, 1.0, 0.0]\ncolor = [1.0, 1.0, 1.0]\n"
    path = scene(f'material = "resin_inlay"\nambient = [0.1, 0.1, 0.1]\n{ball}{light}')
    for name in ("gl", "webgpu", "numpy"):
        result = render(load(path), backend(name), (64, 48))
        rows, columns = np.nonzero(result.covered > 0.5)
        assert columns.mean() > 40 and rows.mean() < 18  # row 0 is at the top
        light_at = result.linear.sum(axis=-1) * (result.covered > 0.99)
        top, bottom = light_at[rows.min() + 2, int(columns.mean())], light_at[rows.max() - 2, int(columns.mean())]
        assert top > 2.0 * bottom


def test_transmitted_light_is_a_factor_on_each_lights_color(
    backend: Callable[[str], Backend], scene: Callable[..., str], tmp_path: Path
) -> None:
    """Without a lamp it is dark, and two lamps add up, although the technique reads no light. A glow needs no lamp."""
    head = '[material]\nname = "shade"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\ntint = [0, 0, 0, 1]\n'
    parts = '[[surface]]\ntechnique = "pbr_constants"\nsurface_roughness = 1.0\n[thickness]\n'
    through = 'technique = "constant_thickness"\n[[translucency]]\ntechnique = "absorption_tint"\nweight = 0.5\n'
    images.write_png(str(tmp_path / "thin.png"), np.ones((1, 1, 3)))
    sky = 'technique = "thinness_map"\nthinness_texture = "thin.png"\n[[translucency]]\ntechnique = "sky_glow"\n'

    def middle(name: str, chain: str, lights: list[tuple[float, float, float]]) -> Any:
        (tmp_path / "shade.toml").write_text(head + parts + chain, encoding="utf-8")
        lamps = "".join(f"[[light]]\ndirection = [0.0, 0.0, -1.0]\ncolor = {[*color]}\n" for color in lights)
        return render(load(scene(f'material = "shade.toml"\n{BALL}{lamps}')), backend(name), (16, 12)).linear[6, 8]

    for name in ("numpy", "gl"):
        red, green = (middle(name, through, [color]) for color in ((1.0, 0.0, 0.0), (0.0, 0.5, 0.0)))
        both_lamps = middle(name, through, [(1.0, 0.0, 0.0), (0.0, 0.5, 0.0)])
        assert red[0] > 0.01 and red[1] == red[2] == 0.0 and green[1] > 0.005 and not green[[0, 2]].any()
        np.testing.assert_allclose(both_lamps, red + green, rtol=1e-5)
        assert not middle(name, through, []).any() and middle(name, sky, []).min() > 0.01


def test_background_exposure_and_averaging(scene: Callable[..., str]) -> None:
    far = '[geometry]\nkind = "ball"\nradius = 0.01\nposition = [9.0, 0.0, 0.0]\n'
    path = scene(f'material = "resin_inlay"\nbackground = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0]]\nexposure = 4.0\n{far}')
    result = render(load(path), backends.get("numpy"), (4, 4))
    np.testing.assert_allclose(result.linear[:, 0, 0], [0.875, 0.625, 0.375, 0.125])
    np.testing.assert_allclose(result.linear[..., 1], 0.5 * result.linear[..., 0])
    assert result.covered.max() == 0.0


def test_samples_are_averaged_in_linear_light(scene: Callable[..., str], tmp_path: Path) -> None:
    """A pixel of N × N samples is the mean of the linear pixels of a picture of N times the size; edges are, too."""
    path = scene(f'material = "paper_lantern"\nsamples = 1\nbackground = [0.2, 0.5, 0.1]\n{BALL}{LAMP}{RIBS}')
    numpy = backends.get("numpy")
    large = render(load(path), numpy, (36, 27)).linear
    small = render(with_samples(load(path), 3), numpy, (12, 9))
    np.testing.assert_allclose(small.linear, large.reshape(9, 3, 12, 3, 3).mean(axis=(1, 3)), rtol=1e-5, atol=1e-7)
    assert ((small.covered > 0.0) & (small.covered < 1.0)).sum() > 5
    written = str(tmp_path / "x.exr")
    assert main(["render", path, "-o", written, "--backend", "numpy", "--size", "12x9", "--samples", "3"]) == 0
    np.testing.assert_allclose(images.read(written), small.linear, rtol=1e-3, atol=1e-4)


def test_a_scene_chooses_parts_of_the_shell(
    backend: Callable[[str], Backend], scene: Callable[..., str], tmp_path: Path
) -> None:
    """Tone mapping, surroundings and shadows of [shell] are drawn, the same on two back ends."""
    bright = LAMP.replace("color = [", "color = [9.0, 9.0, 9.0] # [")
    text = f'material = "paper_lantern"\n{BALL}{bright}{RIBS}[environment]\ncolor = [0.2, 0.3, 0.4]\n'
    chosen = '[shell]\ntone_mapping = "agx"\nenvironment = "prefiltered_environment"\nshadow = "shadow_map"\n'
    plain, mapped = (render(load(scene(text + part)), backends.get("numpy"), SIZE) for part in ("", chosen))
    assert plain.linear.max() > 1.5 and mapped.linear.max() <= 1.0
    assert largest_difference(render(load(scene(text + chosen)), backend("gl"), SIZE), mapped) < 0.5
    for wrong, message in (('tone_mapping = "agxx"', "did you mean 'agx'"), ('fog = "agx"', "unknown key 'fog'")):
        with pytest.raises(SssgenError, match=message):
            load(scene(f"{text}[shell]\n{wrong}\n"))


def test_dicing_places_a_vertex_at_each_pixels_centre() -> None:
    """The vertex of a hit projects to the centre of the pixel, within a thousandth of a pixel in float32."""
    camera, size, ball = Camera((0.3, 0.4, 3.0)), (40, 30), Ball(radius=1.0, rotation=(10.0, 20.0, 30.0), scale=0.8)
    origin, directions = camera.rays(*size)
    hits = ball.hits(origin, directions)
    vertices = pixel_mesh.vertices(hits, origin, directions, ball.to_world(), size)
    matrix = camera.view_projection(size[0] / size[1]) @ ball.to_world()
    clip = np.c_[vertices[:, :3], np.ones(len(vertices))] @ matrix.astype(np.float32).T
    x, y = ((clip[:, axis] / clip[:, 3] + 1.0) * size[axis] / 2.0 for axis in (0, 1))
    np.testing.assert_allclose(x.reshape(30, 40), np.tile(np.arange(40) + 0.5, (30, 1)), atol=1e-3)
    np.testing.assert_allclose(y.reshape(30, 40), np.repeat(np.arange(30) + 0.5, 40).reshape(30, 40), atol=1e-3)
    normal = vertices[:, 3:6][hits.hit] @ np.linalg.inv(ball.to_world())[:3, :3]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    np.testing.assert_allclose(normal, hits.normal[hits.hit], atol=1e-6)
    assert len(pixel_mesh.triangles(size)) == 2 * 39 * 29 and pixel_mesh.triangles(size).max() == 40 * 30 - 1


# The command


def test_render_and_compare(
    capsys: pytest.CaptureFixture[str], scene: Callable[..., str], tmp_path: Path, backend: Callable[[str], Backend]
) -> None:
    backend("gl"), backend("webgpu")
    path = scene(f'material = "paper_lantern"\n{BALL}{LAMP}{RIBS}')
    a, b, c, exr = (str(tmp_path / name) for name in ("a.png", "b.png", "c.png", "d.exr"))
    assert main(["render", path, "-o", a, "--size", "64x48", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["size"] == [64, 48] and report["backend"] == "gl" and "OpenGL" in report["device"]
    assert main(["render", path, "-o", b, "--size", "64x48", "--backend", "webgpu"]) == 0
    assert main(["render", path, "-o", exr, "--size", "64x48"]) == 0
    assert images.read(a).shape == (48, 64, 3) and images.read(exr).dtype == np.float64
    capsys.readouterr()
    assert main(["render", "--compare", a, b, "-o", c, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["flip"] < 1e-3 and result["max"] <= 1.0 and images.read(c).shape == (48, 64, 3)
    assert main(["render", "--compare", a, exr]) == 0
    assert "FLIP   0.00" in capsys.readouterr().out


def test_time_changes_an_animated_picture(scene: Callable[..., str], tmp_path: Path) -> None:
    path = scene('material = "jelly_cubes"\nsamples = 1\n')
    pictures = []
    for time in ("0", "1.5"):
        out = str(tmp_path / f"{time}.png")
        assert main(["render", path, "-o", out, "--size", "24x18", "--time", time, "--backend", "numpy"]) == 0
        pictures.append(images.read(out))
    assert np.abs(pictures[0] - pictures[1]).mean() > 0.02


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("[parameters]\npower = 'x'\n", "'power' takes"),
        ("[parameters]\npower = [1, 2]\n", "'power' takes"),
        ("[parameters]\npowre = 1.0\n", "did you mean 'power'?"),
        ("[parameters]\npower = 999.0\n", "power"),
        ("[textures]\nthickness = 'b.png'\n", "has no texture 'thickness'"),
        ("[textures]\nthickness_texture = 'a.png'\n", "a.png"),
        ("[textures]\nthickness_texture = 'volume.npy'\n", "this is a 3D texture"),
    ],
)
def test_a_scene_that_does_not_fit_its_material(
    capsys: pytest.CaptureFixture[str], scene: Callable[..., str], tmp_path: Path, change: str, message: str
) -> None:
    np.save(tmp_path / "volume.npy", np.ones((2, 2, 2, 1)))
    images.write_png(tmp_path / "b.png", np.ones((2, 2, 3)))
    path = scene(f'material = "paper_lantern"\n{BALL}{LAMP}{change}')
    assert main(["render", path, "-o", str(tmp_path / "x.png"), "--backend", "numpy"]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "x.png").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["SCENE", "--size", "640"], "is not a size"),
        (["SCENE", "--size", "0x10"], "is not a size"),
        (["SCENE", "--size", "8192x8192"], "samples are too many"),
        (["SCENE", "--backend", "opengl"], "unknown back end"),
        (["SCENE", "--backend", "bevy"], "error: bevy evaluates functions and draws no scenes"),
        (["SCENE", "--backend", "gl,webgpu"], "are several back ends"),
        (["SCENE", "--samples", "0"], "is not a number of samples"),
        (["SCENE", "--samples", "9"], "from 1 to 8"),
        (["SCENE", "--samples", "8", "--size", "2000x1000"], "samples are too many"),
        (["SCENE", "--time", "nan"], "is not a time"),
        (["SCENE", "--time", "1e39"], "is not a time"),
        (["SCENE", "-o", "x.jpg"], "'.jpg'"),
        (["SCENE", "-o", "x.npy"], "written as .png or .exr"),
        (["nothing.toml"], "nothing.toml"),
        (["icee"], "did you mean 'ice'?"),
        ([], "a scene is missing"),
        (["--compare", "a.png", "b.png"], "cannot find the picture"),
        (["SCENE", "--compare", "a.png", "b.png"], "no scene"),
    ],
)
def test_wrong_arguments(
    capsys: pytest.CaptureFixture[str], scene: Callable[..., str], arguments: list[str], message: str
) -> None:
    path = scene(f'material = "paper_lantern"\n{BALL}')
    assert main(["render", *[path if argument == "SCENE" else argument for argument in arguments]]) == 2
    assert message in capsys.readouterr().err


def test_a_back_end_for_functions_draws_nothing(backend: Callable[[str], Backend], scene: Callable[..., str]) -> None:
    with pytest.raises(SssgenError, match="unreal evaluates functions and draws no scenes"):
        render(load(scene(f'material = "paper_lantern"\n{BALL}')), backend("unreal"), (8, 8))


def test_outputs_that_cannot_be_written(
    capsys: pytest.CaptureFixture[str], scene: Callable[..., str], tmp_path: Path
) -> None:
    path = scene(f'material = "resin_inlay"\n{BALL}')
    (tmp_path / "file").write_text("", encoding="utf-8")
    common = ["render", path, "--size", "8x8", "--backend", "numpy", "-o"]
    assert main([*common, str(tmp_path / "file" / "x.png")]) == 2
    assert "file" in capsys.readouterr().err
    images.write_png(tmp_path / "small.png", np.zeros((4, 4, 3)))
    images.write_png(tmp_path / "large.png", np.zeros((4, 5, 3)))
    assert main(["render", "--compare", str(tmp_path / "small.png"), str(tmp_path / "large.png")]) == 2
    assert "different sizes: 4 × 4 and 5 × 4" in capsys.readouterr().err


def test_a_surface_material_needs_geometry(scene: Callable[..., str]) -> None:
    with pytest.raises(SssgenError, match="paper_lantern needs a surface to be on"):
        render(load(scene('material = "paper_lantern"\n')), backends.get("numpy"), (8, 8))


def test_nan_is_reported_and_not_written(scene: Callable[..., str], tmp_path: Path) -> None:
    (tmp_path / "hole.sss").write_text(
        "/** A hole.\nrole: surface\n*/\n"
        "void hole(uv_position uv, out vec3 albedo) { albedo = vec3(sqrt(uv.x - 0.9)); }\n",
        encoding="utf-8",
    )
    material = '[material]\nname = "hole"\nshading = "lit"\n[surface]\ntechnique = "hole.sss"\n'
    (tmp_path / "hole.toml").write_text(material, encoding="utf-8")
    path = scene(f'material = "hole.toml"\nambient = [1, 1, 1]\n{BALL}')
    with pytest.raises(SssgenError, match="samples are NaN or infinite"):
        render(load(path), backends.get("numpy"), (16, 12), guards="none")
    assert np.isfinite(render(load(path), backends.get("numpy"), (16, 12)).linear).all()


def test_field_of_view_grows_by_the_border() -> None:
    """The pixels inside the border show the same points as without a border."""
    camera, (width, height) = Camera(), (10, 6)
    wider = math.degrees(2.0 * math.atan(math.tan(math.radians(20.0)) * (height + 2) / height))
    inner = camera.rays(width, height)[1].reshape(height, width, 3)
    whole: Any = Camera(field_of_view=wider).rays(width + 2, height + 2)[1].reshape(height + 2, width + 2, 3)
    np.testing.assert_allclose(whole[1:-1, 1:-1], inner, atol=1e-12)


def test_a_texture_too_large_for_the_driver(
    backend: Callable[[str], Backend], scene: Callable[..., str], tmp_path: Path
) -> None:
    """OpenGL would draw with an empty texture, without an error."""
    for name in ("gl", "hlsl", "webgpu"):
        gpu = backend(name)
        widest = gpu.largest["2D"]  # type: ignore[attr-defined]
        np.save(tmp_path / "wide.npy", np.ones((1, widest + 1, 3)))
        path = scene(f'material = "resin_inlay"\n{BALL}[textures]\nbase_color_texture = "wide.npy"\n')
        with pytest.raises(SssgenError, match=f"texture 'base_color_texture' is {widest + 1} texels wide"):
            render(load(path), gpu, SIZE)


@pytest.mark.parametrize("texel", [np.nan, 1e300])
def test_a_texture_with_nan(scene: Callable[..., str], tmp_path: Path, texel: float) -> None:
    np.save(tmp_path / "none.npy", np.full((2, 2, 3), texel))
    path = scene(f'material = "resin_inlay"\n{BALL}[textures]\nbase_color_texture = "none.npy"\n')
    with pytest.raises(SssgenError, match="a texture contains NaN, infinity or numbers beyond 65504"):
        render(load(path), backends.get("numpy"), SIZE)


def test_an_open_mesh_under_a_pass_gets_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """jade_ring reads the body's back faces: a box without its last triangle has a hole."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += [f"f {a} {b} {c}\nf {a} {c} {d}" for a, b, c, d in faces]
    (tmp_path / "scene.toml").write_text(
        'material = "jade_ring"\nsize = [16, 12]\nsamples = 1\n[geometry]\nkind = "mesh"\nfile = "box.obj"\n'
        "[camera]\nposition = [2.0, 3.0, 5.0]\n[[light]]\ndirection = [0.0, 1.0, 0.0]\ncolor = [1.0, 1.0, 1.0]\n"
    )
    for text, warns in (("\n".join(lines), False), ("\n".join(lines).rsplit("\n", 1)[0], True)):
        (tmp_path / "box.obj").write_text(text)
        picture = str(tmp_path / "picture.png")
        assert main(["render", str(tmp_path / "scene.toml"), "-o", picture, "--backend", "numpy"]) == 0
        assert ("the mesh has holes" in capsys.readouterr().err) == warns
