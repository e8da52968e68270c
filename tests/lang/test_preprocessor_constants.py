"""Which macros become constants."""

from __future__ import annotations

import pytest

from preprocessed import run, spaced, words

KEPT = {
    "3": "const auto A = 3;",
    "-1.5": "const auto A = -1.5;",
    "true": "const auto A = true;",
    "(1 + 2)": "const auto A = (1 + 2);",
    "((1) * (2))": "const auto A = ((1) * (2));",
    "vec3(1.0, 2, -3)": "const auto A = vec3(1.0, 2, -3);",
    "mat2(vec2(1), vec2(2))": "const auto A = mat2(vec2(1), vec2(2));",
    "(B > 1 ? float(B) : 0.5)": "const auto B = 2; const auto A = (B > 1 ? float(B) : 0.5);",
    "B": "const auto B = 2; const auto A = B;",
}


@pytest.mark.parametrize("value", KEPT)
def test_macros_of_numbers_become_constants(value: str) -> None:
    result = run(f"#define B 2\n#define UNUSED 7\n#define A {value} // its name\nfloat x = A;")
    assert " ".join(token.text for token in result.tokens) == spaced(KEPT[value] + " float x = A;")
    assert result.macros == (["B", "A"] if "B" in value else ["A"])


@pytest.mark.parametrize(
    "value",
    [
        "1 + 2",
        "- x",
        "x",
        "(x)",
        "(1, 2)",
        "f(1)",
        "vec2(sin(1.0))",
        "(1) + (2)",
        "(1)(2)",
        "vec2",
        "(vec2)",
        "",
        ")(",
        "(",
        "(1",
        "1;",
        "sampler2D(1)",
        "+",
        "C",
        "v.x",
        "(a = 1)",
        "vec2(1).x",
        '"x"',
        "UNDEFINED",
    ],
)
def test_other_macros_are_expanded(value: str) -> None:
    result = run(f"#define C 1 +\n#define A {value}\nq = A;")
    assert result.macros == []
    assert " ".join(token.text for token in result.tokens) == spaced(f"q = {value.replace('C', '1 +')};")


def test_places_of_constants() -> None:
    result = run("float a;\n  #define HIGH (2.0 * 1.5)\nfloat b = HIGH;\nfloat c = HIGH;")
    head = (2, 11, 2, 15)
    assert [(token.type, token.text, token.span[1:]) for token in result.tokens[3:13]] == [
        ("CONST", "const", head), ("TYPE", "auto", head), ("NAME", "HIGH", head), ("ASSIGN", "=", head),
        ("LPAR", "(", (2, 16, 2, 17)), ("FLOAT", "2.0", (2, 17, 2, 20)), ("OPERATOR", "*", (2, 21, 2, 22)),
        ("FLOAT", "1.5", (2, 23, 2, 26)), ("RPAR", ")", (2, 26, 2, 27)), ("SEMICOLON", ";", (2, 27, 2, 27)),
    ]  # fmt: skip
    assert [(t.type, t.span[1:3]) for t in result.tokens[13:] if t.text == "HIGH"] == [
        ("NAME", (3, 11)),
        ("NAME", (4, 11)),
    ]


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("#define A 1\n#if A\nb;\n#endif", "b;"),
        ("#define A 1\n#define A 1\na = A;\n#define A 1\nb = A;", "const auto A = 1; a = A; b = A;"),
        ("#define A 1\n#undef A\n#define A 2\na = A;", "const auto A = 2; a = A;"),
        ("#define A 1\na = A;\n#undef A\n#define A 2\nb = A;", "const auto A = 1; a = A; b = 2;"),
        ("#define A 1\na = A;\n#define A 2\nb = A;", "const auto A = 1; a = A; b = 2;"),
        ("#define A 1\na = A;\n#undef A\nint A;", "a = 1; int A;"),
        ("#define A 1\na = A;\n#undef A\nb = A;", "a = 1; b = A;"),
        ("int A;\n#define A 1\na = A;", "int A; a = 1;"),
        ("b = A;\n#define A 1\na = A;", "b = A; a = 1;"),
        ("#define A 1\n#define B (A)\na = B;\n#undef A\n#define A 2\nb = B;",
         "const auto A = 1; const auto B = (A); a = B; b = (2);"),
        ("#define B (A)\n#define A 1\na = B;", "const auto A = 1; a = (A);"),
        ("#define ARGS (1.0)\na = f ARGS;", "a = f (1.0);"),
        ("#define A 1\n#define B (A)\na = f B; b = A;", "const auto A = 1; a = f (A); b = A;"),
        ("void f() {\n#define A 1\na = A;\n}", "void f() { a = 1; }"),
        ("void f() { x;\n#define A 1\na = A;\n}", "void f() { x; a = 1; }"),
        ("float f(\n#define A 1\nfloat a[A]);", "float f(float a[1]);"),
        ("float a =\n#define A 1\nA;", "float a = 1;"),
        ("struct S { int a; };\n#define A 1\nfloat a[A];", "struct S { int a; }; const auto A = 1; float a[A];"),
        ("#define A 1\n#define cat(x) v ## x\n#define two(x) x + x\na = cat(A) + two(A);",
         "const auto A = 1; a = vA + A + A;"),
        ("#define float 1\na = float;", "a = 1;"),
        ("#define A 1\n#define f(x) 2\na = f(A);", "a = 2;"),
    ],
)  # fmt: skip
def test_constants_are_used_only_where_valid(text: str, result: str) -> None:
    assert words(text) == spaced(result)


def test_constants_of_includes() -> None:
    files = {"a": "#ifndef PI\n#define PI 3.14\n#endif\nfloat a = PI;\n"}
    assert words('#include "a"\n#include "a"\nb = PI;', files) == spaced(
        "const auto PI = 3.14; float a = PI; float a = PI; b = PI;"
    )
    assert words('#define PI 3.0\n#include "a"', files) == spaced("const auto PI = 3.0; float a = PI;")
