"""The nodes of the IR: small immutable tuples, each with the span of its source.

Every expression has its type; no overload, implicit conversion or name is left to resolve. Assignments are statements,
so an expression has no side effects except through a call's out parameters. Nodes are named tuples, which are cheap to
create. Compare nodes by identity or by their text form (`ir.text`), not with `==`, which ignores the class of a tuple.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from sssgen.ir.spans import NOWHERE as NOWHERE
from sssgen.ir.spans import Span as Span
from sssgen.ir.types import Type, spell

# Expressions


class Literal(NamedTuple):
    """A constant scalar."""

    type: Type
    value: float | int | bool
    span: Span


class Local(NamedTuple):
    """A parameter or local variable of the function."""

    type: Type
    name: str
    span: Span


class Global(NamedTuple):
    """A uniform, a texture, a module constant or a module variable."""

    type: Type
    name: str
    span: Span


class Unary(NamedTuple):
    """`-x`, `!x` or `~x`."""

    type: Type
    op: str
    operand: Expr
    span: Span


class Binary(NamedTuple):
    """`left op right`. On matrices `*` is the matrix product; `==` and `!=` give one bool."""

    type: Type
    op: str
    left: Expr
    right: Expr
    span: Span


class Select(NamedTuple):
    """`condition ? yes : no`; only the chosen arm is evaluated."""

    type: Type
    condition: Expr
    yes: Expr
    no: Expr
    span: Span


class Call(NamedTuple):
    """A call of a function of the module, named by its key (see `Function.key`)."""

    type: Type
    function: str
    args: tuple[Expr, ...]
    span: Span


class Intrinsic(NamedTuple):
    """A call of a builtin of the intrinsic table."""

    type: Type
    name: str
    args: tuple[Expr, ...]
    span: Span


class Construct(NamedTuple):
    """`vec3(a, b)`, `float(i)`, `mat3(x, y, z)`, `Surface(…)`, `float[2](a, b)`: conversion or assembly."""

    type: Type
    args: tuple[Expr, ...]
    span: Span


class Swizzle(NamedTuple):
    """`value.zyx`; `components` is spelled with x, y, z, w."""

    type: Type
    value: Expr
    components: str
    span: Span


class Index(NamedTuple):
    """`value[index]`: an array's element, a vector's component or a matrix's column."""

    type: Type
    value: Expr
    index: Expr  # type: ignore[assignment]  # hides tuple.index, which no node needs
    span: Span


class Member(NamedTuple):
    """`value.field` of a struct."""

    type: Type
    value: Expr
    field: str
    span: Span


Expr: TypeAlias = (
    Literal | Local | Global | Unary | Binary | Select | Call | Intrinsic | Construct | Swizzle | Index | Member
)


# Statements


class Declare(NamedTuple):
    """A local variable; without a value it is undefined."""

    name: str
    type: Type
    value: Expr | None
    span: Span


class Assign(NamedTuple):
    """`target op= value`; `op` is '' for plain assignment."""

    target: Expr
    op: str
    value: Expr
    span: Span


class Evaluate(NamedTuple):
    """A call whose result is not used."""

    call: Expr
    span: Span


class Assume(NamedTuple):
    """A fact that the author states: the range pass relies on it, and no text is emitted."""

    condition: Expr
    span: Span


class If(NamedTuple):
    """A branch; `otherwise` may be empty."""

    condition: Expr
    then: Block
    otherwise: Block
    span: Span


class For(NamedTuple):
    """A bounded loop."""

    init: Stmt | None
    condition: Expr | None
    step: Stmt | None
    body: Block
    span: Span


class While(NamedTuple):
    """A loop that the checker found to be bounded."""

    condition: Expr
    body: Block
    span: Span


class Break(NamedTuple):
    """Leaves the innermost loop."""

    span: Span


class Continue(NamedTuple):
    """Continues with the next iteration of the innermost loop."""

    span: Span


class Return(NamedTuple):
    """Leaves the function."""

    value: Expr | None
    span: Span


class Discard(NamedTuple):
    """Discards the fragment."""

    span: Span


class MemoryOperation(NamedTuple):
    """An operation of `ir.memory_operations`; its first argument is the place in memory, `result` takes its result."""

    name: str
    args: tuple[Expr, ...]
    result: Expr | None
    span: Span


Stmt: TypeAlias = (
    Declare | Assign | Evaluate | Assume | If | For | While | Break | Continue | Return | Discard | MemoryOperation
)
Block: TypeAlias = tuple[Stmt, ...]


# Declarations


class Param(NamedTuple):
    """A parameter; `direction` is in, out or inout; `quantity` its quantity type or ''.

    `passes` is the uniform or module variable that every caller passes, or ''.
    """

    name: str
    type: Type
    direction: str
    quantity: str
    span: Span
    passes: str = ""


class Function(NamedTuple):
    """A function; `body` is None for a slot that a material must bind.

    `key` identifies an overload by name and parameter types, as in `box(vec3,vec3)`.
    """

    name: str
    params: tuple[Param, ...]
    result: Type
    quantity: str
    body: Block | None
    doc: str
    span: Span

    @property
    def key(self) -> str:
        return function_key(self.name, [param.type for param in self.params])

    def begun_with(self, stmts: Block) -> Function:
        """The function with these statements first."""
        return self._replace(body=(*stmts, *(self.body or ())))


class Uniform(NamedTuple):
    """A value or texture set from outside. `default` holds its components, empty for a texture.

    `hints` are the declaration's hints with their arguments, as in `("hint_range", (0.0, 1.0))`. `path` is what a
    program calls it where it is a part of a uniform of the source, or '': `lights[2].color` for a member of all
    elements, `maps[1]` for one texture, `Camera.view` for a member of a block with an instance name. `block` is the
    uniform block that declares it, or ''; `row_major` is whether the block stores its matrices row by row, and `layout`
    is std140, shared, packed, or '' where it states none. `location` is the one that the source states, or -1;
    `precision` is that of GLSL ES, in which both stages of a program agree, or ''.
    """

    name: str
    type: Type
    default: tuple[float, ...]
    hints: tuple[tuple[str, tuple[float | str, ...]], ...]
    quantity: str
    doc: str
    span: Span
    path: str = ""
    block: str = ""
    row_major: bool = False
    layout: str = ""
    location: int = -1
    precision: str = ""

    @property
    def source(self) -> str:
        """What a program calls it."""
        return self.path or self.name


class Constant(NamedTuple):
    """A module constant."""

    name: str
    type: Type
    value: Expr
    span: Span


class Variable(NamedTuple):
    """A module variable: each run of a shader has its own.

    `storage` is private, in (an input of the stage, read-only), out (an output), image, or of a compute shader shared
    (by its workgroup) or buffer (a storage buffer; its type is the struct of its members). A private one may have a
    `value` of constants, uniforms and earlier variables. `builtin` is the `gl_` name of a variable of GLSL, or ''.
    `interpolation` is flat, noperspective, centroid or ''; `location` is -1 if none is given, of a buffer or image its
    binding. `access` is that of these: readonly, writeonly or ''; `layout` is std430 or std140, of an image its format,
    or ''. `block` is the block of inputs or outputs that declares it, or ''; of a storage buffer its own where that has
    no instance name, so that its members are names at file scope. `order` is the number of a buffer or
    image among those of both stages of a program, -1 in a stage alone.
    """

    name: str
    type: Type
    storage: str
    value: Expr | None
    builtin: str
    interpolation: str
    location: int
    doc: str
    span: Span
    access: str = ""
    layout: str = ""
    block: str = ""
    order: int = -1


class StructDecl(NamedTuple):
    """The declaration of a struct type (the type itself holds the fields)."""

    type: Type
    doc: str
    span: Span


class Module(NamedTuple):
    """One program or library, in source order; once linked, functions come after those that they call."""

    structs: tuple[StructDecl, ...] = ()
    constants: tuple[Constant, ...] = ()
    uniforms: tuple[Uniform, ...] = ()
    functions: tuple[Function, ...] = ()
    variables: tuple[Variable, ...] = ()
    workgroup: tuple[int, ...] = ()
    """The three sizes of a compute shader's workgroup; () for all other modules."""


def function_key(name: str, types: list[Type]) -> str:
    """The key under which a function with these parameter types is called."""
    return f"{name}({','.join(map(spell, types))})"
