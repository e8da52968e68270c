"""Prints the Metal Shading Language, C++ with vectors.

There are no global variables but constants, so uniforms and textures are parameters of every function. Out parameters
are references into the thread's memory. C++ copies no arrays: here they are members of a struct, which it does copy;
the template declares it where the text names it.

In a compute shader the entry `kernel` has the storage buffers as parameters and declares the shared memory; functions
get references to both. A struct of a buffer has the layout std430: a vector of three that shares its 16 bytes with the
next member is packed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from sssgen.ir import nodes as ir
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.types import Array, Image, Sampler, Struct, Type, Vector, unnested
from sssgen.passes.stage.storage_layout import offsets
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.atomic_printer import AtomicPrinter
from sssgen.targets.printers.printed_lines import Line, with_doc, wrap
from sssgen.targets.printers.printer import POSTFIX, PRIMARY
from sssgen.targets.uniform_layout import Member

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import TextureBinding

_ACCESS = {"readonly": "read", "writeonly": "write", "": "read_write"}
ARRAY = "fixed_array"


class MetalPrinter(AtomicPrinter):
    """Overrides arrays, constructors of structs, and parameters."""

    constant = "constant"
    load = "atomic_load_explicit(&{0}, memory_order_relaxed)"
    store = "atomic_store_explicit(&{0}, {1}, memory_order_relaxed)"
    atomic = "atomic_{0}"

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.memories = {variable.name: variable for variable in module.variables}
        self.packed: set[tuple[str, str]] = set()
        """The structs' members that are packed vectors."""
        for buffer in self.buffers:
            self.pack(buffer.type)

    def pack(self, type_: Type) -> None:
        """Finds the packed vectors in the type of a storage buffer."""
        struct, _ = unnested(type_)
        if isinstance(struct, Struct):
            places = [*offsets(struct, "std430"), None]
            for field, place, after in zip(struct.fields, places, places[1:], strict=False):
                is_short = after is not None and place is not None and after - place < 16
                if isinstance(field.type, Vector) and field.type.size == 3 and is_short:
                    self.packed.add((struct.name, field.name))
                self.pack(field.type)

    def type(self, type_: Type) -> str:
        if isinstance(type_, Array):
            return self.array_of(self.type(type_.element), type_.length)
        return super().type(type_)

    def array_of(self, element: str, length: int) -> str:
        return f"{ARRAY}<{element}, {length}>"

    def variable(self, type_: Type, name: str) -> str:
        return f"{self.type(type_)} {name}"

    def element(self, array: str, type_: Type, index: str) -> str:
        is_struct = isinstance(type_, Array) and type_.length and array not in self.inlined.values()
        return f"{array}.items[{index}]" if is_struct else f"{array}[{index}]"

    def is_packed(self, expr: ir.Expr) -> bool:
        return isinstance(expr, ir.Member) and (getattr(expr.value.type, "name", ""), expr.field) in self.packed

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        if self.packed and not self.addressed:
            if self.is_packed(expr):
                return f"{self.type(expr.type)}({self.place(expr)})", PRIMARY
            if isinstance(expr, ir.Index | ir.Swizzle) and self.is_packed(expr.value):
                return self.place(expr), POSTFIX
        if isinstance(expr, ir.Swizzle) and isinstance(expr.value, ir.Swizzle):  # v.zyx.x is v.z
            letters = "".join([expr.value.components["xyzw".index(letter)] for letter in expr.components])
            return self.bound(expr._replace(value=expr.value.value, components=letters))
        return super().bound(expr)

    def target_of(self, target: ir.Expr) -> str:
        return self.place(target)

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        if isinstance(construct.type, Array):
            return f"{self.type(construct.type)}{{{{{self.arguments(construct.args)}}}}}", PRIMARY
        if isinstance(construct.type, Struct):
            return f"{construct.type.name}{{{self.arguments(construct.args)}}}", PRIMARY
        return super().construct(construct)

    def simple(self, stmt: ir.Stmt) -> str:
        return "discard_fragment()" if isinstance(stmt, ir.Discard) else super().simple(stmt)

    def param(self, param: ir.Param) -> str:
        if param.passes in self.memories and self.memories[param.passes].storage != "in":
            return self.reference(self.memories[param.passes], param.name)
        if isinstance(param.type, Sampler) or param.direction == "in":
            return super().param(param)
        return f"thread {self.type(param.type)}& {param.name}"

    def reference(self, variable: ir.Variable, name: str) -> str:
        """A parameter for a storage buffer or shared memory."""
        if isinstance(variable.type, Image):
            return f"{self.image(variable.type, variable.access)} {name}"
        space = {"shared": "threadgroup", "buffer": "device"}[variable.storage]
        readonly = "const " if variable.access == "readonly" else ""
        return f"{readonly}{space} {self.stored_type(variable.type, (variable.name,))}& {name}"

    def image(self, image: Image, access: str) -> str:
        """The type of an image."""
        shape = f"{image.dim.lower()}{'_array' if image.array else ''}"
        return f"texture{shape}<{image.kind}, access::{_ACCESS[access]}>"

    def memory(self, stmt: ir.MemoryOperation) -> str:
        """An operation on memory; what a thread stored into an image it loads only behind a fence."""
        text = super().memory(stmt)
        image = stmt.args[0] if stmt.args else None
        name = image.name if isinstance(image, ir.Global | ir.Local) else ""
        stores = not MEMORY[stmt.name].reads_only
        loaded = stores and any(each.name == name and not each.access for each in self.images)
        return f"{text}\n{name}.fence();" if loaded else text

    def image_binding(self, image: ir.Variable) -> int:
        """Behind those of the textures."""
        textures = sum([isinstance(uniform.type, Sampler) for uniform in self.module.uniforms])
        return textures + self.images.index(image)

    def shell_argument(self, uniform: ir.Local, param: ir.Param) -> str:
        return self.argument(uniform, param) if isinstance(param.type, Sampler) else f"material.{uniform.name}"

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        assert isinstance(struct.type, Struct)
        name, fields = struct.type.name, []
        for field in struct.type.fields:
            if (name, field.name) in self.packed:
                text = f"alignas(16) packed_{self.type(field.type)} {field.name}"
            elif isinstance(field.type, Array) and not field.type.length:
                text = f"{self.stored_type(field.type.element, (name, field.name))} {field.name}[1]"
            else:
                text = f"{self.stored_type(field.type, (name, field.name))} {field.name}"
            fields.append(Line(f"    {text};", struct.span))
        return [Line(f"struct {name} {{", struct.span), *fields, Line("};")]

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        """None: the kernel has the variables of a compute shader."""
        return []

    def print_entry(self, name: str) -> list[Line]:
        """The kernel, which passes its memory, its inputs and the uniforms to the author's main function."""
        assert self.stage is not None
        main = self.by_key[self.stage.function]
        builtins = self.target.stage_builtins
        textures = [uniform for uniform in self.module.uniforms if isinstance(uniform.type, Sampler)]
        inputs = [
            f"{self.variable(slot.type, slot.variable.name)} [[{builtins[slot.variable.builtin]}]]"
            for slot in self.stage.inputs
        ]
        if len(textures) < len(self.module.uniforms):
            inputs.append("constant Material& material [[buffer(0)]]")
        inputs += [f"{self.reference(buffer, buffer.name)} [[buffer({self.buffer_binding(buffer)})]]"
                   for buffer in self.buffers]  # fmt: skip
        for index, texture in enumerate(textures):
            sampler = f"{self.sampler_type(texture.type)} {self.sampler(texture.name)}"
            inputs += [f"{self.type(texture.type)} {texture.name} [[texture({index})]]"]
            inputs += [f"{sampler} [[sampler({index})]]"]
        inputs += [f"{self.reference(image, image.name)} [[texture({self.image_binding(image)})]]"
                   for image in self.images]  # fmt: skip
        shared = [variable for variable in self.module.variables if variable.storage == "shared"]
        declared = [f"threadgroup {self.stored_type(variable.type, (variable.name,))} {variable.name};"
                    for variable in shared]  # fmt: skip
        args = [
            param.passes
            if param.passes in self.memories
            else self.shell_argument(ir.Local(param.type, param.passes, param.span), param)
            for param in main.params
        ]
        listed = [f"    {text}{',' if text is not inputs[-1] else ''}" for text in inputs]
        body = [f"    {text}" for text in (*declared, f"{main.name}({', '.join(args)});")]
        head = [f"kernel void {name}(", *listed, ") {"] if inputs else [f"kernel void {name}() {{"]
        return [*map(Line, head), *[line for text in body for line in wrap(text, ir.NOWHERE)], Line("}")]

    def buffer_binding(self, buffer: ir.Variable) -> int:
        """Behind that of the uniforms."""
        return 1 + self.buffers.index(buffer)

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The struct of the uniforms."""
        fields = [
            with_doc(f"    {self.variable(member.uniform.type, member.uniform.name)};", member.uniform)
            for member in members
        ]
        return [Line("struct Material {"), *fields, Line("};")] if fields else []

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """None: textures are parameters of the fragment function or the kernel."""
        return []

    def binding(self, index: int) -> TextureBinding:
        return {"texture": index, "sampler": index}
