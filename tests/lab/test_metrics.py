"""Errors against a noisy reference: their definition, their lack of bias, and the coverage of their bars."""

from __future__ import annotations

from math import isnan, sqrt

import numpy as np
import pytest

from slow_cases import diagonal
from sssgen.lab.measure.error_metric import EPSILON, compare, fit_target, flip


def test_metrics_of_known_values() -> None:
    reference = np.array([[1.0, 0.5], [0.0, 0.1]])
    values = np.array([[1.1, 0.5], [0.05, 0.0]])
    error = compare(values, reference)
    relmse = (0.1**2 / (1.0 + EPSILON) + 0.05**2 / EPSILON + 0.1**2 / (0.01 + EPSILON)) / 4.0
    assert error["relmse"] == pytest.approx(relmse)
    assert error["value"] == error["low"] == error["high"] == pytest.approx(sqrt(relmse))
    assert error["bias"] == pytest.approx((0.1 + 0.05 - 0.1) / 4.0 / 0.4)
    assert error["max"] == pytest.approx(0.1 / 0.4)
    assert error["p99"] == pytest.approx(np.percentile([0.1, 0.0, 0.05, 0.1], 99.0) / 0.4)


def test_equal_values_have_no_error() -> None:
    reference = np.random.default_rng(1).random((3, 50))
    error = compare(reference, reference)
    assert set(error.values()) == {0.0}


def test_percentile_is_not_the_maximum() -> None:
    values = np.ones((1, 1000))
    values[0, 0] = 11.0
    error = compare(values, np.ones((1, 1000)))
    assert (error["max"], error["p99"], error["bias"]) == (10.0, 0.0, pytest.approx(0.01))


def trials(apart: float, noise: float, count: int = 1500, lanes: int = 400) -> tuple[float, np.ndarray]:
    """The true relMSE of values with this error, and the estimates from that many noisy references."""
    generator = np.random.default_rng(8)
    truth = generator.uniform(0.4, 1.0, (3, lanes))
    values = truth * (1.0 + apart * generator.normal(size=truth.shape))
    sigma = noise * generator.uniform(0.5, 1.5, truth.shape)
    right = compare(values, truth)["relmse"]
    results = []
    for _ in range(count):
        noisy = truth + sigma * generator.normal(size=truth.shape)
        results.append({**compare(values, noisy, sigma), "plain": compare(values, noisy)["relmse"]})
    return right, np.array(
        [[result[name] for name in ("relmse", "low", "high", "value", "plain")] for result in results]
    )


@pytest.mark.parametrize(("apart", "noise"), [(0.1, 0.02), (0.1, 0.05), (0.3, 0.02), (0.03, 0.02)])
def test_noise_is_unbiased_and_the_bars_contain_the_truth(apart: float, noise: float) -> None:
    right, result = trials(apart, noise)
    relmse, low, high, value, plain = result.T
    # a bias of a high order remains: at most a seventh of the correction
    assert plain.mean() > 1.005 * right
    assert abs(relmse.mean() - right) < 0.15 * (plain.mean() - right)
    covered = ((low <= sqrt(right)) & (sqrt(right) <= high)).mean()
    assert covered >= 0.94
    assert ((low <= value) & (value <= high)).all()
    # the bars are not too wide: bars of an eighth of the width mostly miss the truth
    narrow = value + 0.125 * np.stack([low - value, high - value])
    assert ((narrow[0] <= sqrt(right)) & (sqrt(right) <= narrow[1])).mean() < 0.5


@pytest.mark.parametrize(
    ("factor", "tail", "bias"),
    diagonal([0.8, 0.9, 1.05, 1.1, 1.3], [pytest.param(0.6, 0.005), pytest.param(0.2, 0.03)]),
)
def test_the_bars_of_few_samples_contain_the_truth(tail: float, bias: float, factor: float) -> None:
    """Means of 128 paths, of which few reach the light, with the noise that 8 batches of them have.

    Fewer paths bring most of the light if `tail`, the shape of the gamma distribution, is small.

    Values that are in proportion to the reference are the hard case: chance makes the reference too low in some lanes,
    and these have larger weights.
    """
    generator = np.random.default_rng(5)
    truth = generator.uniform(0.05, 0.8, (3, 300))
    values = factor * truth
    right, inside, mean = compare(values, truth)["relmse"], 0, 0.0
    for _ in range(200):
        paths = generator.gamma(tail, truth / tail, (128, *truth.shape)).reshape(8, 16, *truth.shape)
        batches = paths.mean(axis=1)
        error = compare(values, batches.mean(axis=0), batches.std(axis=0, ddof=1) / sqrt(8.0))
        inside += error["low"] <= sqrt(right) <= error["high"]
        mean += error["relmse"] / 200
    assert inside >= 0.8 * 200
    assert abs(sqrt(max(mean, 0.0)) - sqrt(right)) < bias


def test_a_fit_to_noisy_targets_is_not_too_low() -> None:
    generator = np.random.default_rng(6)
    truth = generator.uniform(0.1, 0.8, (3, 20000))
    sigma = 0.1 * truth
    noisy = truth + sigma * generator.normal(size=truth.shape)

    def scale(target: np.ndarray, weight: np.ndarray) -> float:
        return float((weight * truth * target).sum() / (weight * truth**2).sum())

    assert scale(noisy, 1.0 / (noisy**2 + EPSILON)) < 0.985
    assert abs(scale(*fit_target(noisy, sigma)) - 1.0) < 0.004
    target, weight = fit_target(noisy, np.zeros_like(noisy))
    assert target is noisy and np.array_equal(weight, 1.0 / (noisy**2 + EPSILON))
    # lanes of mere noise keep their value and their weight
    target, weight = fit_target(np.array([[0.3]]), np.array([[0.3]]))
    assert weight > 0.0 and np.isfinite(target).all()


def test_an_error_below_the_noise_is_not_negative() -> None:
    _, result = trials(0.0, 0.05, 200)
    relmse, low, high, value, _ = result.T
    assert (relmse == 0.0).any() and (relmse >= 0.0).all()
    assert ((low == 0.0) & (value >= 0.0)).mean() > 0.9
    assert (high > 0.0).mean() > 0.9


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_non_finite_values_give_nan_errors(bad: float) -> None:
    values = np.ones((3, 20))
    values[1, 7] = bad
    error = compare(values, np.ones((3, 20)), np.full((3, 20), 0.01))
    assert isnan(error["value"]) and isnan(error["low"]) and isnan(error["high"])
    assert not np.isfinite(error["relmse"])


def test_flip_is_0_for_equal_pictures_and_grows() -> None:
    pytest.importorskip("flip_evaluator")
    reference = np.random.default_rng(3).uniform(0.2, 0.6, (32, 40, 3))
    errors = [flip(reference + more, reference) for more in (0.0, 0.01, 0.05, 0.2)]
    assert errors[0] == 0.0
    assert errors == sorted(errors) and errors[1] < errors[2] < errors[3] <= 1.0
    # both are clamped to the range of a screen
    assert flip(np.full((16, 16, 3), 3.0), np.full((16, 16, 3), 2.0)) == 0.0
