"""Constants are computed as float32, exactly where the rules allow it."""

from __future__ import annotations

import pytest

from pass_cases import assert_is, module_of, text
from sssgen.ir.nodes import Literal, Module, Return
from sssgen.passes.fold import fold

UNIFORMS = "uniform float k = 1.0; uniform int n = 1; uniform bool b = true; uniform vec3 v = vec3(1.0); "


def becomes(before: str, after: str, **fixed: tuple[float, ...]) -> None:
    result = fold(module_of(before), fixed)
    assert_is(result, after)
    again = fold(result)
    assert all(one is other for one, other in zip(again.functions, result.functions, strict=True)), "idempotent"


def value(expression: str, result_type: str = "float") -> str:
    """The IR text of an expression."""
    params = "float x, float y, int i, uint u, bool c, vec2 p, vec3 q, ivec2 iq"
    module = fold(module_of(f"{UNIFORMS} {result_type} f({params}) {{ return {expression}; }}"))
    (line,) = [line for line in text(module).splitlines() if "return" in line]
    return line.strip().removeprefix("return ").rstrip(";")


def number(module: Module) -> object:
    """The literal that the module's last function returns."""
    (stmt,) = module.functions[-1].body or ()
    assert isinstance(stmt, Return) and isinstance(stmt.value, Literal)
    return stmt.value.value


@pytest.mark.parametrize(
    ("expression", "folded"),
    [
        ("1.5 + 2.0 * 3.0", "7.5"),
        ("0.1 + 0.2", "0.30000001192092896"),  # of the float32 nearest to 0.1 and 0.2, rounded once
        ("1.0 / 3.0", "0.3333333432674408"),
        ("16777216.0 + 1.0", "16777216.0"),
        ("-(2.0)", "-2.0"),
        ("1.0e30 * 1.0e10", "(1e+30 * 10000000000.0)"),  # inf
        ("1.0e-30 * 1.0e-10", "(1e-30 * 1e-10)"),  # denormal
        ("1.0 / 0.0", "(1.0 / 0.0)"),
        ("0.0 / 0.0", "(0.0 / 0.0)"),
        ("x * 0.0", "(x * 0.0)"),
        ("x * 1.0", "x"),
        ("1.0 * x", "x"),
        ("x / 1.0", "x"),
        ("1.0 / x", "(1.0 / x)"),
        ("x + 0.0", "x"),
        ("0.0 + x", "x"),
        ("x - 0.0", "x"),
        ("0.0 - x", "(0.0 - x)"),
        ("-(-x)", "x"),
        ("-(-(-x))", "(- x)"),
        ("radians(180.0)", "3.1415927410125732"),
        ("sqrt(2.0)", "1.4142135381698608"),
        ("sqrt(-1.0)", "sqrt(-1.0)"),
        ("log(0.0)", "log(0.0)"),
        ("pow(0.0, 0.0)", "pow(0.0, 0.0)"),
        ("pow(-2.0, 2.0)", "pow(-2.0, 2.0)"),
        ("pow(2.0, 0.5)", "1.4142135381698608"),
        ("exp(100.0)", "exp(100.0)"),
        ("exp(1.0)", "2.7182817459106445"),
        ("acos(2.0)", "acos(2.0)"),
        ("atan(0.0, 0.0)", "atan(0.0, 0.0)"),
        ("atan(1.0, 0.0)", "1.5707963705062866"),
        ("mod(-0.5, 2.0)", "1.5"),
        ("mod(1.0, 0.0)", "mod(1.0, 0.0)"),
        ("fmod(-0.5, 2.0)", "-0.5"),
        ("floor(-0.5)", "-1.0"),
        ("round(2.5)", "2.0"),
        ("fract(1.75)", "0.75"),
        ("sign(-3.0)", "-1.0"),
        ("clamp(3.0, 0.0, 1.0)", "1.0"),
        ("clamp(3.0, 1.0, 0.0)", "clamp(3.0, 1.0, 0.0)"),
        ("mix(1.0, 3.0, 0.25)", "1.5"),
        ("smoothstep(0.0, 2.0, 0.5)", "0.15625"),
        ("smoothstep(1.0, 1.0, 0.5)", "smoothstep(1.0, 1.0, 0.5)"),
        ("step(0.5, 0.25)", "0.0"),
        ("dot(vec3(1.0, 2.0, 3.0), vec3(4.0, -5.0, 6.0))", "12.0"),
        ("length(vec2(3.0, 4.0))", "5.0"),
        ("distance(vec2(4.0, 6.0), vec2(1.0, 2.0))", "5.0"),
        ("max(x, 1.0 + 1.0)", "max(x, 2.0)"),
        ("saturate(2.0)", "1.0"),
        ("true ? x : y", "x"),
        ("1.0 > 2.0 ? x : y", "y"),
        ("c ? x : y", "(c ? x : y)"),
        ("float(3)", "3.0"),
        ("float(2 + 3)", "5.0"),
        ("float(true)", "1.0"),
        ("vec3(x, y, 1.0).y", "y"),
        ("vec4(q, x).w", "x"),
        ("vec4(q, x).y", "q.y"),
        ("vec4(1.0, 2.0, 3.0, 4.0).zyx.x", "3.0"),
        ("vec3(x).z", "x"),
        ("q.zyx.x", "q.z"),
        ("vec3(sin(x), y, 0.0)[0]", "sin(x)"),
        ("float[2](x, y)[1]", "y"),
        ("float[2](x, x)[int(c && false) + 3]", "x"),
        ("q[int(c && false) - 1]", "q[0]"),
        ("mat2(p, vec2(x, y))[1].y", "y"),
    ],
)
def test_floats(expression: str, folded: str) -> None:
    assert value(expression) == folded


@pytest.mark.parametrize(
    ("expression", "type_", "folded"),
    [
        ("2147483647 + 1", "int", "-2147483648"),
        ("-2147483647 - 2", "int", "2147483647"),
        ("65536 * 65536 + 1", "int", "1"),
        ("7 / -2", "int", "-3"),
        ("7 % 4", "int", "3"),
        ("-7 % 4", "int", "-3"),
        ("1 / 0", "int", "(1 / 0)"),
        ("1 << 4", "int", "16"),
        ("1 << 32", "int", "(1 << 32)"),
        ("-8 >> 1", "int", "-4"),
        ("~5 & 12 | 3 ^ 1", "int", "10"),
        ("i * 1 + 0", "int", "i"),
        ("i | 0", "int", "i"),
        ("i << 0", "int", "i"),
        ("int(3.9)", "int", "3"),
        ("int(x * 0.0 + 3.0e9)", "int", "int{((x * 0.0) + 3000000000.0)}"),
        ("abs(-7)", "int", "7"),
        ("max(3, 4)", "int", "4"),
        ("3000000000u + 3000000000u", "uint", "1705032704u"),
        ("uint(-1)", "uint", "4294967295u"),
        ("u / 1u", "uint", "u"),
        ("1.0 < 2.0", "bool", "true"),
        ("vec2(1.0) == vec2(1.0, 1.0)", "bool", "true"),
        ("true && c", "bool", "c"),
        ("c && true", "bool", "c"),
        ("c && false", "bool", "false"),
        ("c || false", "bool", "c"),
        ("true || c", "bool", "true"),
        ("c ^^ true", "bool", "(! c)"),
        ("false ^^ c", "bool", "c"),
        ("!(!c)", "bool", "c"),
        ("c ? false : true", "bool", "(! c)"),
        ("any(lessThan(vec2(1.0, 3.0), vec2(2.0)))", "bool", "true"),
        ("vec3(1.0, 1.0, 1.0)", "vec3", "vec3{1.0}"),
        ("vec3(0.0, -0.0, 0.0)", "vec3", "vec3{0.0, -0.0, 0.0}"),
        ("vec3(vec3(x, y, 0.0))", "vec3", "vec3{x, y, 0.0}"),
        ("vec3(vec2(x, y), 1.0)", "vec3", "vec3{x, y, 1.0}"),
        ("vec3(vec2(1.0), 1.0)", "vec3", "vec3{1.0}"),
        ("q.xyz", "vec3", "q"),
        ("vec4(q, x).xyz", "vec3", "q"),
        ("vec4(p, x, y).yxw", "vec3", "vec3{p.yx, y}"),
        ("vec4(sin(x), y, y, y).xxy", "vec3", "vec4{sin(x), y, y, y}.xxy"),
        ("q * vec3(1.0)", "vec3", "q"),
        ("x * vec3(1.0)", "vec3", "(x * vec3{1.0})"),
        ("vec3(1.0, 2.0, 3.0) * 2.0 - 1.0", "vec3", "vec3{1.0, 3.0, 5.0}"),
        ("mat3(1.0) * vec3(1.0)", "vec3", "(mat3{1.0} * vec3{1.0})"),
        ("vec2(ivec2(1, 2))", "vec2", "vec2{1.0, 2.0}"),
        ("vec2(iq)", "vec2", "vec2{iq}"),
        ("normalize(vec2(3.0, 4.0))", "vec2", "vec2{0.6000000238418579, 0.800000011920929}"),
        ("normalize(vec2(0.0))", "vec2", "normalize(vec2{0.0})"),
        ("cross(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0))", "vec3", "vec3{0.0, 0.0, 1.0}"),
        ("min(vec3(1.0, 2.0, 3.0), 2.0)", "vec3", "vec3{1.0, 2.0, 2.0}"),
        ("mix(vec2(0.0), vec2(1.0, 3.0), 0.5)", "vec2", "vec2{0.5, 1.5}"),
        ("mix(q, q, bvec3(true))", "vec3", "mix(q, q, bvec3{true})"),
    ],
)
def test_other_types(expression: str, type_: str, folded: str) -> None:
    assert value(expression, type_) == folded


def test_fixed_uniforms_become_literals_and_vanish() -> None:
    becomes(
        """
        uniform float depth = 1.0; uniform int mode = 0; uniform bool on = true; uniform vec3 tint = vec3(1.0);
        uniform mat2 turn; uniform float weights[2]; uniform float kept = 1.0;
        float f(vec2 p, int i) {
            return turn[0].x * p.x * depth * tint.y * weights[i] * kept + (on ? float(mode) : 0.0);
        }
        """,
        """
        uniform float kept = 1.0;
        float f(vec2 p, int i) {
            return mat2(1.0, 2.0, 3.0, 4.0)[0].x * p.x * 0.5 * 0.25 * float[2](0.5, 0.75)[i] * kept + 3.0;
        }
        """,
        depth=(0.5,), mode=(3,), on=(1,), tint=(1.0, 0.25, 1.0), turn=(1.0, 2.0, 3.0, 4.0), weights=(0.5, 0.75),
    )  # fmt: skip


def test_a_fixed_uniform_needs_all_its_components() -> None:
    with pytest.raises(ValueError, match="2 components for 3"):
        fold(module_of(f"{UNIFORMS} float f(float x) {{ return v.x; }}"), {"v": (1.0, 2.0)})


def test_a_fixed_parameter_decides_branches() -> None:
    becomes(
        """
        uniform int mode = 0; uniform sampler2D map;
        float f(float x) {
            float y = x;
            if (mode == 1) { float z = y * 2.0; y = z; }
            else if (mode == 2) { y = 0.0; } else { y = texture(map, vec2(y)).r; }
            return y;
        }
        """,
        "uniform sampler2D map; float f(float x) { float y = x; float z = y * 2.0; y = z; return y; }",
        mode=(1,),
    )


def test_a_spliced_block_gets_unique_names() -> None:
    becomes(
        """
        float f(float x) {
            float sum = 0.0;
            if (true) { float part = x; sum += part; }
            float part = 2.0; sum += part;
            if (true) { float part = 4.0; sum += part; }
            for (int i = 0; i < 3; i++) { float part = 3.0; sum += part; }
            return sum + part;
        }
        """,
        """
        float f(float x) {
            float sum = 0.0;
            float part = x; sum += part;
            float part_3 = 2.0; sum += part_3;
            float part_2 = 4.0; sum += part_2;
            for (int i = 0; i < 3; i++) { float part_4 = 3.0; sum += part_4; }
            return sum + part_3;
        }
        """,
    )


def test_loops_that_never_run() -> None:
    becomes(
        """
        const int N = 4;
        float f(float x) {
            float y = x;
            for (int i = 0; i < N - 4; i++) { y += 1.0; }
            for (int i = N; i > 4; i--) { y += 1.0; }
            int j = 7;
            for (j = 3; j < 2; j++) { y += 2.0; }
            while (false && j < 4) { j++; }
            for (int i = 0; i < N; i++) { y *= 1.0; y += 2.0 - 1.0; }
            return y + float(j);
        }
        """,
        """
        const int N = 4;
        float f(float x) {
            float y = x;
            int j = 7;
            j = 3;
            for (int i = 0; i < N; i++) { y += 1.0; }
            return y + float(j);
        }
        """,
    )


def test_module_constants_keep_their_names_but_decide_conditions() -> None:
    becomes(
        """
        const int STEPS = 2 * 8; const float EDGE = 1.0 / 4.0; const vec3 AXIS = vec3(0.0, 1.0, 0.0);
        float f(float x) {
            float y = x * EDGE;
            if (STEPS > 8 && y > EDGE) { y = AXIS.y; }
            if (STEPS < 8 || AXIS.x > 0.5) { y = 2.0; }
            return float(STEPS) + (AXIS == vec3(0.0) ? 1.0 : y);
        }
        """,
        """
        const int STEPS = 16; const float EDGE = 0.25; const vec3 AXIS = vec3(0.0, 1.0, 0.0);
        float f(float x) {
            float y = x * EDGE;
            if (y > EDGE) { y = AXIS.y; }
            return float(STEPS) + y;
        }
        """,
    )


def test_assignments_that_change_nothing_go() -> None:
    becomes(
        "float f(float x) { vec3 y = vec3(x); y *= 1.0; y *= vec3(1.0); x += 0.0; x /= 1.0; y.x -= 0.0; x *= 0.0; "
        "return y.x * x; }",
        "float f(float x) { vec3 y = vec3(x); y *= 1.0; x *= 0.0; return y.x * x; }",
    )


def test_effects_are_not_dropped() -> None:
    source = """
        float g(float x, out float y) { y = x; return x; }
        float f(float x) {
            float y;
            bool a = g(x, y) > 0.0 && false;
            float b = vec2(g(x, y), x).y;
            return a ? b : y;
        }
        """
    becomes(source, source)


def test_a_run_without_changes_keeps_every_node() -> None:
    module = module_of("uniform float k = 1.0; float f(float x) { float y = x * 2.0; if (x > k) { y = k; } return y; }")
    assert all(one is other for one, other in zip(fold(module).functions, module.functions, strict=True))


def test_literals_keep_the_place_of_the_expression() -> None:
    module = module_of("uniform float k = 1.0;\nfloat f(float x) {\n    return k;\n}")
    (stmt,) = fold(module, {"k": (0.5,)}).functions[0].body or ()
    assert isinstance(stmt, Return) and stmt.value is not None
    assert (stmt.value.span.line, stmt.value.span.column) == (3, 12)
    assert number(fold(module, {"k": (0.5,)})) == 0.5
