"""The range pass: sound on random programs, and as precise as techniques need it."""

from __future__ import annotations

from random import Random

import pytest

from pass_cases import key, module_of
from range_programs import Checker as CheckedRun
from range_programs import RangePrograms, Recorder, inputs, recorded
from slow_cases import some_slow
from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import Range
from sssgen.ir.types import Array, Matrix, Struct
from sssgen.ir.walk import all_expressions, statements
from sssgen.passes.ranges import summaries
from sssgen.passes.ranges.range_pass import RangeAnalysis, analyse
from sssgen.support.diagnostics import SssgenError

PROGRAMS, RUNS = 250, 3


# Sound


def programs(first: int, count: int, more: str = "") -> list[tuple[int, ir.Module]]:
    """Random programs with their seeds; `more` is added to each."""
    results = []
    for seed in range(first, first + count):
        try:
            results.append((seed, module_of(RangePrograms(Random(seed), size=3).program() + more)))
        except SssgenError:  # an index that is outside its array
            continue
    return results


def assert_values_lie_in_ranges(name: str, seed: int, module: ir.Module) -> tuple[Recorder, int]:
    """Runs a function; its analysis, and how many values were checked."""
    analysis, random, values = recorded(module, name), Random(seed), 0
    for _ in range(RUNS):
        arguments, uniforms = inputs(random)
        run = CheckedRun(module, analysis, uniforms)
        try:
            run.call(key(module, name), *arguments)
        except AssertionError as wrong:
            raise AssertionError(f"seed {seed}, arguments {arguments}, {uniforms}: {wrong}") from None
        values += run.checked
    return analysis, values


def test_values_of_random_programs_are_in_their_ranges() -> None:
    chosen = programs(0, PROGRAMS)
    values = sum(assert_values_lie_in_ranges("f", seed, module)[1] for seed, module in chosen)
    assert len(chosen) > 0.9 * PROGRAMS and values > 200 * PROGRAMS


def test_a_member_has_the_length_of_a_vector_only_if_it_is_that_vector() -> None:
    """Seed 3243: a member that begins with the same component as a unit vector, N.xxx, was as short as N."""
    (case,) = programs(3243, 1)
    assert_values_lie_in_ranges("f", *case)


CALLER = """
float caller(float a, float b, int n, inout float c, out float d, vec3 N, vec3 P) {
    float total = 0.5;
    d = 0.0;
    for (int i = 0; i < taps; i++) {
        total = f(total, b, i, c, d, N, P) * 0.5;
        if (d > 1.0) { total += f(b, a * total, n, total, d, N * 0.5, P.zyx + c); }
    }
    return total + f(a, total, n, d, c, P, N);
}
"""


@pytest.mark.parametrize(("own", "widenings"), some_slow([(0, 8), (0, 1), (1, 8)], (0, 8)))
def test_values_are_in_their_ranges_where_functions_have_summaries(
    own: int, widenings: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(summaries, "OWN_INTERPRETATIONS", own)
    monkeypatch.setattr(summaries, "SHARED_INTERPRETATIONS", own)
    monkeypatch.setattr(summaries, "WIDENINGS", widenings)
    chosen = programs(300 + 100 * own + 10 * widenings, 40, CALLER)
    most, widened = own + own + widenings + 2, 0
    for seed, module in chosen:
        analysis, _ = assert_values_lie_in_ranges("caller", seed, module)
        assert max(analysis.interpretations.values()) <= most, seed
        widened += any(summary.widenings for summary in analysis.summaries.values())
    assert widened > 0.8 * len(chosen) > 30


@pytest.mark.slow
def test_values_of_many_random_programs_are_in_their_ranges() -> None:
    for seed, module in programs(1000, 4000):
        assert_values_lie_in_ranges("f", seed, module)


def test_random_programs_have_all_that_the_pass_knows() -> None:
    seen: set[object] = set()
    for _, module in programs(0, 60):
        for function in module.functions:
            for stmt in statements(function.body or ()):
                seen.add(type(stmt))
                if isinstance(stmt, ir.For):
                    seen |= {("inner", type(inner)) for inner in statements(stmt.body)}
            for expr in all_expressions(function.body or ()):
                seen |= {type(expr), type(expr.type)}
                if isinstance(expr, ir.Index) and not isinstance(expr.index, ir.Literal):
                    seen.add("dynamic index")
    expected = {ir.For, ir.While, ir.Break, ir.Continue, ir.Return, ir.If, ir.Select, ir.Call, ir.Intrinsic, ir.Index,
              ir.Swizzle, ir.Member, ("inner", ir.For), ("inner", ir.Break), ("inner", ir.Return), Matrix, Array,
              Struct, "dynamic index"}  # fmt: skip
    assert expected <= seen, expected - seen


# Linear


def chain_of_calls(levels: int) -> str:
    """Functions of which each calls the one before twice, with different arguments."""
    functions = ["float f0(float x) { return sqrt(abs(x)) + x * 0.5; }"] + [
        f"float f{level}(float x) {{ float a = f{level - 1}(x * 0.5); float b = f{level - 1}(a + {level}.0);"
        " return x > 0.0 ? a - b : b / (1.0 + a * a); }"
        for level in range(1, levels + 1)
    ]
    return "\n".join(functions)


def interpretations(levels: int) -> int:
    module = module_of(chain_of_calls(levels))
    analysis = RangeAnalysis(module, FLOAT32)
    analysis.root(key(module, f"f{levels}"))
    assert set(analysis.interpretations) == set(analysis.functions)
    assert any(summary.widenings for summary in analysis.summaries.values())
    return sum(analysis.interpretations.values())


def test_the_number_of_interpretations_is_linear_in_the_levels_of_calls() -> None:
    each = summaries.OWN_INTERPRETATIONS + summaries.WIDENINGS + 2
    for levels in (15, 30, 60):
        assert interpretations(levels) <= summaries.SHARED_INTERPRETATIONS + each * (levels + 1)


# What was unsound once, small


def range_of(body: str, params: str = "float x, float y", head: str = "") -> Range:
    """The range of what `f` returns."""
    module = module_of(f"{head}\nfloat f({params}) {{ {body} }}")
    analysis = recorded(module, "f")
    function = module.functions[-1]
    returns = [stmt.value for stmt in statements(function.body or ()) if isinstance(stmt, ir.Return)]
    results = [analysis.found[id(value)][0] for value in returns if id(value) in analysis.found]
    whole = results[0]
    for one in results[1:]:
        whole = whole.joined(one)
    return whole


def has(result: Range, *numbers: float) -> None:
    for number in numbers:
        assert result.low <= number <= result.high and abs(number) >= result.gap, (number, result)


NESTED = """
float total = 0.0;
for (int i = 0; i <= 9; i++) { for (int j = 0; j <= 9; j++) { total += 1.0; } }
return total;
"""
TWICE = "bool up(inout int k) { k += 1; return k > 1; } float deep(float x, out float y) { y = x; return x; }\n"


@pytest.mark.parametrize(
    ("body", "params", "head", "numbers"),
    [
        (NESTED, "float x", "", [100.0]),
        ("vec3 v = vec3(0.0); for (int i = 0; i < 20; i++) { v += 1.0; } return v.z;", "float x", "", [20.0]),
        ("int k = 0; for (int i = 0; i < 20; i++) { k += 1073741824; } return float(k);", "float x", "", [-(2.0**31)]),
        ("float t = 0.0; for (int i = 0; i < 10 && i > -1; i++) { t += 1.0; } return t;", "float x", "", [10.0]),
        ("int k = 0; for (int i = 0; i < 20 && !up(k); i++) { } return float(k);", "int n", TWICE, [2.0]),
        ("int k = 0; bool b = n > 3 && up(k); return float(k);", "int n", TWICE, [0.0, 1.0]),
        ("int k = 0; bool b = n > 3 ? up(k) : true; return float(k);", "int n", TWICE, [0.0, 1.0]),
        ("mat2 m = mat2(0.0); m[n].x = 5.0; return m[1].x;", "int n", "", [0.0, 5.0]),
        ("mat2 m = mat2(0.0); m[n][0] = 5.0; return m[1][0];", "int n", "", [0.0, 5.0]),
        ("return dot(N.xxx, N.xxx);", "vec3 N", "", [3.0]),
        ("return s.a;", "S s", "struct S { float a; vec2 b; };", [1e6, -1e6]),
        ("return s[1];", "float s[2]", "", [1e6, -1e6]),
        ("return table[1];", "float x", "uniform float table[2] = float[2](1.0, 2.0);", [2.0, 1e6]),
        ("if (x + 1.0e6 <= y + 1.0e6) { return x - y; } return 0.0;", "float x, float y", "", [0.01]),
        ("if (x * x < -1.0) { return x; } return 1.0;", "float x", "", [1.0]),
        ("return length(vec2(1.0e-25 + abs(x) * 1.0e-30));", "float x", "", [0.0]),
        ("return pow(abs(x), 0.25);", "float x", "", [0.0, 31.0]),
        ("return x / -1.5;", "float x", "", [1e6 / 1.5]),
        ("return mod(x, 0.1);", "float x", "", [-1e-9, 0.1]),
        ("return dot(vec3(1.0e6, 1.0, 0.0), vec3(x, 1.0, -1.0e6 * x));", "float x", "", [0.0]),
    ],
)  # fmt: skip
def test_values_that_must_be_in_the_range(body: str, params: str, head: str, numbers: list[float]) -> None:
    has(range_of(body, params, head), *numbers)


def test_a_clamped_quantity_does_not_bound_its_argument() -> None:
    """deep(x) >= 0 always holds; x may still be negative."""
    text = "thickness deep(float x) { return thickness(x); }\nfloat f(float x) { %s return 0.0; }"
    sites = analyse(module_of(text % "if (float(deep(x)) >= 0.0) { return sqrt(x); }"), ["f(float)"]).sites
    assert not next(site for site in sites if site.operation == "sqrt").proven


def test_a_call_that_moves_the_index_of_its_own_out_argument() -> None:
    head = "float both(out float y, inout int k) { y = 5.0; k = 1; return 0.0; }"
    body = "vec2 v = vec2(0.0); int k = 0; both(v[k], k); return v.x;"
    has(range_of(body, "float x", head), 5.0)


def test_a_long_sum_is_fast() -> None:
    """x + x of x + x of …: as many terms as there are doublings, not two to that power."""
    body = "x += x;" * 60 + "for (int i = 0; i < 3; i++) { y += x; y -= x; }" + "if (x < y) { return 1.0; } return 0.0;"
    has(range_of(body), 0.0, 1.0)
    chain = "float t = x;" + "t += y; " * 1500 + "if (t < x) { return 1.0; } return 0.0;"
    has(range_of(chain), 0.0, 1.0)


# Precise


def verdicts(body: str, params: str = "float x, float y", head: str = "") -> dict[str, bool]:
    """Of each operation with a domain whether it is proven safe everywhere."""
    module = module_of(f"{head}\nfloat f({params}) {{ {body} }}")
    results: dict[str, bool] = {}
    for site in analyse(module, [module.functions[-1].key]).sites:
        results[site.operation] = results.get(site.operation, True) and site.proven
    return results


STEPS = "uniform int n : hint_range(1, 64) = 8;"
SIZE = "uniform float size : hint_range(0.5, 2.0) = 1.0; uniform float none : hint_range(0.0, 1.0) = 0.5;"


@pytest.mark.parametrize(
    ("what", "body", "params", "head"),
    [
        ("sqrt", "return sqrt(x * x);", "float x", ""),
        ("sqrt", "return sqrt(dot(v, v));", "vec3 v", ""),
        ("sqrt", "float a = dot(v, v); return sqrt(a + 1.0);", "vec3 v", ""),
        ("sqrt", "return sqrt(1.001 - dot(normalize(v), normalize(v)));", "vec3 v", ""),
        ("/", "if (abs(x) < 0.001) { return 0.0; } return y / x;", "float x, float y", ""),
        ("/", "return y / max(x, 0.001);", "float x, float y", ""),
        ("/", "return abs(x) > 0.5 ? y / x : 0.0;", "float x, float y", ""),
        ("/", "if (x > 0.5 && y > 0.5) { return 1.0 / (x * y); } return 0.0;", "float x, float y", ""),
        ("/", "if (!(x < 0.5)) { return 1.0 / x; } return 0.0;", "float x, float y", ""),
        ("/", "float t = 0.0; for (int i = 0; i < max(n, 1); i++) { t += 1.0; } return x / t;", "float x", STEPS),
        ("/", "float t = 0.5; for (int i = 0; i < n; i++) { t += abs(x); } return 1.0 / t;", "float x", STEPS),
        ("acos", "float t = 0.0; for (int i = 0; i < 10; i++) { t += 0.05; } return acos(t);", "float x", ""),
        ("sqrt",
         "float t = 0.0; for (int i = 0; i < n; i++) { t = (float(i) + 0.5) / float(n); } return sqrt(1.0 - t);",
         "float x", STEPS),
        ("/", "for (int i = 0; i < n; i++) { x += 1.0 / float(n); } return x;", "float x", STEPS),
        ("asin", "float a = abs(x); float b = abs(y) + 1.0; assume(a <= b); return asin(a / b * 0.999);",
         "float x, float y", ""),
        ("sqrt", "return x > 0.0 ? sqrt(x) : 0.0;", "float x", ""),
        ("clamp", "float a = min(x, 0.0); float b = max(y, 1.0); return clamp(x, a, b);", "float x, float y", ""),
        ("clamp", "if (x <= y) { return clamp(0.5, x, y); } return 0.0;", "float x, float y", ""),
        ("asin", "return asin(clamp(x, -1.0, 1.0));", "float x", ""),
        ("acos", "return acos(fract(x));", "float x", ""),
        ("/", "return x / size;", "float x", SIZE),
        ("log", "return log(size);", "float x", SIZE),
        ("/", "return 1.0 / sqrt(size * size + x * x);", "float x", SIZE),
        ("/", "float t = 2.0; if (x > 0.0) { t = 3.0; } else if (y > 0.0) { t = 4.0; } return 1.0 / t;",
         "float x, float y", ""),
        ("sqrt", "float t = 0.0; for (int i = 0; i < n; i++) { t += 0.1; if (x > t) { break; } } return sqrt(t);",
         "float x", STEPS),
        ("exp", "return exp(-abs(x));", "float x", ""),
        ("pow", "return pow(1.0 - 0.5 * none, 5.0);", "float x", SIZE),
        ("index", "vec3 v = vec3(x); return v[clamp(int(y * 2.0), 0, 2)];", "float x, float y", ""),
        ("int", "return float(int(x * 100.0));", "float x", ""),
        ("smoothstep", "return smoothstep(0.25 * none, none * 0.25 + 0.75, y);", "float x, float y", SIZE),
        ("/", "return half_of(abs(x) + 1.0);", "float x", "float half_of(float v) { return inner(v); }"),
        ("atan", "return atan(x, abs(y) + 1.0);", "float x, float y", ""),
        ("normalize", "return normalize(vec3(x, y, 1.0)).x;", "float x, float y", ""),
    ],
)  # fmt: skip
def test_proven(what: str, body: str, params: str, head: str) -> None:
    inner = "float inner(float v) { return 1.0 / v; }\n" if "inner(" in head else ""
    verdict_of = verdicts(body, params, inner + head)
    assert verdict_of[what], verdict_of


@pytest.mark.parametrize(
    ("what", "body", "params", "head"),
    [
        ("/", "return x / (x - y);", "float x, float y", ""),
        ("/", "return 1.0 / x;", "float x", ""),
        ("/", "if (x > 0.0) { return 1.0 / x; } return 0.0;", "float x", ""),  # x may be flushed to 0
        ("/", "return 1.0 / none;", "float x", SIZE),
        ("/", "return 1.0 / (size - 0.5);", "float x", SIZE),
        ("sqrt", "return sqrt(x);", "float x", ""),
        ("sqrt", "return sqrt(1.0 - x * x);", "float x", ""),
        ("sqrt", "return sqrt(1.0 - dot(N, N));", "vec3 N", ""),  # interpolated normals may be longer
        ("sqrt", "return sqrt(dot(N, vec3(0.0, 1.0, 0.0)));", "vec3 N", ""),
        ("normalize", "return normalize(a - b).x;", "vec3 a, vec3 b", ""),
        ("normalize", "return normalize(N).x;", "vec3 N", ""),
        ("pow", "return pow(none, none);", "float x", SIZE),
        ("log", "return log(none);", "float x", SIZE),
        ("inversesqrt", "return inversesqrt(dot(v, v));", "vec3 v", ""),
        ("inversesqrt", "return inversesqrt(1.0e-40);", "float x", ""),  # subnormal: flushed to 0
        ("asin", "return asin(dot(normalize(a), normalize(b)));", "vec3 a, vec3 b", ""),  # 1 and a little
        ("acos", "return acos(x);", "float x", ""),
        ("exp", "return exp(x);", "float x", ""),
        ("clamp", "return clamp(x, y, 1.0);", "float x, float y", ""),
        ("smoothstep", "return smoothstep(none, size, x);", "float x", SIZE),
        ("index", "vec3 v = vec3(x); return v[i];", "float x, int i", ""),
        ("int", "return float(int(x * 1.0e6));", "float x", ""),
        ("/", "int k = 0; for (int i = 0; i < 4; i++) { if (x > 0.5) { k++; } } return 1.0 / float(k);", "float x", ""),
        ("atan", "return atan(x, y);", "float x, float y", ""),
        ("mod", "return mod(x, y);", "float x, float y", ""),
        ("sqrt", "float t = 1.0; for (int i = 0; i < n; i++) { t -= 0.1; } return sqrt(t);", "float x", STEPS),
        ("/", "if (x != 0.0) { return 1.0 / x; } return 0.0;", "float x", ""),
    ],
)  # fmt: skip
def test_not_proven(what: str, body: str, params: str, head: str) -> None:
    verdict_of = verdicts(body, params, head)
    assert verdict_of[what] is False, verdict_of


@pytest.mark.parametrize(
    ("body", "params"),
    [
        # the least int is its own negative
        ("if (abs(i) < 4) { return 1.0 / (float(i) + 2147483648.0); } return 0.0;", "int i"),
        ("if (i < 4 && -i < 4) { return 1.0 / (float(i) + 2147483648.0); } return 0.0;", "int i"),
        ("uint u = k & 3u; if (-float(u) < -0.5) { uint w = -u; return 1.0 / float(4294967295u - w); } return 0.0;",
         "uint k"),
        # a square that is too small for its format
        ("if (x * x <= 0.0) { return 1.0 / (1.0e-19 - abs(x)); } return 0.0;", "float x"),
        # a product that is fused with the difference
        ("if (x * x >= y) { return sqrt(x * x - y); } return 0.0;", "float x, float y"),
        ("return sqrt(x * y - x * y);", "float x, float y"),
    ],
)  # fmt: skip
def test_these_sites_are_not_proven(body: str, params: str) -> None:
    verdict_of = verdicts(body, params, "")
    assert not verdict_of.get("/", verdict_of.get("sqrt")), verdict_of


def test_ranges_of_results() -> None:
    assert range_of("return x * x;", "float x").low == 0.0
    unit = range_of("return length(normalize(vec3(x, y, 1.0)));")
    assert 0.99999 < unit.low <= 1.0 <= unit.high < 1.00001
    total = range_of("float t = 0.0; for (int i = 0; i < n; i++) { t += abs(sin(x)); } return t;", "float x", STEPS)
    assert total.low == 0.0 and 64.0 <= total.high < 67.0
    after = range_of("int i = 0; for (int j = 0; j < n; j++) { i = j; } return float(i);", "float x", STEPS)
    assert after.low == 0.0 and 63.0 <= after.high <= 64.0
    part = range_of("float a = abs(x); float b = abs(y) + 1.0; assume(a <= b); return a / b;")
    assert part.low == 0.0 and 1.0 <= part.high < 1.000001


def test_loop_counters_are_below_the_count() -> None:
    body = "float t = 0.5; for (int i = 0; i < n; i++) { t = (float(i) + 0.5) / float(n); } return t;"
    result = range_of(body, "float x", STEPS)
    assert result.low > 0.0 and result.high < 1.0


def test_only_entry_points_have_unknown_arguments() -> None:
    text = "float inner(float v) { return sqrt(v); }\nfloat f(float x) { return inner(x * x); }"
    module = module_of(text)
    assert all(site.proven for site in analyse(module, ["f(float)"]).sites if site.operation == "sqrt")
    assert not all(
        site.proven for site in analyse(module, ["f(float)", "inner(float)"]).sites if site.operation == "sqrt"
    )


def test_a_count_that_may_be_negative_keeps_its_sign() -> None:
    """One guard serves all calls of a function."""
    text = "float part(int k) { return 8.0 / float(k); }\nfloat f(int n) { return part(max(n, 0)) + part(-4); }"
    (site,) = [site for site in analyse(module_of(text), ["f(int)"]).sites if site.operation == "/"]
    assert not site.proven and site.guard.text != "max(y, 1.0)"
