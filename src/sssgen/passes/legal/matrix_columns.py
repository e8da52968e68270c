"""Matrices column by column, for languages that construct or compute them in no other way. Used by `legalise`."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.spans import Span
from sssgen.ir.types import FLOAT, INT, Matrix, Scalar, Vector, components
from sssgen.passes.constructed_parts import components_at
from sssgen.passes.legal.part_stores import Keep


def matrix_from(type_: Matrix, value: ir.Expr, keep: Keep, span: Span) -> ir.Expr:
    """A matrix from a scalar (its diagonal) or from another matrix, written out by columns."""
    zero, one = ir.Literal(FLOAT, 0.0, span), ir.Literal(FLOAT, 1.0, span)
    if isinstance(value.type, Scalar):
        value = keep(value, "diagonal")
        cells = [value if row == column else zero for column in range(type_.columns) for row in range(type_.rows)]
        return ir.Construct(type_, tuple(cells), span)
    value = keep(value, "matrix")
    assert isinstance(value.type, Matrix)
    old, new = value.type.rows, type_.rows
    columns: list[ir.Expr] = []
    for column in range(type_.columns):
        index = ir.Index(Vector("float", old), value, ir.Literal(INT, column, span), span)
        cells = [one if row == column else zero for row in range(new)]
        unit = tuple(cells[old:])
        if column >= value.type.columns:
            columns.append(ir.Construct(Vector("float", new), tuple(cells), span))
        elif new < old:
            columns.append(ir.Swizzle(Vector("float", new), index, "xyzw"[:new], span))
        else:
            columns.append(ir.Construct(Vector("float", new), (index, *unit), span) if unit else index)
    return ir.Construct(type_, tuple(columns), span)


def by_columns(binary: ir.Binary, keep: Keep) -> ir.Expr:
    """Componentwise matrix arithmetic, column by column."""
    assert isinstance(binary.type, Matrix)
    column = Vector("float", binary.type.rows)
    sides = [keep(side, "matrix") for side in (binary.left, binary.right)]

    def part(side: ir.Expr, index: int) -> ir.Expr:
        place = ir.Literal(INT, index, side.span)
        return ir.Index(column, side, place, side.span) if isinstance(side.type, Matrix) else side

    columns = tuple(
        ir.Binary(column, binary.op, part(sides[0], index), part(sides[1], index), binary.span)
        for index in range(binary.type.columns)
    )
    return ir.Construct(binary.type, columns, binary.span)


def needs_columns(type_: Matrix, args: Sequence[ir.Expr]) -> bool:
    """Whether several arguments are neither numbers alone nor whole columns."""
    sizes = {components(arg.type) for arg in args}
    return len(args) > 1 and sizes not in ({1}, {type_.rows})


def by_whole_columns(type_: Matrix, args: Sequence[ir.Expr], span: Span) -> ir.Construct:
    """The matrix from a vector for each column: `mat2(v, -v.y, v.x)` is `mat2(v, vec2(-v.y, v.x))`.

    A vector in `args` that is part of two columns is read twice.
    """
    cells = [(arg, component) for arg in args for component in range(components(arg.type))]
    size = type_.rows
    columns = [_column(cells[start : start + size], size, span) for start in range(0, len(cells), size)]
    return ir.Construct(type_, tuple(columns), span)


def _column(cells: Sequence[tuple[ir.Expr, int]], size: int, span: Span) -> ir.Expr:
    """One column from (argument, which of its components) for each of its numbers."""
    runs: list[tuple[ir.Expr, list[int]]] = []
    for arg, component in cells:
        if runs and runs[-1][0] is arg:
            runs[-1][1].append(component)
        else:
            runs.append((arg, [component]))
    parts = tuple([components_at(arg, run, arg.span) for arg, run in runs])
    return parts[0] if len(parts) == 1 else ir.Construct(Vector("float", size), parts, span)
