"""Storage buffers as bytes, for HLSL, whose other buffers have elements of one type without padding.

A place is an offset in bytes by the layout of the source. A scalar or vector is loaded and stored at it; a matrix or
struct has a function that does so part by part, before the first function that uses it.
"""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.operators import PRECEDENCE
from sssgen.ir.types import FLOAT, INT, Array, Matrix, Scalar, Struct, Type, Vector, components, kind_of, spell
from sssgen.passes.stage.storage_layout import byte_buffers, extent, offsets
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.printed_lines import Line, wrap
from sssgen.targets.printers.printer import PRIMARY, Printer

_BITS = {"float": "asfloat", "int": "asint", "uint": ""}
_PRODUCT = PRECEDENCE["*"]


class Place(NamedTuple):
    """A place in a buffer."""

    buffer: ir.Variable
    offset: int
    """The known part of its offset"""
    steps: tuple[tuple[int, ir.Expr], ...]
    """The strides and indices of the other part"""


class BytePrinter(Printer):
    """Overrides what reads and writes these buffers."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.bytes = {buffer.name: buffer for buffer in byte_buffers(module, target.capabilities)}
        self.parts: set[tuple[str, Type, str, bool]] = set()
        """The functions for matrices and structs: load or store, their type, the layout, and whether it is writable."""
        self.unprinted: list[Line] = []

    def place_of(self, expr: ir.Expr) -> Place | None:
        """The place that an expression names in such a buffer."""
        if isinstance(expr, ir.Global):
            return Place(self.bytes[expr.name], 0, ()) if expr.name in self.bytes else None
        if not self.bytes or not isinstance(expr, ir.Member | ir.Index | ir.Swizzle):
            return None
        outer = self.place_of(expr.value)
        if outer is None:
            return None
        type_, rule = expr.value.type, outer.buffer.layout
        if isinstance(expr, ir.Member):
            assert isinstance(type_, Struct)
            index = [field.name for field in type_.fields].index(expr.field)
            return outer._replace(offset=outer.offset + offsets(type_, rule)[index])
        if isinstance(expr, ir.Swizzle):
            is_part = len(expr.components) == 1
            return outer._replace(offset=outer.offset + 4 * "xyzw".index(expr.components)) if is_part else None
        stride = 4 if isinstance(type_, Vector) else extent(type_, rule).stride
        if isinstance(expr.index, ir.Literal):
            return outer._replace(offset=outer.offset + stride * int(expr.index.value))
        return outer._replace(steps=(*outer.steps, (stride, expr.index)))

    def offset(self, place: Place) -> str:
        """The text of an offset."""
        terms = [f"{self.expr(index, _PRODUCT + 1)} * {stride}" for stride, index in place.steps]
        return " + ".join([*terms, *([str(place.offset)] if place.offset or not terms else [])])

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        place = self.place_of(expr) if self.bytes else None
        if place is None:
            return super().bound(expr)
        return self.load(place.buffer, expr.type, place.buffer.name, self.offset(place)), PRIMARY

    def load(self, buffer: ir.Variable, type_: Type, name: str, at: str) -> str:
        """The text that loads a value at an offset of the buffer that is called `name`."""
        if not isinstance(type_, Scalar | Vector):
            return f"{self.part_function('load', buffer, type_)}({name}, {at})"
        text = f"{name}.Load{_count(type_)}({at})"
        return f"{bits}({text})" if (bits := _BITS[kind_of(type_)]) else text

    def store(self, buffer: ir.Variable, type_: Type, name: str, at: str, value: str) -> str:
        """The statement that stores a value."""
        if not isinstance(type_, Scalar | Vector):
            return f"{self.part_function('store', buffer, type_)}({name}, {at}, {value})"
        return f"{name}.Store{_count(type_)}({at}, {value if kind_of(type_) == 'uint' else f'asuint({value})'})"

    def statement(self, stmt: ir.Stmt, indent: int) -> list[Line]:
        """A statement; a store into components that are not one place is a statement for each of them."""
        if isinstance(stmt, ir.Assign) and isinstance(stmt.target, ir.Swizzle) and self.place_of(stmt.target.value):
            target, value = stmt.target, self.stored(stmt)
            if len(target.components) > 1:
                name = self.free_name("parts")
                lines = wrap(f"{'    ' * indent}{self.variable(value.type, name)} = {self.expr(value)};", stmt.span)
                for letter, source in zip(target.components, "xyzw", strict=False):
                    scalar = Scalar(kind_of(value.type))
                    part = ir.Swizzle(scalar, ir.Local(value.type, name, stmt.span), source, stmt.span)
                    place = ir.Swizzle(scalar, target.value, letter, stmt.span)
                    lines += self.statement(ir.Assign(place, "", part, stmt.span), indent)
                return lines
        return super().statement(stmt, indent)

    def simple(self, stmt: ir.Stmt) -> str:
        if isinstance(stmt, ir.Assign) and (place := self.place_of(stmt.target)) is not None:
            value = self.typed(self.stored(stmt), stmt.target.type)
            return self.store(place.buffer, stmt.target.type, place.buffer.name, self.offset(place), value)
        return super().simple(stmt)

    def stored(self, stmt: ir.Assign) -> ir.Expr:
        """The value that an assignment stores."""
        if not stmt.op:
            return stmt.value
        return ir.Binary(stmt.target.type, stmt.op, stmt.target, stmt.value, stmt.span)

    def typed(self, value: ir.Expr, type_: Type) -> str:
        """A value whose type is not that of a bare literal, of which `asuint` would not know it."""
        is_literal = isinstance(value, ir.Literal) and type_ in (FLOAT, INT)
        return f"{self.type(type_)}({self.expr(value)})" if is_literal else self.expr(value)

    def memory(self, stmt: ir.MemoryOperation) -> str:
        place = self.place_of(stmt.args[0]) if stmt.args else None
        if place is None:
            return super().memory(stmt)
        name, result = place.buffer.name, stmt.result
        if stmt.name == "arrayLength":
            assert result is not None
            size = self.free_name(f"{self.expr(result)}_bytes")
            stride = extent(stmt.args[0].type, place.buffer.layout).stride
            whole = f"({size} - {place.offset})" if place.offset else size
            return f"uint {size};\n{name}.GetDimensions({size});\n{self.expr(result)} = int({whole} / {stride});"
        values = [f"uint({self.expr(arg)})" if arg.type == INT else self.expr(arg) for arg in stmt.args[1:]]
        old = self.free_name("old_bits") if result is not None and result.type == INT else ""
        also = f", {old}" if old else f", {self.expr(result)}" if result is not None else ""
        pattern = MEMORY[stmt.name].texts[self.target.language]
        text = f"{name}.{pattern.format(self.offset(place), *values, also=also)};"
        if old and result is not None:
            text = f"uint {old};\n{text}\n{self.expr(result)} = int({old});"
        return text

    # Functions for matrices and structs

    def part_function(self, verb: str, buffer: ir.Variable, type_: Type) -> str:
        """The name of the function that loads or stores a matrix or struct."""
        writable = buffer.access != "readonly"
        key = (verb, type_, buffer.layout, writable)
        name = f"{verb}_{self.type(type_)}" + ("_std140" if buffer.layout == "std140" else "")
        while name in self.module_names:
            name += "_"
        if key not in self.parts:
            self.parts.add(key)
            lines = self.part_lines(verb, name, buffer, type_, writable)  # the functions of its members come first
            self.unprinted += [*map(Line, lines), Line("")]
        return name

    def part_lines(self, verb: str, name: str, buffer: ir.Variable, type_: Type, writable: bool) -> list[str]:
        """The lines of that function."""
        spelled, kind = self.type(type_), f"{'RW' if writable else ''}ByteAddressBuffer"
        head = f"{kind} buffer, uint at" + (f", {spelled} value" if verb == "store" else "")
        is_load = verb == "load"
        lines = [f"{spelled if is_load else 'void'} {name}({head}) {{"]
        lines += [f"    {spelled} value;"] if is_load else []
        for member, part, at, length, stride in _parts_of(type_, buffer.layout):
            index, step = ("[i]", f" + {stride} * i") if length else ("", "")
            place = f"at + {at}{step}" if at else f"at{step}"
            if is_load:
                text = f"value{member}{index} = {self.load(buffer, part, 'buffer', place)};"
            else:
                text = f"{self.store(buffer, part, 'buffer', place, f'value{member}{index}')};"
            loop = f"    for (uint i = 0; i < {length}; i++) {{"
            lines += [loop, f"        {text}", "    }"] if length else [f"    {text}"]
        return [*lines, *(["    return value;"] if is_load else []), "}"]

    def print_function(self, function: ir.Function) -> list[Line]:
        lines = super().print_function(function)
        needed, self.unprinted = self.unprinted, []
        return [*needed, *lines]


def _count(type_: Type) -> str:
    return str(components(type_)) if isinstance(type_, Vector) else ""


def _parts_of(type_: Type, rule: str) -> list[tuple[str, Type, int, int, int]]:
    """The member, type, offset, and of an array the length and stride, of each part of a matrix or struct."""
    if isinstance(type_, Matrix):
        stride = extent(type_, rule).stride
        return [(f"[{i}]", Vector("float", type_.rows), stride * i, 0, 0) for i in range(type_.columns)]
    assert isinstance(type_, Struct), spell(type_)
    parts = []
    for field, at in zip(type_.fields, offsets(type_, rule), strict=True):
        is_array = isinstance(field.type, Array)
        element = field.type.element if isinstance(field.type, Array) else field.type
        length = field.type.length if isinstance(field.type, Array) else 0
        parts.append((f".{field.name}", element, at, length, extent(field.type, rule).stride if is_array else 0))
    return parts
