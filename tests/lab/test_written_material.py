"""The error of a material as it is written."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from sssgen.lab.measure.measurement import View
from sssgen.lab.measure.problem import material_problem
from sssgen.lab.measure.written_material import measure
from sssgen.material.material_text import MaterialSection
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.view_points import points
from sssgen.scene.scene import Light

TINT = (0.6, 0.3, 0.1)
MATTE = MaterialSection("surface", "base_color", (("tint", [*TINT, 1.0]),))


def view(factor: float) -> View:
    """A cube whose reference is a matte surface of `TINT`, times a factor."""
    scene = dataclasses.replace(
        measured_scene.load("cube"), lights=(Light(None, (0.2, 0.6, 0.77), (1.0, 1.0, 1.0)),), size=(16, 16)
    )
    zeros = np.zeros_like(points(scene).inputs["P"])
    problem = material_problem(scene, [(zeros, zeros)], summed=True)
    reference = np.array(TINT)[:, None] * problem.lambert * factor
    return View("own", scene, ((reference, zeros),), str(factor))


def test_matte_body_has_no_error() -> None:
    (result,) = measure([MATTE], [[view(1.0)]])
    assert result.error == pytest.approx(0.0, abs=1e-6)
    assert result.level == pytest.approx((1.0, 1.0, 1.0), rel=1e-5)
    assert result.operations >= 0


def test_material_of_half_the_light() -> None:
    """The level is the share of the light that the material has, and several cases have a result each."""
    results = measure([MATTE], [[view(2.0)], [view(1.0), view(2.0)]])
    assert results[0].level == pytest.approx((0.5, 0.5, 0.5), rel=1e-5)
    assert 0.3 < results[0].error < 0.5
    assert 0.0 < results[1].error < results[0].error


def test_textures_are_those_of_the_view() -> None:
    """A material names a picture for its colour; the view has none, and the technique's default is white."""
    painted = MATTE._replace(values=(*MATTE.values, ("base_color_texture", "paint.png")))
    (result,) = measure([painted], [[view(1.0)]])
    assert result.error == pytest.approx(0.0, abs=1e-6)
