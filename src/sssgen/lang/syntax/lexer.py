"""GLSL text → tokens with their places: one regular expression splits the text, one table classifies the tokens.

The table is for speed: a token is classified once, together with the blanks after it, so that the loop over the tokens
only counts columns.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from sssgen.ir.spans import Span
from sssgen.lang.syntax.tokens import Comment, Token
from sssgen.support.diagnostics import Reporter

MAX_TOKENS = 2_000_000
"""How many tokens, comments and line ends one text may have. The longest hand-written shaders stay below 100,000."""

Report = Callable[[Span, str, str], None]
"""Reports an error: its place, the message, what to do."""

_DIMENSIONS = "1D 2D 3D Cube 2DRect 1DArray 2DArray CubeArray Buffer 2DMS 2DMSArray"
_SHADOWED = "1D 2D Cube 2DRect 1DArray 2DArray CubeArray"
_SIZES = "2 3 4 2x2 2x3 2x4 3x2 3x3 3x4 4x2 4x3 4x4"

TYPES = frozenset(
    ["void", "float", "int", "uint", "bool", "double", "atomic_uint", "samplerExternalOES"]
    + [f"{prefix}vec{size}" for prefix in ("", "i", "u", "b", "d") for size in (2, 3, 4)]
    + [f"{prefix}mat{size}" for prefix in ("", "d") for size in _SIZES.split()]
    + [
        f"{prefix}{kind}{dim}"
        for prefix in ("", "i", "u")
        for kind in ("sampler", "image")
        for dim in _DIMENSIONS.split()
    ]
    + [f"sampler{dim}Shadow" for dim in _SHADOWED.split()]
)
"""The names of GLSL's own types (GLSL 4.60, section 4.1; GLSL ES 3.20, section 4.1)."""

_RESERVED = """
    const in out inout uniform attribute varying buffer shared layout struct
    if else for while do switch case default return break continue discard
"""
_QUALIFIERS = """
    flat smooth noperspective centroid invariant precise patch sample coherent restrict readonly writeonly volatile
"""

KEYWORDS: Mapping[str, str] = {
    **dict.fromkeys(TYPES, "TYPE"),
    **dict.fromkeys(_QUALIFIERS.split(), "QUALIFIER"),
    **dict.fromkeys(("lowp", "mediump", "highp"), "PRECISION"),
    **dict.fromkeys(("true", "false"), "BOOL"),
    **{word: word.upper() for word in _RESERVED.split()},
    "precision": "DEFAULT_PRECISION",
}
"""GLSL's keywords and their terminals in grammar.lark; every other identifier is a NAME."""

_OPERATORS = "* / % << >> <= >= < > == != && || ^^ & | ^"
_ASSIGNMENTS = "= += -= *= /= %= &= |= ^= <<= >>="
_SIGNS = {
    **dict.fromkeys(("++", "--"), "INCDEC"),
    **dict.fromkeys("+-", "PLUSMINUS"),
    **dict.fromkeys("!~", "NOT"),
    **dict.fromkeys(_OPERATORS.split(), "OPERATOR"),
    **dict.fromkeys(_ASSIGNMENTS.split(), "ASSIGN"),
    "{": "LBRACE", "}": "RBRACE", "(": "LPAR", ")": "RPAR", "[": "LSQB", "]": "RSQB",
    ",": "COMMA", ";": "SEMICOLON", ":": "COLON", ".": "DOT", "?": "QMARK",
}  # fmt: skip

_BLANKS = " \t\n\r\f\v"

NEWLINE = r"\\\r?\n"  # a line continuation
LINE_COMMENT = r"//[^\n\\]*+(?>(?:\\(?:\r?\n)?[^\n\\]*+)*)"  # no (…)*+: Python 3.11.2 matches it wrongly
BLOCK_COMMENT = r"/\*[\s\S]*?\*/"
OPEN_COMMENT = r"/\*[\s\S]*+"
TEXT = r'"[^"\n]*+"?'

_PIECE = re.compile(
    rf"""
    (?: [A-Za-z_]\w*+                                             # a name
      | 0[xX]\w*+ | (?:\d++\.?\d*+|\.\d++)(?:[eE][+-]?\d++)?\w*+  # a number, with all letters and digits after it
      | [{{}}()\[\],;:?~.]
      | <<=? | >>=? | && | \|\| | \^\^ | \+\+ | -- | [-+*%&|^<>=!]=? | /(?![/*])=? | \#\#
    )[ \t]*+
    | (?>(?:\s|{NEWLINE})+)
    | {LINE_COMMENT} | {BLOCK_COMMENT} | {OPEN_COMMENT} | {TEXT}
    | [^\x00-\x7f]++ | .
    """,
    re.VERBOSE | re.ASCII,
)
_INT = re.compile(r"(?:0[xX][0-9a-fA-F]+|\d+)[uU]?")
_FLOAT = re.compile(r"(?:(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)(?:[fF]|lf|LF)?")


def scan(
    text: str, file: str, line: int = 1, column: int = 1, keywords: Mapping[str, str] = KEYWORDS
) -> tuple[list[Token], list[Comment]]:
    """The tokens and the comments of a text that begins at a line and column of a file.

    Raises SssgenError with every unknown character, malformed number, and unclosed comment or string.
    """
    reporter: Reporter | None = None

    def report(span: Span, message: str, hint: str) -> None:
        nonlocal reporter
        if reporter is None:
            reporter = Reporter(file, "\n" * (line - 1) + " " * (column - 1) + text)
        reporter.error(span, message, hint)

    result = Lexer(keywords).scan(text, file, line, column, report)
    if reporter is not None:
        reporter.check()
    return result


class Lexer(dict[str, tuple[str, str, int, int]]):
    """The table of tokens: a token with the blanks after it → its type, its text, its width, the width of both.

    One table may serve many texts with the same keywords; it is faster the more tokens it has seen.
    """

    def __init__(self, keywords: Mapping[str, str] = KEYWORDS) -> None:
        self.keywords = {**_SIGNS, **keywords}

    def __missing__(self, piece: str) -> tuple[str, str, int, int]:
        token = piece.rstrip(" \t")
        entry = (self.type_of(token), token, len(token), len(piece))
        if not piece.startswith(("//", "/*")):  # comments rarely repeat
            self[piece] = entry
        return entry

    def type_of(self, text: str) -> str:
        """The terminal of a token; '' for blanks, comments, and text that is not a token."""
        if text in self.keywords:
            return self.keywords[text]
        if _INT.fullmatch(text):
            return "INT"
        if _FLOAT.fullmatch(text):
            return "FLOAT"
        if text.isidentifier() and text.isascii():
            return "NAME"
        return "STRING" if len(text) > 1 and text[0] == text[-1] == '"' else ""

    def scan(self, text: str, file: str, line: int, column: int, report: Report) -> tuple[list[Token], list[Comment]]:
        """As `scan`, but errors go to `report`, which may raise; if it does not, faulty text is left out."""
        pieces = _PIECE.findall(text)
        tokens: list[Token] = []
        comments: list[Comment] = []
        if len(pieces) > MAX_TOKENS:
            report(Span(file, line, column, line, column + 1), f"more than {MAX_TOKENS} tokens", "split the file")
            return tokens, comments
        append, make, token_type, span_type = tokens.append, tuple.__new__, Token, Span  # local names are fastest
        for piece in pieces:
            kind, token, width, step = self[piece]
            if kind:
                span = make(span_type, (file, line, column, line, column + width))
                append(make(token_type, (kind, token, span)))
                column += step
                continue
            lines = piece.count("\n")
            if piece.startswith(("//", "/*")) and _closed(piece):
                comments.append(Comment(line, line + lines, piece))
            elif piece[0] not in _BLANKS and not (piece[0] == "\\" and lines):
                end = column + (2 if token.startswith("/*") else width)
                report(Span(file, line, column, line, end), *_fault(token))
            line += lines
            column = len(piece) - piece.rfind("\n") if lines else column + step
        return tokens, comments


def pieces(text: str) -> list[str]:
    """A text in pieces, which together are the text: tokens with the blanks after them, comments, blanks."""
    return _PIECE.findall(text)


def _closed(comment: str) -> bool:
    return comment.startswith("//") or (len(comment) > 3 and comment.endswith("*/"))


def _fault(text: str) -> tuple[str, str]:
    """The message about text that is not a token, and what to do."""
    first = text[0]
    if first == "/":
        return "this comment is not closed", "add */ at its end"
    if first == '"':
        return "this string is not closed on its line", ""
    if first.isdecimal():
        return f"'{text}' is not a number", f"write {text[:-1]}.0" if re.fullmatch(r"\d+[fF]", text) else ""
    if first == "#":
        return f"'{text}' is not expected here", "a directive must be first on its line"
    return f"unknown character{'s' * (len(text) > 1)} {text!r}", ""
