"""The typing rules of the IR, for the checker, the reader of the text form and the verifier.

They are those of GLSL ES 3.00, sections 5.4 to 5.9, but without implicit conversions: only constructors convert, and
the arguments of a constructor have its own kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from sssgen.ir.nodes import Binary, Block, Discard, Expr, If, Index, Intrinsic, Member, Return, Select, Swizzle, Unary
from sssgen.ir.signatures import resolve
from sssgen.ir.types import (
    BOOL,
    INT,
    UINT,
    Array,
    Matrix,
    Sampler,
    Scalar,
    Struct,
    Type,
    Vector,
    Void,
    components,
    is_numeric,
    kind_of,
    vector_of,
)

FLOAT_MAX = 3.4028234663852886e38
"""The largest finite float32; larger literals round to infinity or are not portable."""


def prefix_type(op: str, operand: Type) -> Type | None:
    """The type of `op operand`, or None if it is not defined."""
    fits = {"-": is_numeric(operand), "!": operand == BOOL, "~": kind_of(operand) in ("int", "uint")}
    return operand if fits.get(op, False) else None


def operator_type(op: str, left: Type, right: Type) -> Type | None:
    """The type of `left op right`, or None if it is not defined (GLSL ES 3.00, sections 5.8 and 5.9)."""
    if op in ("&&", "||", "^^"):
        return BOOL if left == right == BOOL else None
    if op in ("==", "!="):
        return BOOL if left == right and not isinstance(left, Sampler | Void) else None
    if op in ("<", ">", "<=", ">="):
        return BOOL if left == right and isinstance(left, Scalar) and is_numeric(left) else None
    if op not in ("+", "-", "*", "/", "%", "<<", ">>", "&", "|", "^"):
        return None
    kind = kind_of(left)
    if op in ("<<", ">>"):
        whole = kind in ("int", "uint") and kind_of(right) in ("int", "uint")
        return left if whole and components(right) in (1, components(left)) else None
    if not is_numeric(left) or kind != kind_of(right) or (op in ("%", "&", "|", "^") and kind == "float"):
        return None
    if isinstance(right, Scalar):
        return left
    if isinstance(left, Scalar):
        return right
    if op == "*" and (isinstance(left, Matrix) or isinstance(right, Matrix)):
        return _product_type(left, right)
    return left if left == right else None


def _product_type(left: Type, right: Type) -> Type | None:
    """The type of a product with a matrix: the left factor has as many columns as the right one has rows."""
    if isinstance(left, Matrix) and isinstance(right, Matrix):
        return Matrix(right.columns, left.rows) if left.columns == right.rows else None
    if isinstance(left, Matrix) and isinstance(right, Vector):
        return Vector("float", left.rows) if left.columns == right.size else None
    if isinstance(left, Vector) and isinstance(right, Matrix):
        return Vector("float", right.columns) if left.size == right.rows else None
    return None


def element_type(type: Type) -> tuple[Type, int] | None:
    """The type and number of a type's elements; None if it has none."""
    if isinstance(type, Array):
        return type.element, type.length
    if isinstance(type, Vector):
        return Scalar(type.kind), type.size
    if isinstance(type, Matrix):
        return Vector("float", type.rows), type.columns
    return None


def swizzle_type(type: Type, letters: str) -> Type | None:
    """The type of `.letters` of a vector."""
    if isinstance(type, Vector) and 1 <= len(letters) <= 4 and set(letters) <= set("xyzw"[: type.size]):
        return vector_of(type.kind, len(letters))
    return None


def inferred(expr: Expr) -> Type | None:
    """The type that follows from the types of the operands; None if the expression is not defined for them.

    For all expressions but literals, names, calls and constructors, whose types are given.
    """
    if isinstance(expr, Binary):
        return operator_type(expr.op, expr.left.type, expr.right.type)
    if isinstance(expr, Intrinsic):
        return resolve(expr.name, [arg.type for arg in expr.args])
    if isinstance(expr, Swizzle):
        return swizzle_type(expr.value.type, expr.components)
    if isinstance(expr, Unary):
        return prefix_type(expr.op, expr.operand.type)
    if isinstance(expr, Select):
        same = expr.yes.type == expr.no.type and expr.condition.type == BOOL
        return expr.yes.type if same and not isinstance(expr.yes.type, Sampler | Void) else None
    if isinstance(expr, Index):
        element = element_type(expr.value.type)
        return element[0] if element is not None and expr.index.type in (INT, UINT) else None
    if isinstance(expr, Member):
        fields = expr.value.type.fields if isinstance(expr.value.type, Struct) else ()
        return next((field.type for field in fields if field.name == expr.field), None)
    raise TypeError(f"{type(expr).__name__} has no rule")


def constructs(type: Type, args: Sequence[Type]) -> bool:
    """Whether `type(args…)` is a constructor of the IR.

    A struct takes its fields and an array its elements. For other types, a single argument is converted to another kind
    in the same shape, or is a scalar that fills a vector or a matrix's diagonal, or a matrix that is cut or extended;
    several arguments have together as many components as the result. Vectors are cut by swizzles only.
    """
    if isinstance(type, Struct):
        return [field.type for field in type.fields] == list(args)
    if isinstance(type, Array):
        return [type.element] * type.length == list(args)
    kind = kind_of(type)
    if not kind or not args:
        return False
    if len(args) == 1 and kind_of(args[0]) != kind:
        return _same_shape(type, args[0])
    if any(kind_of(arg) != kind for arg in args):
        return False
    if len(args) == 1:
        filled = isinstance(args[0], Scalar) and not isinstance(type, Scalar)
        resized = isinstance(type, Matrix) and isinstance(args[0], Matrix) and type != args[0]
        return filled or resized
    pieces = all(isinstance(arg, Scalar | Vector) for arg in args)
    return pieces and sum(map(components, args)) == components(type)


def _same_shape(first: Type, second: Type) -> bool:
    if isinstance(first, Vector) and isinstance(second, Vector):
        return first.size == second.size
    return isinstance(first, Scalar) and isinstance(second, Scalar)


def is_type(type: Type, ends_buffer: bool = False) -> bool:
    """Whether a type and everything in it is valid in the IR; `ends_buffer`: it is the last member of a struct."""
    if isinstance(type, Scalar | Vector):
        sized = isinstance(type, Scalar) or type.size in (2, 3, 4)
        return sized and type.kind in ("float", "int", "uint", "bool")
    if isinstance(type, Matrix):
        return type.columns in (2, 3, 4) and type.rows in (2, 3, 4) and type.kind == "float"
    if isinstance(type, Array):
        holds = not isinstance(type.element, Sampler | Void)
        return (
            holds and 1 - ends_buffer <= type.length <= 65536 and is_type(type.element)
        )  # 0: the end of a storage buffer
    if isinstance(type, Struct):
        names = sorted(field.name for field in type.fields)
        unique = bool(names) and all(name != next_name for name, next_name in pairwise(names))
        return unique and all(
            is_type(field.type, field is type.fields[-1]) and not isinstance(field.type, Sampler | Void)
            for field in type.fields
        )
    if isinstance(type, Sampler):
        return type.dim in ("2D", "3D", "Cube", "2DMS")
    return isinstance(type, Void)


def returns(block: Block, discard_ends: bool = True) -> bool:
    """Whether every path through a block ends in a return; or in a discard, if that ends the invocation."""
    for stmt in block:
        if isinstance(stmt, Return) or (isinstance(stmt, Discard) and discard_ends):
            return True
        if isinstance(stmt, If) and returns(stmt.then, discard_ends) and returns(stmt.otherwise, discard_ends):
            return True
    return False
