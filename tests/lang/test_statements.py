"""The language: expressions and statements in the IR."""

from __future__ import annotations

import pytest

from checked_source import checked, text_of
from sssgen.ir.operators import PRECEDENCE
from sssgen.ir.text import print_module
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.support.diagnostics import SssgenError

AROUND = """
struct Body {{ float size; vec3 color; float rings[2]; }};
const int N = 3;
uniform float density = 0.5;
uniform sampler2D map;
uniform sampler3D volume;
uniform samplerCube sky;
float square(float x) {{ return x * x; }}
vec3 square(vec3 x) {{ return x * x; }}
void turn(inout vec3 x, out float y) {{ y = 1.0; }}
{result} made(float a, float b, float c, int i, int j, uint u, bool p, bool r, vec2 t, vec3 v, vec4 w, ivec3 k, bvec2 s,
              mat2 m, mat3 n, mat4 o, float list[3], Body body) {{
    {before}return {expression};
}}
"""

EXPRESSIONS = {
    # Literals
    "1.0": "1.0",
    ".5": "0.5",
    "2.": "2.0",
    "1e3": "1000.0",
    "1.5E-2f": "0.015",
    "-1.0": "-1.0",
    "-(1.0)": "-1.0",
    "-0.0": "-0.0",
    "+1.0": "1.0",
    "- -1.0": "(- -1.0)",
    "3": "3",
    "017": "15",
    "0": "0",
    "0xff": "255",
    "0XFFFFFFFF": "-1",
    "-2147483648": "-2147483648",
    "-0x80000000": "-2147483648",
    "4294967295u": "4294967295u",
    "0x1U": "1u",
    "-1u": "(- 1u)",
    "true": "true",
    # Precedence and grouping, after GLSL ES 3.00, section 5.1
    "a + b * c": "(a + (b * c))",
    "a * b + c": "((a * b) + c)",
    "(a + b) * c": "((a + b) * c)",
    "a - b - c": "((a - b) - c)",
    "a / b / c": "((a / b) / c)",
    "a / b * c": "((a / b) * c)",
    "i % j * 2": "((i % j) * 2)",
    "-a * b": "((- a) * b)",
    "-a.x": None,
    "!p && r": "((! p) && r)",
    "~i & j": "((~ i) & j)",
    "i << 1 + j": "(i << (1 + j))",
    "i + j << 1": "((i + j) << 1)",
    "i & j == 0 ? 1 : 0": None,
    "(i & j) == 0": "((i & j) == 0)",
    "i < j == p": "((i < j) == p)",
    "i & j ^ 1 | 2": "(((i & j) ^ 1) | 2)",
    "1 | 2 ^ i & j": "(1 | (2 ^ (i & j)))",
    "p || r && p": "(p || (r && p))",
    "p ^^ r && p": "(p ^^ (r && p))",
    "p || r ^^ p": "(p || (r ^^ p))",
    "p && a < b || r": "((p && (a < b)) || r)",
    "p ? a : r ? b : c": "(p ? a : (r ? b : c))",
    "p ? r ? a : b : c": "(p ? (r ? a : b) : c)",
    "p || r ? a + b : c": "((p || r) ? (a + b) : c)",
    "a <= b != p": "((a <= b) != p)",
    "i >> 2 << j": "((i >> 2) << j)",
    "u << 1": "(u << 1)",
    # Operators on vectors and matrices
    "v * a": "(v * a)",
    "a / v": "(a / v)",
    "n * v": "(n * v)",
    "v * n": "(v * n)",
    "m * a": "(m * a)",
    "m == m": "(m == m)",
    "v != v": "(v != v)",
    "-v": "(- v)",
    "-m": "(- m)",
    "~k": "(~ k)",
    "k << 2": "(k << 2)",
    "body == body": "(body == body)",
    # Parts
    "v.x": "v.x",
    "v.rgb": "v.xyz",
    "v.stp.p": "v.xyz.z",
    "w.abgr": "w.wzyx",
    "v.xxxx": "v.xxxx",
    "(v + v).zy": "(v + v).zy",
    "v[0]": "v[0]",
    "n[i]": "n[i]",
    "n[2].y": "n[2].y",
    "n[1][2]": "n[1][2]",
    "list[N - 1]": "list[($N - 1)]",
    "list[u]": "list[u]",
    "body.color.xy": "body.color.xy",
    "body.rings[1]": "body.rings[1]",
    # Calls
    "square(a)": "$square(a)",
    "square(v).x": "$square(v).x",
    "sin(a)": "sin(a)",
    "max(v, a)": "max(v, a)",
    "mix(v, v, a)": "mix(v, v, a)",
    "clamp(i, 0, 1)": "clamp(i, 0, 1)",
    "not(s)": "not(s)",
    "texture(map, t)": "texture($map, t)",
    "texture(volume, v).r": "texture($volume, v).x",
    "textureLod(sky, v, 2.0)": "textureLod($sky, v, 2.0)",
    "textureGrad(map, t, dFdx(t), dFdy(t))": "textureGrad($map, t, dFdx(t), dFdy(t))",
    "texelFetch(map, ivec2(0), 0)": "texelFetch($map, ivec2{0}, 0)",
    "transpose(n) * inverse(n)": "(transpose(n) * inverse(n))",
    # Constructors: every argument is brought to the kind of the result
    "vec3(a)": "vec3{a}",
    "vec3(1)": "vec3{1.0}",
    "vec3(i)": "vec3{float{i}}",
    "vec3(t, 1)": "vec3{t, 1.0}",
    "vec3(i, t)": "vec3{float{i}, t}",
    "vec3(k)": "vec3{k}",
    "vec4(k, 1.0)": "vec4{vec3{k}, 1.0}",
    "ivec3(v)": "ivec3{v}",
    "bvec2(t)": "bvec2{t}",
    "vec2(v)": "v.xy",
    "vec2(k)": "vec2{k.xy}",
    "vec3(v)": "v",
    "float(v)": "v.x",
    "float(k)": "float{k.x}",
    "int(v)": "int{v.x}",
    "float(a)": "a",
    "float(i)": "float{i}",
    "float(p)": "float{p}",
    "float(1)": "1.0",
    "int(1.9)": "1",
    "int(-1.9)": "-1",
    "uint(-1)": "4294967295u",
    "int(4294967295u)": "-1",
    "bool(2.0)": "true",
    "bool(0)": "false",
    "uint(true)": "1u",
    "float(-0.0)": "-0.0",
    "mat2(1.0)": "mat2{1.0}",
    "mat2(t, t)": "mat2{t, t}",
    "mat2(1, 2, 3, 4)": "mat2{1.0, 2.0, 3.0, 4.0}",
    "mat2(n)": "mat2{n}",
    "mat4(n)": "mat4{n}",
    "mat2(v, a)": "mat2{v, a}",
    "mat2x2(1.0)": "mat2{1.0}",
    "Body(a, v, float[2](b, c))": "Body{a, v, float[2]{b, c}}",
    "float[2](a, b)": "float[2]{a, b}",
    "float[N](a, b, c)[2]": "float[3]{a, b, c}[2]",
    "thickness(a)": "a",
    "world_position(a, b, c)": "vec3{a, b, c}",
    "uv_direction(0.0)": "vec2{0.0}",
}


@pytest.mark.parametrize("expression", [name for name, text in EXPRESSIONS.items() if text is not None])
def test_expression(expression: str) -> None:
    """The returned expression as its text, whatever type it has."""
    assert returned(expression) == EXPRESSIONS[expression]


@pytest.mark.parametrize("expression", [name for name, text in EXPRESSIONS.items() if text is None])
def test_not_an_expression(expression: str) -> None:
    """What another precedence would make sense of."""
    with pytest.raises(SssgenError):
        returned(expression)


def returned(expression: str, before: str = "") -> str:
    """The IR text of an expression in the function above, found by trying each type for the result."""
    last: SssgenError | None = None
    types = "float int uint bool vec2 vec3 vec4 ivec2 ivec3 bvec2 mat2 mat3 mat4 Body float[2]"
    for type_ in types.split():
        try:
            text = text_of(AROUND.format(result=type_, before=before, expression=expression))
        except SssgenError as error:
            last = error
        else:
            return text[text.rindex("return ") + 7 : text.rindex(";")]
    assert last is not None
    raise last


def test_precedence_is_that_of_the_specification() -> None:
    """GLSL ES 3.00, section 5.1, from the tightest; all group to the left."""
    order = ["* / %", "+ -", "<< >>", "< > <= >=", "== !=", "&", "^", "|", "&&", "^^", "||"]
    levels = [level.split() for level in order]
    assert [{PRECEDENCE[op] for op in level} for level in levels] == [{len(levels) - 1 - n} for n in range(len(levels))]
    assert set(PRECEDENCE) == {op for level in levels for op in level}


STATEMENTS = {
    "float x = a;": "var float x = a;",
    "float x, y = a, z[2];": "var float x; var float y = a; var float[2] z;",
    "const float x = 1.0;": "var float x = 1.0;",
    "highp float x = a;": "var float x = a;",
    "float[2] x = float[2](a, b);": "var float[2] x = float[2]{a, b};",
    "Body x = body;": "var Body x = body;",
    "thickness x = thickness(a);": "var float x = a;",
    "a = b;": "set a = b;",
    "a += b;": "set a += b;",
    "v *= n;": "set v *= n;",
    "i <<= 1u;": "set i <<= 1u;",
    "i++;": "set i += 1;",
    "--a;": "set a -= 1.0;",
    "u++;": "set u += 1u;",
    "v.xz = t;": "set v.xz = t;",
    "v.bgr = v;": "set v.zyx = v;",
    "v[i] = a;": "set v[i] = a;",
    "n[0].xy *= a;": "set n[0].xy *= a;",
    "body.color.r = a;": "set body.color.x = a;",
    "body.rings[i] -= a;": "set body.rings[i] -= a;",
    "turn(v, a);": "call $turn(v, a);",
    "turn(body.color, list[0]);": "call $turn(body.color, list[0]);",
    "square(a);": "call $square(a);",
    "if (p) a = b;": "if p then { set a = b; }",
    "if (p) { a = b; } else if (r) a = c; else { }": "if p then { set a = b; } else { if r then { set a = c; } }",
    "if (p) ; else a = b;": "if p then { } else { set a = b; }",
    "{ float x = a; } { float x = b; } float x = c;": "var float x = a; var float x_2 = b; var float x_3 = c;",
    "for (int q = 0; q < 3; q++) a += b;":
        "for (var int q = 0; (q < 3); set q += 1;) { set a += b; }",
    "for (int q = 3; q > 0; q -= 2) { break; }":
        "for (var int q = 3; (q > 0); set q -= 2;) { break; }",
    "for (i = 0; N >= i; i = i + 1) continue;":
        "for (set i = 0; ($N >= i); set i = (i + 1);) { continue; }",
    "for (; i != 9; ++i) { }": "for (; (i != 9); set i += 1;) { }",
    "for (int q = 0; q < 3 && p; q++) { p = r; }":
        "for (var int q = 0; ((q < 3) && p); set q += 1;) { set p = r; }",
    "for (uint q = 3u; q > 0u; q--) { }": "for (var uint q = 3u; (q > 0u); set q -= 1u;) { }",
    "for (int q = 0; q < 3; q++) { turn(v, a); }":
        "for (var int q = 0; (q < 3); set q += 1;) { call $turn(v, a); }",
    "for (int q = 0; q < 3; q++) a = square(float(q));":
        "for (var int q = 0; (q < 3); set q += 1;) { set a = $square(float{q}); }",
    "while (i < 3) { a += b; i++; }": "while (i < 3) do { set a += b; set i += 1; }",
    "while (p && i < j) { i++; for (int q = 0; q < 3; q++) continue; }":
        "while (p && (i < j)) do { set i += 1; for (var int q = 0; (q < 3); set q += 1;) { continue; } }",
    "if (p) discard;": "if p then { discard; }",
    "if (p) return a;": "if p then { return a; }",
    ";": "",
    "a = b /* b */ + c // c\n * 2.0; // done": "set a = (b + (c * 2.0));",
}  # fmt: skip


@pytest.mark.parametrize("statement", STATEMENTS)
def test_statement(statement: str) -> None:
    text = text_of(AROUND.format(result="float", before=statement + "\n", expression="a"))
    body = text[text.rindex("Body body) {") + 12 : text.rindex("return a;")]
    assert " ".join(body.split()) == STATEMENTS[statement]


def test_hidden_names_are_renamed() -> None:
    """An inner variable gets a name that is unique in its scope; uniforms and locals are separate."""
    source = """
uniform float x;
float f(float a) {
    float b = x;
    float x = x + 1.0;
    if (a > 0.0) { float a = a + b; float a_2 = a; b = a_2; }
    for (int b = 0; b < 3; b++) { int b = b; }
    return a + b + x;
}
"""
    assert (
        text_of(source)
        == """\
uniform float x = (0.0)
function float f(in float a) {
    var float b = $x;
    var float x = ($x + 1.0);
    if (a > 0.0) then {
        var float a_2 = (a + b);
        var float a_2_2 = a_2;
        set b = a_2_2;
    }
    for (var int b_2 = 0; (b_2 < 3); set b_2 += 1;) {
        var int b_3 = b_2;
    }
    return ((a + b) + x);
}
"""
    )


LOOPS_REFUSED = [
    "for (int n = 0; n < 3; n--) { }",
    "for (int n = 0; n > 3; n++) { }",
    "for (int n = 0; n < 3; n += 0) { }",
    "for (int n = 0; n < 3; n += i) { }",
    "for (int n = 0; n < n; n++) { }",
    "for (int n = 0; n < i; n++) { i++; }",
    "for (int n = 0; n < 3; n++) { n = 0; }",
    "for (int n = 0; n < 3; n++) { set_to_zero(n); }",
    "for (int n = 0; n < 3; n++) { a = zeroing(n); }",
    "for (int n = 0; n < 3 && zeroing(n) > 0.0; n++) { }",
    "for (int n = 0; n < zeroing_nothing(); n++) { }",
    "for (int n = 0; n != 3; n += 2) { }",
    "for (int n = 0; n <= 2147483647; n++) { }",
    "for (int n = 0; n < 2147483647; n += 2) { }",
    "for (int n = 0; n <= i; n++) { }",
    "for (int n = 0; n < i; n += 2) { }",
    "for (int n = 0; n >= i; n--) { }",
    "for (int n = 0; i > n; n += 2) { }",
    "for (int n = 0; n <= LAST; n++) { }",
    "for (int n = 0; n <= LAST + 1; n++) { }",
    "for (int n = 0; n <= max(i, 3); n++) { }",
    "for (int n = 0; n <= free_count; n++) { }",
    "for (int n = 0; n <= count + LAST; n++) { }",
    "for (uint n = 0u; n < 4294967295u; n += 2u) { }",
    "for (uint n = 9u; n > 1u; n -= 3u) { }",
    "int n = 0; while (n <= i) { n++; }",
    "for (uint n = 3u; n >= 0u; n--) { }",
    "for (uint n = 3u; n > 0u; n -= 2u) { }",
    "for (float t = 0.0; t < 1.0; t += 0.1) { }",
    "for (int n = 0; n < 3; ) { }",
    "for (int n = 0; ; n++) { }",
    "for (int n = 0; true; n++) { }",
    "for (ivec2 n = ivec2(0); n.x < 3; n.x++) { }",
    "while (true) { }",
    "while (i < 3) { if (a > 0.0) i++; }",
    "while (i < 3) { i++; i--; }",
    "while (i < j) { i++; j++; }",
    "while (i < 3) { if (a > 0.0) { continue; } i++; }",
]


@pytest.mark.parametrize("loop", LOOPS_REFUSED)
def test_loops_that_may_not_end(loop: str) -> None:
    source = f"""
void set_to_zero(out int x) {{ x = 0; }}
float zeroing(inout int x) {{ x = 0; return 1.0; }}
int zeroing_nothing() {{ return 3; }}
const int LAST = 2147483647;
uniform int count : hint_range(1, 64) = 8;
uniform int free_count = 8;
void f(float a, int i, int j) {{ {loop} }}
"""
    with pytest.raises(SssgenError) as raised:
        checked(source)
    assert [error.message for error in raised.value.diagnostics] == ["this loop cannot be proven to end"]


@pytest.mark.parametrize(
    "loop",
    [
        "for (int n = 0; n < i; n++) { }",
        "for (int n = 0; n <= 2147483646; n++) { }",
        "for (int n = 0; n < 2147483646; n += 2) { }",
        "for (int n = 0; n <= min(i, 64); n += 3) { }",
        "for (int n = 0; n < clamp(i, 1, 64); n += 3) { }",
        "for (int n = 0; n <= count + MOST; n++) { }",
        "for (int n = 0; n <= count - 1; n += 2) { }",
        "for (int n = 9; n >= MOST; n -= 3) { }",
        "for (int n = 9; n > i; n--) { }",
        "for (int n = 9; n > max(i, -9); n -= 4) { }",
        "for (uint n = 9u; n > 0u; n--) { }",
        "for (uint n = 9u; n > 2u; n -= 3u) { }",
        "for (uint n = 0u; n < 4294967294u; n += 2u) { }",
        "int n = 0; while (n <= count && a > 0.0) { n++; }",
    ],
)
def test_loops_that_end(loop: str) -> None:
    checked(f"""
const int MOST = 64;
uniform int count : hint_range(1, 64) = 8;
void f(float a, int i) {{ {loop} }}
""")


def test_a_declaration_of_nothing() -> None:
    text = "float f(float x) { float; switch (int(x)) { case 0: int; } return x; }\n"
    assert "return x;" in print_module(load_glsl_text(f"#version 300 es\n{text}", "a.glsl").module, spans=False)


def test_the_length_of_a_result_calls_the_function() -> None:
    text = "int n = 0;\nint[2] f() { n++; int a[2]; return a; }\nint g() { return f().length() * 10 + n; }\n"
    body = print_module(load_glsl_text(text, "a.glsl").module, spans=False).partition("int g()")[2]
    assert "measured = $f();" in body
    assert "2 * 10" in body
