"""The syntax tree: the source before names and types are resolved. Nodes are never changed.

`depth` counts the levels below a node, so that the parser can refuse trees that would exhaust the checker's stack.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from sssgen.ir.spans import NOWHERE, Span


@dataclass(slots=True)
class Name:
    text: str
    span: Span


@dataclass(slots=True)
class Number:
    """An integer or float literal as written."""

    text: str
    is_float: bool
    span: Span


@dataclass(slots=True)
class Boolean:
    value: bool
    span: Span


@dataclass(slots=True)
class Prefix:
    op: str
    operand: Expression
    span: Span
    depth: int


@dataclass(slots=True)
class Infix:
    op: str
    left: Expression
    right: Expression
    span: Span
    depth: int


@dataclass(slots=True)
class Conditional:
    condition: Expression
    yes: Expression
    no: Expression
    span: Span
    depth: int


@dataclass(slots=True)
class TypeName:
    """A type as written; `lengths` are an array's (an Unsized for `[]`), `struct` is a struct declared in place."""

    name: str
    lengths: tuple[Expression, ...]
    span: Span
    struct: StructSyntax | None = None


@dataclass(slots=True)
class Unsized:
    """The length of `float[]`, which its value determines."""

    span: Span


@dataclass(slots=True)
class CallOf:
    """A call of a function, of a constructor when `callee` is a type, or of a method when it is a member."""

    callee: Name | TypeName | MemberOf
    args: tuple[Expression, ...]
    span: Span
    depth: int


@dataclass(slots=True)
class IndexOf:
    value: Expression
    index: Expression
    span: Span
    depth: int


@dataclass(slots=True)
class MemberOf:
    value: Expression
    name: Name
    span: Span
    depth: int


@dataclass(slots=True)
class Assignment:
    """`target op= value`; `++` and `--` are `+= 1` and `-= 1` with a value of None.

    As an expression its value is the target's: the new one, but for `x++` and `x--` (`after`) the old one.
    """

    target: Expression
    op: str
    value: Expression | None
    span: Span
    depth: int = 0
    after: bool = False


@dataclass(slots=True)
class Comma:
    """Expressions that are evaluated in order; the value is that of the last."""

    parts: tuple[Expression, ...]
    span: Span
    depth: int


@dataclass(slots=True)
class Listed:
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


@dataclass(slots=True)
class Qualifiers:
    """The qualifiers before a type: keywords, and the items of `layout(…)`."""

    keywords: tuple[str, ...] = ()
    layout: tuple[tuple[str, Expression | None], ...] = ()
    span: Span = NOWHERE


PLAIN = Qualifiers()


@dataclass(slots=True)
class Hint:
    name: Name
    args: tuple[float | str, ...]


@dataclass(slots=True)
class Declarator:
    """One name of a declaration."""

    name: Name
    lengths: tuple[Expression, ...]
    value: Expression | None
    hints: tuple[Hint, ...] = ()


@dataclass(slots=True)
class Declaration:
    """Variables, members or constants of one type; without declarators it declares only the type's struct."""

    qualifiers: Qualifiers
    type: TypeName
    declarators: tuple[Declarator, ...]
    span: Span
    depth: int = 0


@dataclass(slots=True)
class ExpressionStatement:
    value: Expression
    span: Span
    depth: int = 0


@dataclass(slots=True)
class Compound:
    statements: tuple[Statement, ...]
    span: Span
    depth: int


@dataclass(slots=True)
class IfStatement:
    condition: Expression
    then: Statement
    otherwise: Statement | None
    span: Span
    depth: int


@dataclass(slots=True)
class ForStatement:
    init: Statement | None
    condition: Expression | Declaration | None
    step: Expression | None
    body: Statement
    span: Span
    depth: int


@dataclass(slots=True)
class WhileStatement:
    condition: Expression | Declaration
    body: Statement
    span: Span
    depth: int


@dataclass(slots=True)
class DoStatement:
    body: Statement
    condition: Expression
    span: Span
    depth: int


@dataclass(slots=True)
class Label:
    """`case value:`, or `default:` without one."""

    value: Expression | None
    span: Span
    depth: int = 0


@dataclass(slots=True)
class SwitchStatement:
    value: Expression
    body: Compound
    span: Span
    depth: int


@dataclass(slots=True)
class Jump:
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


@dataclass(slots=True)
class Parameter:
    direction: str
    type: TypeName
    name: Name | None
    lengths: tuple[Expression, ...]
    const: bool = False


@dataclass(slots=True)
class FunctionSyntax:
    """A function; a prototype has no body."""

    result: TypeName
    name: Name
    params: tuple[Parameter, ...]
    body: Compound | None
    doc: str


@dataclass(slots=True)
class GlobalSyntax:
    """Constants, uniforms, inputs, outputs or private variables, according to the qualifiers."""

    declaration: Declaration
    doc: str


@dataclass(slots=True)
class BlockSyntax:
    """`uniform Camera { mat4 view; } camera;`; `instance` is None where members are named without it."""

    qualifiers: Qualifiers
    name: Name
    members: tuple[Declaration, ...]
    instance: Name | None
    lengths: tuple[Expression, ...]
    doc: str


@dataclass(slots=True)
class StructSyntax:
    name: Name
    members: tuple[Declaration, ...]
    doc: str


@dataclass(slots=True)
class LayoutSyntax:
    """`layout(local_size_x = 8) in;`: qualifiers of the whole shader."""

    qualifiers: Qualifiers
    name: Name
    doc: str = ""


External: TypeAlias = FunctionSyntax | GlobalSyntax | BlockSyntax | StructSyntax | LayoutSyntax


@dataclass(slots=True)
class File:
    """A parsed source file."""

    name: str
    externals: tuple[External, ...]
