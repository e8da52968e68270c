"""The lengths that arrays without one get from their use, in desktop GLSL (GLSL 4.60, section 4.1.9).

`float a[]; a[3] = 1.0;` has 4 elements, as does `float a[]; float a[4];`. An array that is never used has one.

The uses may follow the declaration, so that they are counted before the file is checked, by scope.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass

from sssgen.ir.spans import Span
from sssgen.lang.check.constant_values import integer_value
from sssgen.lang.syntax import tree as s

_SCOPES = (
    s.FunctionSyntax, s.Compound, s.IfStatement, s.ForStatement, s.WhileStatement, s.DoStatement, s.SwitchStatement
)  # fmt: skip
_OPERATORS: dict[str, Callable[[int, int], int]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.floordiv,
    "%": operator.mod,
}


@dataclass(slots=True)
class _Variable:
    """What the file says of a variable: a constant's value, and an array's lengths."""

    value: int | None = None
    stated: int = 0
    """The length with which it is declared again"""
    least: int = 0
    """The least length that suits all constant indices"""
    without_length: bool = False
    used: bool = False

    def length(self) -> int:
        """Its length; 0 where it is used, and no use says the length."""
        return self.stated or self.least or (0 if self.used else 1)


class ImplicitLengths:
    """The lengths of one file's arrays without one, by the places of their names."""

    def __init__(self, file: s.File) -> None:
        self.file = file
        self.scopes: list[dict[str, _Variable]] = [{}]
        self.arrays: dict[Span, _Variable] = {}

    def of(self, name: s.Name) -> int:
        """The length of an array by the name in its declaration; 0 where the file does not say it."""
        if not self.arrays:  # most files have none, so that nothing is counted in them
            self.visit(self.file.externals)
        return self.arrays[name.span].length() if name.span in self.arrays else 0

    def find(self, name: str) -> _Variable:
        return next((scope[name] for scope in reversed(self.scopes) if name in scope), _Variable())

    def visit(self, node: object) -> None:
        """Counts the uses in a part of the file."""
        if isinstance(node, s.Name):
            self.find(node.text).used = True
        elif isinstance(node, s.IndexOf):
            self.index(node)
        elif isinstance(node, s.MemberOf):
            self.visit(node.value)
        elif isinstance(node, s.CallOf):
            self.visit((node.callee if not isinstance(node.callee, s.Name) else (), node.args))
        elif isinstance(node, s.Declaration):
            for declarator in node.declarators:
                self.declare(node, declarator)
        elif isinstance(node, s.Parameter):
            if node.name is not None:
                self.scopes[-1][node.name.text] = _Variable()
        elif isinstance(node, s.BlockSyntax):
            if node.instance is not None:
                self.scopes[-1][node.instance.text] = _Variable()
            else:
                self.visit(node.members)
        elif isinstance(node, tuple):
            for part in node:
                self.visit(part)
        elif isinstance(node, _SCOPES):
            self.scopes.append({})
            self.visit_fields(node)
            self.scopes.pop()
        elif is_dataclass(node) and not isinstance(node, s.StructSyntax):
            self.visit_fields(node)

    def visit_fields(self, node: object) -> None:
        for field in fields(node):  # type: ignore[arg-type]  # both callers have a dataclass, of many classes
            self.visit(getattr(node, field.name))

    def index(self, index: s.IndexOf) -> None:
        self.visit((index.value, index.index))
        if isinstance(index.value, s.Name):
            array, number = self.find(index.value.text), self.number(index.index)
            array.least = max(array.least, number + 1 if number is not None else 0)

    def declare(self, declaration: s.Declaration, declarator: s.Declarator) -> None:
        self.visit((declarator.lengths, declarator.value))
        name, scope, variable = declarator.name, self.scopes[-1], _Variable()
        lengths = (*declarator.lengths, *declaration.type.lengths)
        if lengths and declarator.value is None:
            before = scope.get(name.text, variable)
            variable = before if before.without_length else variable
            if isinstance(lengths[0], s.Unsized):
                self.arrays[name.span], variable.without_length = variable, True
            else:
                variable.stated = variable.stated or self.number(lengths[0]) or 0
        elif "const" in declaration.qualifiers.keywords and declarator.value is not None:
            variable.value = self.number(declarator.value)
        scope[name.text] = variable

    def number(self, expression: s.Expression) -> int | None:
        """The value of a constant that consists of integers, names of constants and operators; else None."""
        if isinstance(expression, s.Number) and not expression.is_float:
            return integer_value(expression.text)
        if isinstance(expression, s.Name):
            return self.find(expression.text).value
        if isinstance(expression, s.Infix) and expression.op in _OPERATORS:
            left, right = self.number(expression.left), self.number(expression.right)
            if left is None or right is None or (expression.op in "/%" and (left < 0 or right <= 0)):
                return None
            return _OPERATORS[expression.op](left, right)
        return None
