"""The limits of the preprocessor: endless and hostile texts are errors after a bounded amount of work."""

from __future__ import annotations

import pytest

from preprocessed import faults, run, words
from sssgen.lang.preprocess.preprocessor import MAX_CONDITIONALS
from sssgen.support.diagnostics import SssgenError
from watchdog import bounded

DOUBLED = "".join(f"#define a{n} a{n - 1} a{n - 1}\n" for n in range(1, 21))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("#define a0 x\n" + DOUBLED + "b a20", "this macro expands to more than 100000 tokens"),
        ("#define a0\n" + DOUBLED + "b a20", "this macro expands to more than 100000 tokens"),
        ("#define f(x) x x\nb " + "f(" * 20 + "1" + ")" * 20, "this macro expands to more than 100000 tokens"),
        ("#define f(x) x\nb " + "f(" * 200 + "1" + ")" * 200, "macros nest more than 100 levels deep"),
        ("#define a0 x\n" + "".join(f"#define a{n} a{n - 1}\n" for n in range(1, 500)) + "b a499",
         "macros nest more than 100 levels deep"),
        ("#define a0 x\n" + DOUBLED + "\n" + "a14 " * 100, "macros expand to more than 1000000 tokens"),
        ("#define a0 1\n" + DOUBLED + "#if a20\n#endif", "this macro expands to more than 100000 tokens"),
        ("#define d(a) a ## a\n#define e(a) d(a)\nb " + "e(" * 40 + "x" + ")" * 40,
         "'##' makes a token of more than 1024 characters"),
        ("#if " + "(" * 1000 + "1" + ")" * 1000 + "\n#endif", "this expression nests more than 100 levels deep"),
        ("#if 1" + " ? 1 : 1" * 1000 + "\n#endif", "this expression nests more than 100 levels deep"),
        ("#if 1\n" * 1000, f"conditions nested more than {MAX_CONDITIONALS} deep"),
    ],
)  # fmt: skip
def test_exponential_expansion_is_refused(text: str, message: str) -> None:
    assert message in [fault[0] for fault in faults(text)]


def test_nesting_below_the_limit_is_accepted() -> None:
    deep = 95
    assert words("#if 1\n" * 200 + "a" + "\n#endif" * 200) == "a"
    assert words(f"#if {'(' * deep}1{')' * deep}\na\n#endif") == "a"
    assert words(f"#if {'!' * 1000}1 {'+ 1' * 10000}\na\n#endif") == "a"
    assert words(f"#define f(x) x +\n{'f(' * deep}1{')' * deep}") == "1" + " +" * deep


def test_includes_that_multiply_are_refused() -> None:
    files = {f"f{n}": f'#include "f{n + 1}"\n#include "f{n + 1}"\n' for n in range(40)} | {"f40": ""}
    assert faults('#include "f0"', files)[0][0] == "too much is included"
    files = {"long": "//" + "x" * 3_000_000}
    assert faults('#include "long"\n' * 10, files)[0][0] == "too much is included"


@pytest.mark.parametrize(
    "text",
    [
        "#define A 1 + " + "x + " * 250_000 + "\nA",
        "#define F(x) x\nF(" + "(" * 300_000,
        "#define F(x) x\n" + "F(" * 300_000,
        "/*\n*/" * 200_000,
        "/**/" * 200_000 + "#" + "/**/" * 200_000,
        "#\n" * 300_000,
        "#if 0\n#elif 0\n#endif\n" * 30_000,
        "#define A 1\n#undef A\n" * 30_000,
        "#define A 1\nx = A;\n#undef A\n" * 20_000,
        "".join(f"#define A{n} 1\n#define B{n} (A{n})\nx = B{n};\n" for n in range(10_000)),
        "#if 1\n/*" * 100_000,
        '#include "' * 100_000,
        "\\\n" * 300_000 + "#if 1",
        "x(" * 200_000 + "\n#define A 1\n" + "y\n#define B 1\n" * 20_000,
    ],
    ids=range(14),
)
@pytest.mark.slow
def test_hostile_texts_are_fast(text: str) -> None:
    try:
        with bounded():  # quadratic algorithms take minutes
            run(text)
    except SssgenError as error:
        assert error.diagnostics
