"""Reads of textures at a given level, in place of those that compare neighbouring pixels."""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Construct, Expr, Intrinsic, Literal
from sssgen.ir.signatures import resolve
from sssgen.ir.types import FLOAT, Sampler, vector_of


def at_level(read: Intrinsic, level: Expr) -> Intrinsic | None:
    """The same read at a level; None where there is no such builtin.

    A texture that compares and has no builtin with a level is read with slopes of 0, at level 0.
    """
    row = BUILTINS[read.name]
    if row.with_level is None:
        return None
    name, position, explicit = row.with_level
    # a constant offset comes next; a bias, which comes last, has no meaning here
    offset = read.args[position : position + len(row.constant)]
    result = read._replace(name=name, args=(*read.args[:position], *((level,) if explicit else ()), *offset))
    map_ = read.args[0].type
    assert isinstance(map_, Sampler)
    if not _exists(result) and map_.shadow and row.with_gradients:
        slope = Construct(
            vector_of("float", 2 if map_.dim == "2D" else 3), (Literal(FLOAT, 0.0, read.span),), read.span
        )
        result = read._replace(name=row.with_gradients, args=(*read.args[:2], slope, slope, *offset))
    return result if _exists(result) else None


def _exists(read: Intrinsic) -> bool:
    return resolve(read.name, [arg.type for arg in read.args]) == read.type
