"""The target shadertoy: its pictures are those of the same scene in NumPy, and what it cannot supply is an error."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

import sssgen
from folders import EXAMPLES
from sssgen.cli.main import main
from sssgen.lang.plain_glsl import load_glsl
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import transpile
from sssgen.run import backends
from sssgen.run.backends import Array, Backend, Bound, Drawing, DrawingBackend, Place, Stage, Text
from sssgen.run.compilers import Source
from sssgen.run.compilers.shadertoy_page import program
from sssgen.run.evaluate.evaluation import default_texture
from sssgen.run.render.scene_render import render
from sssgen.run.render.scene_values import shell_of
from sssgen.scene.pictures.images import decode_srgb, encode_srgb, write_png
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import UnsupportedError
from sssgen.targets.runtime.numpy_textures import Texture

SIZE = (64, 48)
SCENE = """
material = "{material}"
samples = 1
time = 2.5
ambient = [0.06, 0.07, 0.08]
background = [[0.02, 0.025, 0.035], [0.02, 0.025, 0.035]]
[geometry]
kind = "ball"
[camera]
position = {camera}
target = [0.0, 0.0, 0.0]
field_of_view = 35.0
[[light]]
direction = [-0.8, 0.5, -1.6]
color = [1.3, 1.2, 1.0]
[[light]]
position = [2.0, 2.5, 3.0]
color = [6.0, 6.0, 6.0]
"""
"""The scene of the shell."""


def picture(
    gl: Backend, text: str, textures: Mapping[str, Texture], time: float, mouse: tuple[float, float] = (0.0, 0.0)
) -> Array:
    """What the site shows, row 0 at the top."""
    values = {
        "iResolution": np.array([*SIZE, 1.0]),
        "iTime": np.array(time),
        "iMouse": np.array([*mouse, 0.0, 0.0]),
    }
    bound = {name: Bound(texture, Place(0, 0)) for name, texture in textures.items()}
    stage = Stage(Text(program(text)))
    vertex = Stage(Text("#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0"
                        " - 1.0, 0.0, 1.0); }"))  # fmt: skip
    drawing = Drawing(SIZE, stage, vertex, floats=True, values=values, textures=bound)
    assert isinstance(gl, DrawingBackend)
    return gl.draw(drawing)[::-1, :, :3]


def channels(compiled: sssgen.Compiled, scene: Scene) -> dict[str, Texture]:
    """The textures of a scene by channel, as the site has them: colours stay encoded."""
    reflection, textures = compiled.reflection, {}
    given = shell_of(scene, load_material(scene.material), reflection).textures
    for index, texture in enumerate(reflection["textures"]):
        chosen = given.get(texture["source_name"]) or default_texture(texture["type"], texture["default"])
        if texture["color_space"] == "sRGB":
            level = chosen.levels[0]
            encoded = np.concatenate([encode_srgb(level[..., :3]), level[..., 3:]], axis=-1)
            chosen = Texture(encoded, chosen.filter, chosen.wrap, mipmaps=len(chosen.levels) > 1)
        textures[f"iChannel{index}"] = chosen
    return textures


def camera(mouse: tuple[float, float]) -> list[float]:
    """The position of the shell's camera."""
    across, up = ((place / side - 0.5) if mouse[0] else 0.0 for place, side in zip(mouse, SIZE, strict=True))
    turn, height = -2.0 * math.pi * across, min(max(0.25 - 3.0 * up, -1.5), 1.5)
    return [4.0 * math.cos(height) * math.sin(turn), 4.0 * math.sin(height), 4.0 * math.cos(height) * math.cos(turn)]


@pytest.mark.parametrize("textured", [False, True])
@pytest.mark.parametrize("mouse", [(0.0, 0.0), (50.0, 30.0)])
@pytest.mark.parametrize("name", ["ice", "paper_lantern", "ice_inlay", "resin_inlay"])
def test_a_ball_is_that_of_numpy(
    name: str, mouse: tuple[float, float], textured: bool, backend: Callable[[str], Backend], tmp_path: Path
) -> None:
    """Each example on the shell's ball, before and after the mouse has turned the camera."""
    compiled = sssgen.compile(name, "shadertoy")
    names = [texture["source_name"] for texture in compiled.reflection["textures"]]
    files = {texture: EXAMPLES / name / "textures" / texture.replace("_texture", ".png") for texture in names}
    maps = "".join([f'{texture} = "{path}"\n' for texture, path in files.items() if textured and path.is_file()])
    if "thickness_texture" in names and not textured:  # without the map nothing is drawn
        write_png(str(tmp_path / "black.png"), np.zeros((1, 1, 3)))
        maps = 'thickness_texture = "black.png"\n'
    text = f"{SCENE.format(material=name, camera=camera(mouse))}[textures]\n{maps}"
    scene = parse_scene(text, tmp_path / "scene.toml")
    shown = picture(backend("gl"), compiled.files[f"{name}.shadertoy.glsl"], channels(compiled, scene), 2.5, mouse)
    oracle = render(scene, backends.get("numpy"), SIZE)
    difference = np.abs(np.clip(shown, 0.0, 1.0) - np.clip(oracle.encoded, 0.0, 1.0)).max(axis=-1)
    ball = difference[oracle.covered > 0.0]
    assert np.ptp(oracle.encoded) > 0.3 and (shown != shown[0, 0]).any(axis=-1).sum() > 300
    if textured:  # levels of detail of encoded and of decoded colours differ
        assert maps and ball.mean() < 4.0 / 255.0
    else:
        assert np.median(ball) < 1e-4 and (ball > 1.0 / 255.0).mean() < 0.01


def test_tones_are_mapped_as_in_numpy(backend: Callable[[str], Backend], tmp_path: Path) -> None:
    material = 'title = "Wax"\n[surface]\ntechnique = "base_color"\n[tone_mapping]\ntechnique = "khronos_neutral"\n'
    (tmp_path / "wax.toml").write_text(f'[material]\nname = "wax"\n{material}exposure = 2.0\n', encoding="utf-8")
    scene = parse_scene(SCENE.format(material="wax.toml", camera=camera((0.0, 0.0))), tmp_path / "scene.toml")
    compiled = sssgen.compile(str(tmp_path / "wax.toml"), "shadertoy")
    shown = picture(backend("gl"), compiled.files["wax.shadertoy.glsl"], channels(compiled, scene), 2.5)
    oracle = render(scene, backends.get("numpy"), SIZE)
    inside = oracle.covered > 0.0
    assert 0.95 < oracle.linear[inside].max() <= 1.0
    assert (np.abs(shown - oracle.encoded)[inside].max(axis=-1) > 1.0 / 255.0).mean() < 0.01


def test_an_srgb_texture_is_decoded(backend: Callable[[str], Backend], tmp_path: Path) -> None:
    (tmp_path / "flat.toml").write_text(
        '[material]\nname = "flat"\n[[surface]]\ntechnique = "base_color"\n', encoding="utf-8"
    )
    compiled = sssgen.compile(str(tmp_path / "flat.toml"), "shadertoy")
    text = compiled.files["flat.shadertoy.glsl"]
    assert "texel = tint * linear_texel(texture(base_color_texture, uv));" in text
    levels = [np.full((2, 2, 4), 0.5)], [np.full((2, 2, 4), float(decode_srgb(np.array(0.5))))]
    stored, decoded = (Texture(level[0]) for level in levels)
    white = text.replace("linear_texel(texture(", "(texture(")
    shown = picture(backend("gl"), text, {"iChannel0": stored}, 0.0)
    expected = picture(backend("gl"), white, {"iChannel0": decoded}, 0.0)
    np.testing.assert_allclose(shown, expected, atol=1e-3)
    assert np.abs(shown - picture(backend("gl"), white, {"iChannel0": stored}, 0.0)).max() > 0.05


def test_a_raymarched_material_draws_its_own_scene(backend: Callable[[str], Backend]) -> None:
    """The middle square of the picture is what GLSL ES shows on a square one."""
    text = sssgen.compile("jelly_cubes", "shadertoy").files["jelly_cubes.shadertoy.glsl"]
    shown = picture(backend("gl"), text, {}, 1.0)
    scene = parse_scene('material = "jelly_cubes"\nsamples = 1\ntime = 1.0\n', EXAMPLES / "scene.toml")
    oracle = render(scene, backends.get("numpy"), (SIZE[1], SIZE[1])).encoded
    edge = (SIZE[0] - SIZE[1]) // 2
    # jelly_cubes encodes with a power of 2.2 instead of sRGB: compared in linear light
    difference = np.abs(decode_srgb(shown[:, edge:-edge]) - decode_srgb(oracle)).max(axis=-1)
    assert np.ptp(oracle) > 0.3 and (difference > 2.0 / 255.0).mean() < 0.01


def test_constants_have_the_materials_values_and_their_documentation(
    assert_compiles: Callable[[Source], None],
) -> None:
    text = sssgen.compile("ice", "shadertoy").files["ice.shadertoy.glsl"]
    assert "uniform" not in re.sub(r"//.*", "", text)
    assert "// Number of cells along one unit of texture coordinate. (1 to 200)\nconst float cell_count = 10.0;" in text
    assert "const vec4 tint = vec4(0.75, 0.9, 1.0, 1.0);" in text
    assert "#define base_color_texture iChannel0" in text and "void mainImage(out vec4 frag_color, in vec2" in text
    assert_compiles(Source(text, "shadertoy", "fragment", "mainImage"))


KINDS = """
/// A number.
uniform int count = 3;
uniform uint bits = 4000000000u;
uniform bool on = true;
uniform mat2 turn;
uniform ivec3 steps = ivec3(1, -2, 3);
uniform float row[3];
/** Uses all of them.
role: surface
*/
void kinds(vec2 uv, out vec3 albedo)
{
    float sum = row[1] + float(count) + float(bits & 15u) + (turn * uv).x + float(steps.y);
    albedo = vec3(on ? sum : 0.0);
}
"""


def test_every_type_of_a_constant(tmp_path: Path, assert_compiles: Callable[[Source], None]) -> None:
    (tmp_path / "kinds.sss").write_text(KINDS, encoding="utf-8")
    path = tmp_path / "kinds.toml"
    path.write_text('[material]\nname = "kinds"\n[[surface]]\ntechnique = "./kinds.sss"\n', encoding="utf-8")
    text = sssgen.compile(str(path), "shadertoy").files["kinds.shadertoy.glsl"]
    for line in (
        "const int count = 3;",
        "const uint bits = 0xee6b2800u;",
        "const bool on = true;",
        "const mat2 turn = mat2(1.0, 0.0, 0.0, 1.0);",
        "const ivec3 steps = ivec3(1, -2, 3);",
        "const float row[3] = float[3](0.0, 0.0, 0.0);",
    ):
        assert line in text
    assert_compiles(Source(text, "shadertoy", "fragment", "mainImage"))


def test_a_cube_map_is_a_channel(tmp_path: Path, assert_compiles: Callable[[Source], None]) -> None:
    head = "uniform samplerCube sky;\n/** The sky.\nrole: surface\n*/\n"
    sky = "void sky_color(world_direction N, out vec3 albedo)\n"
    (tmp_path / "sky_color.sss").write_text(head + sky + "{\n    albedo = texture(sky, N).rgb;\n}\n", encoding="utf-8")
    path = tmp_path / "made.toml"
    path.write_text('[material]\nname = "made"\n[[surface]]\ntechnique = "./sky_color.sss"\n', encoding="utf-8")
    text = sssgen.compile(str(path), "shadertoy").files["made.shadertoy.glsl"]
    assert "// iChannel0 is sky, a cube map.\n" in text and "samplerCube iChannel0" in program(text)
    assert_compiles(Source(text, "shadertoy", "fragment", "mainImage"))


@pytest.mark.parametrize(
    ("name", "wrong", "place"),
    [
        ("wax_mouse", "Shadertoy cannot supply 'distance_map': it has no sampler3D", "distance/distance_texture.sss"),
        ("jade_ring", "cannot supply 'back_face_map': no program draws it", "thickness/back_face_thickness.sss"),
    ],
)  # fmt: skip
def test_what_shadertoy_cannot_supply(name: str, wrong: str, place: str) -> None:
    for form in ("shader", "functions"):
        with pytest.raises(UnsupportedError, match=wrong) as raised:
            sssgen.compile(name, "shadertoy", form)
        first = raised.value.diagnostics[0]
        assert first.span.file == place and first.span.line and "another target" in first.hint


def test_five_textures_are_one_error(tmp_path: Path) -> None:
    textures = "".join(f"uniform sampler2D map_{index};\n" for index in range(5))
    head = "/** Five.\nrole: surface\n*/\nvoid five(vec2 uv, out vec3 albedo)\n"
    read = " + ".join(f"texture(map_{index}, uv).rgb" for index in range(5))
    (tmp_path / "five.sss").write_text(f"{textures}{head}{{\n    albedo = {read};\n}}\n", encoding="utf-8")
    path = tmp_path / "made.toml"
    path.write_text('[material]\nname = "made"\n[[surface]]\ntechnique = "./five.sss"\n', encoding="utf-8")
    with pytest.raises(UnsupportedError, match="has 4 textures, the material reads 5: map_0, map_1") as raised:
        sssgen.compile(str(path), "shadertoy")
    (only,) = raised.value.diagnostics
    assert only.span.line == 5 and only.hint


def test_all_targets_leave_out_what_one_cannot_carry(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["emit", "wax_mouse", "--target", "all", "-o", str(tmp_path)]) == 0
    assert "wax_mouse is not emitted for shadertoy: Shadertoy cannot supply" in capsys.readouterr().err
    assert (tmp_path / "wax_mouse.wgsl").is_file() and not list(tmp_path.glob("*shadertoy*"))
    named = tmp_path / "named"
    assert main(["emit", "wax_mouse", "--target", "shadertoy,wgsl", "-o", str(named)]) == 1
    assert "error: wax_mouse is not emitted for shadertoy" in capsys.readouterr().err
    assert (named / "wax_mouse.wgsl").is_file() and not list(named.glob("*shadertoy*"))


def test_plain_functions_have_a_form(assert_compiles: Callable[[Source], None], tmp_path: Path) -> None:
    path = tmp_path / "plain.glsl"
    path.write_text("uniform float gain;\nfloat brighter(float x) { return gain * x; }\n", encoding="utf-8")
    compiled = transpile(load_glsl(path).module, "shadertoy", "plain")
    text = compiled.files["plain.shadertoy.functions.glsl"]
    assert "float brighter(float x, float gain)" in text
    assert_compiles(Source(text, "shadertoy", "library"))
