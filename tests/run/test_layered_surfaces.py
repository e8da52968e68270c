"""Specular level and clear coat: the back ends against the oracle, three.js against its own material."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skips import or_skip
from slow_cases import some_slow
from sssgen.material.material_loading import load_material, parse_material
from sssgen.pipeline.compiler import all_targets, compile
from sssgen.run import backends
from sssgen.run.backends import Array, Backend
from sssgen.run.backends.engine_page import EnginePage
from sssgen.run.backends.web_engines import THREE
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.run.render import page_values
from sssgen.run.render.scene_render import place_mesh, render
from sssgen.run.render.scene_values import shell_of
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry

DRAWING = ["gl", "gl-es", "webgpu", "hlsl", "unity-urp", "metal"]
SIZE = (48, 36)
SCENE = """
material = "ball.toml"
size = [48, 36]
samples = 1
[geometry]
kind = "ball"
radius = 1.0
[camera]
position = [0.3, 0.4, 3.0]
target = [0.0, 0.0, 0.0]
field_of_view = 45.0
[[light]]
direction = [-0.4, 0.5, 0.7]
color = [1.0, 0.9, 0.8]
[[light]]
position = [1.5, 0.5, 1.5]
color = [2.0, 2.5, 3.0]
"""
BALL = """
[material]
name = "ball"
[[surface]]
technique = "base_color"
tint = [0.5, 0.2, 0.1, 1.0]
[[surface]]
technique = "pbr_constants"
surface_roughness = 0.6
"""
SPECULAR = """
[[surface]]
technique = "specular_level"
dielectric_specular = 0.25
"""
COAT = """
[[surface]]
technique = "clearcoat_constants"
coat_weight = 0.7
coat_roughness = 0.2
"""
SHEEN = """
[[surface]]
technique = "sheen_constants"
sheen_tint = [0.5, 0.5, 0.5]
sheen_spread = 0.3
"""
THROUGH = """
[translucency]
technique = "wrap_lighting"
"""


@pytest.fixture
def drawn(tmp_path: Path) -> Callable[[str, str], Array]:
    """Draws the ball with further stages on a back end."""

    def picture(name: str, stages: str) -> Array:
        (tmp_path / "ball.toml").write_text(BALL + stages, encoding="utf-8")
        (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
        return render(load(str(tmp_path / "scene.toml")), backends.require(name)).linear

    return picture


@pytest.mark.parametrize("name", DRAWING)
def test_back_ends_draw_layers(
    name: str, backend: Callable[[str], Backend], drawn: Callable[[str, str], Array]
) -> None:
    backend(name)
    for stages in (SPECULAR + COAT, SPECULAR):
        expected = drawn("numpy", stages)
        assert np.abs(drawn(name, stages) - expected).max() < 1.0 / 255.0
        assert np.abs(expected - drawn("numpy", "")).max() > 8.0 / 255.0


def test_specular_level_in_the_built_in_pipeline(
    backend: Callable[[str], Backend], drawn: Callable[[str, str], Array]
) -> None:
    backend("unity")
    for stages in (SPECULAR, SPECULAR + THROUGH):
        assert np.abs(drawn("unity", stages) - drawn("numpy", stages)).max() < 1.0 / 255.0


OF_THREE: Mapping[str, Mapping[str, float]] = {
    SPECULAR + COAT: {"clearcoat": 0.7, "clearcoatRoughness": 0.2, "specularColor": 0.5},
    SHEEN: {"sheen": 1.0, "sheenColor": 0.5, "sheenRoughness": 0.3},
}
"""Stages → the properties of three's own material that do the same."""


@pytest.mark.parametrize("renderer", some_slow(THREE.renderers, "webgl", "webgpu"))
@pytest.mark.parametrize("stages", some_slow(OF_THREE, SHEEN), ids=["coat", "sheen"])
def test_three_draws_them_as_its_own_material(stages: str, renderer: str, tmp_path: Path) -> None:
    """The same picture as without the stages, with three's properties in their place."""
    (tmp_path / "ball.toml").write_text(BALL, encoding="utf-8")
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    scene = dataclasses.replace(load(str(tmp_path / "scene.toml")), size=SIZE)
    numpy = compile(load_material(str(tmp_path / "ball.toml")), "numpy")
    shell = shell_of(scene, load_material(scene.material), numpy.reflection)
    mesh = place_mesh(scene, numpy, shell, registry.load("numpy"), SIZE)
    page: Any = or_skip(partial(EnginePage, THREE), renderer)
    try:
        pictures = []
        for given, properties in ((stages, {}), ("", OF_THREE[stages]), ("", {})):
            material = parse_material(BALL + given, str(tmp_path / "ball.toml"))
            compiled = compile(material, "threejs")
            pictures.append(page_values.shade(compiled, mesh.shell, page, mesh.size, mesh.points, properties))
    finally:
        page.page.close()
    ours, theirs, bare = (picture[..., :3][mesh.hit] for picture in pictures)
    assert np.abs(ours - theirs).max() < 1e-3
    assert np.abs(ours - bare).max() > 8.0 / 255.0


def test_every_target_carries_them_or_says_so(assert_compiles: Callable[[Source], None]) -> None:
    material = parse_material(BALL + SPECULAR + COAT + THROUGH, "ball.toml")
    for target in all_targets().values():
        if "clearcoat" in target.lacks:
            continue
        for source in sources(compile(material, target.name).files):
            assert_compiles(source)


def test_an_engine_without_a_clear_coat() -> None:
    with pytest.raises(SssgenError) as caught:
        compile(parse_material(BALL + SPECULAR + COAT, "ball.toml"), "unity-builtin")
    (error,) = caught.value.diagnostics
    assert error.message.endswith("has no 'clearcoat', which 'clearcoat_constants' gives")
    assert (error.span.line, error.span.column) == (16, 13)
    assert error.hint == "leave the stage out, or emit for unity-urp"


def emitted(stages: str, target: str) -> Mapping[str, str]:
    return compile(parse_material(BALL + stages, "ball.toml"), target).files


def test_a_material_without_them_has_nothing_of_them() -> None:
    """The standard lighting of a target without an engine has a coat only where a stage gives one."""
    for target in ("glsl-330", "wgsl", "hlsl", "metal", "shadertoy", "numpy"):
        bare, level, coated = (
            "\n".join(text for name, text in emitted(stages, target).items() if not name.endswith(".json"))
            for stages in ("", SPECULAR, COAT)
        )
        assert "coat" not in bare and "specular" not in bare
        assert "coat" not in level and "specular" in level
        assert "coat_light" in coated and "dielectric_specular" not in coated


def test_a_technique_that_changes_a_value_keeps_it(tmp_path: Path) -> None:
    text = "/** X.\nrole: lighting\n*/\nvec3 own(float clearcoat, vec3 light_color) "
    (tmp_path / "own.sss").write_text(
        text + "{ clearcoat += 0.25; return clearcoat * light_color; }\n", encoding="utf-8"
    )
    (tmp_path / "ball.toml").write_text(BALL + '[lighting]\ntechnique = "own.sss"\n', encoding="utf-8")
    texts = compile(load_material(str(tmp_path / "ball.toml")), "glsl-330").files
    assert "own(0.0, light_color)" in texts["ball.glsl-330.frag"]
