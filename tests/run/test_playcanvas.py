"""Emitted modules in PlayCanvas: WebGL 2 and WebGPU, in a headless Chromium."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from area_light_cases import check_area_light, check_shadow_of_area_light
from engine_cases import (
    HEAD,
    MATERIALS,
    MESHES,
    SIZE,
    chain_case,
    check_refusals,
    check_reported_errors,
    check_texts,
    mesh_of,
    through,
)
from folders import ROOT
from shadow_cases import LAMPS, Scene, check_absence, check_shadows, modules_of
from skips import or_skip
from slow_cases import some_slow
from sssgen.material.material_loading import load_material
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EnginePage
from sssgen.run.backends.web_engines import PLAYCANVAS
from sssgen.run.compilers import Compiler
from sssgen.run.render import page_values, shade_numpy
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import scene_loading
from sssgen.support.diagnostics import SssgenError
from surroundings_cases import check_surroundings

BLACK: Mapping[str, Any] = {"diffuse": 0.0, "useMetalness": False, "specular": 0.0, "enableGGXSpecular": False}
"""PlayCanvas's own reflection is gone: what is left is emission, and the light that comes through."""
SLOW = pytest.mark.slow
CLUSTERED = pytest.mark.parametrize("clustered", [True, False], ids=["clustered", "listed"])
"""PlayCanvas has two loops over lights."""
EXAMPLES = pytest.mark.parametrize(
    ("name", "clustered"),
    [
        pytest.param(name, clustered, marks=[] if (name, clustered) == ("ice", True) else [SLOW])
        for name in MESHES
        for clustered in (True, False)
    ],
)


@pytest.fixture(scope="module", params=some_slow(PLAYCANVAS.renderers, "webgl2"))
def playcanvas(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    page: EnginePage = or_skip(partial(EnginePage, PLAYCANVAS), request.param)
    yield page
    page.page.close()


def drawn(page: EnginePage, name: str, mesh: PlacedMesh, properties: Mapping[str, Any], **changes: Any) -> Array:
    shell = dataclasses.replace(mesh.shell, **changes)
    return page_values.shade(sssgen.compile(name, "playcanvas"), shell, page, mesh.size, mesh.points, properties)


@EXAMPLES
def test_light_that_comes_through_is_that_of_the_oracle(playcanvas: EnginePage, name: str, clustered: bool) -> None:
    mesh = mesh_of(name)
    picture = drawn(playcanvas, name, mesh, {**BLACK, "clustered": clustered}, ambient=(0.0, 0.0, 0.0))
    expected = through(name, mesh)
    assert np.abs(picture - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert (expected[..., :3][mesh.hit].max() > 0.1) == (name != "resin_inlay")  # which reflects only


@EXAMPLES
def test_own_light_is_that_of_the_oracle(playcanvas: EnginePage, name: str, clustered: bool) -> None:
    """All light of the picture, the ambient one as well."""
    mesh = mesh_of(name)
    picture = drawn(playcanvas, name, mesh, {"ownLight": True, "clustered": clustered})
    expected = shade_numpy.shade(sssgen.compile(name, "numpy"), mesh.shell, mesh.size, mesh.points, "float64")
    shown = mesh.hit & (expected[..., 3] >= 0.5)
    # PlayCanvas stores the colours of clustered lights as half floats
    assert (np.abs(picture - expected) / np.maximum(expected, 1.0))[..., :3][shown].max() < 1.0 / 255.0


@SLOW
@pytest.mark.parametrize("name", MESHES)
def test_playcanvas_lights_the_surface(playcanvas: EnginePage, name: str) -> None:
    """The reflected light is PlayCanvas's own: not the oracle's numbers, but the same picture."""
    mesh = mesh_of(name)
    picture = drawn(playcanvas, name, mesh, {})
    expected = shade_numpy.shade(sssgen.compile(name, "numpy"), mesh.shell, mesh.size, mesh.points, "float64")
    shown = mesh.hit & (expected[..., 3] >= 0.5)
    ours, theirs = (np.clip(one[..., :3][shown], 0.0, 1.0) for one in (expected, picture))
    assert np.isfinite(picture).all()
    assert np.abs(ours - theirs).mean() < 0.03
    assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.95


@pytest.mark.parametrize(
    ("name", "front", "light"),
    [
        pytest.param(name, front, light, marks=[] if (front, light) == (True, "point") else [SLOW])
        for name in MATERIALS
        for front in (True, False)
        for light in ("point", "direction")
        if front or name != "rays"
    ],
)
def test_every_value_of_the_chain(playcanvas: EnginePage, name: str, front: bool, light: str, tmp_path: Path) -> None:
    """A turned, stretched and mirrored body from both sides: every input is in its space, per surface and light."""
    case = chain_case(name, front, light, tmp_path)
    compiled = sssgen.compile(case.material, "playcanvas")
    for clustered in (True, False) if name == "lit" and light == "point" else (True,):
        properties = {"clustered": clustered, **(BLACK if name == "lit" else {})}
        picture = page_values.shade(compiled, case.shell, playcanvas, case.mesh.size, case.points, properties)
        difference = np.abs(picture[..., :3] - case.expected[..., :3])[case.mesh.hit]
        assert difference.max() < 3e-3 and picture[..., :3][case.mesh.hit].std() > 0.02


@SLOW
def test_a_raymarched_material_fills_its_mesh(playcanvas: EnginePage) -> None:
    scene = dataclasses.replace(scene_loading.load(str(ROOT / "examples/jelly_cubes/scene.toml")), size=SIZE)
    numpy = sssgen.compile("jelly_cubes", "numpy")
    shell = shell_of(scene, load_material(scene.material), numpy.reflection)
    picture = page_values.shade(sssgen.compile("jelly_cubes", "playcanvas"), shell, playcanvas, SIZE, None)
    expected = shade_numpy.shade(numpy, shell, SIZE, None, "float64") ** 2.2  # its output technique, left out
    assert np.quantile(np.abs(picture - expected)[..., :3], 0.98) < 1.0 / 255.0  # but for edges, where a ray may miss


@SLOW
def test_tangents_come_from_the_texture_coordinates_where_the_mesh_has_none(playcanvas: EnginePage) -> None:
    mesh, compiled = mesh_of("ice"), sssgen.compile("ice", "playcanvas")
    pictures = [
        page_values.shade(compiled, mesh.shell, playcanvas, mesh.size, mesh.points, BLACK, tangents)[..., :3]
        for tangents in (True, False)
    ]
    # the sheet is planar: its derivatives are exact inside of it
    inner = mesh.hit.copy()
    for axis in (0, 1):
        for step in (-2, -1, 1, 2):
            inner &= np.roll(mesh.hit, step, axis)
    difference = np.abs(pictures[0] - pictures[1])[inner].max(axis=-1)
    assert np.quantile(difference, 0.95) < 1.0 / 255.0 and pictures[1][inner].max() > 0.2


@SLOW
def test_properties_have_the_defaults_of_the_material(playcanvas: EnginePage) -> None:
    """Without values and textures, the picture is that of the oracle with the defaults; a volume has its texel, too."""
    for name in ("paper_lantern", "wax_mouse"):
        mesh = mesh_of(name)
        bare = mesh._replace(shell=dataclasses.replace(mesh.shell, parameters={}, textures={}, ambient=(0.0, 0.0, 0.0)))
        picture = drawn(playcanvas, name, bare, BLACK)
        assert np.abs(picture - through(name, bare))[..., :3][mesh.hit].max() < 1.0 / 255.0


TYPES = """
/// A.
uniform bool on = true;
/// A.
uniform int count = 3;
/// A.
uniform uint bits = 5u;
/// A.
uniform ivec3 places = ivec3(1, 2, 3);
/// A.
uniform mat3 three = mat3(0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9);
/// A.
uniform mat4 four = mat4(0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6);
/// O.
uniform float varying_weight = 0.25;
"""
BODY = """void made(out vec3 emission)
{
    float saturate = varying_weight;
    float PI = 4.0 * saturate;
    vec3 sum = three * vec3(1.0, 2.0, 3.0) + (four * vec4(1.0, 2.0, 3.0, 4.0)).xyz;
    emission = on ? PI * (sum + vec3(float(count), float(bits), float(places.x + 2 * places.z))) : vec3(0.0);
}
"""


def test_types_of_parameters_and_names_of_macros(playcanvas: EnginePage, tmp_path: Path) -> None:
    """Every type arrives, and PI, a macro of PlayCanvas's shaders, is free."""
    (tmp_path / "made.sss").write_text(TYPES + HEAD.format("surface") + BODY, encoding="utf-8")
    (tmp_path / "m.toml").write_text('[material]\nname = "m"\n[[surface]]\ntechnique = "./made.sss"\n', "utf-8")
    mesh = mesh_of("wax_mouse")
    picture = drawn(playcanvas, str(tmp_path / "m.toml"), mesh, BLACK, parameters={}, textures={}, ambient=())
    three, four = 0.1 * np.arange(1.0, 10.0).reshape(3, 3).T, 0.1 * np.arange(1.0, 17.0).reshape(4, 4).T
    expected = three @ [1, 2, 3] + (four @ [1, 2, 3, 4])[:3] + [3, 5, 7]
    assert np.abs(picture[..., :3][mesh.hit] - expected).max() < 1e-5


def test_a_type_that_it_cannot_set_is_refused(tmp_path: Path) -> None:
    text = "/// A.\nuniform mat2 m = mat2(1.0, 0.0, 0.0, 1.0);\n" + HEAD.format("surface")
    text += "void made(out vec3 emission) { emission = vec3(m * vec2(1.0, 2.0), 0.0); }\n"
    (tmp_path / "made.sss").write_text(text, encoding="utf-8")
    (tmp_path / "m.toml").write_text('[material]\nname = "m"\n[[surface]]\ntechnique = "./made.sss"\n', "utf-8")
    with pytest.raises(SssgenError, match="'m' cannot be a parameter in PlayCanvas: its type is mat2"):
        sssgen.compile(str(tmp_path / "m.toml"), "playcanvas")


LEAF = """[material]
name = "leaf"
two_sided = true
[[thickness]]
technique = "constant_thickness"
[[thickness]]
technique = "beer_lambert"
[[surface]]
technique = "base_color"
[[surface]]
technique = "pbr_constants"
[translucency]
technique = "wrap_lighting"
"""


@SLOW
@pytest.mark.parametrize("front", [True, False], ids=["front", "back"])
@pytest.mark.parametrize("behind", [True, False], ids=["lit from behind", "lit from the front"])
def test_a_leaf_with_two_sides(playcanvas: EnginePage, front: bool, behind: bool, tmp_path: Path) -> None:
    path = tmp_path / "leaf.toml"
    path.write_text(LEAF, encoding="utf-8")
    mesh = mesh_of("wax_mouse")
    towards = np.asarray(mesh.shell.camera_position, float) * (-1.0 if behind else 1.0)
    shell = dataclasses.replace(
        mesh.shell, parameters={}, textures={}, front=front,
        light_positions=np.array([[*towards, 0.0]]), light_colors=np.array([[0.9, 0.7, 0.5]]),
    )  # fmt: skip
    placed = mesh._replace(shell=shell)
    expected = shade_numpy.shade(sssgen.compile(str(path), "numpy"), shell, mesh.size, mesh.points, "float64")
    whole = drawn(playcanvas, str(path), placed, {"ownLight": True})
    assert np.abs(whole - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    passed = through(str(path), placed)
    alone = drawn(playcanvas, str(path), placed, BLACK, ambient=(0.0, 0.0, 0.0))
    assert np.abs(alone - passed)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert expected[..., :3][mesh.hit].max() > 0.1


LAYERS = """[[surface]]
technique = "specular_level"
dielectric_specular = 0.25
[[surface]]
technique = "clearcoat_constants"
coat_weight = 0.7
coat_roughness = 0.2
[[surface]]
technique = "sheen_constants"
sheen_tint = [0.5, 0.5, 0.5]
sheen_spread = 0.3
"""
BASE = '[material]\nname = "made"\n[[surface]]\ntechnique = "pbr_constants"\nsurface_roughness = 0.6\n'


@SLOW
def test_layers_are_those_of_its_own_material(playcanvas: EnginePage, tmp_path: Path) -> None:
    """The same picture as without the stages, with PlayCanvas's properties in their place."""
    own = {
        "clearCoat": 0.7, "clearCoatGloss": 0.8, "useMetalnessSpecularColor": True, "specular": 0.5 ** (1 / 2.2),
        "useSheen": True, "sheen": 0.5 ** (1 / 2.2), "sheenGloss": 0.7,
    }  # fmt: skip
    mesh = mesh_of("wax_mouse")
    pictures: list[Array] = []
    for stages, properties in ((LAYERS, {}), ("", own), ("", {})):
        path = tmp_path / f"made{len(pictures)}.toml"
        path.write_text(BASE + stages, encoding="utf-8")
        picture = drawn(playcanvas, str(path), mesh, properties, parameters={}, textures={})
        pictures.append(picture[..., :3][mesh.hit])
    ours, theirs, bare = pictures
    assert np.abs(ours - theirs).max() < 1e-3 and np.abs(ours - bare).max() > 8.0 / 255.0


@SLOW
@CLUSTERED
def test_a_body_does_not_shadow_the_light_that_comes_through_it(playcanvas: EnginePage, clustered: bool) -> None:
    """The material is drawn into shadow maps, with its mask, and the light that comes through stays."""
    mesh = mesh_of("ice")
    properties = {**BLACK, "clustered": clustered, "stage": {"shadows": True}}
    alone = drawn(playcanvas, "ice", mesh, properties, ambient=(0.0, 0.0, 0.0))
    assert np.abs(alone - through("ice", mesh))[..., :3][mesh.hit].max() < 1.0 / 255.0
    whole, dark = (
        drawn(playcanvas, "ice", mesh, {"clustered": clustered, "stage": {"shadows": one}}) for one in (False, True)
    )
    assert (whole - dark)[..., :3][mesh.hit].max() > 8.0 / 255.0  # what it reflects is in its own shadow


@pytest.mark.parametrize(
    ("lamp", "clustered"),
    [
        pytest.param(
            lamp, clustered, marks=[] if (lamp, clustered) in (("point", True), ("direction", False)) else [SLOW]
        )
        for lamp in LAMPS
        for clustered in (True, False)
    ],
)
def test_other_bodies_shadow_the_light_that_comes_through(
    playcanvas: EnginePage, lamp: str, clustered: bool, tmp_path: Path
) -> None:
    """A wall does, wherever it is; the body does not, nor one of another scale with the same material."""
    properties = {**BLACK, "clustered": clustered}
    check_shadows(Scene(playcanvas, modules_of("playcanvas", tmp_path), properties, lamp))


@SLOW
@pytest.mark.parametrize(
    ("sought", "chunk"),
    [
        ("CASTSHADOW", "lightFunctionLightPS"),
        ("cookieIntensity", "clusteredLightPS"),
        ("vPositionW", "lightFunctionShadowPS"),
    ],
)
def test_a_version_without_its_text_of_shadows_is_an_error(
    playcanvas: EnginePage, sought: str, chunk: str, tmp_path: Path
) -> None:
    scene = Scene(playcanvas, modules_of("playcanvas", tmp_path), BLACK, "point")
    said = rf"m: this version of PlayCanvas has no .*{sought}_ABSENT.* in its chunk {chunk}"
    check_absence(scene, sought, said)


@SLOW
def test_a_texture_that_each_light_reads(playcanvas: EnginePage, tmp_path: Path) -> None:
    """Each pixel has lights of its own in a cluster, where WGSL refuses a read with derivatives if it is not asked."""
    text = HEAD.format("translucency") + "vec3 made(uv_position uv) { return texture(seen, vec2(uv)).rgb; }\n"
    text = "/// T.\nuniform sampler2D seen : source_color, default_gray;\n" + text
    (tmp_path / "made.sss").write_text(text, encoding="utf-8")
    (tmp_path / "m.toml").write_text('[material]\nname = "m"\n[translucency]\ntechnique = "./made.sss"\n', "utf-8")
    mesh = mesh_of("wax_mouse")
    lights = {"light_positions": np.array([[0.0, 0.0, 1.0, 0.0]]), "light_colors": np.array([[1.0, 0.5, 0.25]])}
    for place in ([0.0, 0.0, 1.0, 0.0], [0.5, 2.0, 3.0, 1.0]):
        lights["light_positions"] = np.array([place])
        made = mesh._replace(shell=dataclasses.replace(mesh.shell, parameters={}, textures={}, ambient=(), **lights))
        picture = drawn(playcanvas, str(tmp_path / "m.toml"), made, BLACK)
        difference = np.abs(picture - through(str(tmp_path / "m.toml"), made))[..., :3][mesh.hit]
        assert difference.max() < 1.0 / 255.0 and picture[..., :3][mesh.hit].max() > 0.01


@SLOW
def test_another_prefix_draws_the_same(playcanvas: EnginePage) -> None:
    mesh = mesh_of("ice")
    own, other = (
        page_values.shade(
            sssgen.compile("ice", "playcanvas", prefix=prefix), mesh.shell, playcanvas, mesh.size, mesh.points
        )
        for prefix in ("", "wax_")
    )
    assert (own == other).all() and own.max() > 0.2


def test_an_error_of_playcanvas_is_reported(playcanvas: EnginePage) -> None:
    check_reported_errors(playcanvas, "playcanvas", "sss_evaluate_surface")


def test_values_that_it_does_not_take_are_refused(playcanvas: EnginePage) -> None:
    check_refusals(
        playcanvas, "playcanvas", "StandardMaterial", "a pc.Color, or a colour such as '#3070ff'", "a pc.Texture"
    )


@pytest.mark.parametrize("form", ["shader", "functions"])
def test_the_texts_in_a_module_compile(form: str, compiler: Callable[[str], Compiler]) -> None:
    check_texts("playcanvas", form, compiler)


def test_parameters_are_properties() -> None:
    compiled = sssgen.compile("ice", "playcanvas")
    described = "type: 'float', default: 10.0, range: [1.0, 200.0], unit: '1', name: 'sss_cell_count'"
    assert f"  cellCount: {{ {described} }},\n" in compiled.files["ice.mjs"]
    assert "set veinColor(value: number[] | pc.Color | string | pc.Vec3);" in compiled.files["ice.d.mts"]
    names = {uniform["source_name"]: uniform["property"] for uniform in compiled.reflection["uniforms"]}
    assert (names["cell_count"], names["metalness"]) == ("cellCount", "sssMetalness")  # PlayCanvas has a metalness


@pytest.mark.slow
def test_light_of_the_surroundings_comes_through(playcanvas: EnginePage, tmp_path: Path) -> None:
    check_surroundings(playcanvas, "playcanvas", BLACK, {"environment": 0.03}, tmp_path)


@CLUSTERED
@pytest.mark.parametrize("shape", ["rectangle", pytest.param("disk", marks=SLOW), pytest.param("sphere", marks=SLOW)])
def test_light_of_an_area_comes_through(playcanvas: EnginePage, shape: str, clustered: bool, tmp_path: Path) -> None:
    """PlayCanvas's areas shine to both sides."""
    black = {**BLACK, "clustered": clustered}
    white = {name: value for name, value in black.items() if name != "diffuse"}
    check_area_light(playcanvas, "playcanvas", black, white, tmp_path, two_sided=True, shape=shape)


@CLUSTERED
def test_other_bodies_shadow_the_light_of_an_area(playcanvas: EnginePage, clustered: bool, tmp_path: Path) -> None:
    check_shadow_of_area_light(playcanvas, "playcanvas", {**BLACK, "clustered": clustered}, tmp_path)
