"""The error of values against a noisy reference of about 1."""

from __future__ import annotations

import numpy as np

from sssgen.lab.measure.measured_point import PointError
from sssgen.run.backends import Array
from sssgen.scene.pictures.images import encode_srgb
from sssgen.scene.pictures.picture_difference import EPSILON
from sssgen.scene.pictures.picture_difference import compare as differ

BARS = 2.0
"""Standard errors to either side, in an error bar."""


def compare(values: Array, reference: Array, noise: Array | None = None) -> PointError:
    """The error of `values` (k, n) against `reference` (k, n), whose standard errors are `noise` (k, n).

    `relmse`: the mean of (v − r)² / (r² + ε), minus the expected contribution of the reference's noise. `value`: its
    square root, the relative error. `low`, `high`: the error minus and plus two standard errors. `bias`: the mean
    difference. `p99`, `max`: of the absolute differences. The last three are relative to the reference's mean. The
    result is NaN if a value is not finite.
    """
    sigma = np.zeros_like(reference) if noise is None else noise
    weight = 1.0 / (reference**2 + EPSILON)
    difference = values - reference
    square = difference**2 - sigma**2
    relmse = float((square * weight).mean())
    # the terms (d + s)² − s² are independent, and their variance is 4 d² s² + 2 s⁴
    spread = 4.0 * np.maximum(square, 0.0) * sigma**2 + 2.0 * sigma**4
    deviation = float(np.sqrt((weight**2 * spread).sum())) / difference.size
    scale = max(float(np.abs(reference).mean()), 1e-9)
    return {
        "value": _root(relmse),
        "low": _root(relmse - BARS * deviation),
        "high": _root(relmse + BARS * deviation),
        "relmse": max(relmse, 0.0),
        "bias": float(difference.mean()) / scale,
        "p99": float(np.percentile(np.abs(difference), 99.0)) / scale,
        "max": float(np.abs(difference).max()) / scale,
    }


def _root(square: float) -> float:
    return float(np.sqrt(max(square, 0.0))) if np.isfinite(square) else float("nan")


def flip(values: Array, reference: Array) -> float:
    """The mean of FLIP's map between two pictures (height, width, 3) in linear light, exposed alike, 0 to 1."""
    return differ(encode_srgb(values), encode_srgb(reference)).flip
