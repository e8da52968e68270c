"""One set of inputs for one technique, and the requirements on its results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from sssgen.analyse.stress.subject import Specimen
from sssgen.ir.formats import FLOAT32
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import Inputs

RANDOM, BOUNDARY, OUTSIDE = "random", "boundary values", "beyond the contract"
ENERGY, STEPS = "thickness grows", "small steps"
"""The trials that do not come from the table of dangerous inputs."""


class Trial(NamedTuple):
    """Inputs, lanes last."""

    name: str
    """The row of the dangerous table, or `RANDOM`, `BOUNDARY`, …"""
    specimen: Specimen
    inputs: Inputs
    counts: bool = True
    """Whether a fault here is a failure: the inputs are in the contract, or the table asks for it."""
    ranged: bool = True
    """Whether the outputs must be in the ranges of their quantities."""
    compared: bool = False
    """Whether the back ends must agree with the oracle."""
    path: bool = False
    """Whether neighbouring lanes are small steps, over which the outputs must not jump."""
    grows: str = ""
    """The input that is larger in the second half of the lanes than in the first: no output may be larger, too."""
    expected: Mapping[str, Array] = {}
    """Outputs that are known, lanes first."""
    tolerance: float = 0.0
    """How far an output may be from those, relative to the larger of its size and 1."""
    epsilon: float = FLOAT32.epsilon
    """The distance from 1 to the next number that the back end computes with."""
