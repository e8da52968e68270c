"""Assumptions in comments of plain GLSL: `// sssgen: assume 0 <= roughness <= 1, unit normal`.

A comment behind code belongs to what that code ends: it holds behind the statement or the declaration. A comment on a
line of its own holds before the statement below, or behind it where that gives one of its variables a value. In a
function it becomes `assume(…);`, the statement of techniques. Beside a declaration it restricts that input, and
beside the head of a function its parameters.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.contracts import Assumption
from sssgen.ir.intervals import INF
from sssgen.ir.spans import Span
from sssgen.lang.syntax.lexer import scan
from sssgen.lang.syntax.tokens import Comment, Token
from sssgen.support.diagnostics import Diagnostic, SssgenError

UNIT = (0.999, 1.001)
"""The lengths of a vector that is assumed to be of length 1, as rounding and interpolation make it."""
NONZERO = 1e-6
"""The least size or length of what is assumed not to be 0."""

_MARK = re.compile(r"sssgen\s*:\s*(.*)", re.DOTALL)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_INPUT = re.compile(
    rf"(?:(?P<low>{_NUMBER})\s*<=?\s*)?(?P<name>[A-Za-z_][\w.]*)\s*(?:(?P<op><=?|>=?)\s*(?P<bound>{_NUMBER}))?"
)
_WORDS = ("unit", "nonzero", "orthonormal", "finite")
_SYNTAX = "write 0 <= x <= 1, x > 0, unit v, nonzero x, orthonormal m or finite t, with commas between several of them"


class AssumedInput(NamedTuple):
    """What a comment assumes of an input of the file."""

    name: str
    assumption: Assumption
    text: str
    """As the author wrote it."""
    span: Span


def with_assumptions(
    tokens: Sequence[Token], comments: Mapping[str, Sequence[Comment]], texts: Mapping[str, str]
) -> tuple[list[Token], list[AssumedInput]]:
    """The tokens with statements for the comments in functions, and what other comments assume of inputs.

    Raises SssgenError for a comment that begins with `sssgen:` and cannot be read, or that belongs to nothing.
    """
    marked = [
        (file, comment, match[1])
        for file, in_file in comments.items()
        for comment in in_file
        if (match := _MARK.match(comment.text[2:].removesuffix("*/").strip()))
    ]
    if not marked:
        return list(tokens), []
    places = _Places(tokens)
    inserted: dict[int, list[Token]] = {}
    inputs: list[AssumedInput] = []
    for file, comment, words in marked:
        span = _span(file, comment, texts.get(file, "").split("\n"))
        terms = _terms(words, span)
        index = places.of(file, comment, span, {name for term in terms for name in re.findall(r"[A-Za-z_]\w*", term)})
        if places.in_function[index]:
            for term in terms:
                inserted.setdefault(index, []).extend(_statement(term, span))
        else:
            inputs += [_input(term, span) for term in terms]
    result: list[Token] = []
    for index, token in enumerate(tokens):
        result += inserted.get(index, ())
        result.append(token)
    return result, inputs


class _Places:
    """Where statements can be inserted in a file's tokens."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        self.tokens = tokens
        self.in_function: list[bool] = []
        """Of each token, and of the end, whether a statement before it is in a function."""
        self.nested: list[int] = []
        """Of each token, in how many parentheses it is."""
        braces: list[bool] = []
        parentheses = 0
        for index, token in enumerate(tokens):
            if token.type == "RPAR":
                parentheses -= 1
            self.in_function.append(bool(braces) and braces[0])
            self.nested.append(parentheses)
            if token.type == "LPAR":
                parentheses += 1
            elif token.type == "LBRACE":
                braces.append(index > 0 and tokens[index - 1].type == "RPAR")
            elif token.type == "RBRACE" and braces:
                braces.pop()
        self.in_function.append(False)
        self.nested.append(0)

    def of(self, file: str, comment: Comment, span: Span, names: set[str]) -> int:
        """The index of the token before which a comment's assumptions hold."""
        own = [index for index, token in enumerate(self.tokens) if token.span.file == file]
        behind = [
            index
            for index in own
            if self.tokens[index].span.line == comment.first and self.tokens[index].span.column < span.column
        ]
        if behind:
            return self.end(behind[-1], span)
        after = next((index for index in own if self.tokens[index].span.line > comment.last), None)
        if after is None:
            raise _fail(span, "nothing follows this assumption", "put it before what it belongs to")
        if not self.in_function[after]:
            return self.end(after, span)
        if self.tokens[after - 1].type not in ("SEMICOLON", "LBRACE", "RBRACE", "COLON") or self.nested[after]:
            raise _fail(span, "an assumption cannot be here", "put { } around the statement below")
        return self.end(after, span) if names & self.declared(after) else after

    def end(self, index: int, span: Span) -> int:
        """The index behind the statement or the head that a token is in."""
        for at in range(index, len(self.tokens)):
            if self.tokens[at].type in ("SEMICOLON", "LBRACE", "RBRACE") and not self.nested[at]:
                return at + 1
        raise _fail(span, "nothing follows this assumption", "put it before what it belongs to")

    def declared(self, index: int) -> set[str]:
        """The names of the variables to which the statement at an index gives their values."""
        names: set[str] = set()
        before = "TYPE"
        for at in range(index, len(self.tokens)):
            kind, text, _ = self.tokens[at]
            if kind in ("SEMICOLON", "LBRACE"):
                break
            if kind == "NAME" and before in ("TYPE", "NAME", "COMMA") and self.nested[at] == self.nested[index]:
                names.add(text)
            before = kind
        return names


def _terms(words: str, span: Span) -> list[str]:
    """The terms of a comment, separated by commas outside of parentheses."""
    match = re.fullmatch(r"assume\b\s*(.*)", words, re.DOTALL)
    if match is None:
        raise _fail(span, f"unknown words behind 'sssgen:': '{words[:40]}'", f"after 'sssgen: assume' {_SYNTAX}")
    terms, depth = [""], 0
    for char in re.sub(r"//.*", "", match[1]):
        depth += (char in "([") - (char in ")]")
        if char == "," and depth == 0:
            terms.append("")
        else:
            terms[-1] += char
    terms = [" ".join(term.split()) for term in terms]
    if "" in terms:
        raise _fail(span, "nothing is assumed here", _SYNTAX)
    return terms


def _statement(term: str, span: Span) -> list[Token]:
    """`assume(…);` for a term; its tokens are at the comment's place."""
    word, _, operand = term.partition(" ")
    if word in ("orthonormal", "finite") and operand:
        raise _fail(span, f"'{word}' is for the inputs of a file", "put the comment beside the declaration")
    if word == "unit" and operand:
        term = f"length({operand}) >= {UNIT[0]} && length({operand}) <= {UNIT[1]}"
    elif word == "nonzero" and operand:
        term = f"length({operand}) >= {NONZERO}"
    elif not re.search(r"<|>|==|!=|\bisnan\b|\bisinf\b", term):
        raise _fail(span, f"'{term[:40]}' is no assumption", _SYNTAX)
    try:
        tokens, _ = scan(f"assume({term});", span.file)
    except SssgenError as error:
        raise _fail(span, error.diagnostics[0].message, _SYNTAX) from None
    return [token._replace(span=span) for token in tokens]


def _input(term: str, span: Span) -> AssumedInput:
    """What a term outside of functions assumes of an input."""
    word, _, name = term.partition(" ")
    if word in _WORDS and re.fullmatch(r"[A-Za-z_][\w.]*", name):
        return AssumedInput(name, assumption_of(word), term, span)
    match = _INPUT.fullmatch(term)
    if match is None or not (match["low"] or match["bound"]):
        raise _fail(span, f"'{term[:40]}' is no assumption about an input", _SYNTAX)
    low, high, least = -INF, INF, 0.0
    if match["low"]:
        low = float(match["low"])
    if match["bound"] and match["op"].startswith("<"):
        high = float(match["bound"])
    elif match["bound"]:
        low = float(match["bound"])
        least = NONZERO if low == 0.0 and match["op"] == ">" else 0.0
    if re.match(rf"{_NUMBER}\s*<\s*[A-Za-z_]", term) and low == 0.0:
        least = NONZERO
    if low > high:
        raise _fail(span, f"no number is in {low:g}..{high:g}", "the lower bound is on the left")
    return AssumedInput(match["name"], Assumption(low, high, least), term, span)


def assumption_of(word: str) -> Assumption:
    """What `unit`, `nonzero`, `orthonormal` and `finite` mean."""
    if word in ("unit", "orthonormal"):
        return Assumption(shortest=UNIT[0], longest=UNIT[1])
    return Assumption(finite=True) if word == "finite" else Assumption(shortest=NONZERO)


def _span(file: str, comment: Comment, lines: Sequence[str]) -> Span:
    """The place of a comment's first line."""
    line = lines[comment.first - 1] if comment.first <= len(lines) else ""
    first = comment.text.split("\n")[0]
    column = max(line.find(first.rstrip("\r")), 0) + 1
    return Span(file, comment.first, column, comment.first, column + len(first))


def _fail(span: Span, message: str, hint: str) -> SssgenError:
    return SssgenError([Diagnostic("error", message, span, hint)])
