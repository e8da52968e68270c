"""What each case of a switch runs: its own statements, and those of the next where it falls through."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from sssgen.ir.spans import Span
from sssgen.lang.syntax import tree as s

if TYPE_CHECKING:
    from sssgen.lang.check.expression_checker import ExpressionChecker

MAX_STATEMENTS = 2000
"""How many statements the cases of one function's switches may have, once each has those that it falls through to."""


class Case(NamedTuple):
    """A case; the default comes last, whatever its place was."""

    labels: tuple[s.Label, ...]
    body: tuple[s.Statement, ...]
    span: Span


def cases_of(checker: ExpressionChecker, switch: s.SwitchStatement) -> list[Case]:
    """The cases of a switch. Reports statements before the first, a second default, and endless falling through."""
    groups: list[tuple[list[s.Label], list[s.Statement]]] = []
    for statement in switch.body.statements:
        if isinstance(statement, s.Label):
            if not groups or groups[-1][1]:
                groups.append(([], []))
            groups[-1][0].append(statement)
        elif not groups:
            raise checker.fail(statement.span, "a switch begins with a case")
        else:
            groups[-1][1].append(statement)
    found, default = list[Case](), None
    for index, (labels, _) in enumerate(groups):
        body = _runs([statements for _, statements in groups[index:]])
        checker.fallen += len(body)
        if checker.fallen > MAX_STATEMENTS:
            hint = "end the cases with break"
            raise checker.fail(labels[0].span, "these cases fall through to too many statements", hint)
        case = Case(tuple(labels), body, labels[0].span)
        if all(label.value is not None for label in labels):
            found.append(case)
        elif default is not None:
            raise checker.fail(labels[0].span, "there are two defaults in this switch")
        else:
            default = case
    return [*found, default] if default is not None else found


def _runs(groups: list[list[s.Statement]]) -> tuple[s.Statement, ...]:
    """The statements from a case up to what leaves the switch."""
    body: list[s.Statement] = []
    for statements in groups:
        for statement in statements:
            ended = _end(statement)
            if ended is not None:
                return (*body, *ended)
            body.append(statement)
    return tuple(body)


def _end(statement: s.Statement) -> tuple[s.Statement, ...] | None:
    """What is left to run of a statement that always leaves the switch; None where it does not."""
    if isinstance(statement, s.Jump):
        return () if statement.kind == "break" else (statement,)
    if isinstance(statement, s.Compound) and statement.statements:
        last = _end(statement.statements[-1])
        if last is not None:
            return (replace(statement, statements=(*statement.statements[:-1], *last)),)
    return None


def leaves(body: tuple[s.Statement, ...]) -> bool:
    """Whether a `break` of the switch itself stands in these statements."""
    return any(_leaves(statement) for statement in body)


def _leaves(statement: s.Statement | None) -> bool:
    if isinstance(statement, s.Jump):
        return statement.kind == "break"
    if isinstance(statement, s.Compound):
        return leaves(statement.statements)
    if isinstance(statement, s.IfStatement):
        return _leaves(statement.then) or _leaves(statement.otherwise)
    return False
