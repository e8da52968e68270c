"""Exponentials, logarithms and roots: 8.2 of the specification."""

from __future__ import annotations

from sssgen.ir.intrinsics.table import F1, F2, Builtin, Guard

_LOG = "WGSL, Vulkan: 3 ulp, but an absolute error of 2^-21 for x in [0.5, 2]"
_EXP = "WGSL, Vulkan: 3 + 2·|x| ulp; taken at |x| = 88"
_EXP2 = "WGSL, Vulkan: 3 + 2·|x| ulp; taken at |x| = 128"

# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("pow", F2, "x to the power y.",
        range="power(maximum(x, F.tiny), y)",
        guards=(
            Guard("(y * rising(math.log2, maximum(x, F.tiny))).high < F.exponent", "a power that overflows", "exp2(min(y * log2(max(x, TINY)), EXPONENT))"),
            Guard("x.low > 0.0 or (x.low >= 0.0 and y.low >= 0.25)", "a power of less than 0, or one of 0 near the power 0", "max(x, TINY)", "x"),
        ),
        inside="(x > 0.0) & (abs(y) <= 64.0) & (abs(y * log2(max(x, 1e-38))) < 126.0)",
        domain="x > 0, or x = 0 and y > 0, where WGSL may miss 0; accurate for |y| <= 64", kind="transcendental", cost=9, ulp=600.0,
        clause="WGSL, Vulkan: that of exp2(y·log2(x)); taken at |y| = 64 and |y·log2(x)| = 126",
        vectors=(((2.0, -1.5), 0.3535533905932738), ((3.0, 2.0), 9.0), ((0.0, 0.5), 0.0), ((5.0, 0.0), 1.0)),
    ),
    Builtin("exp", F1, "e to the power x.",
        range="rising(math.exp, x)",
        guards=(Guard("x.high < 0.69 * F.exponent", "exp overflows", "min(x, 0.69 * EXPONENT)", "x"),),
        inside="x < 88.0",
        domain="x < 88", kind="transcendental", cost=5, ulp=179.0, clause=_EXP,
        vectors=(((1.0,), 2.718281828459045), ((0.0,), 1.0), ((-2.0,), 0.1353352832366127)),
    ),
    Builtin("log", F1, "Natural logarithm.",
        range="rising(math.log, maximum(x, F.tiny))",
        guards=(Guard("x.low > 0.0", "the logarithm of 0 or less", "max(x, TINY)", "x"),),
        inside="x > 0.0",
        domain="x > 0", kind="transcendental", cost=5, absolute=2.0**-21, clause=_LOG,
        vectors=(((1.0,), 0.0), ((10.0,), 2.302585092994046), ((0.5,), -0.6931471805599453)),
    ),
    Builtin("exp2", F1, "2 to the power x.",
        range="rising(math.exp2, x)",
        guards=(Guard("x.high < F.exponent + 1.0", "exp2 overflows", "min(x, EXPONENT)", "x"),),
        inside="x < 128.0",
        domain="x < 128", kind="transcendental", cost=4, ulp=259.0, clause=_EXP2,
        vectors=(((0.5,), 1.4142135623730951), ((0.0,), 1.0), ((-3.0,), 0.125)),
    ),
    Builtin("log2", F1, "Binary logarithm.",
        range="rising(math.log2, maximum(x, F.tiny))",
        guards=(Guard("x.low > 0.0", "the logarithm of 0 or less", "max(x, TINY)", "x"),),
        inside="x > 0.0",
        domain="x > 0", kind="transcendental", cost=4, absolute=2.0**-21, clause=_LOG,
        vectors=(((3.0,), 1.584962500721156), ((1.0,), 0.0), ((0.125,), -3.0)),
    ),
    Builtin("sqrt", F1, "Square root.",
        range="rising(math.sqrt, maximum(x, 0.0))",
        guards=(Guard("x.low >= 0.0", "the square root of less than 0", "max(x, 0.0)", "x"),),
        inside="x >= 0.0",
        domain="x >= 0", kind="transcendental", cost=4, ulp=6.0,
        clause="WGSL, Vulkan: that of 1/inversesqrt(x), with 2 and 2.5 ulp",
        vectors=(((2.0,), 1.4142135623730951), ((0.0,), 0.0), ((0.0625,), 0.25)),
    ),
    Builtin("inversesqrt", F1, "1/sqrt(x).",
        range="falling(lambda v: v**-0.5, maximum(x, F.tiny))",
        guards=(Guard("x.low > 0.0", "the inverse square root of 0 or less", "max(x, TINY)", "x"),),
        inside="x > 0.0",
        domain="x > 0", texts={"hlsl": "rsqrt", "wgsl": "inverseSqrt"}, kind="transcendental", cost=4,
        vectors=(((2.0,), 0.7071067811865476), ((1.0,), 1.0), ((0.0625,), 4.0)),
    ),
)
