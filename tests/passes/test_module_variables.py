"""Module variables: every pass keeps the order in which they are read and written."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir_interpreter import Interpreter
from sssgen.ir.nodes import Module
from sssgen.ir.text import print_module, read_module
from sssgen.ir.verify import check_module, verify
from sssgen.lang.polyfills import polyfill
from sssgen.passes.conversions import drop_conversions
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.legal.legalise import legalise
from sssgen.passes.prune import prune
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.pipeline.programs import plain_module
from sssgen.targets import numpy_runtime as rt
from sssgen.targets import registry
from whole_shaders import FRAGMENT, FUNCTIONS, OLD, SEVERAL, VERTEX


class Programs:
    """The text of a module with `f(float a, float b)`, whose expressions read and write variables in any order.

    All arithmetic is exact in float64, or nearly so and done in one order everywhere.
    """

    def __init__(self, random: Random) -> None:
        self.random = random
        self.made = 0

    def module(self) -> str:
        body = "    var float c = a;\n    var float[2] list = float[2]{a, b};\n" + self.block(4, 2)
        return f"{FUNCTIONS}function float f(in float a, in float b) {{\n{body}    return {self.number(2)};\n}}\n"

    def block(self, count: int, depth: int) -> str:
        return "".join([self.statement(depth) for _ in range(count)])

    def statement(self, depth: int) -> str:
        kind = self.random.randrange(9 if depth else 6)
        if kind == 0:
            return f"    set {self.place()} {self.random.choice(['', '+', '-'])}= {self.number(2)};\n"
        if kind == 1:
            return f"    set {self.place()} = {self.call()};\n"
        if kind == 2:
            return f"    call {self.call()};\n"
        if kind in (3, 4):
            self.made += 1
            return f"    var float t{self.made} = {self.number(2)};\n    set c -= (t{self.made} * 0.25);\n"
        if kind == 5:
            return f"    set list[$turn()] = {self.number(2)};\n"
        if kind in (6, 7):
            otherwise = f" else {{\n{self.block(1, depth - 1)}    }}" if self.random.randrange(2) else ""
            return f"    if {self.condition(2)} then {{\n{self.block(2, depth - 1)}    }}{otherwise}\n"
        self.made += 1
        name = f"i{self.made}"
        inner = self.block(2, depth - 1)
        leave = f"    if {self.condition(1)} then {{\n    break;\n    }}\n" if self.random.randrange(2) else ""
        return f"    for (var int {name} = 0; ({name} < 3); set {name} += 1;) {{\n{inner}{leave}    }}\n"

    def place(self) -> str:
        return self.random.choice(["c", "$g", "$h.x", "$h.y", "list[0]", "list[($k % 2)]"])

    def call(self) -> str:
        kind = self.random.randrange(5)
        if kind == 0:
            return "$next()"
        if kind in (1, 2):
            return f"$both({self.place()})"
        return f"${'peek' if kind == 3 else 'outer'}({self.number(1)})"

    def condition(self, depth: int) -> str:
        if depth and self.random.randrange(3) == 0:
            return f"({self.condition(depth - 1)} {self.random.choice(['&&', '||'])} {self.condition(depth - 1)})"
        return f"({self.number(depth)} {self.random.choice('<>')} {self.number(0)})"

    def number(self, depth: int) -> str:
        kind = self.random.randrange(9 if depth else 3)
        if kind == 0:
            return self.random.choice(["0.0", "1.0", "0.5", "-2.0", "3.0"])
        if kind in (1, 2):
            return self.random.choice(["a", "b", "c", "$g", "$h.x", "$h.y", "list[1]", "list[($k % 2)]"])
        if kind in (3, 4):
            return self.call()
        if kind == 5:
            return f"({self.condition(1)} ? {self.number(depth - 1)} : {self.number(depth - 1)})"
        if kind == 6:
            return f"min({self.number(depth - 1)}, {self.number(depth - 1)})"
        return f"({self.number(depth - 1)} {self.random.choice('+-')} {self.number(depth - 1)})"


KEY = "f(float,float)"
VARIABLES: dict[str, Any] = {"g": 1.0, "h": (2.0, 3.0), "k": 0}
"""What the variables begin with."""


def outcome(module: Module, a: float, b: float) -> tuple[Any, ...]:
    """The result of f, and the variables after it."""
    interpreter = Interpreter(module)
    return (*interpreter.call(KEY, a, b), *[interpreter.globals.get(*one) for one in VARIABLES.items()])


def legal(target: str) -> Callable[[Module], Module]:
    chosen = registry.load(target)
    return lambda module: legalise(module, chosen.dialect, chosen.capabilities, polyfill)


PASSES: dict[str, Callable[[Module], Module]] = {
    "fold": fold,
    "prune": lambda module: prune(module, [KEY]),
    "fold and prune": lambda module: prune(fold(module), [KEY]),
    "hoist": lambda module: hoist(module, [KEY])[0],
    "conversions": drop_conversions,
    "wgsl": legal("wgsl"),
    "hlsl": legal("hlsl"),
    "glsl": legal("glsl-es-300"),
}


@pytest.mark.parametrize("name", PASSES)
@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.sampled_from([-2.0, 0.0, 0.75, 4.0]), st.sampled_from([-1.0, 2.5]))
def test_a_pass_keeps_the_order_of_reads_and_writes(name: str, random: Random, a: float, b: float) -> None:
    module = read_module(Programs(random).module())
    check_module(module)
    result = PASSES[name](module)
    check_module(result)
    assert outcome(result, a, b) == outcome(module, a, b), print_module(result)


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.booleans())
def test_numpy_results_are_equal_without_module_variables(random: Random, keep: bool) -> None:
    module = read_module(Programs(random).module())
    text = transpile(module, "numpy", "x", keep=keep).files["x_functions.py"]
    functions: dict[str, Any] = {}
    exec(compile(text, "numpy", "exec"), functions)
    a, b = np.array([-2.0, 0.0, 0.75, 4.0]), np.array([-1.0, 2.5, 0.0, 2.5])
    functions_of_numpy = variables_to_parameters(module if keep else plain_module(module)[0]).functions
    added = [param for function in functions_of_numpy if function.name == "f" for param in function.params[2:]]
    lanes = {"g": np.ones(4), "h": np.array([[2.0], [3.0]]) * np.ones(4), "k": np.zeros(4, np.int32)}
    with rt.precision(np.float64):
        result = functions["f"](a, b, *[lanes[param.name] for param in added])
    written = [param.name for param in added if param.direction == "inout"]
    values = result if written else (result,)
    for lane in range(4):
        expected = dict(zip(("f", *VARIABLES), outcome(module, float(a[lane]), float(b[lane])), strict=True))
        for name, value in zip(("f", *written), values, strict=True):
            results = np.broadcast_to(value, (*np.shape(VARIABLES.get(name, 0.0)), 4))[..., lane]
            np.testing.assert_array_equal(results, expected[name])


def test_the_verifier_knows_variables() -> None:
    assert verify(read_module(FRAGMENT)) == []
    assert "cannot be assigned" in verify(read_module(FRAGMENT.replace("set $glow", "set $gl_FragCoord")))[0]
    assert "has a value" in verify(read_module("variable in float x = 1.0\n"))[0]
    assert "not a storage" in verify(read_module("variable inout float x\n"))[0]
    for text in (FRAGMENT, VERTEX, OLD, SEVERAL):
        assert print_module(read_module(text)) == text
