"""Comparisons of pictures with a known difference."""

from __future__ import annotations

import numpy as np
import pytest

from sssgen.scene.pictures.picture_difference import compare
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("flip_evaluator", reason="flip-evaluator is missing: pip install -e '.[render]'")

GRAY = np.full((20, 30, 3), 0.5)


def test_equal_pictures_have_no_difference() -> None:
    difference = compare(GRAY, GRAY)
    assert difference[:4] == (0.0, 0.0, 0.0, 0.0)
    assert difference.picture.shape == GRAY.shape
    assert difference.picture.max() < 0.02  # magma is almost black at 0


def test_black_and_white_differ_most() -> None:
    difference = compare(np.ones((20, 30, 3)), np.zeros((20, 30, 3)))
    assert difference.flip == pytest.approx(0.97, abs=0.01)
    assert difference.relmse == pytest.approx(100.0)
    assert difference.p99 == difference.max == pytest.approx(255.0)
    assert difference.picture.min() > 0.5  # magma is almost white at 1


def test_a_single_pixel_changes_the_largest_difference_but_not_the_99th_percentile() -> None:
    other = GRAY.copy()
    other[3, 4, 1] += 10 / 255
    difference = compare(other, GRAY)
    assert difference.max == pytest.approx(10.0)
    assert difference.p99 == 0.0
    assert difference.relmse == pytest.approx((10 / 255) ** 2 / 0.26 / GRAY.size)
    assert 0.0 < difference.flip < 0.05


def test_the_second_picture_is_the_reference() -> None:
    assert compare(GRAY, GRAY / 2).relmse == pytest.approx(0.0625 / (0.0625 + 0.01))
    assert compare(GRAY / 2, GRAY).relmse == pytest.approx(0.0625 / (0.25 + 0.01))


def test_values_are_clamped_to_the_display_range() -> None:
    assert compare(GRAY + 9.0, np.ones_like(GRAY)).max == 0.0


def test_incomparable_pictures_are_refused() -> None:
    with pytest.raises(SssgenError, match="different sizes: 30 × 20 and 20 × 10 pixels"):
        compare(GRAY, GRAY[:10, :20])
    with pytest.raises(SssgenError, match="the picture has the shape"):
        compare(GRAY[..., 0], GRAY)
    with pytest.raises(SssgenError, match="the reference holds NaN"):
        compare(GRAY, GRAY * np.nan)
