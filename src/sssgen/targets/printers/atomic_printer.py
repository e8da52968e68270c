"""Printing for languages whose atomics have a type of their own: WGSL and Metal.

Memory of atomics is read and written by functions, also where the source reads or assigns a plain number.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.types import Array, Scalar, Type
from sssgen.passes.stage.atomic_places import Memory, atomic_places, memory_of, passed_variables
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.printed_lines import Line
from sssgen.targets.printers.printer import POSTFIX, PRIMARY, Printer


class AtomicPrinter(Printer):
    """Overrides places in memory, and statements that write them."""

    load = ""
    """The text that reads the place `{0}`."""
    store = ""
    """The text that writes `{1}` to the place `{0}`."""
    atomic = ""
    """The type of an atomic `{0}`."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.atomics = atomic_places(module)
        """The shared variables and the members of structs that hold atomics."""
        self.addressed = False
        """Whether a place is printed and not its value."""
        self.memory_names: dict[str, str] = {}
        """The parameters of the current function that pass module variables, with the names of these."""

    def enter(self, function: ir.Function) -> None:
        super().enter(function)
        self.memory_names = passed_variables(function)

    def is_atomic(self, expr: ir.Expr) -> bool:
        """Whether an expression is a number in memory of atomics."""
        return (
            bool(self.atomics) and isinstance(expr.type, Scalar) and memory_of(expr, self.memory_names) in self.atomics
        )

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        if self.atomics and not self.addressed and self.is_atomic(expr):
            return self.load.format(self.place(expr)), PRIMARY
        return super().bound(expr)

    def index(self, index: ir.Index) -> tuple[str, int]:
        value = self.expr(index.value, POSTFIX)
        outer, self.addressed = self.addressed, False
        position = self.expr(index.index)
        self.addressed = outer
        return self.element(value, index.value.type, position), POSTFIX

    def element(self, array: str, type_: Type, index: str) -> str:
        """An element of an array or vector."""
        return f"{array}[{index}]"

    def array_of(self, element: str, length: int) -> str:
        """The type of an array, which each language spells; the length is 0 at the end of a storage buffer."""
        raise NotImplementedError

    def stored_type(self, type_: Type, key: Memory) -> str:
        """The type of shared memory or of a struct's member."""
        if key not in self.atomics:
            return self.type(type_)
        if isinstance(type_, Array):
            return self.array_of(self.stored_type(type_.element, key), type_.length)
        return self.atomic.format(self.type(type_))

    def place(self, expr: ir.Expr) -> str:
        outer, self.addressed = self.addressed, True
        text = self.expr(expr, POSTFIX)
        self.addressed = outer
        return text

    def simple(self, stmt: ir.Stmt) -> str:
        if isinstance(stmt, ir.Assign) and self.is_atomic(stmt.target):
            value = stmt.value
            if stmt.op:
                value = ir.Binary(value.type, stmt.op, stmt.target, value, stmt.span)
            return self.store.format(self.place(stmt.target), self.expr(value))
        return super().simple(stmt)

    def block(self, block: ir.Block, indent: int) -> list[Line]:
        """A block; a barrier of memory beside one of control is the same barrier."""
        kept: list[ir.Stmt] = []
        for stmt in block:
            barrier = self.barrier(stmt)
            repeated = barrier and kept and self.barrier(kept[-1]) == barrier
            if not repeated or self.comments(stmt.span.file, stmt.span.line):
                kept.append(stmt)
        return super().block(tuple(kept), indent)

    def barrier(self, stmt: ir.Stmt) -> str:
        """The text of a barrier; '' for another statement."""
        row = MEMORY[stmt.name] if isinstance(stmt, ir.MemoryOperation) else None
        return row.texts[self.target.language] if row and not row.has_place else ""
