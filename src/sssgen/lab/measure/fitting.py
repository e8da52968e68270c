"""The same fair fit for every technique and baseline: its free parameters, and always a scale, by least squares.

What is minimised is the charts' own error. The scale has a closed form for each choice of the others (variable
projection: Golub and Pereyra, 1973), so only the parameters that shape the result are searched.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.pictures.picture_difference import EPSILON
from sssgen.ir.types import BY_NAME, components, kind_of
from sssgen.lab.measure.measured_chain import Chain
from sssgen.lab.measure.problem import Problem
from sssgen.support.extras import need

LANES = 400
"""Lanes of a training problem that are fitted to."""
EVALUATIONS = 30
"""The most evaluations of one search."""
COLORS = (0.0, 1.0)
"""Where a colour's components are searched."""


class Free(NamedTuple):
    """A parameter that is searched."""

    name: str
    low: float
    high: float
    start: tuple[float, ...]
    logarithmic: bool

    def value(self, x: Array) -> Array:
        """The parameter's components from the search's, each 0..1."""
        if self.logarithmic:
            return self.low * (self.high / self.low) ** x
        return self.low + (self.high - self.low) * x

    def place(self, value: float) -> float:
        """Where in the search, 0..1, a component stands."""
        if self.logarithmic:
            return float(np.log(max(value, self.low) / self.low) / np.log(self.high / self.low))
        return (value - self.low) / (self.high - self.low)


class Factor(NamedTuple):
    """The parameter that the scale goes into when a chain is emitted."""

    name: str
    components: int
    most: float
    """The largest scale that it can take"""
    default: tuple[float, ...]


class Fitted(NamedTuple):
    """A chain's parameters for a medium."""

    parameters: dict[str, tuple[float, ...]]
    """By the techniques' own names"""
    scale: tuple[float, ...]
    """What the chain's values are multiplied by, a channel each"""
    matte: tuple[float, ...]
    """What Lambert's light is multiplied by, a channel each: the albedo that goes with the chain"""
    error: float
    """The relative error on what was fitted to"""
    factor: str = ""
    """The parameter that can take the scale, by its technique's own name; '' where none can"""

    def apply(self, values: Array, problem: Problem) -> Array:
        """The picture: scaled values, and the light from the front."""
        whole: Array = np.array(self.scale)[:, None] * values + np.array(self.matte)[:, None] * problem.lambert
        return whole


def fit(chains: Sequence[Chain | None], problems: Sequence[Problem]) -> Fitted:
    """The best parameters over all problems, each with its own body's chain; without one, of the light from the front.

    Raises SssgenError without SciPy. Where values are not finite they count as 1e3, so that the search leaves them.
    """
    thinned = [problem.thinned(LANES) for problem in problems]
    present = [chain for chain in chains if chain is not None]
    if not present:
        return _solved({}, [np.zeros_like(problem.target) for problem in thinned], thinned, None)
    given = {name for problem in thinned for part in problem.parts for name in part.values}
    free, factor = free_parameters(present[0], given, thinned[0])
    found = [_searched(present, thinned, free, start, factor) for start in _starts(free)]
    return min(found, key=lambda one: one.error)


def _searched(
    chains: Sequence[Chain], problems: Sequence[Problem], free: Sequence[Free], start: Array, factor: Factor | None
) -> Fitted:
    optimize = need("scipy.optimize", "scipy", "chart")

    def values_of(parameters: Mapping[str, Any]) -> list[Array]:
        return [_finite(one.values(chain, parameters)) for chain, one in zip(chains, problems, strict=True)]

    def residual(x: Array) -> Array:
        values = values_of(_named(free, x))
        fitted = _solved({}, values, problems, factor)
        apart = [_apart(fitted, one, problem) for one, problem in zip(values, problems, strict=True)]
        return np.concatenate([one.ravel() for one in apart])

    x = start
    if len(start):
        most = max(EVALUATIONS // (len(start) + 1), 8)
        x = optimize.least_squares(residual, start, bounds=(0.0, 1.0), diff_step=1e-3, max_nfev=most).x
    parameters = {
        name: tuple(float(np.float32(one)) for one in np.atleast_1d(value)) for name, value in _named(free, x).items()
    }
    return _solved(parameters, values_of(exact(parameters)), problems, factor)


def exact(parameters: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    """Parameters as a chain takes them: numbers, and components."""
    return {name: _component(np.array(value)) for name, value in parameters.items()}


def _apart(fitted: Fitted, values: Array, problem: Problem) -> Array:
    """The relative error of each lane, so weighted that each problem counts alike."""
    apart: Array = (fitted.apply(values, problem) - problem.target) / np.sqrt(problem.target**2 + EPSILON)
    weighted: Array = apart / np.sqrt(problem.target.size)
    return weighted


def _solved(
    parameters: dict[str, tuple[float, ...]],
    values: Sequence[Array],
    problems: Sequence[Problem],
    factor: Factor | None,
) -> Fitted:
    """The best scale of the values, and of the light from the front; none is below 0.

    A channel has a scale of its own where a colour of the technique's is one; else all have the same, which is what an
    artist can set.
    """
    nnls = need("scipy.optimize", "scipy", "chart").nnls
    channels = len(problems[0].target)
    each = factor is not None and factor.components == 3 and problems[0].role != "coordinates"
    columns: list[list[Array]] = [[] for _ in range((channels if each else 1) + channels)]
    rights = []
    for value, problem in zip(values, problems, strict=True):
        for channel in range(channels):
            weight = 1.0 / np.sqrt((problem.target[channel] ** 2 + EPSILON) * problem.target.size)
            nothing = np.zeros_like(weight)
            scaled, matte = value[channel] * weight, problem.lambert[channel] * weight
            for at, column in enumerate(columns[:-channels]):
                column.append(scaled if not each or at == channel else nothing)
            for at, column in enumerate(columns[-channels:]):
                column.append(matte if at == channel else nothing)
            rights.append(problem.target[channel] * weight)
    basis, right = np.stack([np.concatenate(column) for column in columns], axis=1), np.concatenate(rights)
    best = nnls(basis.T @ basis, basis.T @ right)[0]
    if factor is not None and (best[:-channels] > factor.most).any():
        best[:-channels] = np.minimum(best[:-channels], factor.most)
        rest = right - basis[:, :-channels] @ best[:-channels]
        best[-channels:] = nnls(basis[:, -channels:].T @ basis[:, -channels:], basis[:, -channels:].T @ rest)[0]
    square = float(((basis @ best - right) ** 2).sum())
    scale = best[:-channels] if each else np.repeat(best[:1], channels)
    matte_of = tuple(map(float, best[-channels:]))
    error, name = float(np.sqrt(square / len(problems))), factor.name if factor else ""
    return Fitted(parameters, tuple(map(float, scale)), matte_of, error, name)


def _finite(values: Array) -> Array:
    return np.where(np.isfinite(values), values, 1e3)


def free_parameters(chain: Chain, given: set[str], problem: Problem) -> tuple[list[Free], Factor | None]:
    """The parameters that shape what the chain gives, and that the scene does not; and the factor, if it has one."""
    found: dict[str, Free] = {}
    factors: list[Factor] = []
    for uniform in chain.uniforms:
        name, type_ = uniform["technique_name"], BY_NAME.get(uniform["type"])
        if name in given or type_ is None or name in found:
            continue
        if kind_of(type_) != "float" or not (uniform["range"] or uniform["color"]):
            continue
        low, high = uniform["range"] or COLORS
        default = tuple(uniform["default"])
        if len(default) != components(type_):
            continue
        if is_factor(chain, uniform, problem):
            most = np.inf if uniform["color"] else high / default[0]
            factors.append(Factor(name, len(default), float(most), default))
            continue
        logarithmic = low > 0.0 and high >= 50.0 * low
        if low == 0.0 and high >= 4.0 and uniform["unit"] in ("m", "1/m"):
            low, logarithmic = 1e-3 * high, True  # a length of 0 is a limit, not a place to search
        found[name] = Free(name, float(low), float(high), default, logarithmic)
    return list(found.values()), max(factors, key=lambda one: (one.components, one.most), default=None)


def is_factor(chain: Chain, uniform: Mapping[str, Any], problem: Problem) -> bool:
    """Whether twice the parameter gives just twice the light: then it is what the scale stands for."""
    name, default = uniform["technique_name"], np.array(uniform["default"])
    if not (default > 0.0).all():
        return False
    few = problem.thinned(40)
    with np.errstate(all="ignore"):
        one = few.values(chain, {name: _component(0.4 * default)})
        two = few.values(chain, {name: _component(0.8 * default)})
        few.values(chain, {name: _component(default)})
    same = bool(np.isfinite(one).all()) and bool(np.abs(one).max(initial=0.0) > 0.0)
    return bool(same) and bool(np.allclose(two, 2.0 * one, rtol=1e-6, atol=1e-12))


def _component(value: Array) -> Any:
    return value if len(value) > 1 else value[0]


def _named(free: Sequence[Free], x: Array) -> dict[str, Any]:
    found, at = {}, 0
    for one in free:
        size = len(one.start)
        found[one.name] = _component(one.value(x[at : at + size]))
        at += size
    return found


def _starts(free: Sequence[Free]) -> list[Array]:
    """Where searches begin: the defaults, and the middle of every range."""
    if not free:
        return [np.zeros(0)]
    usual = [np.clip(one.place(value), 0.02, 0.98) for one in free for value in one.start]
    middle = [0.5 if one.logarithmic else 0.3 for one in free for _ in one.start]
    return [np.array(usual), np.array(middle)]
