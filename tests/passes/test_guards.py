"""The guard pass: the guards that it adds, and the operations that need none."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import sssgen
from pass_cases import module_of, text
from sssgen.ir.nodes import Assume, Module
from sssgen.ir.verify import verify
from sssgen.ir.walk import all_expressions, statements
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.lang.polyfills import guard as guard_source
from sssgen.lang.polyfills import polyfill
from sssgen.material import library
from sssgen.passes.guards import GuardedModule, guard
from sssgen.pipeline.compiler import GUARDS, transpile
from sssgen.run.backends import Backend, Call, Text
from sssgen.run.compilers import Source, errors
from sssgen.run.evaluate.probes import subject

NAMES = sorted(library.index())


def guarded(source: str, mode: str = "auto") -> GuardedModule:
    """The module of a source; its last function is the entry point."""
    module = module_of(source)
    result = guard(module, [module.functions[-1].key], mode, guard_source, polyfill)
    assert verify(result.module) == []
    return result


def lines(source: str, mode: str = "auto", target: str = "glsl-330") -> list[str]:
    """The emitted lines from the first function on."""
    module = module_of(source)
    compiled = transpile(module, target, "case", guards=mode, called=[module.functions[-1].key])
    shown = next(iter(compiled.files.values())).splitlines()
    return [line.strip() for line in shown if line.strip() and not line.startswith("//")]


def body(source: str, mode: str = "auto") -> str:
    """The only line of the last function."""
    return lines(source, mode)[-2]


# What is written


@pytest.mark.parametrize(
    ("source", "auto", "everywhere"),
    [
        ("float f(float x) { return sqrt(x); }", "return sqrt(max(x, 0.0));", "return sqrt(max(x, 0.0));"),
        ("float f(float x) { return sqrt(x * x); }", "return sqrt(x * x);", "return sqrt(max(x * x, 0.0));"),
        ("float f(float x) { return 1.0 / abs(x); }", "return 1.0 / max(abs(x), 1.0e-20);", None),
        ("float f(float x) { return 1.0 / -abs(x); }", "return 1.0 / min(-abs(x), -1.0e-20);", None),
        ("float f(float x) { return 1.0 / (2.0 + abs(x)); }", "return 1.0 / (2.0 + abs(x));", None),
        ("float f(float x, float p) { return pow(clamp(x, 0.0, 1.0), abs(p)); }",
         "return pow(clamp(x, 1.0e-37, 1.0), abs(p));", None),
        ("float f(float x) { return 1.0 / max(x, 0.0); }", "return 1.0 / max(x, 1.0e-20);", None),
        ("float f(float x) { return log(x); }", "return log(max(x, 1.0e-37));", "return log(max(x, 1.0e-37));"),
        ("float f(float x) { return asin(x); }", "return asin(clamp(x, -1.0, 1.0));", None),
        ("float f(float x) { return exp(x); }", "return exp(min(x, 86.94));", None),
        ("float f(float x) { return sqrt(1.0 + sqrt(x)); }", "return sqrt(1.0 + sqrt(max(x, 0.0)));", None),
        ("float f(float x, int n) { return x / float(max(n, 0)); }", "return x / max(float(max(n, 0)), 1.0);", None),
        ("float f(vec3 v, int n) { return v[clamp(n, 0, 2)]; }", "return v[clamp(n, 0, 2)];", None),
        ("vec2 f(vec2 v) { return sqrt(v); }", "return sqrt(max(v, 0.0));", None),
    ],
)  # fmt: skip
def test_lines(source: str, auto: str, everywhere: str | None) -> None:
    assert body(source) == auto
    plain = re.search(r"return .*?;", source)
    assert plain is not None and body(source, "none") == plain.group()
    if everywhere is not None:
        assert body(source, "all") == everywhere


def test_mode_none_adds_no_guards_and_removes_assumptions() -> None:
    source = "float f(float x) { assume(x > 0.0); return sqrt(x) / x + normalize(vec2(x, 1.0)).x; }"
    assert body(source, "none") == "return sqrt(x) / x + normalize(vec2(x, 1.0)).x;"
    result = guarded(source, "none")
    assert not result.guarded and len(result.module.functions) == 1


@pytest.mark.parametrize("mode", GUARDS)
def test_assumptions_are_removed(mode: str) -> None:
    module = guarded("float f(float x) { if (x > 0.0) { assume(x > 1.0); } return 1.0 / x; }", mode).module
    assert not [stmt for stmt in statements(module.functions[-1].body or ()) if isinstance(stmt, Assume)]


def test_only_unproven_sites_are_guarded() -> None:
    source = "float f(float x) { return sqrt(x) + sqrt(x * x) + sqrt(abs(x)) + sqrt(exp(min(x, 1.0))); }"
    assert [site.proven for site in guarded(source).sites if site.operation == "sqrt"].count(False) == 1
    assert body(source).count("max(") == 1 and "\n".join(lines(source, "all")).count("max(") == 4


@pytest.mark.parametrize(
    ("argument", "guarded"),
    [
        ("clamp(x, -1.0, 1.0)", "clamp(x, 1.0e-37, 1.0)"),
        ("clamp(x, -2.0, -1.0)", "max(clamp(x, -2.0, -1.0), 1.0e-37)"),
        ("clamp(x, 0.0, y)", "max(min(max(x, 0.0), y), 1.0e-37)"),
        ("max(x, -2.0)", "max(x, 1.0e-37)"),
        ("min(x, 2.0)", "clamp(x, 1.0e-37, 2.0)"),
        ("min(x, -2.0)", "max(min(x, -2.0), 1.0e-37)"),
    ],
)
def test_the_bound_of_a_guard_replaces_a_smaller_one_only_where_it_stays_in_force(argument: str, guarded: str) -> None:
    assert body(f"float f(float x, float y) {{ return log(x + log2({argument})); }}").count(f"log2({guarded})") == 1


BIG = "3.4028234e38"
ONE_SIDED = {
    "float f(vec3 v) { return length(v * v * v * v); }": f"min(length(v * v * v * v), {BIG})",
    "float f(float x) { float y = abs(x) + 1.0; return y * y * y * y * y * y * y; }": f"y * y, {BIG})",
    "float f(float x) { float y = -abs(x) - 1.0; return y * y * y * y * y * y * y; }": f"y * y, -{BIG})",
    "float f(float x) { return x * x * x * x * x * x * x; }": f"clamp(x * x * x * x * x * x * x, -{BIG}, {BIG})",
    "float f(float x) { return asin(abs(x)); }": "asin(min(abs(x), 1.0))",
    "float f(float x) { return acos(min(x, 0.5)); }": "acos(clamp(x, -1.0, 0.5))",
    "float f(float x) { return sinh(abs(x)); }": "sinh(min(abs(x), 75.6))",
    "float f(float x) { return atanh(abs(x)); }": "atanh(min(abs(x), 1.0 - 1.1920929e-7))",
    "int f(float x) { return int(abs(x) * 1.0e6); }": "int(min(abs(x) * 1000000.0, 2.1474835e9))",
    "float f(float a[4], int i) { return a[max(i, 0)]; }": "a[min(max(i, 0), 3)]",
    "float f(float a[4], int i) { return a[min(i, 3)]; }": "a[clamp(i, 0, 3)]",
    "thickness f(float x) { return thickness(x * x); }": "return x * x;",
    "thinness f(float x) { return thinness(abs(x)); }": "return min(abs(x), 1.0);",
    # a vector has one guard for all components, a function one for all calls
    "vec2 f(float x) { float a = abs(x); return vec2(a, -a) * a * a * a * a * a * a; }": f"-{BIG}, {BIG})",
    "float g(float x) { return asin(x); } float f(float x) { return g(abs(x)) + g(min(x, 0.0)); }":
        "asin(clamp(x, -1.0, 1.0))",
    "float g(float x) { return asin(x); } float f(float x) { return g(abs(x)) + g(-0.5); }": "asin(min(x, 1.0))",
    # the range of a builtin's site is that of its argument, not of the result that is guarded
    "vec2 f(uint x) { return unpackHalf2x16(x); }": "clamp(",
}  # fmt: skip


@pytest.mark.parametrize("source", ONE_SIDED)
def test_a_guard_bounds_only_the_sides_that_need_it(source: str) -> None:
    text = "\n".join(lines(source))
    assert ONE_SIDED[source] in text, text
    assert "clamp" in ONE_SIDED[source] or BIG in ONE_SIDED[source] or "clamp(" not in text


@pytest.mark.parametrize(("kind", "shown"), [("int", "clamp(i, 0, 3)"), ("uint", "min(i, 3u)")])
@pytest.mark.parametrize("mode", ["auto", "all"])
def test_indices_stay_among_the_elements(kind: str, shown: str, mode: str) -> None:
    source = f"float f(vec4 v, {kind} i) {{ float a[4] = float[4](v.x, 2.0, 3.0, 4.0); a[i] = v[i]; return a[i]; }}"
    assert "\n".join(lines(source, mode)).count(shown) == 2


def test_variables_of_the_same_name_in_separate_blocks() -> None:
    source = """float f(float x, int n) {
        for (int i = 1; i < 8; i *= 3) { vec3 v = vec3(x); x += v.y; }
        if (x > 1.0) { int v = n; x /= float(v); }
        for (int i = 0; i < n; i++) { mat2 v = mat2(x); x += v[1].y; }
        return sqrt(x);
    }"""
    files = transpile(load_glsl_text(source, "case.glsl").module, "glsl-330", "case", "auto", keep=True).files
    assert "sqrt(max(x, 0.0))" in next(iter(files.values()))


def test_compound_assignments() -> None:
    shown = lines("float f(float x, float y) { x /= y; x *= 2.0; return x; }")
    assert shown[1:3] == ["x = x / (max(abs(y), 1.0e-20) * (2.0 * step(0.0, y) - 1.0));", "x *= 2.0;"]
    assert lines("float f(float x) { x /= 2.0; return x; }")[1] == "x /= 2.0;"


def test_in_headers_conditions_and_nested_calls() -> None:
    source = """
float inner(float v) { return sqrt(v); }
float f(float x, int n) {
    float t = 0.0;
    for (int i = 0; i < 8 && sqrt(x) > 0.5; i++) { t += inner(1.0 - sqrt(x)); }
    if (log(x) > 1.0) { return inner(inner(x)); }
    return t;
}
"""
    shown = "\n".join(lines(source))
    assert "sqrt(max(v, 0.0))" in shown and "&& sqrt(max(x, 0.0)) > 0.5" in shown
    assert "inner(1.0 - sqrt(max(x, 0.0)))" in shown and "if (log(max(x, 1.0e-37)) > 1.0)" in shown


def test_long_guards_become_functions_with_names_of_their_own() -> None:
    source = "vec3 safe_normalize(vec3 v) { return v + 1.0; }\n"
    source += "vec3 f(vec3 a, vec3 b) { return normalize(a - b) + safe_normalize(a); }"
    shown = "\n".join(lines(source))
    assert shown.count("vec3 safe_normalize(vec3") == 1 and shown.count("vec3 safe_normalize_2(vec3") == 1
    assert "return safe_normalize_2(a - b) + safe_normalize(a);" in shown
    once = "vec3 f(vec3 a, vec3 b) { return normalize(a - b) + normalize(b - a * 2.0); }"
    assert "\n".join(lines(once)).count("vec3 safe_normalize(vec3") == 1, "one function for both"
    both = "float f(vec3 a, vec2 b) { return normalize(a + 1.0).x + normalize(b + 1.0).y; }"
    assert len(re.findall(r"vec[23] safe_normalize\(vec[23]", "\n".join(lines(both)))) == 2


def test_quantities_are_clamped_on_the_side_that_needs_it() -> None:
    assert body("thickness f(float x) { return thickness(x * x * x); }") == "return clamp(x * x * x, 0.0, 1.0e12);"
    assert body("thickness f(float x) { return thickness(x); }") == "return max(x, 0.0);"
    assert body("thickness f(float x) { return thickness(abs(x * x * x)); }") == "return min(abs(x * x * x), 1.0e12);"
    assert body("thickness f(float x) { return thickness(abs(x)); }") == "return abs(x);"
    assert body("thinness f(float x) { return thinness(abs(x)); }") == "return min(abs(x), 1.0);"
    assert body("thinness f(float x) { return thinness(min(x, 1.0)); }") == "return clamp(x, 0.0, 1.0);"
    assert body("thinness f(float x) { return thinness(clamp(x, 0.0, 1.0)); }") == "return clamp(x, 0.0, 1.0);"


def test_atan_of_one_argument_has_no_guard() -> None:
    """Only the angle of (0, 0) is undefined."""
    for mode in GUARDS:
        assert body("float f(float x) { return atan(x); }", mode) == "return atan(x);"


def test_every_guard_leads_to_the_source() -> None:
    source = "float f(float x,\n float y) {\n float a = sqrt(x);\n return normalize(vec2(a, y)).x\n / y;\n}"
    result = guarded(source)
    function = result.module.functions[-1]
    spans = {expr.span for expr in all_expressions(function.body or ())}
    assert spans and all(span.file == "test.sss" and span.line >= 1 for span in spans), spans
    compiled = transpile(module_of(source), "glsl-330", "case", guards="auto")
    shown = next(iter(compiled.files.values())).splitlines()
    (places,) = compiled.reflection["source_map"].values()
    at = {
        line.strip(): places[str(number)].rsplit(":", 1)[0]
        for number, line in enumerate(shown, 1)
        if str(number) in places
    }
    assert at["float a = sqrt(max(x, 0.0));"] == "test.sss:3"
    assert next(place for line, place in at.items() if "step(" in line) in ("test.sss:4", "test.sss:5")


def test_guards_of_a_proven_module_change_nothing() -> None:
    source = "float f(float x) { float a = abs(x) + 1.0; return sqrt(a) / a; }"
    assert text(guarded(source).module) == text(module_of(source))


def test_at_drops_and_poisons_single_guards(backend: Callable[[str], Backend]) -> None:
    import numpy as np

    source = "float f(float x, float y) { return sqrt(x) + sqrt(y); }"
    module = module_of(source)
    first = guarded(source).guarded[0].place
    compiled = transpile(
        module, "glsl-330", "case", guards="auto", at=lambda site: "drop" if site.place == first else "keep"
    )
    assert "return sqrt(x) + sqrt(max(y, 0.0));" in next(iter(compiled.files.values()))
    poisoned = transpile(module, "numpy", "case", guards="auto", at=lambda site: "poison")
    shown = next(name for name in poisoned.files if not name.endswith(".json"))
    x = np.array([1.0, -1.0, 4.0], np.float32)
    types = tuple(param.type for param in module.functions[-1].params)
    (result,) = backend("numpy-f32").run(
        Text(poisoned.files[shown]), [Call("f", types, module.functions[-1].result, (x, abs(x)))]
    )
    assert np.isnan(result).tolist() == [False, True, False], "NaN where the guard would have changed anything"


# The library


def library_module(name: str) -> tuple[Module, list[str]]:
    chosen = subject(name)
    return chosen.module, chosen.called


@pytest.mark.parametrize("mode", GUARDS)
def test_every_technique_is_valid_with_guards(mode: str) -> None:
    for name in NAMES:
        module, called = library_module(name)
        result = guard(module, called, mode, guard_source, polyfill)
        assert verify(result.module, linked=True) == [], name
        assert mode != "none" or not result.guarded
        assert mode != "all" or len(result.guarded) == len(result.sites)


@pytest.mark.slow
@pytest.mark.parametrize("target", ["glsl-330", "hlsl", "wgsl"])
def test_the_guarded_library_compiles(target: str, assert_compiles: Callable[[Source], None]) -> None:
    """Each technique as functions, with guards everywhere."""
    from sssgen.run.check.compiler_inputs import sources

    count = 0
    for name in NAMES:
        module, called = library_module(name)
        for source in sources(transpile(module, target, "guarded", "all", called).files):
            assert_compiles(source)
            count += 1
    assert count >= len(NAMES) and errors([]) == []


def test_surface_outputs_are_clamped_where_they_are_computed(tmp_path: Path) -> None:
    """A surface technique may return any roughness; the lighting expects 0 to 1."""
    (tmp_path / "rough.sss").write_text(
        "/**\n * A rough surface.\n * role: surface\n */\n"
        "void rough(uv_position uv, out vec3 albedo, out float roughness)\n"
        "{\n    albedo = vec3(1.0);\n    roughness = 2.0 * uv.x;\n}\n"
    )
    (tmp_path / "shade.sss").write_text(
        "/**\n * Light.\n * role: lighting\n */\n"
        "vec3 shade(world_direction N, world_direction L, vec3 albedo, float roughness, vec3 light_color)\n"
        "{\n    return albedo * sqrt(1.0 - roughness) * max(dot(N, L), 0.0) * light_color;\n}\n"
    )
    path = tmp_path / "nat.toml"
    path.write_text(
        '[material]\nname = "nat"\n\n[surface]\ntechnique = "rough.sss"\n\n[lighting]\ntechnique = "shade.sss"\n'
    )
    text = sssgen.compile(path, "glsl-330").files["nat.glsl-330.frag"]
    assert "roughness = clamp(2.0 * uv.x, 0.0, 1.0);" in text
    assert "sqrt(1.0 - roughness)" in text
