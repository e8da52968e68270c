"""Prints the subset of WGSL that naga and Tint both accept.

Out parameters are pointers; a variable that is assigned only once is a `let`; uniforms are in one struct.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import VOID, Array, Sampler, Scalar, Struct, Type
from sssgen.ir.walk import subexpressions
from sssgen.passes.scopes import assigned, outs_of
from sssgen.passes.stage.atomic_places import atomic_places, memory_of
from sssgen.passes.uniform_blocks import block_type
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.printed_lines import Line, documented, wrap
from sssgen.targets.printers.printer import POSTFIX, PRIMARY, UNARY, Printer
from sssgen.targets.printers.wgsl_entry import print_entry
from sssgen.targets.uniform_layout import Member, padding

_TYPED = (ir.Local, ir.Global, ir.Call, ir.Construct)


class WgslPrinter(Printer):
    """Overrides declarations and parameters; expressions differ in conversions and selects."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.uniforms = frozenset(uniform.name for uniform in module.uniforms)
        self.outs = outs_of(module.functions)
        self.assigned: set[str] = set()
        """The variables that the current function assigns to after their declaration."""
        self.atomics = atomic_places(module)
        """The shared variables and the members of storage buffers that hold atomics."""
        self.addressed = False
        """Whether a place is printed and not its value."""
        self.pointers: set[str] = set()
        """The parameters of the current function that are pointers."""

    def type(self, type_: Type) -> str:
        if isinstance(type_, Array) and not type_.length:
            return f"array<{self.type(type_.element)}>"
        if isinstance(type_, Array):
            return f"array<{self.type(type_.element)}, {type_.length}>"
        return super().type(type_)

    def variable(self, type_: Type, name: str) -> str:
        return f"{name}: {self.type(type_)}"

    def print_function(self, function: ir.Function) -> list[Line]:
        self.assigned = assigned(function, self.outs)
        self.pointers = {param.name for param in function.params if param.direction != "in"}
        return super().print_function(function)

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        """An expression; memory of atomics is read by atomicLoad."""
        if self.atomics and isinstance(expr.type, Scalar) and memory_of(expr) in self.atomics and not self.addressed:
            return f"atomicLoad(&{self.place(expr)})", PRIMARY
        if self.addressed and isinstance(expr, ir.Index):
            place = self.place(expr.value)
            self.addressed = False
            text = f"{place}[{self.expr(expr.index)}]"
            self.addressed = True
            return text, POSTFIX
        if type(expr) is ir.Local:
            return (f"*{expr.name}", UNARY) if expr.name in self.pointers else (expr.name, PRIMARY)
        return super().bound(expr)

    def place(self, expr: ir.Expr) -> str:
        """A place in memory, without reading it."""
        outer, self.addressed = self.addressed, True
        text = self.expr(expr, POSTFIX)
        self.addressed = outer
        return text

    def memory(self, stmt: ir.MemoryOperation) -> str:
        if not stmt.args:
            return super().memory(stmt)
        place, *values = stmt.args
        name = ir.Local(place.type, self.place(place), place.span)
        return super().memory(stmt._replace(args=(name, *values)))

    def simple(self, stmt: ir.Stmt) -> str:
        """A statement; memory of atomics is written by atomicStore."""
        if isinstance(stmt, ir.Assign) and self.atomics and memory_of(stmt.target) in self.atomics:
            value = stmt.value
            if stmt.op:
                value = ir.Binary(value.type, stmt.op, stmt.target, value, stmt.span)
            return f"atomicStore(&{self.place(stmt.target)}, {self.expr(value)})"
        return super().simple(stmt)

    def block(self, block: ir.Block, indent: int) -> list[Line]:
        """A block; a barrier of memory beside one of control is the same barrier."""
        lines: list[Line] = []
        for line in super().block(block, indent):
            if not (lines and line.text.endswith("Barrier();") and lines[-1].text == line.text):
                lines.append(line)
        return lines

    def stored_type(self, type_: Type, key: tuple[str, ...]) -> str:
        """The type of shared memory or of a member of a storage buffer."""
        if key not in self.atomics:
            return self.type(type_)
        if isinstance(type_, Array):
            length = f", {type_.length}" if type_.length else ""
            return f"array<{self.stored_type(type_.element, key)}{length}>"
        return f"atomic<{self.type(type_)}>"

    def global_value(self, value: ir.Global) -> str:
        in_block = value.name in self.uniforms and not isinstance(value.type, Sampler)
        return f"material.{value.name}" if in_block else value.name

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        text, binding = super().intrinsic(call)
        if "wgsl" in BUILTINS[call.name].explicit_type and not _has_type(call):
            first = self.expr(call.args[0])
            text = text.replace(first, f"{self.type(call.args[0].type)}({first})", 1)
        return text, binding

    def select(self, select: ir.Select) -> tuple[str, int]:
        return f"select({self.arguments((select.no, select.yes, select.condition))})", PRIMARY

    def listed(self, texts: list[str]) -> str:
        """The arguments; `(x < y)` is in parentheses, as `x < y, z > t` would be read as a template x<y, z>."""
        first = [f"({text})" if _has_open_less(text) else text for text in texts[:-1]]
        last = texts[-1:]
        if self.target.dialect == "wgsl-wesl" and first != texts[:-1]:  # npm wesl reads `<y), z>` as a template, too
            last = [f"({text})" for text in last]
        return ", ".join([*first, *last])

    def argument(self, arg: ir.Expr, param: ir.Param) -> str:
        if param.direction == "in" or not isinstance(arg, ir.Local):
            return super().argument(arg, param)
        return arg.name if arg.name in self.pointers else f"&{arg.name}"

    def target_of(self, target: ir.Expr) -> str:
        return self.expr(target, UNARY)

    def declare(self, declare: ir.Declare) -> str:
        written = declare.name in self.assigned
        word = "var" if written or declare.value is None else "let"
        if declare.value is None:
            return f"{word} {self.variable(declare.type, declare.name)}"
        return f"{word} {declare.name} = {self.typed(declare.value, declare.type)}"

    def typed(self, value: ir.Expr, type_: Type) -> str:
        """An initialiser. An untyped literal is abstract, for which `i32` and `f32` are the defaults anyway."""
        return self.expr(value)

    def param(self, param: ir.Param) -> str:
        if isinstance(param.type, Sampler) or param.direction == "in":
            return super().param(param)
        return f"{param.name}: ptr<function, {self.type(param.type)}>"

    def signature(self, function: ir.Function) -> str:
        params = ", ".join([self.param(param) for param in function.params])
        result = "" if function.result == VOID else f" -> {self.type(function.result)}"
        return f"fn {function.name}({params}){result}"

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        assert isinstance(struct.type, Struct)
        name = struct.type.name
        fields = [
            Line(f"    {field.name}: {self.stored_type(field.type, (name, field.name))},", struct.span)
            for field in struct.type.fields
        ]
        return [Line(f"struct {name} {{", struct.span), *fields, Line("}")]

    def print_constant(self, constant: ir.Constant) -> list[Line]:
        declared = self.variable(constant.type, constant.name)
        return wrap(f"const {declared} = {self.expr(constant.value)};", constant.span)

    def buffer_binding(self, buffer: ir.Variable) -> int:
        """Behind those of the textures and samplers."""
        textures = sum([isinstance(uniform.type, Sampler) for uniform in self.module.uniforms])
        return self.target.bindings.first + 1 + 2 * textures + self.buffers.index(buffer)

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        if variable.storage in ("shared", "buffer"):
            text = f"{variable.name}: {self.stored_type(variable.type, (variable.name,))};"
            if variable.storage == "shared":
                return self.with_comments(variable, [Line(f"var<workgroup> {text}", variable.span)])
            place = f"@group({self.group}) @binding({self.buffer_binding(variable)})"
            access = "read" if variable.access == "readonly" else "read_write"
            return self.with_comments(variable, [Line(f"{place} var<storage, {access}> {text}", variable.span)])
        declared = f"var<private> {self.variable(variable.type, variable.name)}"
        value = f" = {self.expr(variable.value)}" if variable.value is not None else ""
        return self.with_comments(variable, wrap(f"{declared}{value};", variable.span))

    def print_entry(self, name: str) -> list[Line]:
        assert self.stage is not None
        return print_entry(self, self.stage, name, f"material.{self.stage.resolution}")

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The uniform struct; WGSL's own alignment gives the offsets of std140."""
        if not members:
            return []
        lines = [Line("struct Material {")]
        for member in members:
            text = self.type(block_type(member.uniform.type, self.target.capabilities))
            lines.append(documented(f"    {member.uniform.name}: {text},", member.uniform))
        if self.target.bindings.padded:
            lines += [Line(f"    padding_{index}: f32,") for index in range(padding(members))]
        place = f"@group({self.group}) @binding({self.target.bindings.first})"
        return [*lines, Line("}"), Line(f"{place} var<uniform> material: Material;")]

    @property
    def group(self) -> int | str:
        return self.target.bindings.group or self.target.material_group

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """Each texture and its sampler, at the bindings after the uniform struct's."""
        lines = []
        for index, texture in enumerate(textures):
            binding = self.binding(index)
            for half, name, type_ in (
                ("texture", texture.name, self.type(texture.type)),
                ("sampler", self.sampler(texture.name), self.sampler_type(texture.type)),
            ):
                place = f"@group({binding['group']}) @binding({binding[half]})"
                lines.append(Line(f"{place} var {name}: {type_};", texture.span))
        return lines

    def binding(self, index: int) -> dict[str, int | str]:
        first = self.target.bindings.first
        return {"group": self.group, "texture": first + 1 + 2 * index, "sampler": first + 2 + 2 * index}


def _has_type(call: ir.Intrinsic) -> bool:
    """Whether something in the call is no literal, so that its numbers are not abstract."""
    return any(isinstance(part, _TYPED) for part in subexpressions(call))


def _has_open_less(text: str) -> bool:
    """Whether a `<` is outside of parentheses."""
    if " < " not in text:
        return False
    depth = 0
    for index, char in enumerate(text):
        depth += (char in "([") - (char in ")]")
        if depth == 0 and text.startswith(" < ", index):
            return True
    return False
