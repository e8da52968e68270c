"""Draws the forward pass of the emitted .shader for Unity, with the inputs of the engine.

With the stand-in headers, the lighting is that of the other targets' shells, so all pictures must be the same. With
Unity's own headers (SSSGEN_UNITY_INCLUDES), only pictures that do not depend on Unity's standard lighting must.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from folders import EXAMPLES
from lamp_scene import BALL, LAMP, RIBS, SIZE, largest_difference
from sssgen.cli.main import main
from sssgen.run import backends
from sssgen.run.backends import Backend, Text
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.scene.pictures import images
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError

UNITY = ["unity", "unity-urp"]
PROBE = """
uniform float shade : hint_range(0.0, 1.0) = 0.5;
uniform vec3 mixed : source_color = vec3(1.0, 0.5, 0.25);
uniform mat2 turn = mat2(1.0, 2.0, 3.0, 4.0);
uniform int steps : hint_range(1, 8) = 3;
uniform sampler2D marks : source_color, default_white;

/** Shows what the engine gives.
role: surface
*/
void probe(uv_position uv, world_position P, world_direction V, world_direction N, world_direction T, world_direction B,
    object_position P_object, object_direction V_object, object_direction N_object, float time,
    vec2 screen_uv, float eye_distance,
    out vec3 albedo, out float alpha, out vec3 emission) {
    albedo = vec3(0.5) * shade;
    alpha = P_object.y > 0.6 ? 0.25 : 1.0;
    vec2 turned = turn * vec2(0.01, 0.02);
    emission = 0.25 + 0.25 * vec3(N.x, dot(N, V), P.y) + vec3(turned, time * 0.01) + mixed * 0.05 * float(steps);
    emission += 0.2 * texture(marks, uv).rgb + 0.05 * T + 0.04 * B + 0.03 * V_object + 0.02 * N_object;
    emission += vec3(0.2 * screen_uv, 0.02 * eye_distance);
}
"""
OWN_LIGHTING = """
[material]
name = "own"
shading = "unlit"
[[surface]]
technique = "base_color"
[[surface]]
technique = "normal_map"
[[surface]]
technique = "pbr_constants"
[[lighting]]
technique = "standard"
"""
LIT_FROM_BEHIND = {
    "a lamp inside": "[[light]]\nposition = [0.2, 0.1, -0.2]\ncolor = [0.3, 0.25, 0.2]\n",
    "light from afar": "[[light]]\ndirection = [0.0, 0.0, -1.0]\ncolor = [1.0, 0.9, 0.8]\n",
    "both": "[[light]]\nposition = [0.2, 0.1, -0.2]\ncolor = [0.1, 0.2, 0.1]\n"
    "[[light]]\ndirection = [0.0, 0.0, -1.0]\ncolor = [0.3, 0.3, 0.3]\n",
}
"""Lamps behind a ball in the middle: all visible light is transmitted."""


@pytest.fixture(params=UNITY)
def unity(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> UnityHLSL:
    result = backend(request.param)
    assert isinstance(result, UnityHLSL)
    return result


@pytest.fixture
def standin(unity: UnityHLSL) -> UnityHLSL:
    if unity.unity.real:
        pytest.skip("Unity's standard lighting is not ours")
    return unity


def scene(text: str, folder: Path = EXAMPLES) -> Scene:
    return parse_scene(text, folder / "scene.toml")


def example(name: str) -> Scene:
    """The scene of an example, with one sample per pixel."""
    text = (EXAMPLES / name / "scene.toml").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("samples")]
    described = scene("\n".join(["samples = 1", *lines]), EXAMPLES / name)
    return dataclasses.replace(described, shell={})  # Unity has its own


def picture_of(described: Scene, machine: Backend) -> RenderedPicture:
    return render(described, machine, SIZE)


def test_a_raymarched_scene(unity: UnityHLSL) -> None:
    """The picture is the same as in GLSL, which encodes it with a gamma of 2.2; in Unity the engine encodes."""
    described = scene('material = "jelly_cubes"\nsamples = 1\ntime = 1.0\n[parameters]\nglow_strength = 2.0\n')
    encoded = picture_of(described, backends.get("gl")).encoded
    result = images.encode_srgb(encoded**2.2)
    assert 255.0 * np.abs(picture_of(described, unity).encoded - result).max() < 0.5
    assert result.std() > 0.1


@pytest.mark.parametrize("alpha_mode", ["opaque", "mask", "blend"])
def test_every_input_of_the_engine(unity: UnityHLSL, alpha_mode: str, tmp_path: Path) -> None:
    """Spaces, uniforms of every kind, textures, time, alpha are as in NumPy; with the stand-in headers, light too."""
    (tmp_path / "probe.sss").write_text(PROBE, encoding="utf-8")
    images.write_png(tmp_path / "marks.png", np.random.default_rng(5).random((8, 16, 3)))
    head = f'[material]\nname = "probe"\nshading = "lit"\nalpha_mode = "{alpha_mode}"\n'
    (tmp_path / "probe.toml").write_text(f'{head}[surface]\ntechnique = "probe.sss"\n', encoding="utf-8")
    values = "[parameters]\nshade = 0.75\nmixed = [0.1, 0.9, 0.4]\nturn = [1, 0, 0.5, 2]\nsteps = 5\n"
    ambient, lights = ("[0, 0, 0]", "") if unity.unity.real else ("[0.2, 0.3, 0.4]", LAMP)
    text = f'material = "probe.toml"\nsamples = 2\ntime = 3.0\nambient = {ambient}\n{BALL}{lights}{values}'
    described = scene(text + '[textures]\nmarks = "marks.png"\n', tmp_path)
    result, oracle = picture_of(described, unity), picture_of(described, backends.get("numpy"))
    assert largest_difference(result, oracle) < 0.3
    np.testing.assert_allclose(result.covered, oracle.covered)


@pytest.mark.parametrize("name", ["paper_lantern", "ice", "resin_inlay"])
def test_examples_equal_glsl(standin: UnityHLSL, name: str) -> None:
    described = example(name)
    gl = picture_of(described, backends.get("gl"))
    assert largest_difference(picture_of(described, standin), gl) < 0.3
    assert gl.encoded.std() > 0.05


def test_an_unlit_surface_with_its_own_lighting(unity: UnityHLSL, tmp_path: Path) -> None:
    """The material's own formulas use the main light, so the result does not depend on Unity's lighting."""
    (tmp_path / "own.toml").write_text(OWN_LIGHTING, encoding="utf-8")
    light = "[[light]]\ndirection = [1, 2, 2]\ncolor = [0.9, 0.8, 0.7]\n"
    described = scene(f'material = "own.toml"\nsamples = 1\n{BALL}{light}', tmp_path)
    gl = picture_of(described, backends.get("gl"))
    assert largest_difference(picture_of(described, unity), gl) < 0.3
    assert gl.linear.max() > 0.3


@pytest.mark.parametrize("lights", LIT_FROM_BEHIND.values(), ids=LIT_FROM_BEHIND)
def test_transmitted_light_is_equal_in_glsl(unity: UnityHLSL, lights: str) -> None:
    """The translucency lobe of each kind of light counts once, with any lighting."""
    ball = '[geometry]\nkind = "ball"\nrotation = [20, 30, 40]\nscale = 0.9\n'
    values = "[parameters]\npower = 2.0\nscale = 1.5\ndistortion = 0.4\n"
    described = scene(f'material = "paper_lantern"\nsamples = 1\n{ball}{lights}{values}{RIBS}')
    gl = picture_of(described, backends.get("gl"))
    assert gl.linear.max() > 0.1
    assert largest_difference(picture_of(described, unity), gl) < 0.3


def test_ambient_light(unity: UnityHLSL) -> None:
    """Unity subtracts the 4 % that a dielectric surface reflects."""
    described = scene(f'material = "paper_lantern"\nsamples = 1\nambient = [0.2, 0.4, 0.6]\n{BALL}{RIBS}')
    result, gl = picture_of(described, unity), picture_of(described, backends.get("gl"))
    on = gl.covered > 0.99
    expected = 0.96 if unity.unity.real else 1.0
    np.testing.assert_allclose(result.linear[on], expected * gl.linear[on], rtol=2e-3)
    assert gl.linear[on].min() > 0.1


def test_the_lantern_equals_glsl_approximately(unity: UnityHLSL) -> None:
    """Two lights, ambient light, normal map and thickness map, also with Unity's own lighting."""
    described = example("paper_lantern")
    result, gl = picture_of(described, unity).encoded, picture_of(described, backends.get("gl")).encoded
    assert np.corrcoef(result.ravel(), gl.ravel())[0, 1] > 0.99
    assert result.mean() == pytest.approx(gl.mean(), rel=0.02)


def test_places_on_the_screen_for_each_light(unity: UnityHLSL, tmp_path: Path) -> None:
    """A technique that runs once per light has the fragment's place on the screen and its distance from the eye."""
    text = (
        "/** Shows both.\nrole: translucency\n*/\nvec3 shown(world_direction L, vec2 screen_uv, float eye_distance) {\n"
    )
    text += "    return vec3(screen_uv, 0.1 * eye_distance) + 0.0 * L.x;\n}\n"
    (tmp_path / "shown.sss").write_text(text, encoding="utf-8")
    material = '[material]\nname = "shown"\nshading = "lit"\n[translucency]\ntechnique = "shown.sss"\n'
    (tmp_path / "shown.toml").write_text(material, encoding="utf-8")
    camera = "[camera]\nposition = [0.5, 1.0, 4.0]\n"
    light = "[[light]]\ndirection = [0.5, -0.2, -1.0]\ncolor = [0.9, 0.8, 0.7]\n"
    described = scene(f'material = "shown.toml"\nsamples = 1\n{BALL}{camera}{light}', tmp_path)
    oracle = picture_of(described, backends.get("numpy"))
    assert largest_difference(picture_of(described, unity), oracle) < 0.3
    assert np.ptp(oracle.linear[oracle.covered == 1.0], axis=0).min() > 0.02


def test_how_near_each_light_is(unity: UnityHLSL, tmp_path: Path) -> None:
    """A technique has 1 over the distance of a lamp, and 0 for a light from afar."""
    text = "/** Shows it.\nrole: translucency\n*/\nvec3 shown(world_direction L, float light_nearness) {\n"
    text += "    return vec3(light_nearness, light_nearness * light_nearness, 0.2) + 0.0 * L.x;\n}\n"
    (tmp_path / "shown.sss").write_text(text, encoding="utf-8")
    material = '[material]\nname = "shown"\nshading = "lit"\n[translucency]\ntechnique = "shown.sss"\n'
    (tmp_path / "shown.toml").write_text(material, encoding="utf-8")
    means = {}
    for lights in LIT_FROM_BEHIND.values():
        described = scene(f'material = "shown.toml"\nsamples = 1\n{BALL}{lights}', tmp_path)
        oracle = picture_of(described, backends.get("numpy"))
        assert largest_difference(picture_of(described, unity), oracle) < 0.5
        means[lights] = oracle.linear[oracle.covered == 1.0].mean(axis=0)
    lamp, sun, both = means.values()
    assert sun[0] < 0.02 < 0.05 < both[0] < lamp[0]


@pytest.mark.parametrize("name", UNITY)
def test_the_command(name: str, backend: Callable[[str], Backend], tmp_path: Path) -> None:
    backend(name)
    path, out = tmp_path / "scene.toml", str(tmp_path / "x.png")
    path.write_text(f'material = "paper_lantern"\n{BALL}{LAMP}{RIBS}', encoding="utf-8")
    assert main(["render", str(path), "-o", out, "--size", "24x18", "--backend", name]) == 0
    assert images.read(out).std() > 0.01


@pytest.mark.parametrize("text", ['Shader "x" {', 'Shader "x" { SubShader { Pass {\nHLSLPROGRAM\n#if\nENDHLSL\n} } }'])
def test_a_shader_that_cannot_be_read(unity: UnityHLSL, text: str) -> None:
    with pytest.raises(SssgenError, match=unity.name):
        unity.forward(Text(text), "vertex", ())


def test_a_shader_that_does_not_compile(unity: UnityHLSL) -> None:
    code = "#pragma fragment frag\nfloat4 frag() : SV_Target { return missing; }"
    shader = Text(f'Shader "x" {{ SubShader {{ Pass {{\nHLSLPROGRAM\n{code}\nENDHLSL\n}} }} }}', {4: "glow.sss:7:1"})
    with pytest.raises(SssgenError, match=rf"{unity.name}: forward pass: .*missing[^$]*glow.sss:7"):
        unity.whole.glsl(unity.forward(shader, "fragment", ()), "fragment")


def test_in_another_process(unity: UnityHLSL, backend: Callable[[str], Backend]) -> None:
    """`sssgen ci` draws in another process. The lamp has a colour after a number, which GLSL would not pack so."""
    backend("gl")
    path = EXAMPLES / "ci" / "scenes" / "lamp.toml"
    scene = parse_scene(path.read_text(encoding="utf-8"), str(path))
    other = BackendProcess(unity.name)
    try:
        moved = render(scene, other, SIZE)
    finally:
        other.close()
    expected = render(scene, unity, SIZE)
    assert np.array_equal(moved.linear, expected.linear)
    assert largest_difference(expected, render(scene, backends.get("gl"), SIZE)) < (10.0 if unity.unity.real else 0.3)
