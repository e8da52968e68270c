"""The IR's text form, and that everything the project ships is valid."""

from __future__ import annotations

from contextlib import suppress
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from as_source import as_source
from ir_sample import SAMPLE, SAMPLE_MODULE, exact, of_source
from slow_cases import some_slow
from snapshot import check_snapshot
from sssgen.ir import nodes as ir
from sssgen.ir import text as text_form
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.signatures import instantiate, parse
from sssgen.ir.text import TextError, print_module, read_module
from sssgen.ir.types import FLOAT
from sssgen.ir.verify import verify
from sssgen.lang.loader import load_file
from sssgen.lang.polyfills import polyfill
from strategies import modules, placed_modules

NOWHERE = ir.NOWHERE
LIBRARY = Path(str(files("sssgen"))) / "techniques"


# Text


def test_sample_text() -> None:
    """The text as people see it."""
    check_snapshot("ir/sample.txt", print_module(SAMPLE_MODULE))
    check_snapshot("ir/sample_without_spans.txt", print_module(SAMPLE_MODULE, spans=False))
    assert exact(read_module(print_module(SAMPLE_MODULE))) == exact(SAMPLE_MODULE)


@settings(max_examples=100)
@given(placed_modules())
def test_text_reads_back(module: ir.Module) -> None:
    text = print_module(module)
    again = read_module(text)
    assert exact(again) == exact(module)
    assert print_module(again) == text
    bare = print_module(module, spans=False)
    assert print_module(read_module(bare)) == bare


@pytest.mark.slow
@settings(max_examples=100)
@given(modules())
def test_the_front_end_reproduces_a_written_module(module: ir.Module) -> None:
    checked = of_source(as_source(module))
    assert print_module(checked, spans=False) == print_module(module)
    assert exact(read_module(print_module(checked))) == exact(checked)
    assert verify(checked) == []


def test_docstring_example() -> None:
    """The example in `ir.text` is the text of a module."""
    lines = (text_form.__doc__ or "").split("\n")
    example = "\n".join(line[4:] for line in lines if line.startswith("    ")) + "\n"
    assert print_module(read_module(example)) == example


@pytest.mark.parametrize("value", [0.0, -0.0, 1e-45, 3.4028234663852886e38, 0.1, 1e22, 5e-324, 1 / 3])
def test_floats_are_exact(value: float) -> None:
    constant = ir.Constant("x", FLOAT, ir.Literal(FLOAT, value, NOWHERE), NOWHERE)
    module = ir.Module(constants=(constant,))
    assert exact(read_module(print_module(module))) == exact(module)


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan")])
def test_non_finite_constants_have_no_text(value: float) -> None:
    constant = ir.Constant("x", FLOAT, ir.Literal(FLOAT, value, NOWHERE), NOWHERE)
    with pytest.raises(ValueError, match="has no text"):
        print_module(ir.Module(constants=(constant,)))


def test_strings_are_escaped() -> None:
    doc = 'a "quoted" \\ back\n\n  \t\x00\x1b[31m\u2028\ud800é☃'
    module = ir.Module(uniforms=(ir.Uniform("x", FLOAT, (0.0,), (("alias", (doc,)),), "", doc, NOWHERE),))
    text = print_module(module)
    assert read_module(text) == module
    assert all(char.isprintable() or char == "\n" for char in text)


def test_without_spans_texts_are_equal() -> None:
    """The same program at other places has the same text without spans."""
    moved = of_source("\n\n  " + SAMPLE.replace("    ", "\t"))
    assert print_module(moved) != print_module(SAMPLE_MODULE)
    assert print_module(moved, spans=False) == print_module(SAMPLE_MODULE, spans=False)


MALFORMED = {
    "§": "1:1: '§' is unexpected here",
    "what x": "1:1: a declaration is expected here, not 'what'",
    "file 0 wax": "1:8: a text is expected here, not 'wax'",
    "const@0:1:1-2 float x = 1.0": "1:6: there is no file 0",
    "const wax x = 1.0": "1:7: there is no type 'wax'",
    "const float x 1.0": "1:15: '=' is expected here, not '1.0'",
    "const float x = 1e999": "1:17: 1e999 is not a number",
    "const uint x = -1u": "1:16: -1u is not a number",
    "const uint x = 1.5u": "1:16: 1.5u is not a number",
    "const float x = y": "1:17: 'y' is not declared",
    "const float x = $y": "1:17: 'y' is not declared",
    "const float x = $f(1.0)": "1:23: 'f(float)' is not declared",
    "const float x = sin(1)": "1:22: sin is not defined for these operands",
    "const float x = (1.0 + 1)": "1:24: '+' is not defined for these operands",
    "const float x = (1.0 $ 1)": "1:22: '$' is unexpected here",
    "const float x = (1.0 ? 2.0 : 3.0)": "1:30: '?' is not defined for these operands",
    "const float x = 1.0.x": "1:21: .x is not defined for these operands",
    "const float x = vec2{1.0}[1.0]": "1:27: an index is not defined for these operands",
    "const float x = ;": "1:17: an expression is expected here, not ';'",
    "const float x = (1.0": "1:21: a op is expected here, not ''",
    "const float x = vec2{1.0 2.0}": "1:26: ',' is expected here, not '2.0'",
    "uniform float x = (1e999)": "1:20: 1e999 is not finite",
    'doc "\\110000;" const float x = 1.0': "1:5: there is no character 110000",
    "struct S { float x }": "1:20: ';' is expected here, not '}'",
    "function void f() {": "1:20: a '}' is missing",
    "function void f() { what; }": "1:21: a statement is expected here, not 'what'",
    "function void f(in float x) { set x == 1.0; }": "1:37: an assignment is expected here, not '=='",
    "function void f(in float x) { set x = 1.0 }": "1:43: ';' is expected here, not '}'",
    "function void $f() slot": "1:15: '$' is not part of a declared name",
    "\n\nfunction void f(\n  float x) slot": "4:9: there is no type 'x'",
}


@pytest.mark.parametrize("text", MALFORMED)
def test_malformed_text(text: str) -> None:
    with pytest.raises(TextError) as error:
        read_module(text)
    assert str(error.value) == MALFORMED[text]


def test_text_cut_anywhere() -> None:
    """Any part of a text gives a module or a TextError."""
    text = print_module(SAMPLE_MODULE)
    for end in range(0, len(text), 7):
        try:
            read_module(text[:end])
        except TextError as error:
            assert 1 <= error.line <= text.count("\n") + 1


@settings(max_examples=300)
@given(st.data())
def test_text_with_a_piece_replaced(data: st.DataObject) -> None:
    text = print_module(SAMPLE_MODULE, spans=False)
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 20)))
    pieces = ["", "(", ")", "{", "}", "[", ".x", "1", "-1u", "$", "float", "@0:1:1-2", '"', "\x00"]
    piece = data.draw(st.sampled_from(pieces))
    with suppress(TextError):
        verify(read_module(text[:start] + piece + text[end:]))


@pytest.mark.parametrize("piece", some_slow(["(", "(- ", "[", "{", "sin(", "vec2{"], "(- ", "vec2{"))
def test_deep_text(piece: str) -> None:
    with pytest.raises(TextError):
        read_module(f"const float x = {piece * 100_000}")
    with pytest.raises(TextError):
        read_module("function void f() { " + "while true do { " * 100_000)


# What the project ships


def test_library_is_valid() -> None:
    """Every technique and shared file of the library verifies and reads back."""
    paths = sorted(LIBRARY.rglob("*.sss"))
    assert paths
    for path in paths:
        module = load_file(path, [LIBRARY])
        assert verify(module) == [], path
        assert exact(read_module(print_module(module))) == exact(ir.Module(*module)), path


def test_polyfills_are_valid() -> None:
    result = 0
    for name, row in BUILTINS.items():
        for signature in row.signatures if row.polyfill else ():
            for size in (1, 2, 3, 4):
                types = [instantiate(type_name, size) for type_name in parse(signature)[1:]]
                try:
                    module = polyfill(name, [type_ for type_ in types if type_ is not None])
                except KeyError:
                    continue
                assert verify(module, linked=True) == [], name
                result += 1
    assert result > 50
