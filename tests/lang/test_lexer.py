"""The lexer: tokens, their places, and invalid tokens."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from slow_cases import some_slow
from sssgen.ir.operators import PRECEDENCE
from sssgen.lang.syntax.lexer import MAX_TOKENS, scan
from sssgen.lang.syntax.tokens import Comment
from sssgen.support.diagnostics import MAX_ERRORS, SssgenError
from watchdog import bounded


def types(text: str) -> list[str]:
    return [token.type for token in scan(text, "a.glsl")[0]]


def faults(text: str) -> list[tuple[str, tuple[int, int, int, int], str]]:
    """The message, the place and the hint of each error."""
    with pytest.raises(SssgenError) as caught:
        scan(text, "a.glsl")
    return [(one.message, one.span[1:], one.hint) for one in caught.value.diagnostics]


WORDS = {
    "INT": "0 7 017 42u 42U 0x1F 0XfFu 4294967295",
    "FLOAT": ".5 1. 1.0 1e3 1E+3 1.e-3f 1.5F 1.0lf 1.0LF .5e2 1e3f 0.0",
    "BOOL": "true false",
    "NAME": "x _x gl_Position trueish in_ vec5 mat2x5 e1 samplerX world_direction iff auto",
    "TYPE": "void float int uint bool double vec2 ivec3 uvec4 bvec2 dvec3 mat2 mat4x3 dmat3x2 sampler2D isampler3D "
    "usamplerCube sampler2DArrayShadow samplerCubeArray sampler2DRectShadow samplerBuffer isampler2DMSArray image2D "
    "uimage3D iimageCubeArray imageBuffer sampler1DShadow",
    "PRECISION": "lowp mediump highp",
    "DEFAULT_PRECISION": "precision",
    "QUALIFIER": "flat smooth noperspective centroid invariant precise patch sample coherent restrict readonly "
    "writeonly volatile",
    "INCDEC": "++ --",
    "PLUSMINUS": "+ -",
    "NOT": "! ~",
    "OPERATOR": " ".join(word for word in PRECEDENCE if word not in "+-"),
    "ASSIGN": "= += -= *= /= %= &= |= ^= <<= >>=",
    "STRING": '"" "a/b.sss" "//" "/*"',
}
SINGLE = {
    "{": "LBRACE", "}": "RBRACE", "(": "LPAR", ")": "RPAR", "[": "LSQB", "]": "RSQB",
    ",": "COMMA", ";": "SEMICOLON", ":": "COLON", ".": "DOT", "?": "QMARK",
}  # fmt: skip
RESERVED = """
    const in out inout uniform attribute varying buffer shared layout struct
    if else for while do switch case default return break continue discard
"""


@pytest.mark.parametrize("kind", WORDS)
def test_tokens_of_each_kind(kind: str) -> None:
    for word in WORDS[kind].split():
        tokens, _ = scan(word, "a.glsl")
        assert [token[:2] for token in tokens] == [(kind, word)]
        assert tokens[0].span == ("a.glsl", 1, 1, 1, 1 + len(word))


def test_signs_and_reserved_words_have_terminals_of_their_own() -> None:
    assert {sign: types(sign) for sign in SINGLE} == {sign: [kind] for sign, kind in SINGLE.items()}
    assert {word: types(word) for word in RESERVED.split()} == {word: [word.upper()] for word in RESERVED.split()}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a+++b", ["a", "++", "+", "b"]),
        ("a<<=b<=c<d", ["a", "<<=", "b", "<=", "c", "<", "d"]),
        ("a^^b^=c", ["a", "^^", "b", "^=", "c"]),
        ("v.x.5", ["v", ".", "x", ".5"]),
        ("a[0].xyz", ["a", "[", "0", "]", ".", "xyz"]),
        ("1.0.xxx", ["1.0", ".", "xxx"]),
        ("a/b/c", ["a", "/", "b", "/", "c"]),
        ("a/**/b//c", ["a", "b"]),
        ("1-1.-1", ["1", "-", "1.", "-", "1"]),
        ("a\\\nb\\\r\nc", ["a", "b", "c"]),
        ("a\rb\fc\vd\te\r\n", ["a", "b", "c", "d", "e"]),
    ],
)
def test_the_longest_token_wins(text: str, words: list[str]) -> None:
    assert [token.text for token in scan(text, "a.glsl")[0]] == words


def test_places_count_from_where_the_text_begins() -> None:
    tokens, comments = scan("a /* x\n y */ b\\\n  c // end", "f", line=7, column=5)
    assert [(token.text, *token.span) for token in tokens] == [
        ("a", "f", 7, 5, 7, 6),
        ("b", "f", 8, 7, 8, 8),
        ("c", "f", 9, 3, 9, 4),
    ]
    assert comments == [Comment(7, 8, "/* x\n y */"), Comment(9, 9, "// end")]


def test_a_line_comment_continues_after_a_backslash() -> None:
    tokens, comments = scan("// one \\\n two\nx // three \\ four\ny", "f")
    assert [token.text for token in tokens] == ["x", "y"]
    assert comments == [Comment(1, 2, "// one \\\n two"), Comment(3, 3, "// three \\ four")]


def test_keywords_are_a_parameter() -> None:
    tokens, _ = scan("normal vec3 ##", "f", keywords={"normal": "TYPE", "##": "PASTE"})
    assert [token.type for token in tokens] == ["TYPE", "NAME", "PASTE"]


def test_every_error_is_reported_at_its_place() -> None:
    assert faults("a @ 1f\n 0x 3.x\n'é\n\"open\n/* open") == [
        ("unknown character '@'", (1, 3, 1, 4), ""),
        ("'1f' is not a number", (1, 5, 1, 7), "write 1.0"),
        ("'0x' is not a number", (2, 2, 2, 4), ""),
        ("'3.x' is not a number", (2, 5, 2, 8), ""),
        ('unknown character "\'"', (3, 1, 3, 2), ""),
        ("unknown character 'é'", (3, 2, 3, 3), ""),
        ("this string is not closed on its line", (4, 1, 4, 6), ""),
        ("this comment is not closed", (5, 1, 5, 3), "add */ at its end"),
    ]


@pytest.mark.parametrize("text", ["/*/", "/*", "/**", "\\", "\\ \n", '"', "#", "##", "$", "`", "\x1c", "\xa0", "\x00"])
def test_invalid_tokens_are_refused(text: str) -> None:
    assert len(faults(text)) == 1


def test_the_line_of_an_error_is_shown_where_the_text_begins_later() -> None:
    with pytest.raises(SssgenError) as caught:
        scan("a\nb @", "f", line=10, column=4)
    error = caught.value.diagnostics[0]
    assert (error.span[1:3], error.source_line) == ((11, 3), "b @")


def test_errors_are_counted() -> None:
    assert len(faults("@" * 1_000_000)) == MAX_ERRORS + 1


def test_a_text_of_too_many_tokens_is_refused() -> None:
    assert "tokens" in faults(";" * (MAX_TOKENS + 1))[0][0]


@pytest.mark.parametrize(
    "repeated",
    some_slow(
        ["a + ", "/", "/**/", '"', "1", "1e", "\\\n", "x", "/*", "//\\", " ", "0x", "é", "1."],
        "1e", "\\\n", "x", "/*", " ", "0x",
    ),
)  # fmt: skip
def test_a_line_of_a_megabyte_is_fast(repeated: str) -> None:
    try:
        with bounded():  # quadratic algorithms take minutes
            scan(repeated * (1_000_000 // len(repeated)), "f")
    except SssgenError as error:
        assert len(str(error)) < 100_000


PIECES = ["vec3", "in", "x", ".", "1", "1.5", ".5e3", "0x", "+", "++", "+=", "<<", "<<=", "/", "*", "//", "/*", "*/"]
PIECES += [" ", "\n", "\\\n", "\t", "\r", "{", "}", "(", ")", "é", "@", "#", '"']


@given(st.lists(st.sampled_from(PIECES), max_size=30).map("".join))
def test_tokens_cover_the_text(text: str) -> None:
    """Each token's text is at its place, and between tokens are only blanks and comments."""
    try:
        tokens, comments = scan(text, "f")
    except SssgenError:
        return
    lines = text.split("\n")
    left = [list(line) for line in lines]
    for token in tokens:
        _, line, column, end_line, end_column = token.span
        assert line == end_line and lines[line - 1][column - 1 : end_column - 1] == token.text
        left[line - 1][column - 1 : end_column - 1] = " " * (end_column - column)
    rest = "\n".join(map("".join, left))
    for comment in comments:
        assert comment.text in "\n".join(rest.split("\n")[comment.first - 1 : comment.last])
        rest = rest.replace(comment.text, "\n" * (comment.last - comment.first), 1)
    assert rest.replace("\\\n", "").strip(" \t\r\n\f\v") == ""
