"""The errors of the language: what each says, that several come in one run, and that nothing brings the compiler down."""

from __future__ import annotations

import ast
import inspect
import random
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ir_sample import SAMPLE
from snapshot import check_snapshot

from sssgen import diagnostics, lang
from sssgen.diagnostics import Diagnostic, Reporter, SssgenError, did_you_mean
from sssgen.ir.nodes import Span
from sssgen.ir.verify import verify
from sssgen.lang import quantities
from sssgen.lang.check import check
from sssgen.lang.parser import MAX_DEPTH, parse

LANG = Path(inspect.getfile(lang)).parent


def errors_of(source: str, file: str = "wax.sss") -> SssgenError:
    with pytest.raises(SssgenError) as raised:
        check(parse(source, file), source)
    return raised.value


def inside(statements: str) -> str:
    """Statements in a function that has something of everything."""
    return f"""\
struct Body {{ float size; thickness depth; }};
const int N = 3;
uniform float density = 0.5;
uniform vec2 scale;
uniform sampler2D map : holds(thinness);
uniform sampler3D volume;
float solid(float x, vec2 y) {{ return x; }}
float many(float x) {{ return x; }}
float many(int x) {{ return 1.0; }}
void give(out float x, inout world_position q) {{ x = 1.0; }}
void measure(out thickness d) {{ d = thickness(1.0); }}
void wrong(inout float x, int i, vec3 v, mat2 m, bool b, Body body, world_position P, world_direction N_world,
           object_direction N_object, thickness d, thinness thin, uv_position uv, float list[3]) {{
    {statements}
}}
"""


SYNTAX = {
    "missing_semicolon": "float f() {\n    float x = 1.0\n    return x;\n}",
    "missing_bracket": "float f() { return max(1.0, 2.0; }",
    "missing_operand": "float f() { return 1.0 + ; }",
    "missing_brace": "float f() {\n    return 1.0;\n",
    "stray_brace": "float f() { return 1.0; } }",
    "stray_word": "uniform float x\nuniform float y;",
    "empty_brackets": "float f() { return (); }",
    "assignment_in_an_expression": "float f(float x) { return x = 1.0; }",
    "increment_in_an_expression": "float f(int x) { return float(x++); }",
    "comma_operator": "void f(float x) { x = 1.0, x = 2.0; }",
    "switch": "void f(int x) { switch (x) { case 1: break; } }",
    "do_while": "void f(int x) { do { x += 1; } while (x < 3); }",
    "struct_without_members": "struct S { };",
    "type_as_a_value": "float f() { return float; }",
    "preprocessor": "#define PI 3.14\nfloat f() { return PI; }",
    "unknown_character": "float f() { return 1.0 @ 2.0; }",
    "letters_of_other_scripts": "float größe() { return 1.0; }",
    "comment_not_closed": "float f() { return 1.0; }\n/* and so on\n",
    "comment_not_closed_inside": "float f() { return 1.0 /* and so on\n; }\n",
    "text_not_closed": 'uniform float x : unit("m) = 1.0;',
    "uniform_after_default": "uniform float x = 1.0 : hint_range(0.0, 1.0);",
    "several_syntax_errors": (
        "float f( { return 1.0; }\nfloat fine() { return 1.0; }\nuniform vec3;\nfloat g() { return 1.0 +* 2.0; }\n"
    ),
}

DECLARATIONS = {
    "declared_twice": "uniform float x;\nuniform vec2 x;\nconst float y = 1.0;\nstruct y { float z; };\nfloat x() { return 1.0; }",
    "named_like_a_quantity": "uniform float thickness;",
    "reserved_names": (
        "uniform float gl_x;\nuniform float a__b;\nuniform float input;\nuniform float image2DRect;\n"
        "struct S { float filter; };\nfloat f(float half, float do) { float if = half; return if; }\nfloat template() { return 1.0; }"
    ),
    "member_twice": "struct S { float x, y; int x; };",
    "member_of_samplers": "struct S { sampler2D x; };",
    "member_of_nothing": "struct S { void x; };",
    "unknown_type": "struct Body { float x; };\nuniform flaot x;\nbody f() { return body(1.0); }\nfloat g(vec5 x) { return 1.0; }",
    "array_length": "const int N = 0;\nuniform float x[N];\nuniform float y[1.0];\nuniform float z[];\nuniform float u[70000];\nuniform float v[-1];",
    "array_of_arrays": "uniform float[2] x[3];\nuniform sampler2D y[2];",
    "uniform_of_nothing": "uniform void x;",
    "uniform_of_a_struct": "struct S { float x; };\nuniform S x;\nuniform S y[2];",
    "default_of_a_texture": "uniform sampler2D x = 1.0;",
    "default_of_another_type": "uniform vec3 x = 1.0;\nuniform float y = 1;\nuniform int z = 1.0;",
    "default_not_of_literals": "const float ONE = 1.0;\nuniform float x = ONE;\nuniform float y = 1.0 + 1.0;\nuniform ivec2 z = ivec2(vec2(1.5));",
    "constant_without_value": "const float x;",
    "constant_not_constant": (
        "uniform float x;\nuniform sampler2D map;\nfloat f() { return 1.0; }\nconst float a = x;\nconst float b = f();\n"
        "const vec4 c = texture(map, vec2(0.0));\nconst float d = dFdx(1.0);"
    ),
    "parameter_twice": "float f(float x, vec2 x) { return 1.0; }",
    "parameter_of_nothing": "float f(float x, void y) { return 1.0; }\nfloat g(out sampler2D x) { return 1.0; }",
    "function_twice": "float f(float x) { return x; }\nfloat f(float y) { return y; }\nfloat f(vec2 x) { return x.x; }",
    "prototype_that_differs": (
        "float f(float x);\nvec2 f(float x) { return vec2(x); }\nfloat g(float x);\nfloat g(out float x) { x = 1.0; return x; }\n"
        "float h(thickness x);\nfloat h(float x) { return x; }"
    ),
    "no_return": "float f(float x) {\n    if (x > 0.0) { return x; }\n}",
    "return_without_a_value": "float f() { return; }",
    "recursion": "float f(float x) { return f(x); }",
    "recursion_around": (
        "float a(float x);\nfloat b(float x) { return a(x); }\nfloat c(float x) { return b(x); }\nfloat a(float x) { return c(x); }"
    ),
    "called_before_declared": "float f() { return g(); }\nfloat g() { return 1.0; }",
}

HINTS = {
    "unknown_hint": "uniform float x : hint_rnage(0.0, 1.0);",
    "hint_twice": 'uniform float x : unit("m"), unit("cm");',
    "hint_arguments": 'uniform float x : hint_range(1.0);\nuniform float y : unit;\nuniform vec3 z : source_color("red");\nuniform float u : unit(1.0);',
    "hint_number_too_large": "uniform float x : hint_range(0.0, 1e99);",
    "texture_hint_on_a_value": "uniform float x : default_white;",
    "value_hint_on_a_texture": "uniform sampler2D x : hint_range(0.0, 1.0);",
    "colour_of_two": "uniform vec2 x : source_color;\nuniform ivec3 y : source_color;",
    "texture_that_holds_no_quantity": "uniform sampler2D x : holds(depth);",
    "range_of_no_numbers": "uniform bool x : hint_range(0.0, 1.0);",
    "empty_range": "uniform float x : hint_range(1.0, 0.0);",
    "range_without_a_step": "uniform float x : hint_range(0.0, 1.0, 0.0);",
    "default_outside_its_range": "uniform float x : hint_range(0.0, 1.0) = 2.0;\nuniform vec2 y : hint_range(1.0, 2.0);",
}

STATEMENTS = {
    "unknown_names": "x = densty; x = zork; solve(x); x = sine(x);",
    "function_without_brackets": "x = sin; x = solid;",
    "variable_of_nothing": "void y; sampler2D z;",
    "variable_twice": "float y; vec2 y; float x;",
    "constant_variable": "const float y; const float z = 1.0; z = 2.0; z += 1.0;",
    "assigned_global": "density = 1.0; scale.x = 1.0; map = volume;",
    "assigned_value": "x + 1.0 = 2.0; solid(x, scale) = 1.0; 1.0 = x;",
    "assigned_twice_at_once": "v.xx = vec2(1.0);",
    "assigned_another_type": "x = 1; v = vec2(1.0); x = v; i = 1.0; i = 1u; b = 1; body = x;",
    "assigned_by_an_operator": "x += 1; x += v; i *= 2.0; b += b; x %= 2.0; i <<= 1.0;",
    "incremented": "b++; v++; body--;",
    "dropped_value": "x + 1.0; sin(x); x;",
    "condition_of_a_number": "if (x) x = y; while (i) { zork(); } x = i ? 1.0 : 2.0;",
    "endless_loops": (
        "for (int j = 0; j < 3; j--) x += 1.0;\n    for (int j = 0; j < 3; j++) j = 0;\n    for (;;) x += 1.0;\n"
        "    for (float t = 0.0; t < 1.0; t += 0.1) x += t;\n    for (uint j = 3u; j >= 0u; j--) x += 1.0;\n"
        "    while (b) x += 1.0;\n    while (i < 3) { if (b) continue; i++; }\n    while (i < N) { if (b) i++; }\n"
        "    int k = 3;\n    while (i < k) { i++; k++; }"
    ),
    "two_counters": "for (int j = 0, k = 0; j < 3; j++) x += 1.0;",
    "break_outside": "break; if (b) continue;",
    "return_of_nothing": "return 1.0;",
    "operators": (
        "x = x + 1; x = 1 + x; v = v + scale; b = v < v; x = x % 2.0; b = b & b; i = i & 1u; b = i && b; x = m * v; b = map == map; x = x << 1;"
    ),
    "signs": "b = -b; x = ~x; b = !x; b = !bvec2(true); m = +body;",
    "arms_that_differ": "x = b ? 1.0 : 1; v = b ? v : scale; vec4 t = texture(b ? map : map, uv);",
    "indices": "x = v[1.0]; x = x[0]; x = v[3]; x = list[-1]; x = list[N]; v = m[2];",
    "members": "x = body.sizes; x = x.x; x = v.w; x = v.xg; v = v.xyzxy; x = m.x;",
    "calls": "x = solid(x); x = solid(x, v); x = solid(x, x, x); x = many(v); x = many(); give(1.0, P); give(density, P);",
    "builtins": "x = sin(1); x = max(x, 1); x = dot(v, scale); vec4 t = texture(map, v); x = pow(x); x = radians();",
    "constructors": (
        "v = vec3(1.0, 2.0); v = vec3(scale); v = vec3(v, v); x = float(m); m = mat2(scale); m = mat2(m, m); v = vec3(); x = float(x, x); "
        "body = Body(1.0); x = float(body); float two[2] = float[2](1.0); v = vec3(map);"
    ),
    "constructed_samplers": "x = sampler2D(1.0);",
    "numbers": "i = 2147483648; i = 0x1ffffffff; uint u = 4294967296u; x = 1e40; i = 089; i = int(1e10); u = uint(-1.0);",
    "errors_are_not_repeated": (
        "zork y = 1.0; y += 1.0; x = y; float z = zork; x = z; float w = 1; x = w; int q[2] = 1; i = q[1]; for (int j = 0; j < zork; j++) x = z;"
    ),
}

QUANTITIES = {
    "plain_for_a_quantity": "d = thickness(1.0); d = 1.0; d = x; P = v; uv = scale;",
    "quantity_for_another": "d = thin; thin = transmittance(0.5); P = N_world; N_world = N_object; uv = P.xy;",
    "constructed_from_another": "d = thickness(thin); P = world_position(N_world); N_object = object_direction(N_world);",
    "scalars_together": "x = d + thin; x = d - thin; b = d < thin; x = max(d, thin); x = mix(d, thin, 0.5); d = b ? d : thickness(1.0); x = b ? d : thin;",
    "spaces_together": "x = dot(N_world, N_object); v = cross(N_world, N_object); v = P + N_object; v = mix(N_world, N_object, 0.5); v = N_world * N_object;",
    "positions": "v = N_world - P; P = P + P; P = P * 2.0; N_world = P - vec3(1.0); N_world = -P;",
    "kept_or_lost": "d = d * 2.0; d *= 2.0; d += 1.0; d++; N_world = m[0].xyy * N_world; N_world = mat3(1.0) * N_world; P -= P; N_world = abs(v);",
    "parameters": "x = solid(d, uv); give(d, P); give(x, v); measure(x); measure(thin); world_position Q; measure(Q.x);",
    "texels": "d = texture(map, uv).r; thin = texture(map, uv).g; vec4 t = texture(map, uv); thin = t.r; x = texture(map, N_world.xy).r; t = texture(volume, P);",
    "members_of_quantities": "body = Body(1.0, 1.0); body.depth = 1.0; d = body.depth; thin = body.depth;",
    "results": "d = exp(-d); thin = clamp(d, 0.0, 1.0); x = length(P); d = length(P);",
}

CASES = {**SYNTAX, **DECLARATIONS, **HINTS}
CASES |= {name: inside(text) for name, text in {**STATEMENTS, **QUANTITIES}.items()}


@pytest.mark.parametrize("name", CASES)
def test_error_text(name: str) -> None:
    error = errors_of(CASES[name])
    check_snapshot(f"errors/{name}.txt", f"{error}\n")
    for diagnostic in error.diagnostics:
        assert diagnostic.span.file == "wax.sss"
        assert 1 <= diagnostic.span.line <= CASES[name].count("\n") + 1
        assert diagnostic.as_json()["line"] == diagnostic.span.line


def test_every_error_has_a_snapshot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each place in the front end that reports an error is reached by one of the cases above."""
    reached: set[tuple[str, int]] = set()

    def note() -> None:
        frame = inspect.currentframe()
        while frame is not None:
            path = Path(frame.f_code.co_filename)
            if path.parent == LANG:
                reached.add((path.name, frame.f_lineno))
            frame = frame.f_back

    class Noted(Reporter):
        def error(self, span: Span, message: str, hint: str = "") -> None:
            note()
            super().error(span, message, hint)

    class NotedMixup(quantities.Mixup):
        def __init__(self, message: str, hint: str = "") -> None:
            note()
            super().__init__(message, hint)

    monkeypatch.setattr("sssgen.lang.check.Reporter", Noted)
    monkeypatch.setattr("sssgen.lang.parser.Reporter", Noted)
    monkeypatch.setattr("sssgen.lang.quantities.Mixup", NotedMixup)
    for source in (*CASES.values(), f"float x = {'(' * 500}", f"uniform float x = 1.0{'+1.0' * 2000};", unary(500)):
        errors_of(source)
    missed = [f"{name}:{first}" for name, first, last in sites() if not reached & {(name, n) for n in range(first, last + 1)}]
    assert missed == []


def sites() -> Iterator[tuple[str, int, int]]:
    """The calls in the front end that report an error: file, first and last line."""
    for path in sorted(LANG.glob("*.py")):
        if path.name in ("loader.py", "docs.py"):  # they have no text to point at; the tests of the loader look there
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call):
                called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
                if called in ("fail", "error", "unknown", "Mixup"):
                    yield path.name, node.lineno, node.end_lineno or node.lineno


def test_snapshots_have_cases() -> None:
    folder = Path(__file__).parent / "snapshots" / "errors"
    assert {path.stem for path in folder.glob("*.txt")} == set(CASES)


def test_conversions_that_are_named_exist() -> None:
    """What a hint names is in the library."""
    library = LANG.parent / "techniques"
    text = "\n".join(path.read_text("utf-8") for path in library.rglob("*.sss"))
    for name in quantities._CONVERSIONS.values():
        assert f"{name}(" in text
    for source, target in quantities._FRAMES:
        assert f"{target}_direction {target}_from_{source}({source}_direction " in text


# Nothing brings it down


def unary(count: int) -> str:
    return f"float f(float x) {{ return {'- ' * count}x; }}"


DEEP = 10_000
HOSTILE = {
    "brackets": f"float f() {{ return {'(' * DEEP}1.0{')' * DEEP}; }}",
    "open brackets": f"float f() {{ return {'(' * DEEP}",
    "braces": f"void f() {'{' * DEEP}{'}' * DEEP}",
    "open braces": f"void f() {'{' * DEEP}",
    "closing braces": "}" * DEEP,
    "indices": f"float f(float x[2]) {{ return x{'[0]' * DEEP}; }}",
    "open indices": f"float f(float x[2]) {{ return x{'[' * DEEP}",
    "negations": unary(DEEP),
    "nots": f"bool f(bool x) {{ return {'!' * DEEP}x; }}",
    "else if": f"float f(float x) {{ if (x > 0.0) return x;{' else if (x > 1.0) return x;' * DEEP} return x; }}",
    "ifs": f"void f(bool x) {{ {'if (x) ' * DEEP} x = false; }}",
    "loops": f"void f(int n) {{ {'while (n > 0) ' * DEEP} n--; }}",
    "sum": f"float f(float a) {{ return a{'+a' * DEEP}; }}",
    "choices": f"float f(bool a) {{ return {'a ? 1.0 : ' * DEEP}2.0; }}",
    "choices in choices": f"float f(bool a) {{ return {'a ? ' * DEEP}2.0{' : 1.0' * DEEP}; }}",
    "calls": f"float f(float a) {{ return {'abs(' * DEEP}a{')' * DEEP}; }}",
    "members": f"vec2 f(vec2 a) {{ return a{'.xy' * DEEP}; }}",
    "ifs around brackets": f"void f(bool x) {{ {'if (x) ' * 150}x = {'!' * 150}x; }}",
    "line of sums": f"float f(float a) {{ return a{'+a' * 500_000}; }}",
    "line of digits": f"int f() {{ return {'1' * 1_000_000}; }}",
    "line of digits and a point": f"float f() {{ return {'1' * 1_000_000}.0; }}",
    "line of a name": f"float {'a' * 1_000_000}() {{ return zork; }}",
    "line of a comment": f"/*{' *' * 500_000}",
    "line of a text": f'"{"a" * 1_000_000}',
    "line of zeros": "\0" * 1_000_000,
    "text of errors": "float f() { return x; }\n" * 2_000,
    "text of syntax errors": "float f() { return 1.0 }\n" * 20_000,
    "unknown names": f"void f() {{ {' '.join(f'float v{n};' for n in range(2_000))} {'v = zork;' * 300} }}",
    "binary": random.Random(1).randbytes(1_000_000).decode("latin-1"),
    "printable": "".join(random.Random(2).choices([chr(code) for code in range(32, 127)], k=1_000_000)),
    "words": " ".join(random.Random(3).choices("float x ( ) { } ; + if for 1.0 vec3 in , [ ] = uniform".split(), k=100_000)),
    "line ends": "\r\n" * 100_000 + "\x0c\x0b\x85\u2028zork",
    "surrogates": "float f() { return \ud800; }",
    "hint of digits": f"uniform float x : hint_range(0.0, {'9' * 400});\nuniform float y : hint_range(0, 0x{'f' * 400});",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_text(name: str) -> None:
    """It ends within a second or so (of the processor's: the machine may be busy), with errors that can be shown."""
    check(parse("float f() { return 1.0; }", ""), "")  # the grammar's tables are not what is measured
    start = time.process_time()
    error = errors_of(HOSTILE[name])
    assert time.process_time() - start < 3.0
    assert len(str(error)) < 100_000
    str(error).encode()
    assert all(line.isprintable() for line in str(error).split("\n"))


@pytest.mark.parametrize("piece", ["(", "abs(", "- ", "if (b) ", "{", "b ? x : ", "a[0]+", "while (i < 3) "])
def test_as_deep_as_is_allowed(piece: str) -> None:
    """Just below the limit everything works: the checker, the verifier, with the stack that a caller has used."""
    close = {"(": ")", "abs(": ")", "{": "}"}.get(piece, "")
    for depth in range(MAX_DEPTH, 20, -1):
        deep = f"{piece * depth}x{close * depth}" if piece not in ("if (b) ", "{", "while (i < 3) ") else "x"
        body = f"{piece * depth} x = 1.0; {close * depth}" if deep == "x" and "while" not in piece else ""
        source = f"float f(bool b, float x, float a[1], int i) {{ {body} return {deep}; }}"
        try:
            module = check(parse(source, "deep.sss"), source)
        except SssgenError as error:
            assert "nested more than" in str(error)  # noqa: PT017
            continue
        assert verify(module) == []
        assert depth >= MAX_DEPTH / 4
        return


def test_text_cut_anywhere() -> None:
    """Whatever is left of a file gives a module or errors."""
    for end in range(0, len(SAMPLE), 5):
        try:
            check(parse(SAMPLE[:end], "cut.sss"), SAMPLE[:end])
        except SssgenError as error:
            assert all(1 <= one.span.line <= SAMPLE.count("\n") + 1 for one in error.diagnostics)  # noqa: PT017


@settings(max_examples=300)
@given(st.data())
def test_text_with_a_piece_replaced(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(SAMPLE)))
    end = data.draw(st.integers(start, min(len(SAMPLE), start + 30)))
    pieces = ["", "(", ")", "{", "}", "[", "]", ".", ";", ",", "=", "float", "1", "1.0", "0x", "u", '"', "/*", "//", "#", "é", "\0"]
    text = SAMPLE[:start] + data.draw(st.sampled_from(pieces)) + SAMPLE[end:]
    try:
        module = check(parse(text, "changed.sss"), text)
    except SssgenError as error:
        str(error)
    else:
        assert verify(module) == []


def test_as_many_errors_as_anyone_reads() -> None:
    source = "float f() { return x; }\n" * 500
    error = errors_of(source)
    assert len(error.diagnostics) == diagnostics.MAX_ERRORS + 1
    assert error.diagnostics[-1].message == "more than 100 errors; the rest is not looked at"


# How errors are shown


def test_control_characters_are_harmless() -> None:
    source = "float f() { return \x1b[31mx\x07\u202e\x9b; }"
    shown = str(errors_of(source, "a\x1b[2Jb.sss"))
    assert "\x1b" not in shown
    assert "float f() { return ␛[31mx␇\ufffd\ufffd; }" in shown
    assert "a␛[2Jb.sss:1:20" in shown


def test_carets_stand_below() -> None:
    error = errors_of("float f() {\n\treturn 1.0 + zork;\n}")
    line, caret = str(error).split("\n")[2:4]
    assert caret.index("^") == line.index("zork")
    assert caret.count("^") == len("zork")


def test_line_ends_are_counted_as_editors_do() -> None:
    """Form feeds and the like are no line ends."""
    error = errors_of("// \x0c \x0b \u2028\r\nfloat f() { return zork; }\r\n")
    assert error.diagnostics[0].span[1:3] == (2, 20)
    assert error.diagnostics[0].source_line == "float f() { return zork; }"


def test_diagnostic_without_a_place() -> None:
    assert Diagnostic("warning", "what", hint="do").render() == "warning: what\n  help: do"
    assert Diagnostic("error", "what", Span("a.toml", 0, 0, 0, 0)).render() == "error: what\n  --> a.toml"


def test_did_you_mean() -> None:
    assert did_you_mean("densty", ["density", "distance"]) == "did you mean 'density'?"
    assert did_you_mean("N_WORLD", ["n_world"]) == "did you mean 'n_world'?"
    assert did_you_mean("zork", ["density"]) == ""
    assert did_you_mean("a" * 1000, ["a" * 999]) == ""
