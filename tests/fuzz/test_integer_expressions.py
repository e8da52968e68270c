"""Integer expressions at the boundaries of the types: every back end computes what 32-bit arithmetic gives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from amounts import COUNTED, examples
from integer_expressions import HIGHEST, LOWEST, MOST, PARAMETERS, Expressions, Part, program, result_of
from slow_cases import back_end_cases, diagonal
from sssgen.ir.types import INT, UINT, Scalar
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backend_registry import BACKENDS, SINGLE
from sssgen.run.backends import Array, Backend, Call, Text
from sssgen.support.diagnostics import SssgenError

BATCH = 60
"""Expressions in one shader."""
SEEDS = st.integers(0, 1 << 32)


def computed(text: str, kinds: Sequence[Scalar], result: Scalar, args: Sequence[Array], backend: Backend) -> Array:
    """The results of `f` in plain GLSL."""
    module = load_glsl_text(text, "case.glsl").module
    files = transpile(module, BACKENDS[backend.name].target, "case", "none", keep=True).files
    emitted = next(content for file, content in files.items() if not file.endswith(".json"))
    return backend.run(Text(emitted), [Call("f", tuple(kinds), result, tuple(args))])[0]


def wrong(parts: list[Part], backend: Backend) -> list[str]:
    """The expressions that a back end refuses, or computes otherwise."""
    lanes = len(parts) + -len(parts) % 4
    args = [np.arange(lanes, dtype=np.int32)]
    args += [np.full(lanes, PARAMETERS[name], np.int32 if name in "ab" else np.uint32) for name in "abuv"]
    try:
        results = computed(program(parts), (INT, INT, INT, UINT, UINT), INT, args, backend)
    except SssgenError as error:
        if len(parts) == 1:
            return [f"{parts[0].text}\n{error}"]
        middle = len(parts) // 2
        return wrong(parts[:middle], backend) + wrong(parts[middle:], backend)
    pairs = zip(parts, np.broadcast_to(results, lanes), strict=False)
    return [f"{part.text}\n{result}, not {part.value[0]}" for part, result in pairs if result != part.value[0]]


@pytest.mark.parametrize("name", back_end_cases(SINGLE, "unity"))
@examples(2, 0.1, shrink=False)  # a seed that is smaller makes no smaller expression
@given(seed=SEEDS)
def test_expressions_agree(backend: Callable[[str], Backend], name: str, seed: int) -> None:
    """Constant expressions, which compilers compute, and expressions that contain parameters, too."""
    machine, random = backend(name), Random(seed)
    for parameters in ((), tuple(PARAMETERS)):
        expressions = Expressions(random, parameters)
        parts = [expressions.whole(random.randint(1, 4)) for _ in range(BATCH)]
        failures = wrong(parts, machine)
        assert not failures, "\n\n".join([f"seed {seed}: {len(failures)}", *failures[:8]])
        COUNTED["integer expressions"] += BATCH


def test_a_wrong_value_is_seen(backend: Callable[[str], Backend]) -> None:
    parts = [Part("1 + 1", (2,)), Part("a - 1", (PARAMETERS["a"],)), Part("1 +", (0,))]
    failures = wrong(parts, backend("numpy"))
    assert [failure.split("\n")[0] for failure in failures] == ["a - 1", "1 +"]


NUMBERS = (LOWEST, -HIGHEST, -65536, -9, -2, -1, 0, 1, 2, 7, 0x55555555, 1 << 30, HIGHEST)
FIELDS = [(start, count) for start in range(33) for count in range(33 - start)]
BUILTINS = ("abs", "sign", "bitCount", "findLSB", "findMSB", "bitfieldReverse", "bitfieldExtract", "bitfieldInsert")
SIGNED = ("abs", "sign")
COUNTS = ("bitCount", "findLSB", "findMSB")


@pytest.mark.parametrize(("name", "kind"), diagonal(back_end_cases(SINGLE, "unity"), ["int", "uint"]))
def test_builtins_at_their_boundaries(backend: Callable[[str], Backend], name: str, kind: str) -> None:
    """Scalars and vectors, with arguments that no compiler knows: all fields, all numbers at a boundary."""
    machine = backend(name)
    cases = [*product([number if kind == "int" else number & MOST for number in NUMBERS], FIELDS)]
    cases += cases[: -len(cases) % 4]
    x = np.array([number for number, _ in cases], np.int32 if kind == "int" else np.uint32)
    start, count = (np.array([field[place] for _, field in cases], np.int32) for place in (0, 1))
    for builtin in BUILTINS:
        if builtin in SIGNED and kind == "uint":
            continue
        rest = {"bitfieldExtract": ", s, c", "bitfieldInsert": ", ~x, s, c"}.get(builtin, "")
        expected = np.array([result_of(builtin, kind, number, ~number, *field) for number, field in cases])
        result = "int" if builtin in COUNTS else kind
        vector = f"{'i' if kind == 'int' else 'u'}vec2(x)"
        for call in (f"{builtin}(x{rest})", f"{builtin}({vector}{rest.replace('~x', f'~{vector}')}).y"):
            text = f"{result} f({kind} x, int s, int c) {{ return {call}; }}"
            actual = computed(text, (Scalar(kind), INT, INT), Scalar(result), (x, start, count), machine)
            different = np.flatnonzero(actual.astype(np.int64) != expected)
            assert not different.size, (call, cases[different[0]], actual[different[0]], expected[different[0]])
