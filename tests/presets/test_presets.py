"""Ready materials: each is a right material in each quality, and its numbers are those of its medium or its colour."""

from __future__ import annotations

import re

import numpy as np
import pytest

import sssgen
from folders import ROOT
from slow_cases import some_slow
from sssgen.material.material_loading import parse_material
from sssgen.material.requirements import requirements
from sssgen.material.scatter_color import multiscatter_of_albedo
from sssgen.presets.engines import ENGINES
from sssgen.presets.preset import Preset, preset, presets
from sssgen.presets.preset_stages import BodySize, preset_text
from sssgen.presets.qualities import QUALITIES
from sssgen.support.diagnostics import SssgenError

SIZE = BodySize(20.0, 0.5)


def passes(name: str, quality: str) -> set[str]:
    """The pictures that the material in three.js draws."""
    material = parse_material(preset_text(preset(name), quality, name, SIZE), f"{name}.toml")
    return {drawn["name"] for drawn in sssgen.compile(material, "threejs").reflection["passes"]}


def required(name: str, quality: str) -> tuple[str, ...]:
    text = preset_text(preset(name), quality, name, SIZE)
    return requirements(parse_material(text, f"{name}.toml").stages)


@pytest.mark.parametrize("text", ["Skin_Fair", "skin fair", " SKIN-fair", "skin - fair"])
def test_a_name_has_any_case_and_spaces_or_hyphens(text: str) -> None:
    assert preset(text).name == "skin_fair"


@pytest.mark.parametrize("name", presets())
def test_a_preset_is_a_material_in_each_quality(name: str) -> None:
    row = preset(name)
    assert row.title and row.doc.endswith(".") and row.source
    for quality in QUALITIES:
        material = parse_material(preset_text(row, quality, name, SIZE), f"{name}.toml")
        assert material.name == name and "20 mm" in material.doc
        needs = requirements(material.stages)
        assert quality != "fast" or not needs, "fast needs lights alone"
        assert quality != "good" or "bake" not in needs
        assert (quality == "best" and row.scatters) == ("bake" in needs)


@pytest.mark.parametrize("target", some_slow(ENGINES, "threejs", "godot", "unity-urp"))
def test_a_preset_compiles_for_every_engine(target: str) -> None:
    for name in ("wax", "gummy", "honey", "leaf"):
        for quality in QUALITIES:
            material = parse_material(preset_text(preset(name), quality, name, SIZE), f"{name}.toml")
            assert target == "gltf" or sssgen.compile(material, ENGINES[target].shader or target).files


def test_a_measured_medium_is_that_of_the_table_in_world_units() -> None:
    medium = preset("marble").interior(5.0)
    assert medium.scattering == pytest.approx([5.0 * 2.19, 5.0 * 2.62, 5.0 * 3.0])
    assert medium.ior == preset("marble").ior


def test_a_color_is_what_a_thick_body_reflects() -> None:
    row = preset("coral")
    medium = row.interior(1.0)
    assert multiscatter_of_albedo(medium.albedo) == pytest.approx(row.color, abs=0.02)
    assert [1.0 / part for part in medium.extinction] == pytest.approx(row.depth_mm)


def test_a_larger_body_is_denser() -> None:
    def extinction(unit_mm: float) -> list[float]:
        material = parse_material(preset_text(preset("wax"), "good", "wax", BodySize(unit_mm, 0.5)), "wax.toml")
        (stage,) = [stage for stage in material.stages if "octaves" in stage.values]
        return list(stage.values["extinction"])

    assert np.array(extinction(40.0)) == pytest.approx(2.0 * np.array(extinction(20.0)), rel=1e-4)


def test_light_below_a_refracting_surface_is_more_saturated() -> None:
    """Jade absorbs red and blue, and what its surface reflects back is absorbed again."""
    jade = preset("jade")
    medium = jade.interior(SIZE.unit_mm)
    material = parse_material(preset_text(jade, "good", "jade", SIZE), "jade.toml")
    (albedo,) = [stage.values["scattering_albedo"] for stage in material.stages if "octaves" in stage.values]
    assert albedo[0] / albedo[1] < medium.albedo[0] / medium.albedo[1]
    (tint,) = [stage.values["tint"] for stage in material.stages if "tint" in stage.values]
    colors = multiscatter_of_albedo(medium.albedo)
    assert tint[0] / tint[1] < colors[0] / colors[1]


def test_qualities_need_what_they_say() -> None:
    assert "depth-layers" in required("wax", "good") and "back-faces" in required("honey", "good")
    assert {"bake", "inner-light"} <= set(required("wax", "best"))
    assert required("paper", "best") == ()


def test_an_unknown_preset_is_an_error_with_the_nearest_name() -> None:
    with pytest.raises(SssgenError, match="did you mean 'wax'"):
        preset("waxx")


def test_every_preset_says_one_thing_about_its_inside() -> None:
    def kinds(row: Preset) -> int:
        return bool(row.medium) + any(row.color) + bool(row.clear) + any(row.sheet)

    assert all(kinds(row) == 1 for row in presets().values())
    assert len(presets()) >= 16


def test_small_bodies_in_metres_are_in_range() -> None:
    """A drop of 15 mm in a scene in metres, of every preset."""
    for name in presets():
        text = preset_text(preset(name), "good", name, BodySize(1000.0, 0.003))
        assert parse_material(text, f"{name}.toml").stages


def test_the_documents_name_every_preset() -> None:
    page = (ROOT / "docs" / "presets.md").read_text(encoding="utf-8")
    listed = page.partition("In their order: ")[2].partition(".")[0]
    assert re.findall(r"\w+", listed) == list(presets())
    assert f"[{len(presets())} presets](docs/presets.md)" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_clear_bodies_alone_draw_the_scene_behind_them() -> None:
    assert "scene_behind" in passes("honey", "good")
    assert not passes("honey", "fast")
    assert passes("jade", "good") == {"back_faces", "light_layers"}
