"""Random programs on real back ends, compared with the numpy target. Techniques: see test_parity_techniques.py."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from random import Random

import numpy as np
import pytest

from against_numpy import Array, Draw, arguments, differences
from random_programs import HELPERS, Programs
from sssgen.ir.nodes import Function, Module, Param
from sssgen.ir.types import kind_of
from sssgen.lang.loader import load_text
from sssgen.run.backends import Backend, Call
from sssgen.run.evaluate.probes import probes_of

LANES = 48


@pytest.fixture(params=["gl", "webgpu", "hlsl", "metal"])
def gpu(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> Backend:
    """A back end for each language."""
    return backend(request.param)


def called(title: str, function: Function, draw: Draw, lanes: int) -> tuple[str, Call]:
    params = tuple(param.type for param in function.params)
    return title, Call(function.name, params, function.result, arguments(function, draw, lanes))


class ProgramsInBounds(Programs):
    """Random programs with indices inside their array."""

    def number(self, depth: int = 2) -> str:
        return self.inside(super().number(depth))

    def place(self) -> str:
        return self.inside(super().place())

    def inside(self, text: str) -> str:
        return f"list[abs({text[5:-1]}) % 3]" if text.startswith("list[") else text


@cache
def random_module() -> tuple[Module, tuple[Function, ...]]:
    """A module with random functions, and the probes of these functions."""
    functions = []
    for seed in range(24):
        source = ProgramsInBounds(Random(seed), size=3).program()
        functions.append(source[source.index("float f(") :].replace("float f(", f"float random_{seed}(", 1))
    module = load_text("\n".join([HELPERS, *functions]), "random")
    random = [function for function in module.functions if function.name.startswith("random_")]
    result = [probe for function in random for _, probe in probes_of(function)]
    return module._replace(functions=(*module.functions, *result)), tuple(result)


def exact_argument(param: Param, rng: np.random.Generator, lanes: int) -> Array:
    """Numbers that float32 computes with exactly, so that no condition differs."""
    if kind_of(param.type) == "int":
        return rng.integers(0, 4, lanes).astype(np.int32)
    return (rng.integers(-8, 9, lanes) / 2).astype(np.float32)


def test_random_programs(gpu: Backend) -> None:
    """Programs have control flow that differs between lanes, out parameters, conditional expressions and loops."""
    module, probes = random_module()
    calls = [called(function.name, function, exact_argument, LANES) for function in probes]
    failures = differences(gpu, module, calls, {}, "float32", 1e-4)
    assert not failures, "\n\n".join([f"{len(failures)} of {len(calls)}", *failures])
