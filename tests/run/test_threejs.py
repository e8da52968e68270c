"""Emitted modules in three.js: WebGLRenderer, WebGPURenderer, and its WebGL 2 fallback, in a headless Chromium."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

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
from skips import or_skip
from slow_cases import some_slow
from sssgen.material.material_loading import load_material
from sssgen.run.backends.engine_page import EnginePage
from sssgen.run.backends.web_engines import THREE
from sssgen.run.compilers import Compiler
from sssgen.run.render import page_values, shade_numpy
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import scene_loading
from surroundings_cases import check_surroundings

LEVEL = """[material]
name = "level"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
[[surface]]
technique = "pbr_constants"
surface_roughness = 0.3
[[surface]]
technique = "specular_level"
dielectric_specular = {level}
"""
BLACK = {"color": 0.0, "specularIntensity": 0.0}
"""three's own reflection is gone: what is left is emission, and the light that comes through."""


@pytest.fixture(scope="module", params=some_slow(THREE.renderers, "webgpu"))
def three(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    renderer: EnginePage = or_skip(partial(EnginePage, THREE), request.param)
    yield renderer
    renderer.page.close()


@pytest.mark.parametrize("name", MESHES)
def test_light_that_comes_through_is_that_of_the_oracle(three: EnginePage, name: str) -> None:
    mesh = mesh_of(name)
    dark = dataclasses.replace(mesh.shell, ambient=(0.0, 0.0, 0.0))
    drawn = page_values.shade(sssgen.compile(name, "threejs"), dark, three, mesh.size, mesh.points, BLACK)
    expected = through(name, mesh)
    assert np.abs(drawn - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert (expected[..., :3][mesh.hit].max() > 0.1) == (name != "resin_inlay")  # which reflects only


@pytest.mark.parametrize("name", MESHES)
def test_three_lights_the_surface(three: EnginePage, name: str) -> None:
    """The reflected light is three's own: not the oracle's numbers, but the same picture."""
    mesh = mesh_of(name)
    drawn = page_values.shade(sssgen.compile(name, "threejs"), mesh.shell, three, mesh.size, mesh.points)
    compiled = sssgen.compile(name, "numpy")
    expected = shade_numpy.shade(compiled, mesh.shell, mesh.size, mesh.points, "float64")
    shown = mesh.hit & (expected[..., 3] >= 0.5)
    ours, theirs = (np.clip(picture[..., :3][shown], 0.0, 1.0) for picture in (expected, drawn))
    assert np.isfinite(drawn).all()
    assert np.abs(ours - theirs).mean() < 0.03
    assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.95


@pytest.mark.parametrize("light", ["point", "direction"])
@pytest.mark.parametrize(
    ("name", "front"), [("lit", True), ("lit", False), ("unlit", True), ("unlit", False), ("rays", True)]
)
def test_every_value_of_the_chain(three: EnginePage, name: str, front: bool, light: str, tmp_path: Path) -> None:
    """A turned, stretched and mirrored body from both sides: every input is in its space, per surface and light."""
    case = chain_case(name, front, light, tmp_path)
    compiled = sssgen.compile(case.material, "threejs")
    drawn = page_values.shade(compiled, case.shell, three, case.mesh.size, case.points, BLACK)
    difference = np.abs(drawn[..., :3] - case.expected[..., :3])[case.mesh.hit]
    assert difference.max() < 2e-3 and drawn[..., :3][case.mesh.hit].std() > 0.02


def test_a_raymarched_material_fills_its_mesh(three: EnginePage) -> None:
    scene = dataclasses.replace(scene_loading.load(str(ROOT / "examples/jelly_cubes/scene.toml")), size=SIZE)
    numpy = sssgen.compile("jelly_cubes", "numpy")
    shell = shell_of(scene, load_material(scene.material), numpy.reflection)
    drawn = page_values.shade(sssgen.compile("jelly_cubes", "threejs"), shell, three, SIZE, None)
    expected = shade_numpy.shade(numpy, shell, SIZE, None, "float64") ** 2.2  # its output technique, left to three
    assert np.quantile(np.abs(drawn - expected)[..., :3], 0.98) < 1.0 / 255.0  # but for edges, where a ray may miss


def test_tangents_come_from_the_texture_coordinates_where_the_mesh_has_none(three: EnginePage) -> None:
    mesh, compiled = mesh_of("ice"), sssgen.compile("ice", "threejs")
    drawn = [
        page_values.shade(compiled, mesh.shell, three, mesh.size, mesh.points, BLACK, tangents)[..., :3]
        for tangents in (True, False)
    ]
    # the sheet is planar: its derivatives are exact inside of it
    inner = mesh.hit.copy()
    for axis in (0, 1):
        for step in (-2, -1, 1, 2):
            inner &= np.roll(mesh.hit, step, axis)
    difference = np.abs(drawn[0] - drawn[1])[inner].max(axis=-1)
    assert np.quantile(difference, 0.95) < 1.0 / 255.0 and drawn[1][inner].max() > 0.2


def test_properties_have_the_defaults_of_the_material(three: EnginePage) -> None:
    """Without values and textures, the picture is that of the oracle with the defaults."""
    mesh = mesh_of("paper_lantern")
    bare = mesh._replace(shell=dataclasses.replace(mesh.shell, parameters={}, textures={}, ambient=(0.0, 0.0, 0.0)))
    drawn = page_values.shade(
        sssgen.compile("paper_lantern", "threejs"), bare.shell, three, mesh.size, mesh.points, BLACK
    )
    assert np.abs(drawn - through("paper_lantern", bare))[..., :3][mesh.hit].max() < 1.0 / 255.0


def test_names_of_macros_are_free(three: EnginePage, tmp_path: Path) -> None:
    """three's shaders define PI and others as macros, which would replace local names."""
    body = "{ float PI = OPAQUE; float EPSILON = PI * 2.0; float STANDARD = EPSILON; emission = vec3(STANDARD); }\n"
    uniform = "/// O.\nuniform float OPAQUE = 0.25;\n"
    text = f"{uniform}{HEAD.format('surface')}void made(out vec3 emission) {body}"
    (tmp_path / "made.sss").write_text(text, encoding="utf-8")
    (tmp_path / "m.toml").write_text('[material]\nname = "m"\n[[surface]]\ntechnique = "./made.sss"\n', "utf-8")
    mesh = mesh_of("wax_mouse")
    bare = dataclasses.replace(mesh.shell, parameters={}, textures={}, ambient=(0.0, 0.0, 0.0))
    compiled = sssgen.compile(str(tmp_path / "m.toml"), "threejs")
    drawn = page_values.shade(compiled, bare, three, mesh.size, mesh.points, BLACK)
    assert np.abs(drawn[..., :3][mesh.hit] - 0.5).max() < 1e-6
    assert "float STANDARD = " in sssgen.compile(str(tmp_path / "m.toml"), "glsl-330").files["m.glsl-330.frag"]


def test_another_prefix_draws_the_same(three: EnginePage) -> None:
    mesh = mesh_of("ice")
    own, other = (
        page_values.shade(sssgen.compile("ice", "threejs", prefix=prefix), mesh.shell, three, mesh.size, mesh.points)
        for prefix in ("", "wax_")
    )
    assert (own == other).all() and own.max() > 0.2


def test_an_error_of_three_is_reported(three: EnginePage) -> None:
    check_reported_errors(three, "threejs", r"sss_evaluate_surface|fragment_resin_inlay")


def test_values_that_it_does_not_take_are_refused(three: EnginePage) -> None:
    check_refusals(three, "threejs", "MeshPhysicalMaterial", "or a colour as THREE.Color takes it", "a THREE.Texture")


@pytest.mark.parametrize("form", ["shader", "functions"])
def test_the_texts_in_a_module_compile(form: str, compiler: Callable[[str], Compiler]) -> None:
    check_texts("threejs", form, compiler)


def test_parameters_are_properties() -> None:
    compiled = sssgen.compile("ice", "threejs")
    described = "type: 'float', default: 10.0, range: [1.0, 200.0], unit: '1', name: 'sss_cell_count'"
    assert f"  cellCount: {{ {described} }},\n" in compiled.files["ice.js"]
    assert "set veinColor(value: THREE.Color | THREE.ColorRepresentation | number[]);" in compiled.files["ice.d.ts"]
    names = {uniform["source_name"]: uniform["property"] for uniform in compiled.reflection["uniforms"]}
    assert (names["cell_count"], names["metalness"]) == ("cellCount", "sssMetalness")  # three has a metalness


def test_the_head_names_properties() -> None:
    """Those of the module, not the names in the shaders; a material without a number has an example without values."""
    head = sssgen.compile("jade_ring", "threejs").files["jade_ring.js"].split("\nimport ")[0]
    assert "// lightDepthMap: drawn " in head and "sss_light_depth_map" not in head and "createMaterial())" in head


def test_light_of_the_surroundings_comes_through(three: EnginePage, tmp_path: Path) -> None:
    check_surroundings(
        three, "threejs", BLACK, {"hemisphere": 1.0 / 255.0, "probe": 1.0 / 255.0, "environment": 0.03}, tmp_path
    )


def test_what_reflects_nothing_is_no_mirror_from_the_side(three: EnginePage, tmp_path: Path) -> None:
    """Where the specular level is 0, three's material reflects nothing; at 2 %, all light from the side."""
    mesh = mesh_of("wax_mouse")
    bare = dataclasses.replace(mesh.shell, parameters={}, textures={}, ambient=(0.0, 0.0, 0.0))
    pictures = []
    for level in (0.0, 0.25):
        path = tmp_path / f"level_{level}.toml"
        path.write_text(LEVEL.format(level=level), encoding="utf-8")
        compiled = sssgen.compile(str(path), "threejs")
        pictures.append(page_values.shade(compiled, bare, three, mesh.size, mesh.points)[..., :3][mesh.hit])
    assert np.abs(pictures[0]).max() < 1e-3 < 0.05 < pictures[1].max()


def test_light_of_a_rectangle_comes_through(three: EnginePage, tmp_path: Path) -> None:
    check_area_light(three, "threejs", BLACK, {"specularIntensity": 0.0}, tmp_path)
