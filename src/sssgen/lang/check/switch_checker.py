"""Checks `switch`, which becomes a chain of ifs; one with a `break` inside an if becomes a loop that runs once."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL, INT, UINT
from sssgen.ir.walk import statements
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.evaluation_order import depends, writes_of
from sssgen.lang.check.loop_checker import once
from sssgen.lang.check.statement_checker import StatementChecker
from sssgen.lang.check.switch_cases import Case, cases_of, has_break
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s


class SwitchChecker:
    """Checks the switches of one file."""

    def __init__(self, statements: StatementChecker) -> None:
        self.context = statements.context
        self.statements = statements
        statements.methods[s.SwitchStatement] = self.switch
        statements.methods[s.Label] = self.label

    def switch(self, statement: s.SwitchStatement) -> list[ir.Stmt]:
        context, function, span = self.context, self.context.function, statement.span
        value = self.statements.expressions.check(statement.value).expr
        if value.type not in (INT, UINT):
            raise context.fail(statement.value.span, f"a switch takes an int, but this is {a_type(value.type)}")
        cases = cases_of(context, statement)
        is_loop = any(has_break(case.body) for case in cases)
        position = len(function.prelude)
        flag = None
        if is_loop and function.loop_depth:
            flag = function.temporary("goes_on", ir.Literal(BOOL, False, span))
        outer, function.switches = function.switches, [*function.switches, flag]
        bodies = [self.statements.block(s.Compound(case.body, span, 0)) for case in cases]
        function.switches = outer
        inside = tuple([stmt for body in bodies for stmt in body])
        written, calls = writes_of(inside, context.out_arguments)
        tests = sum(len(case.labels) for case in cases if all(label.value is not None for label in case.labels))
        if max(tests, len(cases)) > 1 and (not isinstance(value, ir.Local) or depends(value, written, calls)):
            value = function.temporary("selected", value, position, before=inside)
        elif not tests:
            self.statements.assignments.calls_of(value)
        self.check_distinct(cases)
        chain: ir.Block = ()
        for case, body in zip(reversed(cases), reversed(bodies), strict=True):
            test = self.matches(value, case.labels)
            chain = body if test is None else (ir.If(test, body, chain, case.span),)
        if not is_loop:
            return list(chain)
        result: list[ir.Stmt] = [once(function, chain, span)]
        if flag is not None and any(_assigns(stmt, flag) for stmt in statements(chain)):
            result.append(ir.If(flag, (ir.Continue(span),), (), span))
        elif flag is not None:
            function.prelude = [stmt for stmt in function.prelude if getattr(stmt, "name", "") != flag.name]
        return result

    def check_distinct(self, cases: list[Case]) -> None:
        """Reports a label that an earlier case has."""
        numbers: set[int] = set()
        for label in sorted([label for case in cases for label in case.labels], key=lambda label: label.span[1:3]):
            number = constant_int(self.context, label.value) if label.value is not None else None
            if number in numbers:
                raise self.context.fail(label.span, f"there is already a case {number}")
            if number is not None:
                numbers.add(number)

    def matches(self, value: ir.Expr, labels: tuple[s.Label, ...]) -> ir.Expr | None:
        """The test whether a switch's value is one of these labels; None for the default."""
        test: ir.Expr | None = None
        for label in labels:
            if label.value is None:
                return None
            number = constant_int(self.context, label.value)
            if number is None:
                raise self.context.fail(label.value.span, "a case label must be a constant integer")
            # a later version converts the int (GLSL ES 3.20, 6.2)
            if 0 < self.context.es < 320 and isinstance(label.value, s.Number):
                kind = UINT if label.value.text.endswith(("u", "U")) else INT
                if kind != value.type:
                    message = f"this label is {a_type(kind)}, but the switch has {a_type(value.type)}"
                    raise self.context.fail(label.value.span, message)
            literal = ir.Literal(value.type, number & 0xFFFFFFFF if value.type == UINT else number, label.value.span)
            equal = ir.Binary(BOOL, "==", value, literal, label.span)
            test = equal if test is None else ir.Binary(BOOL, "||", test, equal, label.span)
        return test

    def label(self, label: s.Label) -> list[ir.Stmt]:
        raise self.context.fail(label.span, "a case must be inside a switch")


def _assigns(stmt: ir.Stmt, variable: ir.Local) -> bool:
    return isinstance(stmt, ir.Assign) and isinstance(stmt.target, ir.Local) and stmt.target.name == variable.name
