"""Matrices made of numbers and vectors side by side, for a language that wants whole columns.

`mat2(v, -v.y, v.x)` is `mat2(v, vec2(-v.y, v.x))`; what is part of two columns is divided.
"""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.spans import Span
from sssgen.ir.types import Matrix, Vector, components, vector_of


def needs_columns(type_: Matrix, args: Sequence[ir.Expr]) -> bool:
    """Whether several arguments are neither numbers alone nor whole columns."""
    sizes = {components(arg.type) for arg in args}
    return len(args) > 1 and sizes not in ({1}, {type_.size})


def by_whole_columns(type_: Matrix, args: Sequence[ir.Expr], span: Span) -> ir.Construct:
    """The matrix from a vector for each column. A vector in `args` that reaches over two columns is read twice."""
    cells = [(arg, at) for arg in args for at in range(components(arg.type))]
    size = type_.size
    columns = [_column(cells[start : start + size], size, span) for start in range(0, size * size, size)]
    return ir.Construct(type_, tuple(columns), span)


def _column(cells: Sequence[tuple[ir.Expr, int]], size: int, span: Span) -> ir.Expr:
    """One column from (argument, which of its components) for each of its numbers."""
    runs: list[tuple[ir.Expr, str]] = []
    for arg, at in cells:
        if runs and runs[-1][0] is arg:
            runs[-1] = arg, runs[-1][1] + "xyzw"[at]
        else:
            runs.append((arg, "xyzw"[at]))
    parts = tuple([_part(arg, letters) for arg, letters in runs])
    return parts[0] if len(parts) == 1 else ir.Construct(Vector("float", size), parts, span)


def _part(arg: ir.Expr, letters: str) -> ir.Expr:
    """Some components of an argument in a row."""
    if not isinstance(arg.type, Vector) or letters == "xyzw"[: arg.type.size]:
        return arg
    return ir.Swizzle(vector_of("float", len(letters)), arg, letters, arg.span)
