"""The error of a material as it is written: nothing is fitted, and its matte colour is part of it."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sssgen.lab.measure.error_metric import compare
from sssgen.lab.measure.measured_chain import Chain, material_of
from sssgen.lab.measure.measurement import View, problem_of, static_cost
from sssgen.material.material_text import MaterialSection
from sssgen.run.backends import Array


class WrittenError(NamedTuple):
    """A material on the views of a body under the same lights."""

    error: float
    """As in charts: the root of relMSE, without the reference's noise"""
    level: tuple[float, ...]
    """The material's mean light over that of the reference, for red, green and blue"""
    operations: int
    """The weighted operations of an evaluation for one light"""


def measure(stages: Sequence[MaterialSection], cases: Sequence[Sequence[View]]) -> list[WrittenError]:
    """The error in each case: several views under the same lights. Raises SssgenError.

    All light that leaves the body is compared, but not what the surface reflects towards the eye. The engine's Lambert
    light has the albedo of the material.
    """
    # textures are those of the views
    numbers = [tuple(pair for pair in stage.values if not isinstance(pair[1], str)) for stage in stages]
    constant = [
        stage._replace(values=own, fixed=tuple(key for key, _ in own))
        for stage, own in zip(stages, numbers, strict=True)
    ]
    with tempfile.TemporaryDirectory() as folder:
        chain = Chain(material_of(constant, folder))
    operations = static_cost(chain).weight
    results = []
    for case in cases:
        values, targets, noises = (
            np.concatenate(arrays, axis=1) for arrays in zip(*(_compared(chain, view) for view in case), strict=True)
        )
        error = compare(values, targets, noises)["value"]
        level = values.mean(axis=1) / np.maximum(targets.mean(axis=1), 1e-6)
        results.append(WrittenError(float(error or 0.0), tuple(map(float, level)), operations))
    return results


def _compared(chain: Chain, view: View) -> tuple[Array, Array, Array]:
    """The material's values, the reference and its standard error, (3, n) each, exposed alike."""
    problem = problem_of("material", view)
    assert problem is not None
    albedo = chain.surface(problem.parts[0].inputs, "albedo")
    values = problem.values(chain, {}) + albedo * problem.lambert
    return np.nan_to_num(values), problem.target, problem.noise
