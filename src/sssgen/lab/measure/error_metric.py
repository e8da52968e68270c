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
NODES, SHARES = np.polynomial.hermite_e.hermegauss(5)
"""Values of a normal variable and their weights, for the mean of a smooth function of it."""
SHARES = SHARES / SHARES.sum()
LEAST_SHARE = 0.25
"""The least share of its usual weight that a lane has in a fit."""


def compare(values: Array, reference: Array, noise: Array | None = None) -> PointError:
    """The error of `values` (k, n) against `reference` (k, n), whose standard errors are `noise` (k, n).

    `relmse`: the mean of (v − r)² / (r² + ε), minus the effect of the reference's noise. `value`: its square root, the
    relative error. `low`, `high`: the error minus and plus two standard errors. `bias`: the mean difference. `p99`,
    `max`: of the absolute differences. The last three are relative to the reference's mean. The result is NaN if a
    value is not finite.

    The noise is in the numerator and in the weight. Its effect is what the same noise adds when it is added once more
    (as in Cook and Stefanski, "Simulation-extrapolation estimation in parametric measurement error models", 1994); the
    mean over that noise is a sum over `NODES`.
    """
    difference = values - reference
    terms, deviation = difference**2 / (reference**2 + EPSILON), 0.0
    if noise is not None:
        noisier = [reference + node * noise for node in NODES]
        squares = [(values - one) ** 2 / (one**2 + EPSILON) for one in noisier]
        with np.errstate(invalid="ignore"):  # values that are not finite
            expected = sum(share * square for share, square in zip(SHARES, squares, strict=True))
            spread = sum(share * (square - expected) ** 2 for share, square in zip(SHARES, squares, strict=True))
            terms = 2.0 * terms - expected
        deviation = float(np.sqrt(np.sum(spread))) / difference.size
    relmse = float(terms.mean())
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


def fit_target(reference: Array, noise: Array) -> tuple[Array, Array]:
    """The targets t and weights w, (k, n) each, whose mean of w (v − t)² a fit minimises: the relMSE of `compare`.

    Without noise they are r and 1 / (r² + ε). A fit to noisy targets that does not subtract the effect of their noise
    gives values that are too low, because a reference that is too low by chance has a larger weight.
    """
    usual = 1.0 / (reference**2 + EPSILON)
    if not noise.any():
        return reference, usual
    noisier = [reference + node * noise for node in NODES]
    weights = [1.0 / (one**2 + EPSILON) for one in noisier]
    weight = 2.0 * usual - sum(share * part for share, part in zip(SHARES, weights, strict=True))
    product = 2.0 * reference * usual - sum(
        share * part * one for share, part, one in zip(SHARES, weights, noisier, strict=True)
    )
    kept = weight >= LEAST_SHARE * usual  # lanes that are mostly noise have no such form
    return np.where(kept, product / np.where(kept, weight, 1.0), reference), np.where(kept, weight, usual)


def _root(square: float) -> float:
    return float(np.sqrt(max(square, 0.0))) if np.isfinite(square) else float("nan")


def flip(values: Array, reference: Array) -> float:
    """The mean of FLIP's map between two pictures (height, width, 3) in linear light, exposed alike, 0 to 1."""
    return differ(encode_srgb(values), encode_srgb(reference)).flip
