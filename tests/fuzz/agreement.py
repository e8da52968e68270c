"""A batch of random programs through every compiler, and on real back ends against the numpy target in float64."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from sssgen.ir.nodes import Module
from sssgen.lang.loader import load_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Backend, get
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.run.evaluate.deviation import errors
from sssgen.run.evaluate.evaluation import DTYPES, Inputs, run
from sssgen.run.evaluate.probes import Probe, Subject

LANES = 48
TOLERANCE = 1e-3
"""What a program may deviate by, in the measure of `run.evaluate.deviation`: it nests builtins that may each be off by
1e-6. A program that is wrong deviates more, in some lane."""
STEADY = 1e-5
"""A lane where NumPy's float32 is further from float64 than this is excused: the formulas themselves lose too much."""
LANGUAGES = ("glsl-330", "glsl-es-300", "hlsl", "wgsl", "tsl")
SHOWS = ("_result", "_floats", "_whole")


def compiles(module: Module, assert_compiles: Callable[[Source], None]) -> None:
    """Every compiler accepts the text of the module in every language."""
    for language in LANGUAGES:
        for source in sources(transpile(module, language, "fuzzed").files):
            assert_compiles(source)


def subject_of(text: str) -> Subject:
    """The functions of `shader_programs.source` that show outputs."""
    module = load_text(text, "fuzzed.sss")
    functions = [function for function in module.functions if function.name.endswith(SHOWS)]
    probes = tuple(Probe(function.name, function.name, function.params, function.result) for function in functions)
    return Subject("fuzzed", module, probes, {})


@cache
def arguments() -> Inputs:
    """Arguments for `shader_programs.INPUTS`."""
    rng = np.random.default_rng(7)

    def eighths() -> Array:
        return rng.integers(-40, 41, LANES) / 8.0

    def whole(kind: str, *shape: int) -> Array:
        info = np.iinfo(DTYPES[kind])
        small = rng.integers(-9 if kind == "int" else 0, 10, (*shape, LANES))
        any_ = rng.integers(info.min, info.max, (*shape, LANES), endpoint=True)
        return np.where(rng.random((*shape, LANES)) < 0.8, small, any_).astype(DTYPES[kind])

    def floats(*shape: int) -> Array:
        return rng.uniform(-3.0, 3.0, (*shape, LANES)).astype(np.float32).astype(np.float64)

    values = {
        "a": eighths(), "b": eighths(), "d": floats(3), "n": whole("int"), "h": whole("uint"),
        "f": rng.random(LANES) < 0.5,
        "g": whole("int", 2), "t": floats(),
    }  # fmt: skip
    return Inputs(values, {}, LANES)


class Oracle:
    """The results of the numpy target for a text, and the lanes where float32 is comparable."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.subject = subject_of(text)
        self.right = run(self.subject, arguments(), get("numpy"))
        rounded = run(self.subject, arguments(), get("numpy-f32"))
        self.steady = {name: _apart(rounded[name], right) <= STEADY for name, right in self.right.items()}

    def excused(self) -> float:
        """The share of lanes that are not compared."""
        return 1.0 - float(np.mean([*self.steady.values()]))

    def differences(self, backend: Backend) -> list[str]:
        """Where a back end computes something else, with the arguments."""
        result = run(self.subject, arguments(), backend)
        failures = []
        for name, right in self.right.items():
            apart = np.where(self.steady[name], _apart(result[name], right), 0.0)
            if (apart > TOLERANCE).any():
                lane = int(np.argmax(apart))
                values = {key: value[..., lane].tolist() for key, value in arguments().values.items()}
                got, wanted = np.broadcast_to(result[name].T, right.T.shape).T[lane], right[lane]
                failures.append(f"{backend.name}: {name}{values} is {got}, and in float64 {wanted}")
        return failures


def _apart(actual: Array, expected: Array) -> Array:
    """The deviation of each lane; results that are the same for all are spread out."""
    shape = (LANES, *np.shape(expected)[1:])
    return errors(np.broadcast_to(actual, shape), np.broadcast_to(expected, shape))
