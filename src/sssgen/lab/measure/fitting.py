"""The fit of a chain's parameters by least squares, the same for every technique and baseline.

It minimises the error of the charts. For given parameters the scales have a closed form (variable projection: Golub and
Pereyra, 1973), so the search is over the other parameters only.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.contracts import COLOR
from sssgen.ir.formats import FLOAT32
from sssgen.ir.types import BY_NAME, components, kind_of
from sssgen.lab.measure.measured_chain import Chain
from sssgen.lab.measure.problem import Problem
from sssgen.run.backends import Array
from sssgen.support.extras import need

LANES = 400
"""The largest number of lanes of a training problem that the fit uses."""
EVALUATIONS = 30
"""The limit of evaluations of one search."""
COLORS = (0.0, 1.0)
"""The range of a colour's components."""


class Free(NamedTuple):
    """A parameter that the search varies."""

    name: str
    low: float
    high: float
    start: tuple[float, ...]
    logarithmic: bool

    def value(self, x: Array) -> Array:
        """The parameter's components at coordinates in 0..1."""
        if self.logarithmic:
            return self.low * (self.high / self.low) ** x
        return self.low + (self.high - self.low) * x

    def coordinate(self, value: float) -> float:
        """The inverse of `value`, for one component."""
        if self.logarithmic:
            return float(np.log(max(value, self.low) / self.low) / np.log(self.high / self.low))
        return (value - self.low) / (self.high - self.low)


class Factor(NamedTuple):
    """A parameter in which the output is linear; an emitted chain includes the fitted scale in it."""

    name: str
    components: int
    largest: float
    """The largest scale that its range allows"""
    default: tuple[float, ...]
    weights: bool = False
    """Whether each component weights a term of its own, the same for all channels"""

    def settings(self) -> list[dict[str, Any]]:
        """The parameter's values for the terms of the output: for weights each component alone, otherwise none."""
        return [{self.name: unit} for unit in np.eye(self.components)] if self.weights else [{}]


class FitResult(NamedTuple):
    """A chain's parameters for a medium."""

    parameters: dict[str, tuple[float, ...]]
    """By their names in the techniques"""
    scale: tuple[float, ...]
    """The factor of the chain's output, per channel"""
    matte: tuple[float, ...]
    """The factor of the Lambert reflection, per channel: the albedo to use with the chain"""
    error: float
    """The relative error on the training problems"""
    factor: str = ""
    """The name of the Factor in its technique; '' without one"""

    def apply(self, values: Array, problem: Problem) -> Array:
        """The picture: scaled values plus the Lambert reflection."""
        picture: Array = np.array(self.scale)[:, None] * values + np.array(self.matte)[:, None] * problem.lambert
        return picture


def fit(chains: Sequence[Chain | None], problems: Sequence[Problem]) -> FitResult:
    """The best parameters over all problems, each with the chain for its body; None stands for the empty chain.

    Values that are not finite count as 1e3, so that the search avoids them. Raises SssgenError without SciPy.
    """
    thinned = [problem.thin_out(LANES) for problem in problems]
    compiled = [chain for chain in chains if chain is not None]
    if not compiled:
        return _with_best_scales({}, [np.zeros((1, *problem.target.shape)) for problem in thinned], thinned, None)
    of_scene = {name for problem in thinned for part in problem.parts for name in part.values}
    free, factor = free_parameters(compiled[0], of_scene, thinned[0])
    results = [_fit_from(compiled, thinned, free, start, factor) for start in _starts(free)]
    return min(results, key=lambda result: result.error)


def _fit_from(
    chains: Sequence[Chain], problems: Sequence[Problem], free: Sequence[Free], start: Array, factor: Factor | None
) -> FitResult:
    """The result of one search, which begins at the coordinates `start`."""
    optimize = need("scipy.optimize", "scipy", "chart")

    settings = factor.settings() if factor is not None else [{}]

    def values_of(parameters: Mapping[str, Any]) -> list[Array]:
        return [
            np.stack([_finite(problem.values(chain, {**parameters, **setting})) for setting in settings])
            for chain, problem in zip(chains, problems, strict=True)
        ]

    def residual(x: Array) -> Array:
        values = values_of(_values_by_name(free, x))
        fitted = _with_best_scales({}, values, problems, factor)
        weights = np.array(fitted.parameters[factor.name]) if factor is not None and factor.weights else np.ones(1)
        return np.concatenate([
            _residual(fitted, np.tensordot(weights, terms, 1), problem).ravel()
            for terms, problem in zip(values, problems, strict=True)
        ])  # fmt: skip

    x = start
    if len(start):
        evaluations = max(EVALUATIONS // (len(start) + 1), 8)
        x = optimize.least_squares(residual, start, bounds=(0.0, 1.0), diff_step=1e-3, max_nfev=evaluations).x
    parameters = {
        name: tuple(float(np.float32(part)) for part in np.atleast_1d(value))
        for name, value in _values_by_name(free, x).items()
    }
    return _with_best_scales(parameters, values_of(chain_values(parameters)), problems, factor)


def chain_values(parameters: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    """Parameters as arguments of a chain: numbers, or arrays of components."""
    return {name: _component(np.array(value)) for name, value in parameters.items()}


def _residual(fitted: FitResult, values: Array, problem: Problem) -> Array:
    """The relative error of each lane, weighted so that all problems count equally."""
    target, weight = problem.fit_target
    weighted: Array = (fitted.apply(values, problem) - target) * np.sqrt(weight / target.size)
    return weighted


def _with_best_scales(
    parameters: dict[str, tuple[float, ...]],
    values: Sequence[Array],
    problems: Sequence[Problem],
    factor: Factor | None,
) -> FitResult:
    """The best scales of the values and of the Lambert reflection, all at least 0, for these parameters.

    `values` has the terms of each problem, (terms, channels, lanes). Each channel has its own scale only if the factor
    is a colour, because otherwise an artist cannot set it.
    """
    nnls = need("scipy.optimize", "scipy", "chart").nnls
    channels = len(problems[0].target)
    weighted = factor is not None and factor.weights
    per_channel = factor is not None and factor.components == 3 and not weighted and problems[0].role != "coordinates"
    count = channels if per_channel else len(values[0])
    columns: list[list[Array]] = [[] for _ in range(count + channels)]
    targets = []
    for value, problem in zip(values, problems, strict=True):
        for channel in range(channels):
            goals, weights = problem.fit_target
            weight = np.sqrt(weights[channel] / problem.target.size)
            zeros = np.zeros_like(weight)
            matte = problem.lambert[channel] * weight
            for index, column in enumerate(columns[:-channels]):
                term = value[0 if per_channel else index, channel] * weight
                column.append(term if not per_channel or index == channel else zeros)
            for index, column in enumerate(columns[-channels:]):
                column.append(matte if index == channel else zeros)
            targets.append(goals[channel] * weight)
    basis, target = np.stack([np.concatenate(column) for column in columns], axis=1), np.concatenate(targets)
    best = nnls(basis.T @ basis, basis.T @ target)[0]
    if factor is not None and (best[:-channels] > factor.largest).any():
        best[:-channels] = np.minimum(best[:-channels], factor.largest)
        remainder = target - basis[:, :-channels] @ best[:-channels]
        best[-channels:] = nnls(basis[:, -channels:].T @ basis[:, -channels:], basis[:, -channels:].T @ remainder)[0]
    squared_error = float(((basis @ best - target) ** 2).sum())
    scale = best[:-channels] if per_channel else np.repeat(best[:1], channels)
    albedo = tuple(map(float, best[-channels:]))
    error, name = float(np.sqrt(squared_error / len(problems))), factor.name if factor else ""
    if factor is not None and weighted:  # the weights are the parameter itself
        parameters = {**parameters, name: tuple(float(np.float32(part)) for part in best[:-channels])}
        scale, name = np.ones(channels), ""
    return FitResult(parameters, tuple(map(float, scale)), albedo, error, name)


def _finite(values: Array) -> Array:
    return np.where(np.isfinite(values), values, 1e3)


def free_parameters(chain: Chain, of_scene: set[str], problem: Problem) -> tuple[list[Free], Factor | None]:
    """The parameters that the scene does not set (it sets those in `of_scene`), and the factor among them, if any."""
    free: dict[str, Free] = {}
    factors: list[Factor] = []
    for uniform in chain.uniforms:
        name, type_ = uniform["technique_name"], BY_NAME.get(uniform["type"])
        if name in of_scene or type_ is None or name in free:
            continue
        if kind_of(type_) != "float" or not (uniform["range"] or uniform["color"]):
            continue
        low, high = uniform["range"] or COLORS
        default = tuple(uniform["default"])
        if len(default) != components(type_):
            continue
        if is_factor(chain, uniform, problem):
            weights = len(default) > 1 and not uniform["color"] and is_sum(chain, uniform, problem)
            top = COLOR[FLOAT32.name] if uniform["color"] else high
            largest = top if weights else top / max(default)
            factors.append(Factor(name, len(default), float(largest), default, weights))
            continue
        logarithmic = low > 0.0 and high >= 50.0 * low
        if low == 0.0 and high >= 4.0 and uniform["unit"] in ("m", "1/m"):
            low, logarithmic = 1e-3 * high, True  # a length of 0 is a limit, not a value to try
        free[name] = Free(name, float(low), float(high), default, logarithmic)
    return list(free.values()), max(factors, key=lambda factor: (factor.components, factor.largest), default=None)


def is_factor(chain: Chain, uniform: Mapping[str, Any], problem: Problem) -> bool:
    """Whether the output is proportional to the parameter, so that the scale can replace it."""
    name, default = uniform["technique_name"], np.array(uniform["default"])
    if not (default > 0.0).all():
        return False
    small = problem.thin_out(40)
    with np.errstate(all="ignore"):
        values = small.values(chain, {name: _component(0.4 * default)})
        doubled = small.values(chain, {name: _component(0.8 * default)})
        small.values(chain, {name: _component(default)})  # restores the chain's default
    if not np.isfinite(values).all() or not values.any():
        return False
    return bool(np.allclose(doubled, 2.0 * values, rtol=1e-6, atol=1e-12))


def is_sum(chain: Chain, uniform: Mapping[str, Any], problem: Problem) -> bool:
    """Whether the output is a sum of terms, each weighted with a component of the parameter."""
    name, default = uniform["technique_name"], np.array(uniform["default"])
    small = problem.thin_out(40)
    with np.errstate(all="ignore"):
        terms = [small.values(chain, {name: default * unit}) for unit in np.eye(len(default))]
        whole = small.values(chain, {name: default})
    return bool(np.allclose(sum(terms), whole, rtol=1e-6, atol=1e-12))


def _component(value: Array) -> Any:
    return value if len(value) > 1 else value[0]


def _values_by_name(free: Sequence[Free], x: Array) -> dict[str, Any]:
    """The parameters' values at the search's coordinates."""
    values, start = {}, 0
    for parameter in free:
        end = start + len(parameter.start)
        values[parameter.name] = _component(parameter.value(x[start:end]))
        start = end
    return values


def _starts(free: Sequence[Free]) -> list[Array]:
    """The start points of the searches: the defaults, and the middle of every range."""
    if not free:
        return [np.zeros(0)]
    defaults = [np.clip(parameter.coordinate(value), 0.02, 0.98) for parameter in free for value in parameter.start]
    middle = [0.5 if parameter.logarithmic else 0.3 for parameter in free for _ in parameter.start]
    return [np.array(defaults), np.array(middle)]
