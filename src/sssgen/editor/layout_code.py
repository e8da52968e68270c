"""The layout of techniques and GLSL: indentation by braces, blanks between tokens, single blank lines.

Lines stay as the author broke them; comments keep their distance, and directives their text. The tokens are compared
with those before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from sssgen.lang.syntax.lexer import KEYWORDS, TYPES, pieces
from sssgen.lang.syntax.parser import parse
from sssgen.support.diagnostics import failure

INDENT = "    "

_SPACED = frozenset(
    "= += -= *= /= %= &= |= ^= <<= >>= + - * / % << >> < > <= >= == != && || ^^ & | ^ ? :".split()  # noqa: SIM905  # a list would hide the tokens
)
_BEFORE_BRACKET = frozenset(("if", "for", "while", "switch", "return", "else", "do", "case"))
"""The keywords before which and behind which a bracket has a space."""
_HEADS = frozenset(("if", "for", "while", "switch"))
_ENDS_OPERAND = frozenset((")", "]"))


class _Piece(NamedTuple):
    """A token or comment with the blanks before it; a directive is one piece."""

    text: str
    blanks: str


def code_layout(text: str, shown: str) -> str:
    """The text of a technique in this layout. Raises SssgenError with its syntax errors."""
    parse(text, shown)
    result = join_lines(_lay_out(list(_lines(text))))
    if _words(result) != _words(text):
        raise failure("the layout would change a token", "report this file as a bug of sssgen fmt", shown)
    return result


def _words(text: str) -> list[str]:
    """The tokens, comments and directives of a text without blanks."""
    return [" ".join(piece.text.split()) for line in _lines(text) for piece in line]


def _lines(text: str) -> Iterator[list[_Piece]]:
    """The lines of a text; a comment of several lines is one piece."""
    line: list[_Piece] = []
    blanks, offset, directive_end = "", 0, 0
    for piece in pieces(text):
        start, offset = offset, offset + len(piece)
        if start < directive_end:
            continue
        if not piece.strip():
            for _ in range(piece.count("\n")):
                yield line
                line = []
            blanks = piece.rpartition("\n")[2]
            continue
        if piece.strip() == "#" and not line:
            directive_end = start + len(text[start : _end_of_directive(text, start)].rstrip())
            line.append(_Piece(text[start:directive_end], ""))
            continue
        token = piece if piece.startswith(("//", "/*")) else piece.rstrip(" \t")
        line.append(_Piece(token.rstrip(), blanks))
        blanks = piece[len(token) :]
    yield line


def _end_of_directive(text: str, start: int) -> int:
    """The end of the line that a directive ends on: a backslash continues it."""
    end = start
    while True:
        end = text.find("\n", end)
        if end < 0:
            return len(text)
        if not text[start:end].rstrip("\r").endswith("\\"):
            return end
        end += 1


def _lay_out(lines: Sequence[list[_Piece]]) -> Iterator[str]:
    """The lines with their indentation and blanks."""
    place = _Place()
    for line in lines:
        if line and line[0].text.startswith("#"):
            yield "\n".join(part.rstrip() for part in line[0].text.split("\n"))
        elif line:
            yield _indent(INDENT * place.depth(line[0].text), _space_tokens(line, place.last))
            for piece in line:
                place.take(piece.text)
        else:
            yield ""


class _Place:
    """How deeply a line is nested: what is open where it begins."""

    def __init__(self) -> None:
        self.braces = self.brackets = 0
        self.heads = 0
        """The heads of `if`, `for` and so on before it whose statement is still to come."""
        self.first = ""
        """The first token of the statement that it continues."""
        self.last = ""
        """The token before it."""

    def depth(self, first: str) -> int:
        """The depth of a line that begins with this piece."""
        depth = self.braces - (first == "}") - (first in ("case", "default"))
        if first != "{":
            depth += self.heads + bool(self.first or self.brackets)
        return max(0, depth)

    def take(self, text: str) -> None:
        """Goes on behind a piece."""
        if text.startswith(("//", "/*")):
            return
        self.first = self.first or text
        self.braces += (text == "{") - (text == "}")
        self.brackets += (text in ("(", "[")) - (text in (")", "]"))
        if text == "if" and self.last == "else":
            self.heads -= 1  # the statement of this `else` is on its line
        label = text == ":" and self.first in ("case", "default")
        if self.brackets == 0 and (text in (";", "{", "}") or label):
            self.heads, self.first = 0, ""
        elif self.brackets == 0 and (text in ("else", "do") or (text == ")" and self.first in _HEADS)):
            self.heads, self.first = self.heads + 1, ""
        self.last = text


def _indent(indent: str, text: str) -> str:
    """An indented line; the further lines of a comment move with the first."""
    first, *rest = text.split("\n")
    star = all(part.lstrip().startswith("*") for part in rest if part.strip())
    moved = [f"{indent} {part.strip()}" if star and part.strip() else part.rstrip() for part in rest]
    return "\n".join([indent + first.rstrip(), *moved])


def _space_tokens(line: Sequence[_Piece], last: str) -> str:
    """The pieces of a line with the blanks between them; `last` is the token before the line."""
    text = line[0].text
    unary = _is_unary(last, line[0].text)
    for index in range(1, len(line)):
        before, piece = line[index - 1].text, line[index]
        was_unary, unary = unary, _is_unary(before, piece.text)
        is_label = piece.text == ":" and line[0].text in ("case", "default")
        text += ("" if is_label else _blanks_between(before, piece, was_unary, unary)) + piece.text
    return text


def _blanks_between(before: str, piece: _Piece, was_unary: bool, unary: bool) -> str:
    """The blanks between two pieces of a line."""
    token = piece.text
    if token.startswith("//"):
        return piece.blanks or " "
    if token.startswith("/*") or before.startswith("/*"):
        return "" if before in ("(", "[") or token in (")", "]", ",", ";") else " "
    if token in (",", ";", ")", "]", ".") or before in ("(", "[", "."):
        return ""
    if before == "case" or before in (",", ";", "{", "}") or token in ("{", "}"):
        return " "
    if token in ("(", "["):
        return " " if before in _BEFORE_BRACKET or (before in _SPACED and not was_unary) else ""
    if token in ("++", "--"):
        return "" if _ends_an_operand(before) else " " * (before in _SPACED and not was_unary)
    if was_unary or before in ("!", "~"):
        return " " if before in ("+", "-") and token.startswith(before) else ""
    if before in ("++", "--"):
        return " " if token in _SPACED else ""
    return " "


def _is_unary(before: str, token: str) -> bool:
    """Whether a sign belongs to what follows it."""
    return token in ("!", "~") or (token in ("+", "-") and not _ends_an_operand(before))


def _ends_an_operand(token: str) -> bool:
    """Whether a token can be the last of an operand."""
    if token in _ENDS_OPERAND or token in ("++", "--"):
        return True
    is_word = token[:1].isalnum() or token[:1] == "_" or (token[:1] == "." and len(token) > 1)
    return is_word and (token not in KEYWORDS or token in TYPES or token in ("true", "false"))


def join_lines(lines: Iterator[str]) -> str:
    """The lines with at most one blank line in a row, and one line end at the end."""
    kept: list[str] = []
    for line in lines:
        if line.strip() or (kept and kept[-1]):
            kept.append(line if line.strip() else "")
    while kept and not kept[-1]:
        kept.pop()
    return "\n".join(kept) + "\n" if kept else ""
