"""Functions of matrices."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sssgen.ir import vector_ranges
from sssgen.ir.intrinsics.table import Builtin, Guard, Samples

Columns = Sequence[Sequence[float]]


def _transposed(matrix: Columns) -> list[float]:
    return [number for row in zip(*matrix, strict=True) for number in row]


def _determinant(matrix: Columns) -> float:
    if len(matrix) == 1:
        return matrix[0][0]
    first, *others = matrix
    minors = [[[*column[:row], *column[row + 1 :]] for column in others] for row in range(len(first))]
    return math.fsum((-1.0) ** row * first[row] * _determinant(minors[row]) for row in range(len(first)))


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("matrixCompMult", ("matCR(matCR, matCR)",), "Componentwise product.",
        es=100, range=lambda F, x, y: x * y,
        inside=lambda rt, x, y: abs(x * y) < 1e38,
        texts={"hlsl": "", "wgsl": "", "tsl": ""},
        polyfill="""
mat2R matrixCompMult(mat2R x, mat2R y) { return mat2R(x[0] * y[0], x[1] * y[1]); }
mat3R matrixCompMult(mat3R x, mat3R y) { return mat3R(x[0] * y[0], x[1] * y[1], x[2] * y[2]); }
mat4R matrixCompMult(mat4R x, mat4R y) { return mat4R(x[0] * y[0], x[1] * y[1], x[2] * y[2], x[3] * y[3]); }
""",
        vectors=(
            ((((1.0, 2.0), (3.0, 4.0)), ((5.0, 6.0), (7.0, 8.0))), ((5.0, 12.0), (21.0, 32.0))),
            ((((1.0, 0.0), (0.0, 1.0)), ((5.0, 6.0), (7.0, 8.0))), ((5.0, 0.0), (0.0, 8.0))),
            ((((0.0, 0.0), (0.0, 0.0)), ((5.0, 6.0), (7.0, 8.0))), ((0.0, 0.0), (0.0, 0.0))),
        ),
    ),
    Builtin("outerProduct", ("matCR(vecR, vecC)",), "The matrix whose column i is x·y[i].",
        es=300, componentwise=False, range=vector_ranges.outer_product,
        inside=lambda rt, x, y: rt.length(x) * rt.length(y) < 1e38,
        texts={"hlsl": "", "wgsl": "", "tsl": ""},
        polyfill="""
mat2R outerProduct(vecR x, vec2 y) { return mat2R(x * y.x, x * y.y); }
mat3R outerProduct(vecR x, vec3 y) { return mat3R(x * y.x, x * y.y, x * y.z); }
mat4R outerProduct(vecR x, vec4 y) { return mat4R(x * y.x, x * y.y, x * y.z, x * y.w); }
""",
        vectors=(
            (((1.0, 2.0), (3.0, 4.0)), ((3.0, 6.0), (4.0, 8.0))),
            (((0.0, 0.0), (3.0, 4.0)), ((0.0, 0.0), (0.0, 0.0))),
            (((1.0, 0.0, 2.0), (0.0, 1.0, -1.0)), ((0.0, 0.0, 0.0), (1.0, 0.0, 2.0), (-1.0, 0.0, -2.0))),
            (((1.0, 0.0, 2.0), (0.0, -1.0)), ((0.0, 0.0, 0.0), (-1.0, 0.0, -2.0))),
        ),
    ),
    Builtin("transpose", ("matRC(matCR)",), "Rows for columns.",
        es=300, not_constant=("wgsl",), fold=_transposed, componentwise=False, range=vector_ranges.transpose,
        cost=0,
        ulp=0.0, vectors=(
            ((((1.0, 2.0), (3.0, 4.0)),), ((1.0, 3.0), (2.0, 4.0))),
            ((((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)),), ((1.0, 4.0), (2.0, 5.0), (3.0, 6.0))),
            ((((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)),), ((1.0, 4.0, 7.0), (2.0, 5.0, 8.0), (3.0, 6.0, 9.0))),
        ),
    ),
    Builtin("determinant", ("float(mat)",), "Determinant.",
        es=300, not_constant=("wgsl",), fold=lambda x: [_determinant(x)], samples=Samples(invertible=True), overflow_is_nan=True, componentwise=False, range=vector_ranges.determinant,
        cost=8, ulp=32.0, clause="WGSL: no bound",
        vectors=(
            ((((1.0, 2.0), (3.0, 4.0)),), -2.0), ((((1.0, 2.0), (2.0, 4.0)),), 0.0),
            ((((2.0, 0.0, 0.0), (1.0, 3.0, 0.0), (5.0, 7.0, 4.0)),), 24.0),
        ),
    ),
    Builtin("inverse", ("mat(mat)",), "Inverse matrix.",
        es=300, samples=Samples(invertible=True), componentwise=False, range=vector_ranges.inverse, overflow_is_nan=True,
        guards=(Guard(None, "division", "a matrix without an inverse", "", doc="The inverse; of a matrix without one, large numbers.",
            advice=lambda *ranges: "call it only where abs(determinant(x)) > DIVISOR", result=lambda F, range: range),),  # not finite, where a cofactor overflows
        domain="determinant(x) != 0, and well away from it for accuracy", texts={"hlsl": "", "wgsl": ""},
        polyfill="""
mat2 inverse(mat2 x) {
    return mat2(x[1].y, -x[0].y, -x[1].x, x[0].x) * (1.0 / (x[0].x * x[1].y - x[1].x * x[0].y));
}
mat3 inverse(mat3 x) {
    vec3 a = cross(x[1], x[2]);
    return transpose(mat3(a, cross(x[2], x[0]), cross(x[0], x[1]))) * (1.0 / dot(x[0], a));
}
mat4 inverse(mat4 x) {
    vec3 a = cross(x[0].xyz, x[1].xyz);
    vec3 b = cross(x[2].xyz, x[3].xyz);
    vec3 c = x[0].xyz * x[1].w - x[1].xyz * x[0].w;
    vec3 d = x[2].xyz * x[3].w - x[3].xyz * x[2].w;
    float s = 1.0 / (dot(a, d) + dot(b, c));
    return transpose(mat4(
        vec4(cross(x[1].xyz, d) + b * x[1].w, -dot(x[1].xyz, b)),
        vec4(cross(d, x[0].xyz) - b * x[0].w, dot(x[0].xyz, b)),
        vec4(cross(x[3].xyz, c) + a * x[3].w, -dot(x[3].xyz, a)),
        vec4(cross(c, x[2].xyz) - a * x[2].w, dot(x[2].xyz, a))
    )) * s;
}
""",
        cost=16, ulp=64.0, clause="GLSL ES 3.00: no bound, and undefined where ill-conditioned",
        vectors=(
            ((((1.0, 2.0), (3.0, 4.0)),), ((-2.0, 1.0), (1.5, -0.5))),
            ((((2.0, 0.0, 0.0), (0.0, 4.0, 0.0), (6.0, 8.0, 1.0)),), ((0.5, 0.0, 0.0), (0.0, 0.25, 0.0), (-3.0, -2.0, 1.0))),
            ((((2.0, 0.0, 0.0, 0.0), (0.0, 0.0, -1.0, 0.0), (0.0, 1.0, 0.0, 0.0), (4.0, 3.0, 2.0, 1.0)),), ((0.5, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, -1.0, 0.0, 0.0), (-2.0, 2.0, -3.0, 1.0))),
        ),
    ),
)
