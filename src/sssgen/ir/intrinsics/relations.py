"""Relations of vectors, component by component."""

from __future__ import annotations

import operator
from collections.abc import Callable

from sssgen.ir.component_ranges import within
from sssgen.ir.intrinsics.table import Builtin
from sssgen.ir.vector_ranges import all_within


def _relation(name: str, op: str, fold: Callable[..., bool], below: bool, same: bool, above: bool) -> Builtin:
    """A componentwise comparison, and its results for x below, equal to, and above y."""
    kinds = "FIUB" if op in ("==", "!=") else "FIU"
    vectors = (
        (((1, 2, 3), (3, 2, 1)), (below, same, above)),
        (((1.0, 1.0), (1.0, 2.0)), (same, below)),
        (((0.0, 2.0), (-0.0, 1.0)), (same, above)),
    )
    return Builtin(
        name,
        tuple(f"vecB(vec{k}, vec{k})" for k in kinds),
        f"Componentwise x {op} y.",
        es=100,
        fold=fold,
        not_constant=("hlsl",) if op not in ("==", "!=") else (),
        range=within(0.0, 1.0),
        texts={"hlsl": f"op:{op}", "wgsl": f"op:{op}", "tsl": f"op:{op}"},
        vectors=vectors,
    )


# A table: several fields to a line.
# fmt: off
ROWS = (
    _relation("lessThan", "<", operator.lt, True, False, False),
    _relation("lessThanEqual", "<=", operator.le, True, True, False),
    _relation("greaterThan", ">", operator.gt, False, False, True),
    _relation("greaterThanEqual", ">=", operator.ge, False, True, True),
    _relation("equal", "==", operator.eq, False, True, False),
    _relation("notEqual", "!=", operator.ne, True, False, True),
    Builtin("any", ("bool(vecB)",), "Whether some component is true.",
        es=100, fold=lambda x: [any(x)], componentwise=False, range=all_within(0.0, 1.0),
        vectors=((((False, True),), True), (((False, False, False),), False), (((True, True),), True)),
    ),
    Builtin("all", ("bool(vecB)",), "Whether every component is true.",
        es=100, fold=lambda x: [all(x)], componentwise=False, range=all_within(0.0, 1.0),
        vectors=((((False, True),), False), (((False, False, False),), False), (((True, True),), True)),
    ),
    Builtin("not", ("vecB(vecB)",), "Componentwise negation.",
        es=100, fold=operator.not_, range=within(0.0, 1.0),
        texts={"hlsl": "op:!", "wgsl": "op:!", "tsl": "op:!"},
        vectors=(
            (((False, True),), (True, False)), (((True, True, True),), (False, False, False)),
            (((False, False),), (True, True)),
        ),
    ),
)
