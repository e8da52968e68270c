"""The interpreter of `--verify`: values, undefined lanes, outcomes of comparisons, rounding errors, loops."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from sssgen.analyse.verify.branch_outcomes import Outcomes, branches
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.loop_inputs import loop_inputs
from sssgen.analyse.verify.rounded_floats import round_floats, seed_errors
from sssgen.analyse.verify.rounding_noise import GrantedRun, RoundedRun, noise
from sssgen.analyse.verify.verification import load

LOW, HIGH = -(2**31), 2**31 - 1


def run(text: str, kind: type[Run] = Run, **arguments: Any) -> tuple[list[Any], Run]:
    """The results of the last function, and the run; lists are int32 or float64."""
    program = Program(load(text, "shader.glsl"))
    function = program.module.functions[-1]
    kinds = {"float": np.float64, "int": np.int32, "uint": np.uint32}
    values: Mapping[str, Any] = {
        param.name: np.array(arguments[param.name], kinds[param.type.kind]) for param in function.params
    }
    lanes = max(len(value) for value in values.values())
    one = kind(program, lanes, {}, Outcomes(lanes))
    return one.result(function.key, values).tolist(), one


UNDEFINED = [
    ("int f(int a, int b) { return a << b; }", [1, 1, 1, 1], [0, 31, 32, -1], [False, False, True, True]),
    ("int f(int a, int b) { return a / b; }", [7, 7, LOW, LOW], [2, 0, -1, 1], [False, True, True, False]),
    ("int f(int a, int b) { return a % b; }", [7, 7, -7, 7], [2, 0, 2, -2], [False, True, True, True]),
    ("int f(int a, int b) { return clamp(7, a, b); }", [1, 2, 3, 4], [1, 1, 9, 3], [False, True, False, True]),
    (
        "int f(int a, int b) { int v[3] = int[3](5, 6, 7); return v[a] + b; }",
        [0, 2, 3, -1],
        [0] * 4,
        [False, False, True, True],
    ),
    ("int f(int a, int b) { return bitfieldExtract(a, b, 8); }", [1] * 4, [0, 24, 25, -1], [False, False, True, True]),
    ("int f(int a, int b) { return a == b ? a / b : 0; }", [0, 0, 1, 1], [0, 1, 1, 0], [True, False, False, False]),
    ("int f(int a, int b) { return b != 0 && a / b > 1 ? 1 : 0; }", [4, 4, 1, 0], [0, 1, 1, 0], [False] * 4),
]


@pytest.mark.parametrize(("text", "a", "b", "undefined"), UNDEFINED)
def test_undefined_integers(text: str, a: list[int], b: list[int], undefined: list[bool]) -> None:
    assert run(text, a=a, b=b)[1].undefined.tolist() == undefined


FLOATS = [
    ("int f(float x) { return int(x); }", [2147483520.0, 2147483648.0, -2147483648.0, -2147483904.0], [0, 1, 0, 1]),
    ("uint f(float x) { return uint(x); }", [0.0, -0.5, 4294967040.0, 4294967296.0], [0, 1, 0, 1]),
    ("float f(float x) { return pow(x, 2.0); }", [1.0, -1.0, 0.0, 1e30], [0, 1, 0, 1]),
    ("float f(float x) { return 1.0 / x; }", [1.0, 0.0, 1e-30, 1e30], [0, 1, 0, 0]),
    ("float f(float x) { return sqrt(x) > 0.0 ? 1.0 : 0.0; }", [1.0, -1.0, 0.0, 4.0], [0, 1, 0, 0]),
    ("float f(float x) { return x * 1e30; }", [1.0, 1e9, -1e9, 1e8], [0, 1, 1, 0]),
    ("float f(float x) { return smoothstep(x, 1.0, 0.5); }", [0.0, 1.0, 2.0, 0.5], [0, 1, 1, 0]),
    ("float f(float x) { return atan(x, x); }", [0.0, 1.0, -1.0, 2.0], [1, 0, 0, 0]),
]


@pytest.mark.parametrize(("text", "x", "undefined"), FLOATS)
def test_undefined_floats(text: str, x: list[float], undefined: list[int]) -> None:
    assert run(text, x=x)[1].undefined.astype(int).tolist() == undefined


def test_control_flow_of_each_lane() -> None:
    text = """int f(int n) {
    int s = 0;
    for (int i = 0; i < 10; i++) {
        if (i == n) continue;
        if (i > n + 2) break;
        s += i;
        { int s = 100; s++; }
    }
    while (s > 20) { s -= 7; if (s == 15) return -1; }
    return s;
}"""

    def expected(n: int) -> int:
        s = sum(i for i in range(min(10, max(n + 3, 0))) if i != n)
        while s > 20:
            s -= 7
            if s == 15:
                return -1
        return s

    lanes = list(range(-3, 14))
    assert run(text, n=lanes)[0] == [expected(n) for n in lanes]


def test_out_parameters_and_structs() -> None:
    text = """struct S { int a; int b[2]; };
void g(inout S s, out int k) { s.b[1] += s.a; k = s.b[1] * 2; s.a = 0; }
int f(int n) { S s = S(n, int[2](1, 2)); int k; g(s, k); return k * 100 + s.b[1] * 10 + s.a; }"""
    assert run(text, n=[3, 4])[0] == [1050, 1260]


def test_endless_lanes_stop() -> None:
    one = run("int f(int n) { while (n != 0) { n = n * 2 + n % 1; if (n == 1) n = 1; } return n; }", n=[0, 1, 3])[1]
    assert one.endless.tolist() == [False, False, False]
    one = run("int f(int n) { while (n != 0) { n = n & 7; } return n; }", n=[0, 1, 8])[1]
    assert one.endless.tolist() == [False, True, False]


def test_exact_results_have_no_error_and_others_do() -> None:
    with seed_errors(0):
        x = round_floats(np.full(1000, 3.0))
        assert set(np.asarray(x * x + 7.0 - 2.0).tolist()) == {14.0}
        assert set(np.asarray(x / 2.0).tolist()) == {1.5}
        assert len(set(np.asarray(x / 3.0).tolist())) > 1
        third = np.asarray(x * 0.1)
    assert len(set(third.tolist())) > 1 and np.abs(third - 0.3).max() < 1e-7


def test_granted_errors_are_larger() -> None:
    text = "float f(float x) { return sin(x); }"
    with seed_errors(1):
        small, large = (np.ptp(run(text, kind, x=[1.0] * 500)[0]) for kind in (RoundedRun, GrantedRun))
    assert 0.0 < small < 1e-6 < 2e-4 < large < 2.0**-10


def test_outcomes_of_branches_and_comparisons() -> None:
    program = Program(load("int f(int n) {\n if (n > 5)\n n = 7;\n return n < 0 ? 1 : clamp(n, 2, 6);\n}", "s.glsl"))
    outcomes = Outcomes(3)
    Run(program, 3, {}, outcomes).result("f(int)", {"n": np.array([6, 5, 1], np.int32)})
    own = branches(program.module, "f(int)")
    assert [(one.line, one.outcome) for one in own] == [(2, "if"), (2, "else"), (4, "? yes"), (4, ": no")]
    assert [outcomes.branches[one.key].tolist() for one in own] == [
        [True, False, False], [False, True, True], [False] * 3, [True] * 3,
    ]  # fmt: skip
    cases = sorted(case for (_, case), lanes in outcomes.cases.items() if lanes[0])
    assert cases == [1, 1, 2, 2]


def test_inputs_that_bound_loops() -> None:
    text = """uniform int count;
int deep(int m) { int s = 0; while (s < m) s++; return s; }
int f(int a, int b, float c, float d, int e) {
    int s = 0, last = a + 1;
    for (int i = 0; i < last; i++) s += b;
    for (float t = 0.0; t < 1.0; t += c) s++;
    for (int i = 0; i < 8; i++) if (d > 2.0) s++;
    return s + deep(count) + e;
}"""
    assert loop_inputs(load(text, "s.glsl"), "f(int,int,float,float,int)") == {"a", "c", "count"}


def test_a_choice_without_lanes_has_a_value() -> None:
    """Its condition loops without end in every lane, and what follows still computes with the choice."""
    text = """float lost(float x) { while (true) { x += 1.0; } return x; }
    float f(float x) { return cosh(lost(x) > 0.0 ? x : 1.0); }"""
    assert run(text, x=[1.0, 2.0])[1].endless.all()


def movement(text: str, at_edges: bool, **arguments: list[float]) -> list[float]:
    """How far rounding moves the results of the last function."""
    program = Program(load(text, "shader.glsl"))
    values = {name: np.array(numbers, np.float64) for name, numbers in arguments.items()}
    lanes = np.arange(len(next(iter(values.values()))))
    (moved,) = noise(program, [program.module.functions[-1].key], values, {}, lanes, 64, True, at_edges=at_edges)
    return moved.tolist()


@pytest.mark.parametrize("condition", ["x * 1.3 < y", "step(x * 1.3, y) > 0.5", "lessThan(vec2(x * 1.3), vec2(y)).x"])
def test_a_comparison_near_its_edge_has_both_outcomes(condition: str) -> None:
    """No error of the product reaches the third unit in the last place; four times the largest does."""
    text = f"float f(float x, float y) {{ return {condition} ? 5.0 : 2.0; }}"
    unit = 2.0**-23
    product = float(np.float32(1.1)) * float(np.float32(1.3))
    numbers = {"x": [float(np.float32(1.1))] * 3, "y": [product + step * unit for step in (3, 40, -40)]}
    assert movement(text, False, **numbers) == [0.0, 0.0, 0.0]
    assert movement(text, True, **numbers) == [1.5, 0.0, 0.0]


def test_equal_operands_without_rounding_are_no_edge() -> None:
    assert movement("float f(float x, float y) { return x < y ? 1.0 : 2.0; }", True, x=[1.0], y=[1.0]) == [0.0]


def test_total_reflection_is_0_in_every_driver() -> None:
    """Also where the errors of its terms are large; near its edge the ray may be either."""
    text = "vec3 f(float x) { return refract(vec3(0.0, sqrt(1.0 - x * x), -x), vec3(0.0, 0.0, 1.0), 1000.0); }"
    far, edge = 0.5, float(np.sqrt(1.0 - 1e-6))
    assert movement(text, True, x=[far]) == [0.0]
    assert movement(text, True, x=[edge])[0] > 0.5
