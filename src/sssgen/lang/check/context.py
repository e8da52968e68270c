"""What the checkers of one file share: the reporter, the declarations so far, and the state of the current function."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.spans import Span
from sssgen.ir.types import FLOAT, VOID, Struct, Type
from sssgen.ir.walk import statements
from sssgen.lang import shadertoy
from sssgen.lang.check.name_scope import GlobalValue, Scopes, Signature
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import Reporter, did_you_mean


class Language(NamedTuple):
    """What a file of plain GLSL is written in."""

    es: int = 0
    """The version of GLSL ES that the file names, or 0"""
    vertex: bool = False
    """Whether it is a vertex shader"""
    compute: bool = False
    """Whether it is a compute shader by its name, also without the size of its workgroup"""
    extensions: frozenset[str] = frozenset()
    """The names of the extensions that it asks for"""
    desktop: int = 0
    """The version of desktop GLSL that the file names, or 0"""
    precisions: Mapping[Span, str] = MappingProxyType({})
    """The precisions of the types in GLSL ES, by their places"""


class Typed(NamedTuple):
    """A checked expression and its quantity ('' for none)."""

    expr: ir.Expr
    quantity: str = ""


class AlreadyReported(Exception):
    """Unwinds to the statement or declaration that contains an error, once the error is reported."""


class FunctionContext:
    """The state of one function while it is checked. Expressions at file scope have one that holds no variables."""

    def __init__(self, result: Type = VOID, quantity: str = "") -> None:
        self.result, self.quantity = result, quantity
        self.scopes = Scopes()
        self.prelude: list[ir.Stmt] = []
        """The statements that run before the current expression: its side effects."""
        self.loop_depth = 0
        self.switches: list[ir.Local | None] = []
        """For each switch between the current statement and the innermost loop: the variable that requests a
        `continue` of that loop, where the switch itself becomes a loop; else None."""
        self.case_statements = 0
        """The number of statements in all switch cases, with those that they fall through to."""
        self.has_faults = False
        """Whether a statement was left out because of an error."""

    def temporary(
        self,
        name: str,
        value: ir.Expr | None,
        position: int | None = None,
        type_: Type | None = None,
        before: ir.Block = (),
        constant: bool = False,
    ) -> ir.Local:
        """A new variable with this value, declared in the prelude (at its end, or at `position`).

        Its name is `name`, with a number where that is taken, also inside the statements `before` which it is declared.
        `constant`: its value is a constant expression.
        """
        declared_type = type_ if type_ is not None else value.type if value is not None else FLOAT
        span = value.span if value is not None else ir.NOWHERE
        inner = {stmt.name for stmt in statements(before) if isinstance(stmt, ir.Declare)}
        variable = self.scopes.invent(name, declared_type, inner, constant)
        declaration = ir.Declare(variable.ir_name, declared_type, value, span)
        self.prelude.insert(len(self.prelude) if position is None else position, declaration)
        return ir.Local(declared_type, variable.ir_name, span)


class CheckContext:
    """The declarations of one file so far, and the function that is being checked.

    `plain`: the file is GLSL, where an int converts to a float and loops need no visible bound. Otherwise it is a
    technique. `converts`: numbers convert implicitly, as in desktop GLSL.
    """

    def __init__(self, reporter: Reporter, plain: bool = False, language: Language = Language()) -> None:  # noqa: B008 - immutable
        self.reporter = reporter
        self.plain = plain
        self.language = language
        self.es = language.es
        converting = any("implicit_conversions" in extension for extension in language.extensions)
        self.converts = plain and (converting or not self.es)
        self.file_scope = FunctionContext()
        self.function = self.file_scope
        self.check_expression: Callable[[s.Expression], Typed]
        """Checks an expression; the checker of expressions sets it."""
        self.length_by_use: Callable[[s.Name], int] = lambda name: 0
        """Gives the length of an array without one in desktop GLSL, by its declared name; 0 where its use says none."""
        self.declared_without_length: set[str] = set()
        """The variables at file scope that may be declared again, with their length."""
        self.struct_precisions: dict[str, str] = {}
        """The precisions of the members of structs, by the struct's name."""
        self.sequences = 0
        """The number of comma operators so far."""
        self.structs: dict[str, Struct] = {}
        self.struct_declarations: list[ir.StructDecl] = []
        self.functions: dict[str, list[Signature]] = {}
        self.globals: dict[str, GlobalValue] = {}
        self.variables: dict[str, ir.Variable] = {}
        """The inputs, outputs and private variables of a whole shader."""
        self.uniform_blocks: set[str] = set()
        """The names of the uniform blocks so far."""
        self.uniform_layout: tuple[tuple[str, s.Expression | None], ...] = ()
        """The layout of all uniform blocks that follow."""
        self.buffer_layout: tuple[tuple[str, s.Expression | None], ...] = ()
        """The layout of all storage buffers that follow."""
        self.uniform_locations: dict[int, str] = {}
        """The locations that the file gives its uniforms → the names of these."""
        self.sharing: set[str] = set()
        """The outputs that share a location with others: they state their components, or their index for blending."""
        self.workgroup: tuple[int, ...] = ()
        """The sizes of a compute shader's workgroup."""
        self.buffer_members: dict[str, ir.Member] = {}
        """The members of storage buffers without an instance name."""
        self.counters: set[str] = set()
        """The atomic counters, which are such members."""
        self.counter_place: s.Name | None = None
        """The name of a counter in the call of a counter's function that is being checked: it alone is allowed."""
        self.barriers: list[ir.Span] = []
        """The places of barriers, which compute shaders alone have."""
        self.derivatives: list[ir.Span] = []
        """The places of derivatives along the screen."""
        self.draw_uniforms: list[ir.Uniform] = []
        """The uniforms in place of variables that other languages lack."""
        self.file_names: set[str] = set()
        """The names that the file declares at file scope, also later."""
        self.faulty: set[str] = set()
        """Names whose declaration has an error. Their uses are not reported."""
        self.blocks: dict[str, dict[str, Typed]] = {}
        """The members of each block that has an instance name, by that name."""
        self.block_arrays: dict[str, list[str]] = {}
        """For each array of blocks, the instance names of the blocks that replace its elements."""
        self.aliases: dict[str, str] = {}
        """The names of the members of an input or output block without an instance name → those of the variables."""
        self.texture_arrays: dict[str, list[str]] = {}
        """For each array of textures, the names of the textures that replace its elements."""

        self.has_lines = False
        """Whether there are textures of one dimension."""

    def find_struct(self, name: str) -> Struct | None:
        """The struct that a name stands for here."""
        return self.function.scopes.find_struct(name) or self.structs.get(name)

    def fail(self, span: ir.Span, message: str, hint: str = "") -> AlreadyReported:
        """Reports an error; gives the exception to raise."""
        self.reporter.error(span, message, hint)
        return AlreadyReported()

    def unknown(self, span: ir.Span, kind: str, name: str, candidates: list[str]) -> AlreadyReported:
        """Reports a name that is not declared."""
        if name in self.faulty:
            return AlreadyReported()
        hint = did_you_mean(name, candidates)
        if self.plain and name in shadertoy.UNIFORMS:
            declaration = shadertoy.UNIFORMS[name].partition(" :")[0].partition(";")[0]
            hint = f"it is a uniform of Shadertoy: write {declaration};, or transpile with --entry shadertoy"
        return self.fail(span, f"unknown {kind} '{name}'", hint)

    def extent(self, name: str) -> tuple[float, float]:
        """The least and the largest value of a global integer."""
        declared = self.globals[name]
        number = declared.value[0] if declared.value else None
        return (number, number) if isinstance(number, int) else declared.extent

    def out_arguments(self, call: ir.Call) -> list[ir.Expr]:
        """The arguments that a call writes to."""
        overloads = self.functions[call.function.split("(")[0]]
        directions = next(signature.directions for signature in overloads if signature.key == call.function)
        return [arg for arg, direction in zip(call.args, directions, strict=True) if direction != "in"]
