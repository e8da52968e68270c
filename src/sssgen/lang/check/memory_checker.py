"""Checks what compute shaders share: workgroup sizes, storage buffers, atomics, barriers."""

from __future__ import annotations

import math

from sssgen.ir import nodes as ir
from sssgen.ir.memory_operations import MEMORY, MemoryRow
from sssgen.ir.types import INT, UINT, VOID, Array, Field, Matrix, Sampler, Struct, Type, unnested
from sssgen.ir.walk import subexpressions, written_root
from sssgen.lang.check.builtin_variables import INVOCATION
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.context import Typed
from sssgen.lang.check.declared_names import check_global_name, unused_global_name
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.image_checker import image_arguments
from sssgen.lang.check.name_scope import GlobalValue, Scopes
from sssgen.lang.check.type_names import array_type, named_type
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s

_RESULT_NAMES = {"arrayLength": "count", "imageLoad": "texel", "imageSize": "size"}
"""Operation → what a variable with its result is called; that of the others is the old value."""
_SIZES = ("local_size_x", "local_size_y", "local_size_z")
MAX_INVOCATIONS = 1024
"""Of a workgroup: what OpenGL and D3D guarantee (WebGPU: 256, unless the device is asked for more)."""


class MemoryChecker:
    """Checks these parts of one file; CallChecker and GlobalChecker call it."""

    def __init__(self, expressions: ExpressionChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions
        self.sizes: dict[str, int] = {}
        """The size of the workgroup, as far as the file states it"""

    def layout(self, layout: s.LayoutSyntax) -> None:
        """`layout(local_size_x = 8, local_size_y = 8) in;`, and the order in which uniform blocks store matrices."""
        sizes = {name: value for name, value in layout.qualifiers.layout if name in _SIZES and value is not None}
        context = self.context
        specialized = any(name.removesuffix("_id") in _SIZES for name, _ in layout.qualifiers.layout)
        if "uniform" in layout.qualifiers.keywords:
            if any(name == "std430" for name, _ in layout.qualifiers.layout):
                message = "std430 is a layout of storage buffers, not of uniform blocks"
                raise context.fail(layout.qualifiers.span, message, "write std140")
            context.uniform_layout = (*context.uniform_layout, *layout.qualifiers.layout)
        if "buffer" in layout.qualifiers.keywords:
            context.buffer_layout = (*context.buffer_layout, *layout.qualifiers.layout)
        if not (sizes or specialized) or "in" not in layout.qualifiers.keywords:
            return
        if 0 < context.es < 310:
            raise context.fail(layout.qualifiers.span, "compute shaders need GLSL ES 3.10", "write #version 310 es")
        context.workgroup = (1, 1, 1)  # with a wrong size it is a compute shader, too
        numbers = []
        for name in _SIZES:
            number = constant_int(context, sizes[name]) if name in sizes else 1
            if number is None or not 1 <= number <= MAX_INVOCATIONS:
                message = f"a {name} must be a constant from 1 to {MAX_INVOCATIONS}"
                raise context.fail(sizes[name].span, message, "write layout(local_size_x = 64) in;")
            if name in sizes and self.sizes.setdefault(name, number) != number:
                raise context.fail(sizes[name].span, f"{name} is already {self.sizes[name]}", "write it once")
            numbers.append(self.sizes.get(name, 1))
        if math.prod(numbers) > MAX_INVOCATIONS:
            raise context.fail(
                layout.qualifiers.span,
                f"a workgroup has at most {MAX_INVOCATIONS} invocations, not {math.prod(numbers)}",
                "the invocations are local_size_x * local_size_y * local_size_z",
            )
        context.workgroup = tuple(numbers)

    def buffer(self, block: s.BlockSyntax) -> None:
        """A storage buffer: a variable whose type is the struct of its members."""
        context, keywords = self.context, block.qualifiers.keywords
        fields: list[Field] = []
        for member in block.members:
            for declarator in member.declarators:
                if fields and unnested(fields[-1].type)[1][:1] == (0,):
                    message = "only the last member of a storage buffer can have no length"
                    raise context.fail(declarator.name.span, message)
                fields.append(Field(declarator.name.text, self.member_type(member, declarator)))
        own = (*context.buffer_layout, *block.qualifiers.layout)
        layouts = [own, *[member.qualifiers.layout for member in block.members]]
        rows = any(name == "row_major" for layout in layouts for name, _ in layout)
        if rows and any(_has_matrix(field.type) for field in fields):
            message = "matrices of storage buffers are stored column by column here, not row_major"
            hint = "leave row_major out, and transpose the matrix where it is read"
            context.reporter.error(block.name.span, message, hint)
        access = next((word for word in keywords if word in ("readonly", "writeonly")), "")
        if not access and all("readonly" in member.qualifiers.keywords for member in block.members):
            access = "readonly"
        items = dict(own)
        binding = constant_int(context, value) if (value := items.get("binding")) is not None else -1
        if binding is None or not -1 <= binding < 1000:
            raise context.fail(block.name.span, "a binding must be an integer from 0 to 999")
        check_global_name(context, block.name)
        struct = Struct(block.name.text, tuple(fields))
        context.struct_declarations.append(ir.StructDecl(struct, "", block.name.span))
        if block.instance is not None:
            check_global_name(context, block.instance)
        label = block.name.text
        name = block.instance.text if block.instance is not None else f"{label[0].lower()}{label[1:]}"
        if block.instance is None and (name == label or name in context.file_names):
            name = unused_global_name(context, f"{name}_buffer")
        layout = next((name for name, _ in reversed(own) if name in ("std140", "std430")), "std430")
        context.variables[name] = ir.Variable(
            name, struct, "buffer", None, "", "", binding, block.doc, block.name.span, access, layout,
            label if block.instance is None else "",
        )  # fmt: skip
        context.globals[name] = GlobalValue(struct, "", writable=access != "readonly")
        if block.instance is None:
            for member in block.members:
                for declarator in member.declarators:
                    check_global_name(context, declarator.name)
            whole = ir.Global(struct, name, block.name.span)
            for field in fields:
                context.buffer_members[field.name] = ir.Member(field.type, whole, field.name, block.name.span)

    def member_type(self, member: s.Declaration, declarator: s.Declarator) -> Type:
        """The type of a member; a length of `[]` is 0."""
        context = self.context
        base, _ = named_type(context, s.TypeName(member.type.name, (), member.type.span))
        lengths = (*declarator.lengths, *member.type.lengths)
        if lengths and isinstance(lengths[0], s.Unsized):
            inner = array_type(context, base, lengths[1:])
            type_: Type = Array(inner, 0)
        else:
            type_ = array_type(context, base, lengths)
        if holds(type_, "bool") or isinstance(unnested(type_)[0], Sampler):
            hint = "write uint, which is 0 or 1" if holds(type_, "bool") else ""
            held = "a bool" if hint else a_type(type_)
            raise context.fail(declarator.name.span, f"a storage buffer cannot hold {held}", hint)
        return type_

    def operation(self, row: MemoryRow, call: s.CallOf) -> Typed:
        """An atomic or a barrier: a statement before the one that contains the call."""
        context, function = self.context, self.context.function
        if function is context.file_scope:
            raise context.fail(call.span, f"{row.name} cannot be called outside of functions")
        count = row.has_place + row.values
        if len(call.args) != count:
            raise context.fail(call.span, f"{row.name} takes {count} arguments, but gets {len(call.args)}")
        if row.image:
            return self.result(row, *image_arguments(self.expressions, row, call), call)
        if row.has_place:
            self.expressions.check_place(call.args[0])
        args = self.expressions.operands(call.args, {0} if row.has_place else ())
        values = tuple([arg.expr for arg in args])
        if row.has_place:
            place = values[0]
            root = written_root(place)
            storage = (
                context.variables[root.name].storage
                if isinstance(root, ir.Global) and root.name in context.variables
                else ""
            )
            if storage not in ("shared", "buffer") or place.type not in (INT, UINT):
                message = f"{row.name} needs an int or uint in shared memory or in a storage buffer"
                raise context.fail(call.args[0].span, message)
            converted = [
                self.expressions.require(arg, place.type, "", written.span, f"argument {index + 2} of {row.name}")
                for index, (arg, written) in enumerate(zip(args[1:], call.args[1:], strict=True))
            ]
            values = (place, *converted)
        return self.result(row, values, values[0].type if values else VOID, call)

    def length(self, value: ir.Expr, call: s.CallOf) -> Typed:
        """The length of an array at the end of a storage buffer."""
        return self.result(MEMORY["arrayLength"], (value,), INT, call)

    def result(self, row: MemoryRow, values: tuple[ir.Expr, ...], type_: Type, call: s.CallOf) -> Typed:
        """The variable of this type that takes the result of an operation, which becomes a statement."""
        function, span = self.context.function, call.span
        if not row.has_place:
            self.context.barriers.append(span)
        result = None
        if row.returns and (row.needs_result or id(call) not in self.expressions.dropped):
            name = _RESULT_NAMES.get(row.name, "old")
            result = function.temporary(name, None, type_=type_)
        function.prelude.append(ir.MemoryOperation(row.name, values, result, span))
        return Typed(result if result is not None else ir.Literal(VOID, 0, span))

    def find_stage(self) -> None:
        """Makes a compute shader without a size, whose workgroups have one invocation, a compute shader."""
        context = self.context
        is_compute = context.language.compute or INVOCATION & context.variables.keys()
        if is_compute and not context.workgroup and "main" in context.functions:
            context.workgroup = (1, 1, 1)

    def check_stage(self) -> None:
        """Reports what only a compute shader can have, in any other file, and what only a fragment shader can have."""
        context = self.context
        if context.workgroup or (context.es and context.language.vertex):
            for span in context.derivatives:
                context.reporter.error(span, "derivatives along the screen belong to fragment shaders")
        if context.workgroup:
            return
        hint = "a compute shader has layout(local_size_x = 64) in;"
        for variable in context.variables.values():
            if variable.storage == "shared":
                context.reporter.error(variable.span, "shared memory belongs to compute shaders", hint)
        for span in context.barriers:
            context.reporter.error(span, "barriers belong to compute shaders", hint)


def stored_directly(stmts: list[ir.Stmt], scopes: Scopes) -> list[ir.Stmt]:
    """A statement with its prelude, where the result of an operation on memory goes straight to a variable that would
    only take it from a temporary one."""
    if len(stmts) < 3:
        return stmts
    *before, temporary, operation, last = stmts
    if not isinstance(operation, ir.MemoryOperation) or not isinstance(temporary, ir.Declare):
        return stmts
    taken = last.value if isinstance(last, ir.Declare | ir.Assign) else None
    result = operation.result
    if not isinstance(taken, ir.Local) or not isinstance(result, ir.Local) or taken.name != result.name:
        return stmts
    written = last.target.name if isinstance(last, ir.Assign) and isinstance(last.target, ir.Local) else ""
    if any(
        isinstance(part, ir.Local) and part.name == written for arg in operation.args for part in subexpressions(arg)
    ):
        return stmts  # a language may write the result before it has read the values
    if isinstance(last, ir.Declare) and last.type == result.type:
        scopes.forget(result.name)
        place = ir.Local(last.type, last.name, last.span)
        return [*before, last._replace(value=None), operation._replace(result=place)]
    if isinstance(last, ir.Assign) and isinstance(last.target, ir.Local) and not last.op:
        scopes.forget(result.name)
        return [*before, operation._replace(result=last.target)]
    return stmts


def _has_matrix(type_: Type) -> bool:
    innermost, _ = unnested(type_)
    if isinstance(innermost, Struct):
        return any(_has_matrix(field.type) for field in innermost.fields)
    return isinstance(innermost, Matrix)


def holds(type_: Type, kind: str) -> bool:
    """Whether there are scalars of a kind in it."""
    innermost, _ = unnested(type_)
    if isinstance(innermost, Struct):
        return any(holds(field.type, kind) for field in innermost.fields)
    return getattr(innermost, "kind", "") == kind
