"""The errors of the language: their messages, several in one run, and that no input crashes the front end."""

from __future__ import annotations

import ast
import inspect
import random
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import glsl_errors
from folders import SNAPSHOTS
from ir_sample import SAMPLE
from snapshot import check_snapshot
from sssgen import lang
from sssgen.ir.nodes import Span
from sssgen.ir.verify import verify
from sssgen.lang.check import quantities
from sssgen.lang.check.module_checker import check
from sssgen.lang.check.suggested_conversions import suggested_conversions
from sssgen.lang.syntax.parser import MAX_DEPTH, parse
from sssgen.support import diagnostics
from sssgen.support.diagnostics import Diagnostic, Reporter, SssgenError, did_you_mean
from watchdog import bounded

LANG = Path(inspect.getfile(lang)).parent


def errors_of(source: str, file: str = "wax.sss") -> SssgenError:
    with pytest.raises(SssgenError) as raised:
        check(parse(source, file), source)
    return raised.value


AROUND = """\
struct Body { float size; thickness depth; };
const int N = 3;
uniform float density = 0.5;
uniform vec2 scale;
uniform sampler2D map : holds(thinness);
uniform sampler3D volume;
float solid(float x, vec2 y) { return x; }
float many(float x) { return x; }
float many(int x) { return 1.0; }
void give(out float x, inout world_position q) { x = 1.0; }
void measure(out thickness d) { d = thickness(1.0); }
void wrong(inout float x, int i, vec3 v, mat2 m, bool b, Body body, world_position P, world_direction N_world,
           object_direction N_object, thickness d, thinness thin, uv_position uv, float list[3]) {
%s
}
"""
"""What stands around the statements of a case, so that they have something of everything."""


def read_cases() -> dict[str, str]:
    """The sources of errors_language.txt by their names."""
    text = Path(__file__).with_name("errors_language.txt").read_text("utf-8")
    cases = {}
    for section in re.split(r"^=== ", text, flags=re.MULTILINE)[1:]:
        title, _, source = section.rstrip("\n").partition("\n")
        name, _, kind = title.partition(": ")
        cases[name] = AROUND % source if kind == "statements" else source
    return cases


CASES = read_cases()


@pytest.mark.parametrize("name", CASES)
def test_error_text(name: str) -> None:
    error = errors_of(CASES[name])
    check_snapshot(f"errors/{name}.txt", f"{error}\n")
    for diagnostic in error.diagnostics:
        assert diagnostic.span.file == "wax.sss"
        assert 1 <= diagnostic.span.line <= CASES[name].count("\n") + 1
        assert diagnostic.as_json()["line"] == diagnostic.span.line


def test_every_error_has_a_snapshot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each place in the front end that reports an error is reached by one of the cases above, or of plain GLSL's."""
    reached: set[tuple[str, int]] = set()

    def note() -> None:
        frame = inspect.currentframe()
        while frame is not None:
            path = Path(frame.f_code.co_filename)
            if path.is_relative_to(LANG):
                reached.add((path.name, frame.f_lineno))
            frame = frame.f_back

    def recorded(method: Callable[..., None]) -> Callable[..., None]:
        def recording(*arguments: Any) -> None:
            note()
            method(*arguments)

        return recording

    for owner, name in ((Reporter, "error"), (quantities.Mixup, "__init__")):
        monkeypatch.setattr(owner, name, recorded(getattr(owner, name)))
    for source in (*CASES.values(), f"float x = {'(' * 500}", f"uniform float x = 1.0{'+1.0' * 2000};", unary(500)):
        errors_of(source)
    for source in (*glsl_errors.CASES.values(), *glsl_errors.LONG.values()):
        glsl_errors.errors_of(source)
    missed = [
        f"{name}:{first}" for name, first, last in sites() if not reached & {(name, n) for n in range(first, last + 1)}
    ]
    assert missed == []


def sites() -> Iterator[tuple[str, int, int]]:
    """The calls in the front end that report an error: file, first and last line."""
    for path in sorted(LANG.rglob("*.py")):
        if path.name in ("loader.py", "docs.py"):  # they have no text to point at; the tests of the loader look there
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call):
                called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
                if called in ("fail", "error", "unknown", "Mixup"):
                    yield path.name, node.lineno, node.end_lineno or node.lineno


def test_snapshots_have_cases() -> None:
    folder = SNAPSHOTS / "errors"
    assert {path.stem for path in folder.glob("*.txt")} == set(CASES)


def test_suggested_conversions_exist() -> None:
    """What a hint names is in the library."""
    library = LANG.parent / "techniques"
    text = "\n".join(path.read_text("utf-8") for path in library.rglob("*.sss"))
    for name in suggested_conversions().values():
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
    "words": " ".join(
        random.Random(3).choices(
            [
                "float",
                "x",
                "(",
                ")",
                "{",
                "}",
                ";",
                "+",
                "if",
                "for",
                "1.0",
                "vec3",
                "in",
                ",",
                "[",
                "]",
                "=",
                "uniform",
            ],
            k=100_000,
        )
    ),
    "line ends": "\r\n" * 100_000 + "\x0c\x0b\x85\u2028zork",
    "surrogates": "float f() { return \ud800; }",
    "hint of digits": f"uniform float x : hint_range(0.0, {'9' * 400});",
    "hint of hexadecimal digits": f"uniform float x : hint_range(0, 0x{'f' * 400});",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_text(name: str) -> None:
    """It ends soon, with errors that can be shown."""
    check(parse("float f() { return 1.0; }", ""), "")  # the grammar's tables are loaded before the measurement
    with bounded():
        error = errors_of(HOSTILE[name])
    assert len(str(error)) < 100_000
    str(error).encode()
    assert all(line.isprintable() for line in str(error).split("\n"))


@pytest.mark.parametrize("piece", ["(", "abs(", "- ", "if (b) ", "{", "b ? x : ", "a[0]+", "while (i < 3) "])
def test_nesting_up_to_the_limit_is_accepted(piece: str) -> None:
    """Just below the limit everything works: the checker, the verifier, with the stack that a caller has used."""
    close = {"(": ")", "abs(": ")", "{": "}"}.get(piece, "")
    for depth in range(MAX_DEPTH, 20, -1):
        deep = f"{piece * depth}x{close * depth}" if piece not in ("if (b) ", "{", "while (i < 3) ") else "x"
        body = f"{piece * depth} x = 1.0; {close * depth}" if deep == "x" and "while" not in piece else ""
        source = f"float f(bool b, float x, float a[1], int i) {{ {body} return {deep}; }}"
        try:
            module = check(parse(source, "deep.sss"), source)
        except SssgenError as error:
            assert "nested more than" in str(error)
            continue
        assert verify(module) == []
        assert depth >= MAX_DEPTH / 4
        return


def test_text_cut_anywhere() -> None:
    """Any part of a file gives a module or errors."""
    for end in range(0, len(SAMPLE), 5):
        try:
            check(parse(SAMPLE[:end], "cut.sss"), SAMPLE[:end])
        except SssgenError as error:
            assert all(1 <= one.span.line <= SAMPLE.count("\n") + 1 for one in error.diagnostics)


@settings(max_examples=300)
@given(st.data())
def test_text_with_a_piece_replaced(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(SAMPLE)))
    end = data.draw(st.integers(start, min(len(SAMPLE), start + 30)))
    pieces = [
        "",
        "(",
        ")",
        "{",
        "}",
        "[",
        "]",
        ".",
        ";",
        ",",
        "=",
        "float",
        "1",
        "1.0",
        "0x",
        "u",
        '"',
        "/*",
        "//",
        "#",
        "é",
        "\0",
    ]
    text = SAMPLE[:start] + data.draw(st.sampled_from(pieces)) + SAMPLE[end:]
    try:
        module = check(parse(text, "changed.sss"), text)
    except SssgenError as error:
        str(error)
    else:
        assert verify(module) == []


def test_the_number_of_errors_is_limited() -> None:
    source = "float f() { return x; }\n" * 500
    error = errors_of(source)
    assert len(error.diagnostics) == diagnostics.MAX_ERRORS + 1
    assert error.diagnostics[-1].message == "more than 100 errors; the others are not reported"


# How errors are shown


def test_control_characters_are_harmless() -> None:
    source = "float f() { return \x1b[31mx\x07\u202e\x9b; }"
    shown = str(errors_of(source, "a\x1b[2Jb.sss"))
    assert "\x1b" not in shown
    assert "float f() { return ␛[31mx␇\ufffd\ufffd; }" in shown
    assert "a␛[2Jb.sss:1:20" in shown


def test_carets_mark_the_token() -> None:
    error = errors_of("float f() {\n\treturn 1.0 + zork;\n}")
    line, caret = str(error).split("\n")[2:4]
    assert caret.index("^") == line.index("zork")
    assert caret.count("^") == len("zork")


def test_lines_are_counted_as_in_editors() -> None:
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
    assert did_you_mean("", ["density"]) == ""


def test_did_you_mean_prefers_names_that_begin_with_the_word() -> None:
    assert did_you_mean("glsl", ["wgsl", "glsl-330", "hlsl", "glsl-es-300"]) == (
        "did you mean 'glsl-330' or 'glsl-es-300'?"
    )
    assert did_you_mean("uni", [f"unit{number}" for number in range(9)]).count("unit") == 5
    assert did_you_mean("un", ["unity", "uno"]) == "did you mean 'uno'?"
    assert did_you_mean("glsk", ["glsk_table", "glsl"]) == "did you mean 'glsk_table'?"


def test_did_you_mean_prefers_names_with_the_word_to_aliases() -> None:
    assert did_you_mean("roughness", ["surface_roughness", "rough"], ["roughnessFactor"]) == (
        "did you mean 'surface_roughness'?"
    )
    assert did_you_mean("roughness", ["gloss"], ["roughnessFactor"]) == "did you mean 'roughnessFactor'?"
    assert did_you_mean("color", ["base_color", "colour"]) == "did you mean 'colour'?"
