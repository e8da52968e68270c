"""Macros that are kept as constants: `#define HEIGHT 0.5` becomes `const auto HEIGHT = 0.5;`, and its uses stay names.

The names that people gave to numbers are worth keeping in a translated shader. A macro is kept where a constant may
stand in its place: its words are one number, or one expression in brackets or of a constructor, made of numbers and of
other constants; it is defined between two declarations; and what uses it uses it as an operand.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from sssgen.ir.spans import Span
from sssgen.lang.preprocess.macros import Macro
from sssgen.lang.syntax.tokens import Token

_LITERALS = ("INT", "FLOAT", "BOOL")
_OPERATORS = ("PLUSMINUS", "NOT", "OPERATOR", "QMARK", "COLON")
_CONSTRUCTOR = re.compile(r"float|int|uint|bool|[iub]?vec[234]|mat[234](x[234])?")
_OPERAND_ENDS = frozenset(("NAME", "TYPE", "RPAR", "RSQB", "DOT", *_LITERALS))
"""Behind these no operand stands: `f SIZE` is a call if SIZE is `(1.0)`."""


class KeptConstants:
    """The constants of one run over a text: what was defined, and from where to where of the words that came out."""

    def __init__(self, barred: frozenset[str]) -> None:
        self.barred = barred
        self.words: dict[str, tuple[Token, tuple[Token, ...]]] = {}  # of each: its name where defined, and its value
        self.begins: dict[str, int] = {}
        self.ends: dict[str, int] = {}
        self.users: dict[str, list[str]] = {}  # of each: the constants whose values name it

    def add(self, macro: Macro, name: Token, kept: set[str], position: int) -> None:
        """Keeps a macro that is defined before the word at a position, where its name and its words allow it."""
        if macro.params is not None or name.type != "NAME" or macro.name in self.barred or macro.name in self.ends:
            return
        if not is_constant(macro.body, kept):
            return
        kept.add(macro.name)
        self.words[macro.name] = name, macro.body
        self.begins[macro.name] = position
        for token in macro.body:
            if token.type == "NAME":
                self.users.setdefault(token.text, []).append(macro.name)

    def end(self, name: str, kept: set[str], used: set[str], position: int) -> None:
        """From a position on a name, and what is made of it, is kept no more, and never again if it was used."""
        ending = [name]
        while ending:
            name = ending.pop()
            if name not in kept:
                continue
            kept.remove(name)
            users = self.users.pop(name, [])
            ending += users
            if users or name in used:
                self.ends[name] = position
            else:
                del self.words[name], self.begins[name]

    def in_use(self, tokens: Sequence[Token]) -> list[str]:
        """The constants that words name, and those that their values name, in the order of their definitions."""
        found, looked_at = set[str](), list({token.text for token in tokens} & self.words.keys())
        while looked_at:
            name = looked_at.pop()
            if name not in found:
                found.add(name)
                looked_at += [token.text for token in self.words[name][1] if token.type == "NAME"]
        return [name for name in self.words if name in found]

    def conflicts(self, names: Sequence[str], tokens: Sequence[Token]) -> set[str]:
        """Those of the names that stand where they are no constant's, or no operand can be."""
        if not names:
            return set()
        wanted, found, before = set(names), set[str](), ""
        for position, (kind, text, _) in enumerate(tokens):
            if text in wanted and (
                before in _OPERAND_ENDS or position < self.begins[text] or position >= self.ends.get(text, len(tokens))
            ):
                found.add(text)
            before = kind
        return found

    def declared(self, names: Sequence[str], tokens: list[Token]) -> list[Token]:
        """The words with the declarations of constants between them."""
        made: list[Token] = []
        done = 0
        for name in names:
            made += tokens[done : self.begins[name]]
            done = self.begins[name]
            made += _declaration(*self.words[name])
        return made + tokens[done:]


def _declaration(name: Token, value: tuple[Token, ...]) -> list[Token]:
    last = value[-1].span
    end = Span(last.file, last.end_line, last.end_column, last.end_line, last.end_column)
    head = [Token("CONST", "const", name.span), Token("TYPE", "auto", name.span), name]
    return [*head, Token("ASSIGN", "=", name.span), *value, Token("SEMICOLON", ";", end)]


def is_constant(value: Sequence[Token], constants: set[str]) -> bool:
    """Whether words are one operand made of numbers and the given constants: `1`, `-1.0`, `(A + 1)`, `vec2(A)`."""
    types = [token.type for token in value]
    if len(value) <= 2:
        literal = types[-1:] != [] and types[-1] in _LITERALS
        named = types == ["NAME"] and value[0].text in constants
        return named or (literal and (len(value) == 1 or value[0].text == "-"))
    first = 1 if types[0] == "TYPE" else 0
    if types[first] != "LPAR" or types[-1] != "RPAR":
        return False
    constructors: list[bool] = []  # of the brackets that are open: whether a constructor's
    for at, token in enumerate(value):
        if token.type == "LPAR":
            constructors.append(at > 0 and types[at - 1] == "TYPE")
        elif token.type == "RPAR":
            constructors.pop()
            if not constructors and at + 1 < len(value):
                return False
        elif token.type == "COMMA":
            if not constructors[-1]:
                return False
        elif token.type == "TYPE":
            if not _CONSTRUCTOR.fullmatch(token.text) or types[at + 1] != "LPAR":
                return False
        elif token.type == "NAME":
            if token.text not in constants:
                return False
        elif token.type not in _LITERALS and token.type not in _OPERATORS:
            return False
    return not constructors
