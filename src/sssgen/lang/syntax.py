"""The syntax tree: what was written, before names and types are resolved.

`depth` on what nests counts the levels below, so that the checker can refuse what would exhaust its stack.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from ..ir.spans import NOWHERE, Span


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
    """A type as written; `lengths` are an array's (an Unsized for `[]`), `struct` is one declared on the spot."""

    name: str
    lengths: tuple[Expression, ...]
    span: Span
    struct: StructSyntax | None = None


class Unsized(NamedTuple):
    """The length of `float[]`, which the value tells."""

    span: Span


class CallOf(NamedTuple):
    """A call of a function, of a constructor when `callee` is a type, or of a method when it is a member."""

    callee: Name | TypeName | MemberOf
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


class Assignment(NamedTuple):
    """`target op= value`; `++` and `--` are `+= 1` and `-= 1` with a value of None.

    As an expression it has the target's value: of `x++` and `x--` (`after`) that from before.
    """

    target: Expression
    op: str
    value: Expression | None
    span: Span
    depth: int = 0
    after: bool = False


class Comma(NamedTuple):
    """Expressions one after the other; the last one is the value."""

    parts: tuple[Expression, ...]
    span: Span
    depth: int


class Listed(NamedTuple):
    """`{1.0, 2.0}`, the value of an array or struct."""

    items: tuple[Expression, ...]
    span: Span
    depth: int


Expression: TypeAlias = (
    Name
    | Number
    | Boolean
    | Prefix
    | Infix
    | Conditional
    | TypeName
    | Unsized
    | CallOf
    | IndexOf
    | MemberOf
    | Assignment
    | Comma
    | Listed
)


class Qualifiers(NamedTuple):
    """What stands before a type: its words, and the items of `layout(…)`."""

    words: tuple[str, ...] = ()
    layout: tuple[tuple[str, Expression | None], ...] = ()
    span: Span = NOWHERE


PLAIN = Qualifiers()


class Hint(NamedTuple):
    name: Name
    args: tuple[float | str, ...]


class Declarator(NamedTuple):
    """One name of a declaration."""

    name: Name
    lengths: tuple[Expression, ...]
    value: Expression | None
    hints: tuple[Hint, ...] = ()


class Declaration(NamedTuple):
    """Variables, members or constants of one type; without declarators it declares the type's struct alone."""

    qualifiers: Qualifiers
    type: TypeName
    declarators: tuple[Declarator, ...]
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
    step: Expression | None
    body: Statement
    span: Span
    depth: int


class WhileStatement(NamedTuple):
    condition: Expression
    body: Statement
    span: Span
    depth: int


class DoStatement(NamedTuple):
    body: Statement
    condition: Expression
    span: Span
    depth: int


class Label(NamedTuple):
    """`case value:`, or `default:` without one."""

    value: Expression | None
    span: Span
    depth: int = 0


class SwitchStatement(NamedTuple):
    value: Expression
    body: Compound
    span: Span
    depth: int


class Jump(NamedTuple):
    """return (perhaps with a value), break, continue or discard."""

    kind: str
    value: Expression | None
    span: Span
    depth: int = 0


Statement: TypeAlias = (
    Declaration
    | Assignment
    | ExpressionStatement
    | Compound
    | IfStatement
    | ForStatement
    | WhileStatement
    | DoStatement
    | SwitchStatement
    | Label
    | Jump
)


class Parameter(NamedTuple):
    direction: str
    type: TypeName
    name: Name | None
    lengths: tuple[Expression, ...]
    const: bool = False


class FunctionSyntax(NamedTuple):
    """A function; a prototype has no body."""

    result: TypeName
    name: Name
    params: tuple[Parameter, ...]
    body: Compound | None
    doc: str


class GlobalSyntax(NamedTuple):
    """Constants, uniforms, inputs, outputs and variables of the module, as their qualifiers say."""

    declaration: Declaration
    doc: str


class BlockSyntax(NamedTuple):
    """`uniform Camera { mat4 view; } camera;`; `instance` is None where its members are named alone."""

    qualifiers: Qualifiers
    name: Name
    members: tuple[Declaration, ...]
    instance: Name | None
    lengths: tuple[Expression, ...]
    doc: str


class StructSyntax(NamedTuple):
    name: Name
    members: tuple[Declaration, ...]
    doc: str


External: TypeAlias = FunctionSyntax | GlobalSyntax | BlockSyntax | StructSyntax


class File(NamedTuple):
    """A parsed source file."""

    name: str
    externals: tuple[External, ...]
