"""The media of subsurface colours, against adding-doubling (iadpython)."""

from __future__ import annotations

import math

import pytest

from sssgen.interchange.albedo_inversion import subsurface_medium, transmission_medium
from sssgen.material.scatter_color import albedo_of_color

iadpython = pytest.importorskip("iadpython")


@pytest.mark.parametrize("anisotropy", [-0.9, -0.5, 0.0, 0.5, 0.9])
def test_a_thick_body_has_its_color(anisotropy: float) -> None:
    """What it reflects of diffuse light differs from the colour by at most 0.006."""
    for color in (0.02, 0.2, 0.5, 0.8, 0.95):
        thick = iadpython.Sample(
            a=albedo_of_color(color, anisotropy), b=math.inf, g=anisotropy, n=1.0, quad_pts=16
        )  # fmt: skip
        assert thick.rt()[2] == pytest.approx(color, abs=0.006), color


def test_ends() -> None:
    """Black absorbs all, white nothing; the albedo grows with the colour, and numbers outside are limited."""
    assert albedo_of_color(0.0) == pytest.approx(0.0, abs=1e-4)
    assert albedo_of_color(1.0) == pytest.approx(1.0, abs=1e-6)
    assert (albedo_of_color(-1.0), albedo_of_color(7.0)) == (albedo_of_color(0.0), albedo_of_color(1.0))
    for anisotropy in (-0.9, 0.0, 0.9):
        albedos = [albedo_of_color(step / 50, anisotropy) for step in range(51)]
        assert albedos == sorted(albedos)


def test_impossible_numbers_make_possible_media() -> None:
    """A mean free path of 0 and an anisotropy of 1 are limited."""
    medium = subsurface_medium((0.5, 0.5, 0.5), (0.0, 1.0, 1.0), 1.0)
    assert math.isfinite(medium.extinction[0]) and medium.anisotropy < 1.0


def test_black_glass_is_finite() -> None:
    medium = transmission_medium((0.0, 0.5, 1.0), 0.1, (0.0, 0.0, 0.0))
    assert math.isfinite(medium.absorption[0]) and medium.absorption[2] == 0.0
