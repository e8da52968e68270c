"""Plain GLSL that is refused: the cases of tests/lang/errors_glsl.txt, and longer ones."""

from __future__ import annotations

import re

import pytest

from folders import TESTS
from sssgen.lang import plain_glsl as glsl
from sssgen.lang.check.switch_cases import MAX_STATEMENTS
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.support.diagnostics import SssgenError

FILE = "errors_glsl.glsl"


def read_cases() -> dict[str, str]:
    """The sources of errors_glsl.txt by their names."""
    text = (TESTS / "lang" / "errors_glsl.txt").read_text("utf-8")
    sections = [section.partition("\n") for section in re.split(r"^=== ", text, flags=re.MULTILINE)[1:]]
    return {name: source.rstrip("\n") + "\n" for name, _, source in sections}


CASES = read_cases()
_FALLING = "".join(f"case {number}: x += 1.0;\n" for number in range(int((2 * MAX_STATEMENTS) ** 0.5) + 2))
LONG = {
    "fall through to too many statements": f"void f(int n, float x) {{ switch (n) {{\n{_FALLING}}} }}\n",
    "conditions nested more than": "#if 1\n" * 10_000,
    "macros nest more than": "\n".join(f"#define A{n}(x) A{n + 1}(x)" for n in range(500)) + "\nA0(1)\n",
    "this macro expands to more than": "\n".join(f"#define A{n} A{n + 1} A{n + 1}" for n in range(60)) + "\nA0\n",
    "a name has at most": f"float {'x' * 1025};\n",
    "'##' makes a token of more than": "#define J(a, b) a ## b\n#define D(a) J(a, a)\nD(" + "x" * 100_000 + ")\n",
}
"""The errors of texts that are too long for the file of cases."""


def errors_of(source: str) -> SssgenError:
    """The errors of plain GLSL. The text can include itself by its name."""
    original = glsl._Finder.find

    def find(finder: glsl._Finder, name: str, place: glsl.Span, angled: bool) -> tuple[str, str]:
        return (FILE, source) if name == FILE else original(finder, name, place, angled)

    with pytest.MonkeyPatch.context() as patch, pytest.raises(SssgenError) as raised:
        patch.setattr(glsl._Finder, "find", find)
        load_glsl_text(source, FILE)
    return raised.value
