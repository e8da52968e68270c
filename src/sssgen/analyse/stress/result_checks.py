"""The faults of results: tests of bits, ranges, energy, steps, and known values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from sssgen.analyse.stress.contract_inputs import contract, is_direction
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import Trial
from sssgen.ir.contracts import of_param
from sssgen.run.backends import Array
from sssgen.run.evaluate.deviation import errors
from sssgen.run.evaluate.probes import RESULT

KINDS = ("non-finite", "out of range", "energy", "jump", "wrong value", "disagreement")
"""The kinds of faults, the worst first."""

ULPS = 4.0
"""How far beyond the end of a range rounding may bring a result, in units of the last place."""
JUMP = 0.02
"""The largest step of an output, relative to the larger of its size and 1, between neighbours on a path."""
GROWTH = 1e-5
"""How much light rounding may add when there is more matter, relative to the larger of its size and 1."""

_LIGHTS = {"translucency", "lighting", "environment", "tone_mapping", "output"}


class OutputFaults(NamedTuple):
    """Faults of one kind in one output."""

    kind: str
    output: str
    bad: Array
    """(lanes,) bool"""


def non_finite(value: Array) -> Array:
    """Where a float's exponent bits are all set: (…,) bool. It uses no comparison that fast-math could remove."""
    masks: dict[int, tuple[Any, int]] = {
        2: (np.uint16, 0x7C00),
        4: (np.uint32, 0x7F800000),
        8: (np.uint64, 0x7FF << 52),
    }
    dtype, mask = masks[value.dtype.itemsize]
    failing: Array = (np.ascontiguousarray(value).view(dtype) & dtype(mask)) == dtype(mask)
    return failing


def faults_of(
    trial: Trial, outputs: Mapping[str, Array], oracle: Mapping[str, Array] | None = None
) -> list[OutputFaults]:
    """The faults of a back end's outputs, lanes first."""
    faults = []
    for name, value in outputs.items():
        if value.dtype.kind != "f":
            continue
        lanes = np.broadcast_to(value, (trial.inputs.lanes, *value.shape[1:]) if value.ndim else (trial.inputs.lanes,))
        failing = _any(non_finite(lanes))
        faults.append(OutputFaults("non-finite", name, failing))
        for kind, test in _TESTS.items():
            faults.append(OutputFaults(kind, name, test(trial, name, lanes, oracle) & ~failing))
    return [fault for fault in faults if fault.bad.any()]


def _out_of_range(trial: Trial, output: str, value: Array, _: Mapping[str, Array] | None) -> Array:
    if not trial.ranged:
        return _none(value)
    low, high, length = bounds(trial.specimen, output)
    slack = trial.specimen.quantity(output) == "" and low == 0.0
    eps = trial.epsilon
    with np.errstate(over="ignore", invalid="ignore"):
        bad = _any((value < low - slack * ULPS * eps) | (value > high * (1.0 + ULPS * eps)))
        if slack:
            bad &= not_longer(trial)
        if np.isfinite(length):
            bad |= np.linalg.norm(value.astype(np.float64), axis=-1) > length + 1e-3 + ULPS * eps
    return bad


def bounds(specimen: Specimen, output: str) -> tuple[float, float, float]:
    """Lowest, highest value and greatest length that an output may have, by its quantity, its name and the role."""
    param = specimen.output(output)
    range_of = of_param(param)
    if is_direction(output, range_of):
        return -np.inf, np.inf, range_of.length
    if param.quantity and not param.quantity.endswith("_position"):
        return range_of.low, range_of.high, np.inf
    if range_of.low >= 0.0:  # a colour has no highest value, a fraction has
        return 0.0, 1.0 if range_of.high <= 1.0 else np.inf, np.inf
    return (0.0 if output == RESULT and specimen.role in _LIGHTS else -np.inf), np.inf, np.inf


def _energy(trial: Trial, _: str, value: Array, __: Mapping[str, Array] | None) -> Array:
    """The lanes where more matter transmits more light."""
    if not trial.grows:
        return _none(value)
    thin, thick = np.split(value.astype(np.float64), 2)
    with np.errstate(invalid="ignore"):
        more = _any(thick - thin > GROWTH * np.maximum(np.abs(thin), 1.0))
    return np.concatenate([more, more])


def _jumps(trial: Trial, output: str, value: Array, oracle: Mapping[str, Array] | None) -> Array:
    """Steps between neighbours on a path that are larger than `JUMP`, and than the oracle's own, where it has one."""
    if not trial.path:
        return _none(value)
    step = steps(value)
    own = steps(oracle[output]) if oracle is not None else np.zeros_like(step)
    padded = np.pad(own, 2)  # in float32 a decision may change a step or two earlier or later
    own = np.max([padded[shift : shift + len(own)] for shift in range(5)], axis=0)
    return np.concatenate([step > np.maximum(JUMP, 2.0 * own), [False]])


def steps(value: Array) -> Array:
    """The steps between neighbouring lanes, (lanes - 1,), relative to the larger of their size and 1."""
    return errors(value[1:], value[:-1])


def _wrong(trial: Trial, output: str, value: Array, _: Mapping[str, Array] | None) -> Array:
    if output not in trial.expected:
        return _none(value)
    expected = np.broadcast_to(trial.expected[output], value.shape)
    return errors(value, expected) > trial.tolerance


def growing_input(specimen: Specimen) -> str:
    """The thickness input of a technique that returns light, thinness or transmittance; '' if it has none."""
    lets_through = {specimen.quantity(probe.output) for probe in specimen.subject.probes} & {
        "transmittance",
        "thinness",
    }
    for name, param in specimen.subject.params.items():
        if param.quantity == "thickness" and (lets_through or specimen.role == "translucency"):
            return name
    return ""


def not_longer(trial: Trial) -> Array:
    """The lanes in which no direction is longer than 1, (lanes,) bool; longer ones may make a light negative."""
    short: Array = np.ones(trial.inputs.lanes, np.bool_)
    for name, value in trial.inputs.values.items():
        if value.dtype.kind == "f" and is_direction(name, contract(trial.specimen, name)):
            lengths: Array = np.linalg.norm(value.astype(np.float64), axis=0)
            short &= np.asarray(lengths <= 1.0 + 1e-6)
    return short


def _any(bad: Array) -> Array:
    return np.asarray(bad.reshape(len(bad), -1).any(axis=1))


def _none(value: Array) -> Array:
    return np.zeros(len(value), np.bool_)


Test = Callable[[Trial, str, Array, "Mapping[str, Array] | None"], Array]
_TESTS: dict[str, Test] = {
    "out of range": _out_of_range, "energy": _energy, "jump": _jumps, "wrong value": _wrong,
}  # fmt: skip
