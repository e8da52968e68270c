"""Functions of whole vectors: lengths, products, directions."""

from __future__ import annotations

from sssgen.ir.intrinsics.table import Builtin, Guard

_REDUCE = ("float(vecF, vecF)", "float(float, float)")
_SUM = "WGSL, Vulkan: that of the formula, whose sum rounds in any order"

# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("length", ("float(genF)",), "Euclidean length.",
        range="whole: length(x)",
        inside="(dot(x, x) < 1e38) & ((dot(x, x) > 1e-30) | (dot(x, x) == 0.0))",
        domain="dot(x, x) does not overflow: |x| < 1e19", kind="transcendental", cost=2, once=4, ulp=8.0,
        clause="WGSL, Vulkan: that of sqrt(dot(x, x))",
        vectors=((((3.0, 4.0),), 5.0), (((0.0, 0.0, 0.0),), 0.0), ((-2.0,), 2.0)),
    ),
    Builtin("distance", _REDUCE, "Length of x - y.",
        range="whole: length(x, y)",
        inside="(dot(x - y, x - y) < 1e38) & ((dot(x - y, x - y) > 1e-30) | (dot(x - y, x - y) == 0.0))",
        domain="|x - y| < 1e19", texts={"hlsl/float,float": ""}, polyfill="float distance(float x, float y) { return abs(x - y); }",
        kind="transcendental", cost=3, once=4, ulp=8.0, clause="WGSL, Vulkan: that of length(x - y)",
        vectors=(
            (((4.0, 6.0), (1.0, 2.0)), 5.0), (((1.0, 2.0, 3.0), (1.0, 2.0, 3.0)), 0.0), ((1.0, -1.5), 2.5),
        ),
    ),
    Builtin("dot", _REDUCE, "Sum of the products of the components.",
        range="whole: dot(x, y)",
        inside="dot(abs(x), abs(y)) < 1e38", size="dot(abs(x), abs(y))",
        texts={"hlsl/float,float": "op:*", "wgsl/float,float": "op:*"}, cost=2,
        vectors=(
            (((1.0, 2.0, 3.0), (4.0, -5.0, 6.0)), 12.0), (((0.0, 1.0), (1.0, 0.0)), 0.0), ((2.0, -3.0), -6.0),
        ),
    ),
    Builtin("cross", ("vec3(vec3, vec3)",), "Cross product, right-handed: x-axis with y-axis gives z-axis.",
        range="whole: cross(x, y)",
        inside="length(x) * length(y) < 1e38", size="max(abs(x * y[[1, 2, 0]]), abs(y * x[[1, 2, 0]]))",
        cost=3,
        vectors=(
            (((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), (0.0, 0.0, 1.0)),
            (((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)), (-3.0, 6.0, -3.0)),
            (((2.0, 4.0, 6.0), (1.0, 2.0, 3.0)), (0.0, 0.0, 0.0)),
        ),
    ),
    Builtin("normalize", ("vecF(vecF)", "float(float)"), "x / length(x).",
        range="whole: unit(x)",
        guards=(Guard("F.square**0.5 < x.low and x.high < F.largest**0.5", "the direction of a zero vector", "x * inversesqrt(max(dot(x, x), SQUARE))",
            doc="The direction of `x`; of a zero vector, 0."),),
        inside="(dot(x, x) < 1e38) & (dot(x, x) > 1e-30)",
        domain="dot(x, x) > 0 and does not overflow", texts={"hlsl/float": "", "wgsl/float": ""},
        polyfill="float normalize(float x) { return sign(x); }", kind="transcendental", cost=3, once=4, ulp=8.0,
        clause="WGSL, Vulkan: that of x / length(x)",
        vectors=(
            (((3.0, 4.0),), (0.6, 0.8)),
            (((1.0, 2.0, 3.0),), (0.2672612419124244, 0.5345224838248488, 0.8017837257372732)),
            (((0.0, 0.0, -0.5),), (0.0, 0.0, -1.0)), ((-2.0,), -1.0),
        ),
    ),
    Builtin("faceforward", ("vecF(vecF, vecF, vecF)", "float(float, float, float)"),
        "x where dot(z, y) < 0, else -x: the normal x turned against the direction of incidence y.",
        range="whole: turned(x)",
        inside="(dot(abs(z), abs(y)) < 1e38) & ((dot(abs(z), abs(y)) == 0.0) | (abs(dot(z, y)) > max(1e-30, 1e-6 * dot(abs(z), abs(y)))))",
        texts={"hlsl/float,float,float": "", "wgsl": "faceForward", "wgsl/float,float,float": ""},
        polyfill="float faceforward(float x, float y, float z) { return z * y < 0.0 ? x : -x; }", cost=4,
        ulp=0.0, vectors=(
            (((0.0, 1.0), (0.0, -1.0), (0.0, 1.0)), (0.0, 1.0)),
            (((0.0, 1.0), (0.0, 1.0), (0.0, 1.0)), (0.0, -1.0)),
            (((0.0, 0.5, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), (0.0, -0.5, -1.0)),
        ),
    ),
    Builtin("reflect", ("vecF(vecF, vecF)", "float(float, float)"),
        "x - 2·dot(y, x)·y: direction x mirrored at the unit normal y.",
        range="whole: reflected(x, y)",
        inside="(abs(dot(y, y) - 1.0) < 1e-6) & (abs(x) < 1e38)", size="max(abs(x), 2.0 * dot(abs(x), abs(y)) * abs(y))",
        domain="dot(y, y) = 1", texts={"hlsl/float,float": "", "wgsl/float,float": ""},
        polyfill="float reflect(float x, float y) { return x - 2.0 * y * x * y; }", cost=4, ulp=8.0,
        clause=_SUM,
        vectors=(
            (((1.0, -1.0), (0.0, 1.0)), (1.0, 1.0)), (((0.0, 0.0, -1.0), (0.0, 0.0, 1.0)), (0.0, 0.0, 1.0)),
            (((1.0, 2.0, 3.0), (1.0, 0.0, 0.0)), (-1.0, 2.0, 3.0)),
        ),
    ),
    Builtin("refract", ("vecF(vecF, vecF, float)", "float(float, float, float)"),
        "Direction x refracted at the unit normal y, z = n_from/n_into; 0 on total internal reflection.",
        range="whole: refracted(x, y, z)",
        inside="(abs(dot(x, x) - 1.0) < 1e-6) & (abs(dot(y, y) - 1.0) < 1e-6) & (z > 0.0) & (abs(1.0 - z * z * (1.0 - dot(x, y) ** 2)) > 0.1)", size="max(z * z, 1.0)",
        domain="dot(x, x) = dot(y, y) = 1 and z > 0",
        texts={"hlsl/float,float,float": "", "wgsl/float,float,float": ""},
        polyfill="""
float refract(float x, float y, float z) {
    float c = y * x;
    float k = 1.0 - z * z * (1.0 - c * c);
    return k < 0.0 ? 0.0 : z * x - (z * c + sqrt(max(k, 0.0))) * y;
}
""",
        splat=(), kind="transcendental", cost=12, ulp=16.0,
        clause="WGSL, Vulkan: that of the formula, with sqrt near total internal reflection",
        vectors=(
            (((0.0, -1.0), (0.0, 1.0), 0.75), (0.0, -1.0)), (((1.0, 0.0), (0.0, 1.0), 1.5), (0.0, 0.0)),
            (((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.25), (0.25, 0.0, -0.9682458365518543)),
        ),
    ),
)
