"""Makes uniforms of what a target's compute shaders cannot ask for: the lengths of buffers, the number of workgroups.

Why: Metal's buffers have no length, and D3D tells no shader how many workgroups there are. The program knows both.
Place: before `variable_parameters` and `uniform_parameters`, which pass on the new uniforms.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import INT, Type, components, spell
from sssgen.passes.scopes import claim, names_of
from sssgen.passes.unsupported import Note

_COUNT = "gl_NumWorkGroups"
COUNT_TEXT = "The number of workgroups of the dispatch"
"""The documentation of its uniform."""


def length_text(block: Type, member: str) -> str:
    """The documentation of the uniform for the length of a block's member."""
    return f"The number of elements of {spell(block)}.{member}"


def lengths_to_uniforms(module: ir.Module) -> tuple[ir.Module, list[Note]]:
    """The module with an int uniform `values_length` for each length of a buffer's member `values` that it reads."""
    uniforms = _Uniforms(module)

    def restate(stmt: ir.Stmt) -> ir.Block | None:
        if not isinstance(stmt, ir.MemoryOperation) or stmt.name != "arrayLength" or stmt.result is None:
            return None
        (array,) = stmt.args
        assert isinstance(array, ir.Member) and isinstance(array.value, ir.Global)
        message = f"'{array.field}.length()' is the uniform '{{}}' here"
        doc = length_text(array.value.type, array.field)
        uniform = uniforms.uniform(
            doc, f"{array.field}_length", INT, message, "set it to the number of elements", stmt.span
        )
        return (ir.Assign(stmt.result, "", uniform, stmt.span),)

    return uniforms.added_to(rewrite_module(module, lambda expr: expr, restate))


def group_count_to_uniform(module: ir.Module) -> tuple[ir.Module, list[Note]]:
    """The module with a uvec3 uniform in the place of gl_NumWorkGroups, if it reads that."""
    variable = next((variable for variable in module.variables if variable.builtin == _COUNT), None)
    if variable is None:
        return module, []
    uniforms = _Uniforms(module)
    message = f"{_COUNT} is the uniform '{{}}' here"
    hint = "set it to the number of workgroups for each dispatch"
    uniform = uniforms.uniform(COUNT_TEXT, _COUNT.removeprefix("gl_"), variable.type, message, hint, variable.span)

    def change(expr: ir.Expr) -> ir.Expr:
        return uniform if isinstance(expr, ir.Global) and expr.name == variable.name else expr

    others = tuple([other for other in module.variables if other is not variable])
    return uniforms.added_to(rewrite_module(module._replace(variables=others), change))


class _Uniforms:
    """New uniforms of a module, with a note for each."""

    def __init__(self, module: ir.Module) -> None:
        self.taken = names_of(module)
        self.uniforms: dict[str, ir.Uniform] = {}
        """By what they are, which is their documentation."""
        self.notes: list[Note] = []

    def uniform(self, doc: str, name: str, type_: Type, message: str, hint: str, span: ir.Span) -> ir.Global:
        """The uniform with this documentation, which gets about that name."""
        if doc not in self.uniforms:
            name = claim(name, self.taken)
            self.uniforms[doc] = ir.Uniform(name, type_, (0.0,) * components(type_), (), "", doc, span)
            self.notes.append(Note(message.format(name), span, hint))
        return ir.Global(type_, self.uniforms[doc].name, span)

    def added_to(self, module: ir.Module) -> tuple[ir.Module, list[Note]]:
        return module._replace(uniforms=(*module.uniforms, *self.uniforms.values())), self.notes
