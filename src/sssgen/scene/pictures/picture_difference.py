"""How far apart two pictures are: FLIP, relative squared error, and the largest differences."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

EPSILON = 1e-2
"""Added to the reference's square in relMSE, so that black does not count more than dark."""


class Difference(NamedTuple):
    """How a picture differs from a reference."""

    flip: float
    """The mean of FLIP's map, 0 (the same) to 1"""
    relmse: float
    """The mean of (a − b)² / (b² + 0.01) over pixels and channels"""
    p99: float
    """99 of 100 pixels differ by no more than this in their worst channel, in 1/255"""
    max: float
    """The largest difference of any channel, in 1/255"""
    picture: Array
    """(height, width, 3), encoded sRGB: FLIP's map in its magma colours"""


def compare(a: npt.ArrayLike, b: npt.ArrayLike) -> Difference:
    """How the picture `a` differs from the reference `b`: both (height, width, 3), encoded sRGB, clamped to 0..1.

    FLIP (Andersson et al. 2020, the LDR one) has its default viewing conditions: a display of 3840 pixels and 0.7 m
    across, seen from 0.7 m, which is 67 pixels per degree. Raises SssgenError for pictures of different sizes, for
    arrays that are not pictures, and for NaN.
    """
    picture, reference = _picture(a, "picture"), _picture(b, "reference")
    if picture.shape != reference.shape:
        sizes = [f"{image.shape[1]} × {image.shape[0]}" for image in (picture, reference)]
        raise failure(f"the pictures have different sizes: {sizes[0]} and {sizes[1]} pixels", "render both in one size")
    flip = need("flip_evaluator", "flip-evaluator")
    error, mean, _ = flip.evaluate(reference.astype(np.float32), picture.astype(np.float32), "LDR")
    differences = np.abs(picture - reference)
    relative = (picture - reference) ** 2 / (reference**2 + EPSILON)
    return Difference(
        float(mean),
        float(relative.mean()),
        255.0 * float(np.percentile(differences.max(axis=2), 99.0)),
        255.0 * float(differences.max()),
        np.asarray(error, np.float64),
    )


def _picture(values: npt.ArrayLike, name: str) -> Array:
    array = np.asarray(values, np.float64)
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape:
        raise failure(f"the {name} has the shape {array.shape}", "compare pictures of (height, width, 3)")
    if np.isnan(array).any():
        raise failure(f"the {name} holds NaN", "find its source before comparing")
    return np.clip(array, 0.0, 1.0)
