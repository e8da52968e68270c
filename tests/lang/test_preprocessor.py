"""The preprocessor: C's macros and conditions, places through macros and includes, preserved constants, errors."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from preprocessed import faults, run, spaced, words
from sssgen.lang.preprocess.preprocessor import MAX_INCLUDED
from sssgen.lang.syntax.lexer import scan
from sssgen.support.diagnostics import SssgenError

# Macros

RESCANNED = """
#define x y 3
#define f(a) f(x * (a))
#undef x
#define x int(2)
#define g f
#define z z[0]
#define h g(~
#define m(a) a(w)
#define w 0,1
#define t(a) a
#define p() int
#define q(x) x
#define r(x,y) x ## y
"""
"""C11, section 6.10.3.5, example 3, but for what GLSL lacks; x is no constant, as it stands behind itself twice."""


@pytest.mark.parametrize(
    ("use", "result"),
    [
        ("f(y+1) + f(f(z)) % t(t(g)(0) + t)(1);", "f(X * (y+1)) + f(X * (f(X * (z[0])))) % f(X * (0)) + t(1);"),
        ("g(x+(3,4)-w) | h 5) & m\n(f)^m(m);", "f(X * (X+(3,4)-0,1)) | f(X * ( ~ 5)) & f(X * (0,1))^m(0,1);"),
        ("p() i[q()] = { q(1), r(2,3), r(4,), r(,5), r(,) };", "int i[] = { 1, 23, 4, 5, };"),
    ],
)
def test_the_rescan_examples_of_the_standard(use: str, result: str) -> None:
    text = "void before() {" + RESCANNED + use
    assert words(text) == spaced("void before() {" + result.replace("X", "int(2)"))


def test_the_paste_examples_of_the_standard() -> None:
    """C11, section 6.10.3.5, examples 5 and 7 in GLSL's words."""
    text = "#define t(x,y,z) x ## y ## z\nj = t(1,2,3), t(,4,5), t(6,,7), t(8,9,), t(10,,), t(,11,), t(,,12), t(,,);"
    assert words(text) == spaced("j = 123, 45, 67, 89, 10, 11, 12, ;")


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("#define f(x) f(x+1)\nf(f(2))", "f(f(2+1)+1)"),
        ("#define a b\n#define b a\na b", "a b"),
        ("#define a b + c\n#define b a + d\n#define c b\na;", "a + d + a + d;"),
        ("#define f(x) x\n#define g f\ng(1) g f (2) f", "1 g 2 f".replace("g", "f")),
        ("#define f(x) x*f\nf(2)(9)", "2*f(9)"),
        ("#define f(a) a*g\n#define g(a) f(a)\nf(2)(9)", "2*9*g"),
        ("#define f(x, y) x + y\nf((1, 2),\n  vec2(3, 4)[0])", "(1, 2) + vec2(3, 4)[0]"),
        ("#define f(x) [x]\nf() f( ) f(,", None),
        ("#define f() 1\nf() f( )", "1 1"),
        ("#define e\n#define f(x) x\ne f e (1) e", "f (1)"),
        ("#define f (x) y\nf", "(x) y"),
        (
            "#define cat(a, b) a ## b\n#define xcat(a, b) cat(a, b)\n#define one 1\n{cat(one, 2) xcat(one, 2)}",
            "{one2 12}",
        ),
        ("#define v(n) in_ ## n ## _attr.x\nv(normal)", "in_normal_attr.x"),
        ("#define r(x, y) a x ## y b\nr(, 1) r(1, ) r(, )", "a 1 b a 1 b a b"),
        ("#define op(a) a ## =\nx op(+) y op(<<) z", "x += y <<= z"),
        ("#define texture2D texture\n#define lowp\nlowp vec4 c = texture2D(a, b);", "vec4 c = texture(a, b);"),
        ("#define f(x) \\\n  x + \\\n  x\nf(1)", "1 + 1"),
        ("#define f(x) x /* of\n x */ + 1 // end\nf(2)", "2 + 1"),
        ("#define A 1 +\n#undef A\n#undef A\nA", "A"),
        ("#define A 1 +\n#define A 2 +\nA", "2 +"),
        ("#define L __LINE__ +\nL\n__LINE__ L __FILE__", "2 + 3 3 + 0"),
        ("#define f(x) x +\n#ifdef no\na\n#else\nf\n#endif\n(3)", "3 +"),
        ("#define f(x) x +\n#ifdef no\na\n#else\nf\n#endif\n[3]", "f[3]"),
        ("#define f(x) x +\nf", "f"),
        ("#define f(x) x +\nf\n#undef f\n(3)", "f(3)"),
    ],
)
def test_macros(text: str, result: str | None) -> None:
    if result is None:
        assert faults(text)[0][0] == "the arguments of 'f' are not closed"
    else:
        assert words(text) == spaced(result)


def test_places_go_through_macros() -> None:
    text = "#define TWICE(x) (x + x)\n#define OUTER(x) TWICE(x * HERE) + HERE\n#define HERE here.x\n  OUTER(a  +\n b);"
    place = {token.text: token.span[1:] for token in run(text).tokens}
    use = (4, 3, 4, 8)
    assert place == {
        "(": use, "+": use, "*": use, ")": use, "here": use, ".": use, "x": use,
        "a": (4, 9, 4, 10), "b": (5, 2, 5, 3), ";": (5, 4, 5, 5),
    }  # fmt: skip
    tokens = run(text).tokens
    assert [token.span[1:] for token in tokens if token.text == "a"] == [(4, 9, 4, 10)] * 2
    assert [token.span[1:] for token in tokens if token.text == "+"] == [(4, 12, 4, 13), use, (4, 12, 4, 13), use]
    pasted = run("#define cat(a, b) a ## b\n cat(x, y) z").tokens
    assert [(token.text, token.span[1:]) for token in pasted] == [("xy", (2, 2, 2, 5)), ("z", (2, 12, 2, 13))]


def test_places_go_through_includes() -> None:
    files = {"a": "float a;\n  #include <b>\n  float c;", "<b>": "#define B float b;\n\n B"}
    tokens = run('/* 1\n2 */ #include "a"\nfloat d;', files).tokens
    assert [(token.text, *token.span[:3]) for token in tokens if token.type in ("NAME", "TYPE")] == [
        ("float", "a", 1, 1), ("a", "a", 1, 7), ("float", "<b>", 3, 2), ("b", "<b>", 3, 2), ("float", "a", 3, 3),
        ("c", "a", 3, 9), ("float", "main", 3, 1), ("d", "main", 3, 7),
    ]  # fmt: skip


# Conditions

VALUES = {
    "1": 1, "0": 0, "0x10": 16, "010": 8, "10u": 10, "X": 0, "float": 0, "true": 0, "ONE": 1, "TWICE(3)": 6,
    "1 + 2 * 3": 7, "(1 + 2) * 3": 9, "7 - 2 - 1": 4, "-7 / 2": -3, "-7 % 2": -1, "7 / -2": -3, "7 % -2": 1,
    "1 << 3 + 1": 16, "-16 >> 2": -4, "1 << 63 < 0": 1, "0x7fffffffffffffff + 1 < 0": 1, "~0": -1, "- - 3": 3,
    "!0 + !5": 1, "!!7": 1, "~-1": 0, "- -3": 3, "1 < 2 == 1": 1, "3 > 2 > 1": 0, "2 >= 2": 1, "2 <= 1": 0, "1 != 2": 1,
    "6 & 3": 2, "6 | 3": 7, "6 ^ 3": 5, "1 | 2 ^ 3 & 4": 3, "1 || 0 && 0": 1, "5 && 6": 1, "0 || 7": 1,
    "0 && 1 / 0": 0, "1 || 1 % 0": 1, "1 ? 2 : 1 / 0": 2, "0 ? 1 : 0 ? 2 : 3": 3, "defined ONE": 1, "defined(X)": 0,
    "defined ( ONE ) && !defined X": 1, "HAS": 1, "defined(TWICE)": 1, "defined __LINE__": 1, "__VERSION__": 450,
    "defined GL_ES": 0, "GL_core_profile": 1, "__LINE__": 5, "X ? 1 : 2": 2, "1 /* a */ + // b": None,
}  # fmt: skip


@pytest.mark.parametrize("expression", VALUES)
def test_the_arithmetic_of_conditions(expression: str) -> None:
    value = VALUES[expression]
    head = "\n#define ONE 1\n#define TWICE(x) (x + x)\n#define HAS defined(ONE)\n"
    if value is None:
        assert faults(f"{head}#if {expression}\n#endif")[0][0] == "the expression ends too early"
        return
    assert words(f"{head}#if ({expression}) == ({value})\nyes\n#else\nno\n#endif") == "yes"
    assert words(f"{head}#if {expression}\nyes\n#else\nno\n#endif") == ("yes" if value else "no")


@pytest.mark.parametrize(
    ("expression", "message", "column"),
    [
        ("1 +", "the expression ends too early", 1),
        ("(1", "a ')' is missing", 1),
        ("1 2", "'2' is not expected here", 7),
        ("f(1)", "'(' is not expected here", 6),
        ("1 / 0", "division by 0", 7),
        ("1 << 64", "a shift by 64 bits: it must be 0 to 63", 7),
        ("1 << -1", "a shift by -1 bits: it must be 0 to 63", 7),
        ("1.0 > 0", "'1.0' is not an integer", 5),
        ("08", "'08' is not a number", 5),
        ("defined 3", "'defined' needs the name of a macro", 13),
        ("1 = 1", "'=' is not expected here", 7),
        ("1 ^^ 1", "'^^' is not expected here", 7),
        ("* 3", "'*' is not expected here", 5),
        ("", "a condition is missing here", 1),
    ],
)
def test_faulty_conditions(expression: str, message: str, column: int) -> None:
    assert faults(f"#if {expression}\n#endif") == [(message, "main", 1, column)]


def test_one_branch_is_taken_and_the_others_are_ignored() -> None:
    text = "#if {0}\na\n#elif {1}\nb\n#elif {2}\nc\n#else\nd\n#endif"
    assert [words(text.format(*values)) for values in ((1, "1/0", "@"), (0, 1, "1/0"), (0, 0, 1), (0, 0, 0))] == [
        *"abcd"
    ]
    off = (
        '#if 0\n\' @ 1f "\n#foo\n#error no\n#include "x"\n#if 1/0\n#elif 1\ne\n#else\nf\n#endif\n#define A 1\n#endif\nA'
    )
    assert words(off) == "A"
    assert words("#ifndef A\n#define A\na\n#endif\n#ifdef A\nb\n#endif A") == "a b"
    assert words("#if 0\n/*\n#endif\n*/ // \\\n#endif\na\n#endif\nb") == "b"


@pytest.mark.parametrize(
    ("text", "tokens"),
    [
        ("flo\\\nat x\\\n_1 = 1\\\n2.5\\\ne0;", "float x_1 = 12.5e0 ;"),
        ("a \\\nb +\\\n= c <\\\r\n<\\\r\n= d", "a b += c <<= d"),
        ("#def\\\nine A\\\nB(x\\\ny) xy #\\\n# 1\nAB(c)", "c1"),
        ("a /\\\n/ b\n/\\\n* c *\\\n/ d", "a d"),
        ("ab\\\n\\\ncd", "abcd"),
    ],
)  # fmt: skip
def test_a_token_may_go_on_after_a_line_continuation(text: str, tokens: str) -> None:
    assert words(text) == tokens
    assert run(text + "\nz").tokens[-1].span.line == text.count("\n") + 2


def test_directives_in_comments_and_within_lines_are_ignored() -> None:
    assert words("/*\n#if 0\n*/ a // \\\n#error no\n b") == "a b"
    assert words("/* x */ # /* y */ define /* z */ A /* w\n*/ b +\n  # \nA") == "b +"
    assert faults("# \\\n /*\n*/ undef \\\n A\n@ b")[0] == ("unknown character '@'", "main", 5, 1)
    assert faults("a # define B")[0] == ("'#' is not expected here", "main", 1, 3)
    assert faults("/*\n*/ a #if 1")[0] == ("'#' is not expected here", "main", 2, 6)


def test_conditions_close() -> None:
    assert faults("#if 1\n#ifdef A\n#endif") == [("this condition is not closed", "main", 1, 1)]
    assert faults("a\n #endif") == [("there is no #if before this #endif", "main", 2, 2)]
    assert faults("#else\n#elif 1") == [
        ("there is no #if before this #else", "main", 1, 1),
        ("there is no #if before this #elif", "main", 2, 1),
    ]
    assert faults("#if 1\n#else\n#else\n#elif 1\n#endif") == [
        ("#else after #else", "main", 3, 1),
        ("#elif after #else", "main", 4, 1),
    ]
    assert faults('#include "a"\n#endif', {"a": "\n#if 1\n"}) == [
        ("this condition is not closed", "a", 2, 1),
        ("there is no #if before this #endif", "main", 2, 1),
    ]


# Other directives


def test_versions() -> None:
    for version, profile, holds in [
        ("", "", "GL_core_profile && __VERSION__ == 450 && !defined GL_ES"),
        ("100", "es", "GL_ES && __VERSION__ == 100 && !defined GL_core_profile && GL_FRAGMENT_PRECISION_HIGH"),
        ("300 es", "es", "GL_ES && GL_es_profile && __VERSION__ == 300"),
        ("120", "", "!defined GL_core_profile && !defined GL_ES"),
        ("330 core", "core", "GL_core_profile && !defined GL_compatibility_profile"),
        ("460 compatibility", "compatibility", "GL_compatibility_profile && !defined GL_core_profile"),
    ]:
        head = f"# version {version} // one\n" if version else ""
        result = run(f"{head}#if {holds}\nyes\n#endif")
        assert [token.text for token in result.tokens] == ["yes"], version
        assert (result.version, result.profile) == (int(version.split()[0]) if version else 0, profile)
    assert faults("#version 300 fs") == [("'300 fs' is not a version", "main", 1, 1)]
    assert faults("#version 330\n#version 300 es") == [("the version is already 330", "main", 2, 1)]


def test_a_text_without_version_that_sets_a_precision_is_es() -> None:
    question = "#ifdef GL_ES\nyes\n#else\nno\n#endif\n"
    for text, answer in [
        (f"{question}precision mediump float;", "yes"),
        (f"#ifdef A\n#endif\nprecision /* */ highp\nint;\n{question}", "yes"),
        (f"#ifdef GL_ES\nprecision mediump float;\n#endif\n{question}", "no"),
        (f"#version 330\nprecision mediump float;\n{question}", "no"),
        (f"// precision mediump float;\n{question}", "no"),
    ]:
        assert answer in [token.text for token in run(text).tokens], text
    assert [token.text for token in run("precision lowp float;\n__VERSION__").tokens][-1] == "100"


def test_extensions_pragmas_and_lines() -> None:
    result = run("#extension GL_A:enable\n#extension  all : /* */ disable\n#pragma optimize(on) // x\n#line 7 2\n#\na")
    assert (result.extensions, result.pragmas) == (["GL_A:enable", "all : disable"], ["optimize(on)"])
    assert [token.span[1:3] for token in result.tokens] == [(6, 1)]


NUMBERED = {
    "#line 10\n__LINE__\n__LINE__": "10 11",
    "#version 330\n#line 10\n__LINE__": "10",
    "#version 460 core\n\n#line 7 3\n\n__LINE__ __FILE__": "8 3",
    "#version 300 es\n#line 10\n__LINE__": "10",
    "#version 100\n#line 10\n__LINE__": "10",
    "#version 110\n#line 10\n__LINE__": "11",
    "#version 150\n#line 10 2\n__LINE__ __FILE__\n#line 20\n__LINE__ __FILE__": "11 2 21 2",
    "#define N 30\n#line N + 2\n__LINE__": "32",
    "#define N 30\n#line (N * 2) 4\n__LINE__ __FILE__": "60 4",
    "#line 5 /* a\n b */ \\\n 6\n__LINE__ __FILE__": "5 6",
    '#line 5 "main.glsl"\n__LINE__ __FILE__': "5 0",
    "#define L __LINE__ +\n#line 100\nL\nL": "100 + 101 +",
    "#line 100\n#if __LINE__ == 101\nno\n#endif\n#line 50\n#if __LINE__ == 50\nyes\n#endif": "yes",
    "#line 9\n#ifdef NO\n#line 90\n#endif\n__LINE__": "12",
}


@pytest.mark.parametrize("text", NUMBERED)
def test_numbered_lines(text: str) -> None:
    assert words(text) == spaced(NUMBERED[text])


def test_an_included_file_has_lines_of_its_own() -> None:
    files = {"a": "__LINE__\n#line 70 7\n__LINE__ __FILE__\n"}
    result = run('#line 10 1\n__LINE__\n#include "a"\n__LINE__ __FILE__', files)
    assert [token.text for token in result.tokens] == ["10", "1", "70", "7", "12", "1"]
    assert [token.span.line for token in result.tokens] == [2, 1, 3, 3, 4, 4]


@pytest.mark.parametrize("rest", ["", "here", "-5", "4 5 6", "99999999999", "1 / 0"])
def test_faulty_lines(rest: str) -> None:
    assert faults(f"\n#line {rest}\n@") == [
        ("#line needs the number of a line", "main", 2, 1), ("unknown character '@'", "main", 3, 1)
    ]  # fmt: skip


def test_error_directives_and_malformed_directives() -> None:
    assert faults(
        "#error no // really\n @\n#foo\n#elseif\n#define\n#define f(a\n#define g(a,a) a\n#define 1\n#undef A B"
    ) == [
        ("#error no", "main", 1, 1),
        ("unknown character '@'", "main", 2, 2),
        ("there is no directive '#foo'", "main", 3, 1),
        ("there is no directive '#elseif'", "main", 4, 1),
        ("#define needs a name", "main", 5, 1),
        ("these parameters are not closed", "main", 6, 10),
        ("'a' is not expected here", "main", 7, 13),
        ("#define needs a name", "main", 8, 9),
        ("'B' is not expected here", "main", 9, 10),
    ]
    assert faults("#define f(x) x\n#define g(x, y) x\nf(1, 2) g(1) f(3\n") == [
        ("'f' takes 1 argument, but gets 2", "main", 3, 1),
        ("'g' takes 2 arguments, but gets 1", "main", 3, 9),
        ("the arguments of 'f' are not closed", "main", 3, 14),
    ]
    assert faults("#define A ## b\n#define B b ##\n#define C(x) x ## ;\nC(1)") == [
        ("'##' must be between two tokens", "main", 1, 11),
        ("'##' must be between two tokens", "main", 2, 13),
        ("'##' makes '1;' here, which is not a token", "main", 4, 1),
    ]
    assert faults("#define A @\nA\n#endif /* x") == [
        ("unknown character '@'", "main", 1, 11),
        ("there is no #if before this #endif", "main", 3, 1),
        ("this comment is not closed", "main", 3, 8),
    ]
    assert faults('#define A "x\nA\n#define B /* y') == [
        ("this string is not closed on its line", "main", 1, 11),
        ("this comment is not closed", "main", 3, 11),
    ]


def test_the_line_of_an_error_is_shown() -> None:
    with pytest.raises(SssgenError) as caught:
        run('#include "a"', {"a": "\n\n  b @"})
    assert caught.value.diagnostics[0].source_line == "  b @"


def test_definitions_from_outside() -> None:
    assert words("#if A == 3\nA B C\n#endif", A="3", B="", C="x +") == "3 x +"
    assert run("float a = A;", A="3").macros == []
    assert words("A", A="__VERSION__ +") == "450 +"
    assert "@" in faults("a", A="@")[0][0]


# Includes


def test_includes() -> None:
    files = {"a": "a1\n#define A a2 +\n", "<a>": "angled", "once": "#pragma once\no", "twice": "t"}
    assert words('#include "a"\n#include <a> // x\nA', files) == "a1 angled a2 +"
    assert words('#include "once"\n#include "once"\n#include "twice"\n#include "twice"', files) == "o t t"
    assert run('#include "a"', files).texts == {"main": '#include "a"', "a": files["a"]}
    missing = faults('#include "x"\n  #include <y> z\n#include\n#include A\n#include "z" // \n@')
    assert missing == [
        ("no x at 1:11-12", "", 0, 0),
        ("no z at 5:11-12", "", 0, 0),
        ('#include needs a file: "name" or <name>', "main", 2, 3),
        ('#include needs a file: "name" or <name>', "main", 3, 1),
        ('#include needs a file: "name" or <name>', "main", 4, 1),
        ("unknown character '@'", "main", 6, 1),
    ]


def test_guarded_include_cycles_are_allowed() -> None:
    guarded = '#ifndef A\n#define A\n#include "b"\na\n#endif'
    assert words('#include "a"\n#include "b"', {"a": guarded, "b": '#include "a"\nb'}) == "b a b"


def test_circles_and_depths_are_named() -> None:
    circle = {"a": '#include "b"', "b": '\n #include "c"', "c": '#include "a"'}
    assert faults('#include "a"', circle) == [("'c' includes itself: c → a → b → c", "b", 2, 12)]
    chain = {f"f{n}": f'#include "f{n + 1}"' for n in range(MAX_INCLUDED)} | {f"f{MAX_INCLUDED}": "a"}
    assert words('#include "f1"', chain) == "a"
    assert faults('#include "f0"', chain)[0][0] == f"files include files more than {MAX_INCLUDED} deep"


# Without directives it is the lexer

PIECES = [
    "float",
    "x",
    " ",
    "\n",
    "\t",
    "1 ",
    "2.5 ",
    "+",
    "(",
    ")",
    "{",
    "}",
    ";",
    ",",
    "// c",
    "/* d */",
    "/*\n*/",
    "in",
]


@given(st.lists(st.sampled_from(PIECES), max_size=40).map("".join))
def test_a_text_without_directives_is_only_split(text: str) -> None:
    result = run(text)
    tokens, comments = scan(text, "main")
    assert (result.tokens, result.comments.get("main", []), result.texts) == (tokens, comments, {"main": text})


@given(st.lists(st.sampled_from(PIECES), max_size=40).map("".join))
def test_directives_without_effect_change_nothing(text: str) -> None:
    """#if 1 around each line that is no part of a comment, and a macro for a name, leave the words as they are."""
    plain = run(text).tokens
    assert [t[:2] for t in run("#define unused(x) y\n#if 1\n" + text + "\n#endif").tokens] == [t[:2] for t in plain]
    named = run("#define x q\n#define q x\n" + text).tokens
    assert [t[:2] for t in named] == [t[:2] for t in plain]


def test_windows_line_ends() -> None:
    text = "#define A(x) x + \\\n 1\n#if A(1) == 2 // c\nA(2) /* d\n */;\n#endif\n"
    one, other = run(text), run(text.replace("\n", "\r\n"))
    assert (one.tokens, spaced("2 + 1;")) == (other.tokens, " ".join(token.text for token in other.tokens))


def test_comments_of_active_text() -> None:
    files = {"a": "// a1\n#if 0\n// a2\n#endif\n#define B 1 /* a3 */\n"}
    result = run('// m1\n#include "a"\n#include "a"\n/* m2 */ #if 1 // m3\n// m4\n#else\n// m5\n#endif', files)
    assert {file: [comment.text.strip() for comment in found] for file, found in result.comments.items()} == {
        "main": ["// m1", "/* m2 */", "// m3", "// m4"],
        "a": ["// a1", "/* a3 */"],
    }
    assert [comment.first for comment in result.comments["main"]] == [1, 4, 4, 5]
