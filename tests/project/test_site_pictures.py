"""The pictures of the techniques' pages: curves by NumPy, and bodies drawn with OpenGL."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import chart_pictures
import records
import stability_pictures
import technique_curves
import technique_pages
import technique_pictures
from sssgen.material import library
from sssgen.run.backends import Backend


def _curve(name: str, **values: float) -> np.ndarray:
    technique = library.load(name)
    sweep = technique_curves.sweep_of(technique)
    assert sweep is not None
    result = technique_curves._result(technique, sweep, values)
    assert result is not None and len(result) == len(sweep.ticks)
    return result[:, 0]


def test_a_curve_is_the_result_of_the_technique() -> None:
    lengths = np.linspace(0.0, 1.0, technique_curves.STEPS)
    assert _curve("beer_lambert", attenuation_distance=0.5) == pytest.approx(np.exp(-lengths / 0.5), abs=1e-6)


def test_a_lobe_is_shown_over_the_angle_of_the_light() -> None:
    light_behind = _curve("gltf_thin_wall")
    assert light_behind[:90].max() == 0.0 < light_behind[91] < light_behind[180]


def test_a_parameter_that_changes_nothing_has_no_panel() -> None:
    ends = technique_curves.curves_at_the_ends(library.load("lobe_gdc2011"))
    assert ends is not None and "distortion, power, scale, ambient at the lowest" in ends.caption
    assert 0.5 < ends.colors.mean() < 0.999 and ends.colors.min() < 0.4  # lines on white
    assert technique_curves.curves_at_the_ends(library.load("thinness_from_transmittance")) is None  # no parameter


@pytest.mark.parametrize("name", ["thickness_map", "march_light", "camera_still"])
def test_what_needs_a_body_has_no_curve(name: str) -> None:
    assert technique_curves.default_curve(library.load(name)) is None


def test_the_picture_of_the_ends_is_below_the_limits() -> None:
    ends = technique_pages.Shown("beer_lambert_ends.png", "At both ends")
    text = technique_pages.page(library.load("beer_lambert"), limits=[ends])
    assert "![At both ends](beer_lambert_ends.png)\n\n*At both ends.*" in text.partition("\n## Limits\n")[2]


def test_a_page_without_a_picture_says_why() -> None:
    technique = library.load("fluence_fixed")
    why = technique_pictures.why_none(technique)
    assert why == "It has no picture here: it reads `fluence_volume`, which is made for one body or one surface."
    assert "reads `fluence_volume`" in technique_pages.page(technique, without=why)


def test_a_published_technique_is_shown_beside_what_to_use_instead() -> None:
    text = technique_pages.page(library.load("cheap_sss_thinness"))
    assert "dark X" in text and "](../../../docs/stability/cube.png)" in text.partition("\n## Limits\n")[2]
    assert stability_pictures.comparisons_of("lobe_normalized") == []  # in both materials, and no baseline


@pytest.mark.slow
def test_a_ball_is_shown_at_the_ends_of_a_range(backend: Callable[[str], Backend]) -> None:
    picture = technique_pictures.ball_at_the_ends(library.load("clearcoat_constants"), backend("gl"))
    assert picture is not None and "at 0 (left) and at 1 (right)" in picture.caption
    left, right = np.split(picture.colors, 2, axis=1)
    assert np.abs(left - right).max() > technique_pictures.VISIBLE
    assert technique_pictures.ball_at_the_ends(library.load("beer_lambert"), backend("gl")) is None  # no ball shows it


@pytest.mark.slow
def test_a_charted_chain_is_shown_beside_path_tracing() -> None:
    """Both halves are the body in the same scale: alike, but not equal."""
    point = records.best_point("lobe_gdc2011")
    assert point is not None
    picture = chart_pictures.beside_path_tracing(point)
    left, right = picture.colors[:, : chart_pictures.SIDE * 2], picture.colors[:, -chart_pictures.SIDE * 2 :]
    assert picture.caption.startswith("What remains: ") and f"{point['error']['value']:.2f}" in picture.caption
    assert 0.7 < left.mean() / right.mean() < 1.4 and np.abs(left - right).mean() > 0.01


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("uv_transform", "uv_rotation at 45"),  # whose defaults change nothing, and neither does a whole turn
        ("pbr_constants", "metalness at 1, the highest"),
        ("thickness_map", "thickness on a ball"),
        ("thinness_uniform", "thinness of a cube"),
        ("thinness_from_thickness", "result over the thickness"),
    ],
)
def test_the_picture_shows_what_its_caption_says(name: str, what: str, backend: Callable[[str], Backend]) -> None:
    picture = technique_pictures.draw(library.load(name), backend("gl"))
    assert picture is not None and what in picture.caption
    assert picture.colors.std() > 0.05
