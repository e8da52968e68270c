"""The LALR(1) parser loop over the tables that lark builds of grammar.lark (`grammar_tables`).

Most reductions of an expression only pass one child through a level of precedence. The loop skips these by a table that
it fills on demand, and needs no call per reduction; it parses about 3 times as fast as lark's own loop
(`benchmarks/bench_transpile.py` prints the shares).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

from sssgen.ir.spans import NOWHERE
from sssgen.lang.syntax.tokens import Token

END = "$END"


class Reduction(NamedTuple):
    """What to do with the values on the stack when a rule is complete."""

    size: int
    origin: str
    """The rule's name, by which the next state is found."""
    callback: str
    """The builder's method; '' for a helper whose children are those of the rule around it."""
    children: tuple[tuple[int, bool, int], ...]
    """Of each value that is kept: its place, whether it is a helper's list, and how many absent ones go before it."""
    absent: int
    """How many absent ones come at the end."""


Action: TypeAlias = int | Reduction | str
"""The state to go to, a rule to reduce, or the name of a rule that passes its one child through."""


class Tables(NamedTuple):
    """The automaton: actions by terminal and next states by rule, of each state."""

    actions: list[dict[str, Action]]
    goto: list[dict[str, int]]
    start: int
    end: int
    passed: dict[tuple[int, int, str], int]
    """Where a child that is passed through ends up: by the state below it, its own, and the next token."""


class Unexpected(Exception):
    """A token that cannot stand where it does; carries its index (the number of tokens, for the end) and what could."""

    def __init__(self, index: int, accepted: set[str]) -> None:
        super().__init__(index)
        self.index, self.accepted = index, accepted


def run(found: Tables, tokens: Sequence[Token], methods: dict[str, Callable[[list[Any]], Any]]) -> Any:
    """What the start rule's method makes of the tokens. Raises Unexpected for the first that does not fit."""
    actions, goto = found.actions, found.goto
    states: list[int] = [found.start]
    values: list[Any] = []
    passed = found.passed
    for index, token in enumerate((*tokens, Token(END, "", NOWHERE))):
        kind = token[0]
        while True:
            top = states[-1]
            action = actions[top].get(kind)
            if action.__class__ is int:
                states.append(action)
                values.append(token)
                break
            if action.__class__ is Reduction:
                size, origin, callback, children, absent = action
                if size:
                    given = values[-size:]
                    del states[-size:], values[-size:]
                else:
                    given = values  # of which nothing is taken
                if callback:
                    values.append(methods[callback](_gathered(given, children, absent)))
                else:
                    values.append(_listed(given, children, absent))
                states.append(goto[states[-1]][origin])
                if kind == END and states[-1] == found.end:
                    return values[-1]
            elif action is None:
                raise Unexpected(index, accepted(found, states))
            else:
                below = states[-2]
                key = (below, top, kind)
                reached = passed.get(key)
                if reached is None:
                    reached = top
                    while isinstance(through := actions[reached].get(kind), str):
                        reached = goto[below][through]
                    passed[key] = reached
                states[-1] = reached
    raise Unexpected(len(tokens), accepted(found, states))


def _gathered(given: list[Any], children: tuple[tuple[int, bool, int], ...], absent: int) -> list[Any]:
    """The values that a rule keeps, those of helpers among them."""
    kept: list[Any] = []
    for place, is_list, before in children:
        if before:
            kept += [None] * before
        if is_list:
            kept += given[place]
        else:
            kept.append(given[place])
    if absent:
        kept += [None] * absent
    return kept


def _listed(given: list[Any], children: tuple[tuple[int, bool, int], ...], absent: int) -> list[Any]:
    """A helper's list; one that begins with another helper's goes on in it, so that long lists are not copied."""
    if children and children[0][1] and not children[0][2]:
        kept: list[Any] = given[children[0][0]]
        kept += _gathered(given, children[1:], absent)
        return kept
    return _gathered(given, children, absent)


def accepted(found: Tables, states: list[int]) -> set[str]:
    """The terminals that could come next."""
    return {kind for kind in found.actions[states[-1]] if _fits(found, states, kind)}


def _fits(found: Tables, states: list[int], kind: str) -> bool:
    """Whether a terminal is shifted in the end, not only reduced for."""
    stack = list(states)
    while True:
        action = found.actions[stack[-1]].get(kind)
        if action is None:
            return False
        if isinstance(action, int):
            return True
        size, origin = (1, action) if isinstance(action, str) else (action.size, action.origin)
        if size:
            del stack[-size:]
        stack.append(found.goto[stack[-1]][origin])
