"""The error of a material, where a chart of its scene is in the cache."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from sssgen.cli.chart import settings_of
from sssgen.cli.commands import command_parser
from sssgen.lab.chart.charting import Settings
from sssgen.material.material_loading import load_material
from sssgen.preview.measured_error import measured_error, nearest
from sssgen.scene.measured import measured_scene
from sssgen.scene.preview_scene import scene_of
from sssgen.support import cache

pytest.importorskip("numpy")

MATERIAL = """[material]
name = "stone"
shading = "lit"
[thickness]
technique = "constant_thickness"
[translucency]
technique = "absorption_tint"
"""
SCENE = """material = "stone.toml"
[geometry]
kind = "ball"
[camera]
position = [0.0, 0.0, 4.0]
[[light]]
direction = [0.0, 0.0, 1.0]
color = [1.0, 1.0, 1.0]
"""
MEDIUM = "[medium]\nabsorption = [0.1, 0.2, 0.3]\nscattering = [1.0, 1.0, 1.0]\n"


def point(label: str, error: float, *chain: str, **others: Any) -> dict[str, Any]:
    band = {"value": error, "low": error, "high": 1.2 * error}
    common = {"role": "material", "chain": chain, "path": "", "failed": "", "cost": {"value": 50.0}}
    return {**common, "label": label, "error": band, "views": {"own": band}, **others}


POINTS = [
    point("far", 0.01, "voronoi_thickness", "lobe_normalized"),
    point("worse", 0.4, "constant_thickness", "absorption_tint"),
    point("better", 0.25, "constant_thickness", "absorption_tint"),
    point("fails", 0.1, "constant_thickness", "absorption_tint", failed="NaN"),
    point("a part", 0.1, "constant_thickness", role="thickness"),
]


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SSSGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "_folder", None)
    (tmp_path / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    path = tmp_path / "scene.toml"
    path.write_text(SCENE + MEDIUM, encoding="utf-8")
    return path


def error_of(path: Path) -> str:
    scene = scene_of(str(path))
    return measured_error(scene, load_material(scene.material)).text


def test_a_scene_without_a_medium_is_not_measured(scene: Path) -> None:
    scene.write_text(SCENE, encoding="utf-8")
    assert "not measured" in error_of(scene) and "[medium]" in error_of(scene)


def test_without_a_chart_the_command_is_named(scene: Path) -> None:
    said = error_of(scene)
    assert said.endswith(f"sssgen chart {scene.as_posix()}"), said


def test_the_nearest_chain_of_the_chart_is_named(scene: Path) -> None:
    record = {"scene": {}, "points": POINTS}
    cache.write(Settings().cache_name(measured_scene.load(str(scene))), json.dumps(record).encode())
    assert error_of(scene) == "Error of this chain in the chart, better: 0.25, at most 0.3; its cost 50."
    other = '[[thickness]]\ntechnique = "constant_thickness"\n[[thickness]]\ntechnique = "beer_lambert"\n'
    text = MATERIAL[: MATERIAL.index("[thickness]")] + other + '[translucency]\ntechnique = "lobe_normalized"\n'
    (scene.parent / "stone.toml").write_text(text, encoding="utf-8")
    assert error_of(scene).startswith("Error of the nearest chain in the chart, ")


def test_the_nearest_is_the_one_with_the_fewest_other_techniques() -> None:
    names = frozenset({"voronoi_thickness", "lobe_normalized", "beer_lambert"})
    found = nearest(POINTS, names)
    assert found is not None and found["label"] == "far"
    assert nearest(POINTS[3:], names) is None


def test_the_command_takes_the_scene() -> None:
    asked = settings_of(command_parser("chart").parse_args(["scene.toml"]))
    assert (asked.samples, asked.seed, asked.roles) == (Settings().samples, Settings().seed, Settings().roles)


def test_a_clear_medium_is_not_measured(scene: Path) -> None:
    scene.write_text(SCENE + MEDIUM.replace("[1.0, 1.0, 1.0]", "[0.0, 0.0, 0.0]"), encoding="utf-8")
    assert error_of(scene).startswith("Error: not measured, as a clear medium scatters no light")
