"""Macros that become constants: `#define HEIGHT 0.5` becomes `const auto HEIGHT = 0.5;`, and its uses stay names.

A translated shader should keep the names of its numbers. A macro becomes a constant where one can replace it: its body
is a number, or a parenthesised expression or a constructor of numbers and other constants; it is defined between two
declarations; and every use is an operand.
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
"""No operand follows these: `f SIZE` is a call if SIZE is `(1.0)`."""


class MacroConstants:
    """The constants of one run over a text, each with the range of output tokens in which it is defined."""

    def __init__(self, barred: frozenset[str]) -> None:
        self.barred = barred
        self.values: dict[str, tuple[Token, tuple[Token, ...]]] = {}  # of each: its name where defined, and its value
        self.begins: dict[str, int] = {}
        self.ends: dict[str, int] = {}
        self.users: dict[str, list[str]] = {}  # of each: the constants whose values name it

    def add(self, macro: Macro, name: Token, constants: set[str], position: int) -> None:
        """Keeps a macro that is defined before the token at `position`, if its name and its body allow it."""
        if macro.params is not None or name.type != "NAME" or macro.name in self.barred or macro.name in self.ends:
            return
        if not is_constant(macro.body, constants):
            return
        constants.add(macro.name)
        self.values[macro.name] = name, macro.body
        self.begins[macro.name] = position
        for token in macro.body:
            if token.type == "NAME":
                self.users.setdefault(token.text, []).append(macro.name)

    def end(self, name: str, constants: set[str], used: set[str], position: int) -> None:
        """Ends a constant, and those made of it, at `position`; one that was used cannot become a constant again."""
        ending = [name]
        while ending:
            name = ending.pop()
            if name not in constants:
                continue
            constants.remove(name)
            users = self.users.pop(name, [])
            ending += users
            if users or name in used:
                self.ends[name] = position
            else:
                del self.values[name], self.begins[name]

    def in_use(self, tokens: Sequence[Token]) -> list[str]:
        """The constants that the tokens name, and those that their values name, in the order of their definitions."""
        used, pending = set[str](), list({token.text for token in tokens} & self.values.keys())
        while pending:
            name = pending.pop()
            if name not in used:
                used.add(name)
                pending += [token.text for token in self.values[name][1] if token.type == "NAME"]
        return [name for name in self.values if name in used]

    def conflicts(self, names: Sequence[str], tokens: Sequence[Token]) -> set[str]:
        """Those of the names that are used outside of the constant's range, or where no operand can be."""
        if not names:
            return set()
        candidates, conflicts = set(names), set[str]()
        for position in [position for position, token in enumerate(tokens) if token[1] in candidates]:
            text, before = tokens[position].text, tokens[position - 1].type if position else ""
            if before in _OPERAND_ENDS or not self.begins[text] <= position < self.ends.get(text, len(tokens)):
                conflicts.add(text)
        return conflicts

    def with_declarations(self, names: Sequence[str], tokens: list[Token]) -> list[Token]:
        """The tokens with the declarations of the constants inserted."""
        result: list[Token] = []
        start = 0
        for name in names:
            result += tokens[start : self.begins[name]]
            start = self.begins[name]
            result += _declaration(*self.values[name])
        return result + tokens[start:]


def _declaration(name: Token, value: tuple[Token, ...]) -> list[Token]:
    last = value[-1].span
    end = Span(last.file, last.end_line, last.end_column, last.end_line, last.end_column)
    head = [Token("CONST", "const", name.span), Token("TYPE", "auto", name.span), name]
    return [*head, Token("ASSIGN", "=", name.span), *value, Token("SEMICOLON", ";", end)]


def is_constant(value: Sequence[Token], constants: set[str]) -> bool:
    """Whether tokens are one operand made of numbers and the given constants: `1`, `-1.0`, `(A + 1)`, `vec2(A)`."""
    types = [token.type for token in value]
    if len(value) <= 2:
        literal = types[-1:] != [] and types[-1] in _LITERALS
        named = types == ["NAME"] and value[0].text in constants
        return named or (literal and (len(value) == 1 or value[0].text == "-"))
    first = 1 if types[0] == "TYPE" else 0
    if types[first] != "LPAR" or types[-1] != "RPAR":
        return False
    constructors: list[bool] = []  # for each open parenthesis: whether it is a constructor's
    for index, token in enumerate(value):
        if token.type == "LPAR":
            constructors.append(index > 0 and types[index - 1] == "TYPE")
        elif token.type == "RPAR":
            constructors.pop()
            if not constructors and index + 1 < len(value):
                return False
        elif token.type == "COMMA":
            if not constructors[-1]:
                return False
        elif token.type == "TYPE":
            if not _CONSTRUCTOR.fullmatch(token.text) or types[index + 1] != "LPAR":
                return False
        elif token.type == "NAME":
            if token.text not in constants:
                return False
        elif token.type not in _LITERALS and token.type not in _OPERATORS:
            return False
    return not constructors
