"""Relations of vectors, component by component."""

from __future__ import annotations

from sssgen.ir.intrinsics.table import Builtin


def _relation(name: str, op: str, below: bool, same: bool, above: bool) -> Builtin:
    """A componentwise comparison, and what it gives for x below, the same as, and above y."""
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
        range="hull(0, 1)",
        texts={"hlsl": f"op:{op}", "wgsl": f"op:{op}"},
        vectors=vectors,
    )


# A table: several fields to a line.
# fmt: off
ROWS = (
    _relation("lessThan", "<", True, False, False),
    _relation("lessThanEqual", "<=", True, True, False),
    _relation("greaterThan", ">", False, False, True),
    _relation("greaterThanEqual", ">=", False, True, True),
    _relation("equal", "==", False, True, False),
    _relation("notEqual", "!=", True, False, True),
    Builtin("any", ("bool(vecB)",), "Whether some component is true.",
        range="hull(0, 1)",
        vectors=((((False, True),), True), (((False, False, False),), False), (((True, True),), True)),
    ),
    Builtin("all", ("bool(vecB)",), "Whether every component is true.",
        range="hull(0, 1)",
        vectors=((((False, True),), False), (((False, False, False),), False), (((True, True),), True)),
    ),
    Builtin("not", ("vecB(vecB)",), "Componentwise negation.",
        range="hull(0, 1)",
        texts={"hlsl": "op:!", "wgsl": "op:!"},
        vectors=(
            (((False, True),), (True, False)), (((True, True, True),), (False, False, False)),
            (((False, False),), (True, True)),
        ),
    ),
)
