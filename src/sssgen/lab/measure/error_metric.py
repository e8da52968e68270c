"""How far values are from a reference of about 1 that has noise of its own."""

from __future__ import annotations

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.pictures.images import encode_srgb
from sssgen.harness.pictures.picture_difference import EPSILON
from sssgen.harness.pictures.picture_difference import compare as differ

BARS = 2.0
"""Standard errors to either side of an error that its bar shows."""


def compare(values: Array, reference: Array, noise: Array | None = None) -> dict[str, float]:
    """How far `values` (k, n) are from `reference` (k, n), whose standard errors are `noise` (k, n).

    `relmse` is the mean of (v − r)² / (r² + ε), less what the reference's noise adds to it on average; `value` its
    square root, the relative error; `low` and `high` that error two standard errors to either side; `bias` the signed
    mean, `p99` and `max` the differences, all relative to the reference's mean. NaN where a value is not finite.
    """
    sigma = np.zeros_like(reference) if noise is None else noise
    weight = 1.0 / (reference**2 + EPSILON)
    apart = values - reference
    square = apart**2 - sigma**2
    relmse = float((square * weight).mean())
    # of a sum of independent (d + s)² − s²: their variance is 4 d² s² + 2 s⁴
    spread = 4.0 * np.maximum(square, 0.0) * sigma**2 + 2.0 * sigma**4
    deviation = float(np.sqrt((weight**2 * spread).sum())) / apart.size
    scale = max(float(np.abs(reference).mean()), 1e-9)
    return {
        "value": _root(relmse),
        "low": _root(relmse - BARS * deviation),
        "high": _root(relmse + BARS * deviation),
        "relmse": max(relmse, 0.0),
        "bias": float(apart.mean()) / scale,
        "p99": float(np.percentile(np.abs(apart), 99.0)) / scale,
        "max": float(np.abs(apart).max()) / scale,
    }


def _root(square: float) -> float:
    return float(np.sqrt(max(square, 0.0))) if np.isfinite(square) else float("nan")


def flip(values: Array, reference: Array) -> float:
    """The mean of FLIP's map between two pictures (height, width, 3) in linear light, exposed alike, 0 to 1."""
    return differ(encode_srgb(values), encode_srgb(reference)).flip
