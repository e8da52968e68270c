"""The error of values against a noisy reference of about 1."""

from __future__ import annotations

from collections.abc import Callable

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
PARABOLA = 1.0 / 3.0
"""The share of a parabola, beside a straight line, in the extrapolation to a reference without noise. The noise of few
paths has long tails: there a line gives errors that are too small, and a parabola errors that are too large. With this
share the mean of errors measured with 128 paths is within 0.005 of the truth, with very long tails within 0.03
(`tests/lab/test_metrics.py`)."""
LEAST_SHARE = 0.25
"""The least share of its usual weight that a lane has in a fit."""


def compare(values: Array, reference: Array, noise: Array | None = None) -> PointError:
    """The error of `values` (k, n) against `reference` (k, n), whose standard errors are `noise` (k, n).

    `relmse`: the mean of (v − r)² / (r² + ε), minus the effect of the reference's noise. `value`: its square root, the
    relative error. `low`, `high`: the error minus and plus two standard errors. `bias`: the mean difference. `p99`,
    `max`: of the absolute differences. The last three are relative to the reference's mean. The result is NaN if a
    value is not finite.

    The noise is in the numerator and in the weight. Its effect is extrapolated from what the same noise adds when it is
    added once and twice more (Cook and Stefanski, "Simulation-extrapolation estimation in parametric measurement error
    models", 1994); the mean over that noise is a sum over `NODES`. The bar has what two extrapolations differ by, too.
    """
    difference = values - reference

    def square(target: Array) -> Array:
        term: Array = (values - target) ** 2 / (target**2 + EPSILON)
        return term

    terms, deviation = square(reference), 0.0
    if noise is not None:
        with np.errstate(invalid="ignore"):  # values that are not finite
            line, parabola = extrapolations(square, reference, noise)
            terms = line + PARABOLA * (parabola - line)
            # for one standard error of each value of the reference
            change = 0.5 * (square(reference + noise) - square(reference - noise))
        doubt = 0.25 * float((parabola - line).mean())
        deviation = float(np.hypot(np.sqrt(np.sum(change**2)) / difference.size, doubt))
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
    weight = without_noise(lambda target: 1.0 / (target**2 + EPSILON), reference, noise)
    product = without_noise(lambda target: target / (target**2 + EPSILON), reference, noise)
    kept = weight >= LEAST_SHARE * usual  # lanes that are mostly noise have no such form
    return np.where(kept, product / np.where(kept, weight, 1.0), reference), np.where(kept, weight, usual)


def with_noise(function: Callable[[Array], Array], reference: Array, noise: Array) -> Array:
    """The mean of a function of the reference when normal noise with the standard errors `noise` is added to it."""
    parts = [share * function(reference + node * noise) for node, share in zip(NODES, SHARES, strict=True)]
    result: Array = np.sum(parts, axis=0)
    return result


def extrapolations(function: Callable[[Array], Array], reference: Array, noise: Array) -> tuple[Array, Array]:
    """A function of the reference, extrapolated to a reference without the noise that it has: from the means with the
    noise that it has and with once more, along a line; and with twice more, along a parabola."""
    plain, once, twice = (
        function(reference), with_noise(function, reference, noise),
        with_noise(function, reference, float(np.sqrt(2.0)) * noise),
    )  # fmt: skip
    return 2.0 * plain - once, 3.0 * (plain - once) + twice


def without_noise(function: Callable[[Array], Array], reference: Array, noise: Array) -> Array:
    """A function of the reference, extrapolated to a reference without the noise that it has."""
    line, parabola = extrapolations(function, reference, noise)
    return line + PARABOLA * (parabola - line)


def _root(square: float) -> float:
    return float(np.sqrt(max(square, 0.0))) if np.isfinite(square) else float("nan")


def flip(values: Array, reference: Array) -> float:
    """The mean of FLIP's map between two pictures (height, width, 3) in linear light, exposed alike, 0 to 1."""
    return differ(encode_srgb(values), encode_srgb(reference)).flip
