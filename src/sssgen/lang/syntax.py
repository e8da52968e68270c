"""The syntax tree: what was written, before names and types are resolved.

`depth` on what nests counts the levels below, so that the checker can refuse what would exhaust its stack.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from ..ir.nodes import Span


class Name(NamedTuple):
    text: str
    span: Span


class Number(NamedTuple):
    """An integer or float literal as written."""

    text: str
    is_float: bool
    span: Span


class Boolean(NamedTuple):
    value: bool
    span: Span


class Prefix(NamedTuple):
    op: str
    operand: Expression
    span: Span
    depth: int


class Infix(NamedTuple):
    op: str
    left: Expression
    right: Expression
    span: Span
    depth: int


class Conditional(NamedTuple):
    condition: Expression
    yes: Expression
    no: Expression
    span: Span
    depth: int


class TypeName(NamedTuple):
    """A type as written; `length` is the array length, if it is an array."""

    name: str
    length: Expression | None
    span: Span


class CallOf(NamedTuple):
    """A call of a function, or of a constructor when `callee` is a type."""

    callee: Name | TypeName
    args: tuple[Expression, ...]
    span: Span
    depth: int


class IndexOf(NamedTuple):
    value: Expression
    index: Expression  # type: ignore[assignment]  # hides tuple.index, which nothing here asks for
    span: Span
    depth: int


class MemberOf(NamedTuple):
    value: Expression
    name: Name
    span: Span
    depth: int


Expression: TypeAlias = Name | Number | Boolean | Prefix | Infix | Conditional | CallOf | IndexOf | MemberOf


class Declarator(NamedTuple):
    """One name of a declaration; `length` is an Empty for `[]`."""

    name: Name
    length: Expression | None
    value: Expression | None


class Declaration(NamedTuple):
    const: bool
    type: TypeName
    declarators: tuple[Declarator, ...]
    span: Span
    depth: int = 0


class Assignment(NamedTuple):
    """`target op= value`; `++` and `--` arrive as `+= 1` and `-= 1` with a value of None."""

    target: Expression
    op: str
    value: Expression | None
    span: Span
    depth: int = 0


class ExpressionStatement(NamedTuple):
    value: Expression
    span: Span
    depth: int = 0


class Compound(NamedTuple):
    statements: tuple[Statement, ...]
    span: Span
    depth: int


class IfStatement(NamedTuple):
    condition: Expression
    then: Statement
    otherwise: Statement | None
    span: Span
    depth: int


class ForStatement(NamedTuple):
    init: Statement | None
    condition: Expression | None
    step: Statement | None
    body: Statement
    span: Span
    depth: int


class WhileStatement(NamedTuple):
    condition: Expression
    body: Statement
    span: Span
    depth: int


class Jump(NamedTuple):
    """return (perhaps with a value), break, continue or discard."""

    kind: str
    value: Expression | None
    span: Span
    depth: int = 0


Statement: TypeAlias = (
    Declaration | Assignment | ExpressionStatement | Compound | IfStatement | ForStatement | WhileStatement | Jump
)


class Parameter(NamedTuple):
    direction: str
    type: TypeName
    name: Name | None
    length: Expression | None


class FunctionSyntax(NamedTuple):
    """A function; a prototype has no body."""

    result: TypeName
    name: Name
    params: tuple[Parameter, ...]
    body: Compound | None
    doc: str


class Hint(NamedTuple):
    name: Name
    args: tuple[float | str, ...]


class UniformSyntax(NamedTuple):
    type: TypeName
    name: Name
    length: Expression | None
    hints: tuple[Hint, ...]
    value: Expression | None
    doc: str


class ConstantSyntax(NamedTuple):
    declaration: Declaration


class StructSyntax(NamedTuple):
    name: Name
    members: tuple[Declaration, ...]
    doc: str


class IncludeSyntax(NamedTuple):
    path: str
    span: Span


External: TypeAlias = FunctionSyntax | UniformSyntax | ConstantSyntax | StructSyntax | IncludeSyntax


class File(NamedTuple):
    """A parsed source file."""

    name: str
    externals: tuple[External, ...]
    comments: tuple[tuple[int, int, str], ...]
    """Every comment: its first line, its last line, its text as written."""
