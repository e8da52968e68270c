"""Emitted modules in Babylon.js: its WebGL 2 engine and its WebGPU engine, in a headless Chromium."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from area_light_cases import check_area_light
from engine_cases import (
    HEAD,
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
from shadow_cases import Scene, check_absence, check_shadows, modules_of
from skips import or_skip
from slow_cases import some_slow
from sssgen.material.material_loading import load_material, parse_material
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EnginePage
from sssgen.run.backends.web_engines import BABYLON
from sssgen.run.compilers import Compiler
from sssgen.run.render import page_values, shade_numpy
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import scene_loading
from surroundings_cases import check_surroundings

LEAF = """
[material]
name = "leaf"
two_sided = true

[[thickness]]
technique = "constant_thickness"
thickness_factor = 0.3

[[thickness]]
technique = "thinness_from_thickness"

[[thickness]]
technique = "transmittance_from_thinness"

[[surface]]
technique = "base_color"

[translucency]
technique = "lobe_normalized"
distortion = 0.2
"""
BLACK = {"albedoColor": 0.0, "metallicF0Factor": 0.0}
"""Babylon's own reflection is gone: what is left is emission, and the light that comes through."""
SLOW = pytest.mark.slow
QUICK = "wax_mouse"


@pytest.fixture(scope="module", params=some_slow(BABYLON.renderers, "webgl"))
def babylon(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    renderer: EnginePage = or_skip(partial(EnginePage, BABYLON), request.param)
    yield renderer
    renderer.page.close()


def dark(mesh: PlacedMesh, **changes: Any) -> PlacedMesh:
    """The mesh without ambient light."""
    return mesh._replace(shell=dataclasses.replace(mesh.shell, ambient=(0.0, 0.0, 0.0), **changes))


def drawn(babylon: EnginePage, material: str, mesh: PlacedMesh, **options: Any) -> Array:
    compiled = sssgen.compile(material, "babylonjs")
    return page_values.shade(compiled, mesh.shell, babylon, mesh.size, mesh.points, **({"properties": BLACK} | options))


@pytest.mark.parametrize("name", some_slow(MESHES, QUICK))
def test_light_that_comes_through_is_that_of_the_oracle(babylon: EnginePage, name: str) -> None:
    mesh = mesh_of(name)
    expected = through(name, mesh)
    assert np.abs(drawn(babylon, name, dark(mesh)) - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert (expected[..., :3][mesh.hit].max() > 0.1) == (name != "resin_inlay")  # which reflects only


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
def test_babylon_lights_the_surface(babylon: EnginePage, name: str) -> None:
    """The reflected light is Babylon's own: not the oracle's numbers, but the same picture."""
    mesh = mesh_of(name)
    picture = drawn(babylon, name, mesh, properties={})
    expected = shade_numpy.shade(sssgen.compile(name, "numpy"), mesh.shell, mesh.size, mesh.points, "float64")
    shown = mesh.hit & (expected[..., 3] >= 0.5)
    ours, theirs = (np.clip(one[..., :3][shown], 0.0, 1.0) for one in (expected, picture))
    assert np.isfinite(picture).all()
    assert np.abs(ours - theirs).mean() < 0.03
    assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.95


CHAINS = [
    (name, front, light)
    for name, front in (("lit", True), ("lit", False), ("unlit", True), ("unlit", False), ("rays", True))
    for light in ("point", "direction")
]
QUICK_CHAIN = ("lit", False, "point")


@pytest.mark.parametrize(("name", "front", "light"), some_slow(CHAINS, QUICK_CHAIN))
def test_every_value_of_the_chain(babylon: EnginePage, name: str, front: bool, light: str, tmp_path: Path) -> None:
    """A turned, stretched and mirrored body from both sides: every input is in its space, per surface and light."""
    case = chain_case(name, front, light, tmp_path)
    picture = drawn(babylon, case.material, case.mesh._replace(shell=case.shell, points=case.points))
    difference = np.abs(picture[..., :3] - case.expected[..., :3])[case.mesh.hit]
    assert difference.max() < 2e-3 and picture[..., :3][case.mesh.hit].std() > 0.02


@pytest.mark.slow
@pytest.mark.parametrize("front", [True, False])
@pytest.mark.parametrize("lit_from", ["front", "behind"])
def test_a_leaf_from_both_sides(babylon: EnginePage, front: bool, lit_from: str, tmp_path: Path) -> None:
    """Light from behind, as it is seen, comes through; `front` is whether the mesh's front faces are seen."""
    mesh = mesh_of("ice")
    towards = np.array([-0.4, 0.1, 0.9]) * (1.0 if lit_from == "front" else -1.0)
    mesh = dark(
        mesh, parameters={}, textures={}, front=front, light_positions=np.array([[*towards, 0.0]]),
        light_colors=np.array([[1.0, 0.9, 0.7]]),
    )  # fmt: skip
    (tmp_path / "leaf.toml").write_text(LEAF, "utf-8")
    leaf = str(tmp_path / "leaf.toml")
    expected = through(leaf, mesh)
    picture = drawn(babylon, leaf, mesh)
    inner = mesh.hit.copy()
    inner[[0, -1]] = inner[:, [0, -1]] = False  # the rasteriser's rule leaves the mesh's last row out
    assert np.abs(picture - expected)[..., :3][inner].max() < 1.0 / 255.0
    assert (picture[..., :3][inner].max() > 0.1) == (lit_from == "behind")


@pytest.mark.parametrize("lamp", some_slow(["direction", "point", "cascades", "spot"], "point"))
def test_other_bodies_shadow_the_light_that_comes_through(babylon: EnginePage, lamp: str, tmp_path: Path) -> None:
    """A wall does, wherever it is; the body does not, nor one of another scale with the same material."""
    check_shadows(Scene(babylon, modules_of("babylonjs", tmp_path), BLACK, lamp))


@pytest.mark.slow
@pytest.mark.parametrize(("sought", "text"), [("aggShadow", "aggShadow_ABSENT"), ("[^;]*worldPos", "worldPos_ABSENT")])
def test_a_version_without_its_text_of_shadows_is_an_error(
    babylon: EnginePage, sought: str, text: str, tmp_path: Path
) -> None:
    scene = Scene(babylon, modules_of("babylonjs", tmp_path), BLACK, "point")
    check_absence(scene, sought, rf"m: this version of Babylon\.js has no .*{text}")


@pytest.mark.slow
def test_a_raymarched_material_fills_its_mesh(babylon: EnginePage) -> None:
    scene = dataclasses.replace(scene_loading.load(str(ROOT / "examples/jelly_cubes/scene.toml")), size=SIZE)
    numpy = sssgen.compile("jelly_cubes", "numpy")
    shell = shell_of(scene, load_material(scene.material), numpy.reflection)
    picture = page_values.shade(sssgen.compile("jelly_cubes", "babylonjs"), shell, babylon, SIZE, None)
    expected = shade_numpy.shade(numpy, shell, SIZE, None, "float64") ** 2.2  # its output technique, left to Babylon
    assert np.quantile(np.abs(picture - expected)[..., :3], 0.98) < 1.0 / 255.0  # but for edges, where a ray may miss


@pytest.mark.slow
def test_tangents_come_from_the_texture_coordinates_where_the_mesh_has_none(babylon: EnginePage) -> None:
    mesh = mesh_of("ice")
    first, second = (drawn(babylon, "ice", mesh, tangents=tangents)[..., :3] for tangents in (True, False))
    # the sheet is planar: its derivatives are exact inside of it
    inner = mesh.hit.copy()
    for axis in (0, 1):
        for step in (-2, -1, 1, 2):
            inner &= np.roll(mesh.hit, step, axis)
    difference = np.abs(first - second)[inner].max(axis=-1)
    assert np.quantile(difference, 0.95) < 1.0 / 255.0 and second[inner].max() > 0.2


@pytest.mark.slow
def test_properties_have_the_defaults_of_the_material(babylon: EnginePage) -> None:
    """Without values and textures, the picture is that of the oracle with the defaults."""
    mesh = dark(mesh_of("paper_lantern"), parameters={}, textures={})
    difference = np.abs(drawn(babylon, "paper_lantern", mesh) - through("paper_lantern", mesh))
    assert difference[..., :3][mesh.hit].max() < 1.0 / 255.0


@pytest.mark.slow
def test_numbers_of_every_type_and_names_of_defines(babylon: EnginePage, tmp_path: Path) -> None:
    """Babylon's block has floats only; its defines, such as NORMAL, would replace local names."""
    declared = {
        "int count = 3": "float(count)", "uint bits = 5u": "float(bits)", "bool on = true": "float(on)",
        "ivec2 pair = ivec2(1, -2)": "float(pair.x * pair.y)",
        "mat2 two = mat2(1.0, 2.0, 3.0, 4.0)": "two[1].x",
        "mat3 three = mat3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0)": "three[2].y",
        "mat4 four = mat4(2.0)": "four[3].w",
    }  # fmt: skip
    uniforms = "".join(f"/// U.\nuniform {text};\n" for text in declared)
    body = f"{{ float NORMAL = {' + '.join(declared.values())}; float UV1 = NORMAL / 100.0; emission = vec3(UV1); }}\n"
    (tmp_path / "made.sss").write_text(
        f"{uniforms}{HEAD.format('surface')}void made(out vec3 emission) {body}", "utf-8"
    )
    (tmp_path / "m.toml").write_text('[material]\nname = "m"\n[[surface]]\ntechnique = "./made.sss"\n', "utf-8")
    mesh = dark(mesh_of("wax_mouse"), parameters={}, textures={})
    picture = drawn(babylon, str(tmp_path / "m.toml"), mesh)
    assert np.abs(picture[..., :3][mesh.hit] - (3 + 5 + 1 - 2 + 3 + 8 + 2) / 100.0).max() < 1e-6


@pytest.mark.slow
def test_layers_are_those_of_babylon(babylon: EnginePage) -> None:
    """The same picture as without the stages, with Babylon's properties in their place."""
    mesh = mesh_of("wax_mouse")
    surface = '[material]\nname = "ball"\n[[surface]]\ntechnique = "pbr_constants"\nsurface_roughness = 0.6\n'
    layers = '[[surface]]\ntechnique = "specular_level"\ndielectric_specular = 1.0\n'
    layers += '[[surface]]\ntechnique = "clearcoat_constants"\ncoat_weight = 0.7\ncoat_roughness = 0.2\n'
    layers += '[[surface]]\ntechnique = "sheen_constants"\nsheen_tint = [0.5, 0.5, 0.5]\nsheen_spread = 0.3\n'
    own = {
        "clearCoat.isEnabled": True,
        "clearCoat.intensity": 0.7,
        "clearCoat.roughness": 0.2,
        "indexOfRefraction": 1.78885438,  # it reflects 0.08
        "sheen.isEnabled": True,
        "sheen.color": 0.5,
        "sheen.roughness": 0.3,
        "sheen.albedoScaling": True,
    }
    bare = dataclasses.replace(mesh.shell, parameters={}, textures={})
    ours, theirs, none = (
        page_values.shade(
            sssgen.compile(parse_material(text, "ball.toml"), "babylonjs"), bare, babylon, mesh.size, mesh.points, given
        )[..., :3][mesh.hit]
        for text, given in ((surface + layers, {}), (surface, own), (surface, {}))
    )
    assert np.abs(ours - theirs).max() < 1e-3
    assert np.abs(ours - none).max() > 8.0 / 255.0


@pytest.mark.slow
def test_another_prefix_draws_the_same(babylon: EnginePage) -> None:
    mesh = mesh_of("ice")
    own, other = (
        page_values.shade(
            sssgen.compile("ice", "babylonjs", prefix=prefix), mesh.shell, babylon, mesh.size, mesh.points
        )
        for prefix in ("", "wax_")
    )
    assert (own == other).all() and own.max() > 0.2


@pytest.mark.slow
def test_an_error_of_babylon_is_reported(babylon: EnginePage) -> None:
    check_reported_errors(babylon, "babylonjs", "sss_evaluate_surface")


def test_values_that_it_does_not_take_are_refused(babylon: EnginePage) -> None:
    check_refusals(
        babylon, "babylonjs", "PBRMaterial", "a Color3, or a colour such as '#3070ff'", "a texture, the URL of one"
    )


@pytest.mark.parametrize("form", ["shader", "functions"])
def test_the_texts_in_a_module_compile(form: str, compiler: Callable[[str], Compiler]) -> None:
    check_texts("babylonjs", form, compiler)


def test_parameters_are_properties() -> None:
    compiled = sssgen.compile("ice", "babylonjs")
    described = "type: 'float', default: 10.0, range: [1.0, 200.0], unit: '1', name: 'sss_cell_count'"
    assert f"  cellCount: {{ {described} }},\n" in compiled.files["ice.babylon.js"]
    assert "set veinColor(value: Color3 | string | number[]);" in compiled.files["ice.babylon.d.ts"]
    names = {uniform["source_name"]: uniform["property"] for uniform in compiled.reflection["uniforms"]}
    assert names["cell_count"] == "cellCount"


def test_light_of_the_surroundings_comes_through(babylon: EnginePage, tmp_path: Path) -> None:
    check_surroundings(babylon, "babylonjs", BLACK, {"hemisphere": 1.0 / 255.0, "environment": 0.03}, tmp_path)


@pytest.mark.parametrize("left_handed", [False, True], ids=["right-handed", "left-handed"])
def test_light_of_a_rectangle_comes_through(babylon: EnginePage, left_handed: bool, tmp_path: Path) -> None:
    check_area_light(babylon, "babylonjs", BLACK, {"metallicF0Factor": 0.0}, tmp_path, leftHanded=left_handed)
