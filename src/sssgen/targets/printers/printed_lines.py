"""The printed lines: where a long line is broken, the comments on lines, and whether a text can take a member."""

from __future__ import annotations

import re
import textwrap
from typing import NamedTuple

from sssgen.ir import nodes as ir

WIDTH = 110
"""Lines longer than this are broken at a call's arguments."""


class Line(NamedTuple):
    """One printed line, without its line break, and where it came from."""

    text: str
    span: ir.Span = ir.NOWHERE


def wrap(text: str, span: ir.Span, chains: bool = False) -> list[Line]:
    """Breaks a long line at the outermost commas and operators, with `chains` also before the methods of a result.

    The rest is indented once more, and that of the head of a block twice, as the block itself is indented once.
    """
    if len(text) <= WIDTH:
        return [Line(text, span)]
    indent = len(text) - len(text.lstrip())
    rest = " " * (indent + (8 if indent and text.endswith("{") else 4))
    lines = []
    while len(text) > WIDTH:
        place = _break_place(text, chains)
        if place == 0:
            break
        lines.append(Line(text[:place].rstrip(), span))
        text = rest + text[place:].lstrip()
    return [*lines, Line(text, span)]


_BREAKS = (" + ", " - ", " * ", " ? ", " : ", " && ", " || ")


def _break_place(text: str, chains: bool) -> int:
    """Where to break a line: inside as few parentheses as possible, then as late as possible; 0 for nowhere.

    A type such as `array<vec4<f32>, 4>` is not broken; comparisons have spaces around them.
    """
    position, best_score, depth, angles = 0, -1000.0, 0, 0
    start = len(text) - len(text.lstrip()) + 8
    for index, char in enumerate(text[:WIDTH]):
        depth += (char in "([") - (char in ")]")
        ends = text[index - 1 : index + 1]
        angles += (char == "<" and text[index - 1].isalnum()) - (char == ">" and angles > 0)
        can_break = ends in (", ", "; ") or (chains and ends == ").") or text.startswith(_BREAKS, index)
        if index > start and not angles and can_break:
            score = index / WIDTH - 2.0 * depth
            if score > best_score:
                position, best_score = index, score
    return position


def comment_text(text: str) -> str:
    """Text that is safe in a line comment: a backslash at its end would continue the comment."""
    return text.rstrip("\\ ")


_ATTRIBUTE = re.compile(r"[a-z]\w*:")
_SENTENCE_END = re.compile(r"[.!?][)'\"`]*(?= +[^a-z ]|$)")


def summary(doc: str, mark: str = "// ") -> list[str]:
    """The sentences that begin on the first line of a doc comment, whole, in lines that fit behind a mark."""
    lines: list[str] = []
    for line in doc.strip().split("\n"):
        if not line.strip() or (lines and _ATTRIBUTE.match(line)):
            break
        lines.append(line.strip())
    text = " ".join(lines)
    end = next((end.end() for end in _SENTENCE_END.finditer(text) if end.end() >= len(lines[0])), None)
    return [comment_text(line) for line in textwrap.wrap(text[:end], WIDTH - len(mark))]


def first_sentence(doc: str) -> str:
    """The first sentence of a doc comment, without the dot at its end."""
    text = " ".join(doc.split())
    end = _SENTENCE_END.search(text)
    return comment_text(text[: end.end() if end else None].rstrip("."))


def with_doc(text: str, uniform: ir.Uniform) -> Line:
    """A uniform's declaration with the first sentence of its documentation, where that fits on the line."""
    words = first_sentence(uniform.doc)
    full = f"{text}  // {words}"
    return Line(full if words and len(full) <= WIDTH else text, uniform.span)


def is_postfix(text: str) -> bool:
    """Whether a text is a name with members, or a call, so that a member or an index can be added."""
    name, _, rest = text.partition("(")
    return name.replace(".", "").isidentifier() and (not rest or _closes(rest))


def _closes(text: str) -> bool:
    """Whether only the last character closes the parenthesis that is open before the text."""
    depth = 1
    for index, char in enumerate(text):
        depth += (char == "(") - (char == ")")
        if depth == 0:
            return index == len(text) - 1
    return False
