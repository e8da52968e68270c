"""Energy: more matter never lets more light through."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sssgen.analyse.stress.contract_inputs import contract, sample_inputs
from sssgen.analyse.stress.result_checks import growing_input
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import ENERGY, Trial
from sssgen.ir.formats import FLOAT32, Format
from sssgen.run.evaluate.evaluation import Inputs

PAIRS = 4096


def trials(specimen: Specimen, seed: int, format: Format = FLOAT32) -> Iterator[Trial]:
    """Pairs of lanes that differ in the thickness alone; in the second half it is larger, by a little or by much."""
    name = growing_input(specimen)
    if not name:
        return
    rng = np.random.default_rng([seed, 4])
    thin = sample_inputs(specimen, PAIRS, rng, format)
    highest = contract(specimen, name, format).high
    ordinary = rng.random(PAIRS) < 0.8
    first = np.where(ordinary, rng.random(PAIRS) * 4.0, thin.values[name])
    increased = first * (1.0 + np.exp2(-20.0 * rng.random(PAIRS))) + np.where(ordinary, 1e-6, 0.0)
    values = {
        key: np.concatenate([value, value], -1) if value.shape[-1] > 1 else value for key, value in thin.values.items()
    }
    values[name] = np.minimum(np.concatenate([first, increased]), highest).astype(np.float32)
    yield Trial(ENERGY, specimen, Inputs(values, thin.textures, 2 * PAIRS), grows=name)
