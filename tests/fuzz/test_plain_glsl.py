"""Plain GLSL that is cut, nested deeply, or has endless macros: an error with its place, after bounded work."""

from __future__ import annotations

from pathlib import Path

import pytest

from front_ends import CORPUS
from sssgen.analyse.verify.inline_includes import expand
from sssgen.lang.plain_glsl import load_glsl, load_glsl_text
from sssgen.lang.syntax.lexer import scan
from sssgen.support.diagnostics import SssgenError
from watchdog import bounded

DEEP = 10_000
CUT = ("switches.glsl", "side_effects.glsl", "structs.glsl", "uniforms.frag", "macros.glsl")


def refused(text: str) -> SssgenError | None:
    """The messages for a text, each with a place in it, within the time; None where it is accepted."""
    load_glsl_text("float f() { return 1.0; }", "seed.glsl")  # the grammar's tables are loaded before the measurement
    try:
        with bounded():
            load_glsl_text(text, "fuzzed.glsl")
        return None
    except SssgenError as error:
        for result in error.diagnostics:
            assert result.span.file == "fuzzed.glsl"
            assert 1 <= result.span.line <= text.count("\n") + 1
        assert len(str(error)) < 200_000
        return error


def within(statement: str) -> str:
    return f"float f(float x, bool b, int n) {{ {statement} return x; }}\n"


REFUSED = {
    "brackets": within(f"x = {'(' * DEEP}1.0{')' * DEEP};"),
    "open brackets": within("x = " + "(" * DEEP),
    "blocks": within("{" * DEEP + "}" * DEEP),
    "open blocks": within("{" * DEEP),
    "indices": f"float f(float a[3]) {{ return a{'[int(a' * DEEP}[0]{')]' * DEEP}; }}",
    "open indices": within("x = a" + "[" * DEEP),
    "#ifs": "#if 1\n" * DEEP + "#endif\n" * DEEP,
    "#ifs switched off": "#if 0\n" * DEEP + "#endif\n" * DEEP,
    "brackets of a condition": f"#if {'(' * DEEP}1{')' * DEEP}\n#endif\n",
    "choices of a condition": f"#if {'1 ? 1 : ' * DEEP}1\n#endif\n",
    "calls": within(f"x = {'abs(' * DEEP}x{')' * DEEP};"),
    "choices": within(f"x = {'b ? x : ' * DEEP}x;"),
    "choices with effects": within(f"x = {'b ? x++ : ' * DEEP}x;"),
    "signs": within(f"x = {'- ' * DEEP}x;"),
    "negations": within(f"b = {'!' * DEEP}b;"),
    "else ifs": within("if (b) x = 1.0; " + "else if (b) x = 1.0; " * DEEP),
    "ifs": within("if (b) " * DEEP + "x = 1.0;"),
    "loops": within("while (b) " * DEEP + "x = 1.0;"),
    "do loops": within("do " * DEEP + "x = 1.0;" + " while (b);" * DEEP),
    "switches": within("switch (n) { case 0: " * DEEP + "}" * DEEP),
    "braces": within(f"float a[] = {'{' * DEEP}1.0{'}' * DEEP};"),
    "assignments": within(f"x = {'x = ' * DEEP}1.0;"),
    "structs": "struct S { " * DEEP + "float x; " + "} s; " * DEEP,
    "layouts": "layout(location = " + "(" * DEEP + "1" + ")" * DEEP + ") in vec2 uv;",
    "a bomb of macros": "".join(f"#define A{n} A{n + 1} A{n + 1}\n" for n in range(100)) + "A0\n",
    "a bomb of arguments": "#define D(x) x + x\n" + within(f"x = {'D(' * 40}x{')' * 40};"),
    "macros in macros": "".join(f"#define A{n}(x) A{n + 1}(x)\n" for n in range(DEEP)) + "A0(1)\n",
    "arguments in arguments": "#define I(x) x\n" + within(f"x = {'I(' * DEEP}x{')' * DEEP};"),
    "an argument that is not closed": "#define I(x) x\n" + within("x = I(" + "x + " * DEEP),
    "a word that doubles": "#define J(a, b) a ## b\n#define D(a) J(a, a)\n" + "D(" * 60 + "x" + ")" * 60,
    "a line of letters": "a" * (1 << 20),
    "a line of digits": within("x = " + "9" * (1 << 20) + ";"),
    "a line of a sum": within("x = x" + " + x" * (1 << 18) + ";"),
    "a line of marks": "#" * (1 << 20),
    "words without end": within("x " * (1 << 19)),
    "zero bytes": "\0" * 1000,
    "what is no text": bytes(range(256)).decode("latin-1") * 100,
    "cases that fall": within("switch (n) { " + "".join(f"case {n}: x += 1.0; " for n in range(2000)) + "}"),
    "a huge array": within("float a[2147483647];"),
}
TAKEN = {
    "comments": "/* " * DEEP + "*/ float x;" + "//" * DEEP,
    "signs of a condition": f"#if {'- ' * DEEP}1\n#endif\n",
    "a line of commas": within("x = 1.0" + ", x" * (1 << 18) + ";"),
    "continued lines": "float x" + "\\\n" * DEEP + ";",
    "many declarators": "float " + ", ".join(f"a{n}" for n in range(2000)) + ";",
    "empty statements": within(";" * DEEP),
    "a huge literal": within("x = 1" + "0" * 400 + ".0;"),
}


@pytest.mark.parametrize("title", REFUSED)
def test_invalid_programs_are_refused(title: str) -> None:
    assert refused(REFUSED[title]) is not None


@pytest.mark.parametrize("title", TAKEN)
def test_long_valid_programs_are_accepted(title: str) -> None:
    error = refused(TAKEN[title])
    assert error is None, error


@pytest.mark.parametrize("name", CUT)
def test_files_cut_between_words(name: str) -> None:
    """Whatever is left of a file is taken or refused, at a line that it has."""
    text = expand((CORPUS / name).read_text("utf-8"), CORPUS / name)
    code = "\n".join("" if line.startswith("#") else line for line in text.split("\n"))
    lines = text.split("\n")
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line) + 1)
    ends = {starts[word.span.end_line - 1] + word.span.end_column - 1 for word in scan(code, name)[0]}
    for end in sorted(ends):
        refused(text[:end])


def test_files_that_include_each_other(tmp_path: Path) -> None:
    (tmp_path / "a.glsl").write_text('#include "b.glsl"\n', encoding="utf-8")
    (tmp_path / "b.glsl").write_text('\n#include "a.glsl"\n', encoding="utf-8")
    with pytest.raises(SssgenError, match=r"includes itself: .*a\.glsl") as raised:
        load_glsl(tmp_path / "a.glsl", "a.glsl")
    assert raised.value.diagnostics[0].span.line


def test_files_that_double_at_each_include(tmp_path: Path) -> None:
    """Each includes the next one twice."""
    for number in range(40):
        text = f'#include "{number + 1}.glsl"\n' * 2 if number < 39 else "\n"
        (tmp_path / f"{number}.glsl").write_text(text, encoding="utf-8")
    with bounded(), pytest.raises(SssgenError, match="too much is included"):
        load_glsl(tmp_path / "0.glsl", "0.glsl")
