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
    """The action on the stack of values when a rule is complete."""

    size: int
    origin: str
    """The rule's name, by which the next state is found."""
    callback: str
    """The builder's method; '' for a helper whose children are those of the rule around it."""
    children: tuple[tuple[int, bool, int], ...] | None
    """For each kept value: its position, whether it is a helper's list, and the number of absent values before it; None
    where the values are kept as they are."""
    absent: int
    """The number of absent values at the end."""


Action: TypeAlias = int | Reduction | str
"""The next state, a rule to reduce, or the name of a rule that passes its only child through."""


class Tables(NamedTuple):
    """The automaton: actions by terminal and next states by rule, of each state."""

    actions: list[dict[str, Action]]
    goto: list[dict[str, int]]
    start: int
    end: int
    passed: dict[tuple[int, int, str], int]
    """The last state of a child that is passed through: by the state below it, its own, and the next token."""


class Unexpected(Exception):
    """A token that does not fit; has its index (the number of tokens, for the end) and the terminals that would fit."""

    def __init__(self, index: int, accepted: set[str]) -> None:
        super().__init__(index)
        self.index, self.accepted = index, accepted


def run(tables: Tables, tokens: Sequence[Token], methods: dict[str, Callable[[list[Any]], Any]]) -> Any:
    """The value of the start rule's method for the tokens. Raises Unexpected for the first token that does not fit."""
    actions, goto = tables.actions, tables.goto
    states: list[int] = [tables.start]
    values: list[Any] = []
    passed = tables.passed
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
                if size == 1:
                    states.pop()
                    popped = [values.pop()]
                elif size:
                    popped = values[-size:]
                    del states[-size:], values[-size:]
                else:
                    popped = []
                if children is not None:
                    popped = _gathered(popped, children, absent) if callback else _listed(popped, children, absent)
                values.append(methods[callback](popped) if callback else popped)
                states.append(goto[states[-1]][origin])
                if kind == END and states[-1] == tables.end:
                    return values[-1]
            elif action is None:
                raise Unexpected(index, accepted(tables, states))
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
    raise Unexpected(len(tokens), accepted(tables, states))


def _gathered(popped: list[Any], children: tuple[tuple[int, bool, int], ...], absent: int) -> list[Any]:
    """The values that a rule keeps, with those of its helpers."""
    result: list[Any] = []
    for place, is_list, before in children:
        if before:
            result += [None] * before
        if is_list:
            result += popped[place]
        else:
            result.append(popped[place])
    if absent:
        result += [None] * absent
    return result


def _listed(popped: list[Any], children: tuple[tuple[int, bool, int], ...], absent: int) -> list[Any]:
    """A helper's list; one that begins with another helper's list extends that, so that long lists are not copied."""
    if children and children[0][1] and not children[0][2]:
        result: list[Any] = popped[children[0][0]]
        result += _gathered(popped, children[1:], absent)
        return result
    return _gathered(popped, children, absent)


def accepted(tables: Tables, states: list[int]) -> set[str]:
    """The terminals that could come next."""
    return {kind for kind in tables.actions[states[-1]] if _fits(tables, states, kind)}


def _fits(tables: Tables, states: list[int], kind: str) -> bool:
    """Whether a terminal is shifted in the end, not only reduced for."""
    stack = list(states)
    while True:
        action = tables.actions[stack[-1]].get(kind)
        if action is None:
            return False
        if isinstance(action, int):
            return True
        size, origin = (1, action) if isinstance(action, str) else (action.size, action.origin)
        if size:
            del stack[-size:]
        stack.append(tables.goto[stack[-1]][origin])
