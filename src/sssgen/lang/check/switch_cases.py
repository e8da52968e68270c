"""The cases of a switch: each with its own statements and those of the cases that it falls through to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from typing import NamedTuple

from sssgen.ir.spans import Span
from sssgen.lang.check.context import CheckContext
from sssgen.lang.syntax import tree as s

MAX_STATEMENTS = 2000
"""How many statements all cases of one function may have, with those that they fall through to."""


class Case(NamedTuple):
    """A case; the default comes last, wherever it is written."""

    labels: tuple[s.Label, ...]
    body: tuple[s.Statement, ...]
    span: Span


def cases_of(context: CheckContext, switch: s.SwitchStatement) -> list[Case]:
    """The cases of a switch.

    Reports statements before the first, a second default, a last label without statements in GLSL ES, and too many
    statements.
    """
    groups: list[tuple[list[s.Label], list[s.Statement]]] = []
    for statement in switch.body.statements:
        if isinstance(statement, s.Label):
            if not groups or groups[-1][1]:
                groups.append(([], []))
            groups[-1][0].append(statement)
        elif not groups:
            raise context.fail(statement.span, "a switch must begin with a case")
        else:
            groups[-1][1].append(statement)
    cases, default = list[Case](), None
    for index, (labels, _) in enumerate(groups):
        body = _statements_of([statements for _, statements in groups[index:]])
        earlier = [statement for _, statements in groups[:index] for statement in statements]
        body = (*_declared_before(earlier, body), *body)
        context.function.case_statements += len(body)
        if context.function.case_statements > MAX_STATEMENTS:
            hint = "end the cases with break"
            raise context.fail(labels[0].span, "these cases fall through to too many statements", hint)
        case = Case(tuple(labels), body, labels[0].span)
        if all(label.value is not None for label in labels):
            cases.append(case)
        elif default is not None:
            raise context.fail(labels[0].span, "this switch has two defaults")
        else:
            default = case
    needs_statement = context.es or context.language.desktop in range(130, 331)
    if needs_statement and groups and not groups[-1][1]:
        raise context.fail(groups[-1][0][-1].span, "nothing follows this label", "write break; after it")
    return [*cases, default] if default is not None else cases


def _statements_of(groups: list[list[s.Statement]]) -> tuple[s.Statement, ...]:
    """The statements from a case to the statement that leaves the switch."""
    body: list[s.Statement] = []
    for statements in groups:
        for statement in statements:
            last = _without_break(statement)
            if last is not None:
                return (*body, *last)
            body.append(statement)
    return tuple(body)


def _declared_before(earlier: list[s.Statement], body: tuple[s.Statement, ...]) -> Iterator[s.Statement]:
    """The declarations of earlier cases that a case uses, without the values, which it does not compute: all cases are
    one scope."""
    declarations = [statement for statement in earlier if isinstance(statement, s.Declaration)]
    if not declarations:
        return
    own = {name for statement in body if isinstance(statement, s.Declaration) for name in _names(statement)}
    used = set(_words(body)) - own
    for declaration in declarations:
        is_const = "const" in declaration.qualifiers.keywords
        declarators = [
            declarator if is_const else replace(declarator, value=None)
            for declarator in declaration.declarators
            if declarator.name.text in used
        ]
        if declarators:
            yield replace(declaration, declarators=tuple(declarators))


def _names(declaration: s.Declaration) -> list[str]:
    return [declarator.name.text for declarator in declaration.declarators]


def _words(part: object) -> Iterator[str]:
    """The names in a part of the syntax tree."""
    if isinstance(part, s.Name):
        yield part.text
    elif isinstance(part, tuple) and not isinstance(part, Span):
        for item in part:
            yield from _words(item)
    elif is_dataclass(part):
        for field in fields(part):
            yield from _words(getattr(part, field.name))


def _without_break(statement: s.Statement) -> tuple[s.Statement, ...] | None:
    """A statement that always leaves the switch, without its `break`; None for any other statement."""
    if isinstance(statement, s.Jump):
        return () if statement.kind == "break" else (statement,)
    if isinstance(statement, s.Compound) and statement.statements:
        last = _without_break(statement.statements[-1])
        if last is not None:
            return (replace(statement, statements=(*statement.statements[:-1], *last)),)
    return None


def has_break(body: tuple[s.Statement, ...]) -> bool:
    """Whether these statements contain a `break` of the switch itself."""
    return any(_has_break(statement) for statement in body)


def _has_break(statement: s.Statement | None) -> bool:
    if isinstance(statement, s.Jump):
        return statement.kind == "break"
    if isinstance(statement, s.Compound):
        return has_break(statement.statements)
    if isinstance(statement, s.IfStatement):
        return _has_break(statement.then) or _has_break(statement.otherwise)
    return False
