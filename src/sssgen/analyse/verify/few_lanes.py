"""Runs a part of a program on few of the interpreter's lanes: a loop that others have left, a branch of few.

Their values are copied into shorter arrays, and back at the end, so that the time of a loop follows from the lanes
that are in it rather than from all lanes until the last one leaves it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Protocol

import numpy as np

from sssgen.analyse.verify.branch_outcomes import Outcomes
from sssgen.analyse.verify.lane_values import Value, narrow, widen
from sssgen.run.backends import Array


class LaneState(Protocol):
    """What a run of the interpreter has of each lane."""

    lanes: int
    """Their number."""
    active: Array
    undefined: Array
    endless: Array
    stopped: Array
    faults: Array
    frame: dict[str, Value]
    values: dict[str, Value]
    returned: Value
    loops: list[list[Array]]
    outcomes: Outcomes | None

    def of_lanes(self, chosen: Array) -> AbstractContextManager[None]: ...


FEWEST = 512
"""The fewest lanes of which some are run alone; of fewer, an operation takes about the same time."""
SHARE = 0.5
"""The largest share of the lanes that is run alone."""
_MASKS = ("active", "undefined", "endless", "stopped", "faults")


def are_few(lanes: Array) -> bool:
    """Whether to run these lanes alone."""
    return len(lanes) >= FEWEST and 0 < int(np.count_nonzero(lanes)) <= SHARE * len(lanes)


def run_alone(run: LaneState, lanes: Array, execute: Callable[[Array], Array]) -> Array:
    """What `execute(lanes)` returns, which gets and returns lanes, called on a run of these lanes only."""
    total, chosen = run.lanes, np.flatnonzero(lanes)
    masks = {name: getattr(run, name) for name in _MASKS}
    frame, values, returned, loops, outcomes = run.frame, run.values, run.returned, run.loops, run.outcomes
    run.lanes = len(chosen)
    for name, mask in masks.items():
        setattr(run, name, mask[chosen])
    few_variables = {name: narrow(value, chosen, total) for name, value in frame.items()}
    few_values = {name: narrow(value, chosen, total) for name, value in values.items()}
    few_returned = None if returned is None else narrow(returned, chosen, total)
    run.frame, run.values, run.returned = few_variables.copy(), few_values.copy(), few_returned
    run.loops = [[mask[chosen] for mask in jumps] for jumps in loops]
    if outcomes is not None:
        run.outcomes = Outcomes(len(chosen))

    def wide(old: Value, before: Value, after: Value) -> Value:
        return old if after is before else widen(old, after, chosen, total)

    def all_wide(old: Mapping[str, Value], before: Mapping[str, Value], after: Mapping[str, Value]) -> dict[str, Value]:
        return {name: wide(value, before[name], after[name]) for name, value in old.items()}

    with run.of_lanes(chosen):
        left = execute(np.ones(len(chosen), bool))
    run.lanes = total
    for name, mask in masks.items():
        setattr(run, name, widen(mask, getattr(run, name), chosen, total))
    run.frame, run.values = all_wide(frame, few_variables, run.frame), all_wide(values, few_values, run.values)
    run.returned = wide(returned, few_returned, run.returned)
    for jumps, few_jumps in zip(loops, run.loops, strict=True):
        jumps[:] = [widen(mask, few, chosen, total) for mask, few in zip(jumps, few_jumps, strict=True)]
    run.loops = loops
    if outcomes is not None and run.outcomes is not None:
        outcomes.add(run.outcomes, chosen)
    run.outcomes = outcomes
    result: Array = widen(np.zeros(total, bool), left, chosen, total)
    return result
