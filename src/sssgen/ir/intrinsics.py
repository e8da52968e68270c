"""The intrinsic table: everything the project knows about each builtin function, in one place.

From it come the checker's overloads, the printers' text, the polyfills, the static cost, the documentation
(`docs/intrinsics.md`), and an executed test of every builtin on every target. It holds the functions of chapter 8 of
the GLSL ES 3.00 specification, and three of our own: `saturate`, the truncated remainder `fmod`, and `unpackNormal`. Left out are modf,
whose second result is an out parameter, and the texture reads with an offset or a projection or of other samplers.

Signatures are written as in that specification: `genF` stands for float, vec2, vec3 and vec4 alike (one size throughout
a signature), `vecF` for the vectors alone; likewise genI, genU, genB, vecI, vecU, vecB; `mat` for mat2, mat3 and mat4.
`ir.signatures` reads them.

`texts` maps a language to how the builtin is written there. A language that is not named uses the builtin's own name.
A key may name one signature by its parameters, as in `"hlsl/genF,genF"`; it goes before the language's own.
A value is one of
- a name: `"lerp"` is called with the arguments as they stand;
- `"op:<"`: the binary (two arguments) or unary (one argument) operator;
- a pattern: `"{texture}.Sample({sampler}, {1})"`, where `{0}`, `{1}`… are arguments, `{texture}` and `{sampler}` the two
  halves of argument 0 (`{bare_texture}` and `{bare_sampler}` where an engine wraps them into structs that lack the
  method), `{dim}` its dimension (2D, 3D, CUBE) and `{type}` the result's type as the target spells it;
  arguments stand only where a call's argument could;
- `""`: the language has no such builtin, and `polyfill` is put in its place; without a polyfill it is refused there.
The dialects `hlsl-dx9` (Unity's built-in pipeline) and `hlsl-macros` (Unity's SRP) fall back to `hlsl`, and `glsl-330`,
which lacks some of what ES 3.00 has, to `glsl`.
NumPy has a function of the builtin's own name for every row, in `targets/numpy_runtime.py` (`not_` for `not`).

`polyfill` is source in the project's own language, generic in the same way as the signatures; it is parsed by the same
front end, instantiated for the types at hand, and inlined where it is one expression. It defines every signature that
some language lacks, each in a function of its own.

Test vectors' arguments are exact in float32; their results are correctly rounded to float64. Where the table grants
more than 4 ulp, WGSL means its section "Accuracy of Concrete Floating Point Expressions", Vulkan its appendix
"Precision and Operation of SPIR-V Instructions", and D3D the Direct3D 11.3 functional specification.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from .formats import Format


class Guard(NamedTuple):
    """What arguments must keep to, and what stands in the call's place where the range pass cannot prove it."""

    needs: str
    """Python over the ranges (`passes.intervals`) x, y, z of the arguments (lengths, of vectors that a builtin takes
    whole) and the format F; true where nothing can go wrong."""
    says: str
    """What goes wrong otherwise, for people."""
    text: str
    """An expression of the language in x, y, z, or a function's body, with the constants TINY (smallest normal number),
    DIVISOR, SQUARE, EPSILON, EXPONENT (the largest of exp2), LARGEST and ROOT (its square root). '' means that it is the
    polyfill with its own divisions guarded."""
    replaces: str = ""
    """The argument that `text` stands for; `result`: the call's own, x in it; '' means the whole call."""
    scalar: str = ""
    """The text for a single number, where that reads better."""
    doc: str = ""
    """The comment of the function that it becomes where it is too long to stand in the text."""


def with_constants(text: str, format: Format, limits: tuple[float, float], shown: Callable[[float], str] = repr) -> str:
    """A guard's text with the format's numbers for its constants, times the factor that stands before one.

    LOW and HIGH are the `limits` of the place, LAST the upper one as an int.
    """
    numbers = {
        "TINY": format.tiny, "DIVISOR": format.divisor, "SQUARE": format.square, "EPSILON": format.epsilon,
        "EXPONENT": format.exponent, "LARGEST": format.largest, "ROOT": format.largest**0.5,
        "LOW": limits[0], "HIGH": limits[1],
    }  # fmt: skip

    def number(found: re.Match[str]) -> str:
        factor, name = found.groups()
        return str(int(limits[1])) if name == "LAST" else shown(float(factor or 1.0) * numbers[name])

    return re.sub(rf"(?:([\d.]+) \* )?\b({'|'.join(numbers)}|LAST)\b", number, text)


class Builtin(NamedTuple):
    """One row of the table."""

    name: str
    signatures: tuple[str, ...]
    doc: str
    domain: str = ""
    """Where the result is defined, with x, y, z for the arguments in their order; '' means everywhere."""
    range: str = ""
    """The range of a component of the result, as Python over those of the arguments' components (`passes.intervals`);
    after `whole:`, of the result from the whole arguments (`passes.builtin_ranges`); '' means any number."""
    guards: tuple[Guard, ...] = ()
    """Where it may give inf or NaN, or what languages leave undefined; the first one needed is put in."""
    inside: str = ""
    """The domain as Python, for each component, over the functions of the NumPy runtime; '' means every finite number.
    It is where the parity is measured, and so leaves out where intermediate results overflow or underflow."""
    size: str = ""
    """What the error is measured in ulp of, as Python: the size of terms that may cancel; '' means the result."""
    texts: Mapping[str, str] = MappingProxyType({})
    polyfill: str = ""
    splat: tuple[str, ...] = ("wgsl",)
    """Languages in which a scalar beside vectors must be widened to a vector first."""
    kind: str = "alu"
    """What it costs: alu, transcendental, fetch or derivative."""
    cost: int = 1
    """Operations per component, for the static cost."""
    once: int = 0
    """Operations beside these, once a call: the one root of a length."""
    ulp: float = 4.0
    """The float32 error allowed against the float64 oracle, in units in the last place of the result's magnitude."""
    absolute: float = 0.0
    """The absolute error allowed instead, where that is larger."""
    clause: str = ""
    """Where a specification allows more than 4 ulp: which, and what it says."""
    vectors: tuple[tuple[tuple[object, ...], object], ...] = ()
    """At least three test vectors: (arguments, result); vectors are tuples, matrices tuples of columns."""


NONZERO = "max(abs(y), DIVISOR) * (2.0 * step(0.0, y) - 1.0)"
"""A divisor of the same sign (0 counts as positive) that is not 0."""
FINITE = "mix(clamp(x, -LARGEST, LARGEST), genF(0.0), isnan(x))"
"""The largest number in place of infinity, 0 in place of NaN."""


def _table(*rows: Builtin) -> dict[str, Builtin]:
    return {row.name: row for row in rows}


_F1 = ("genF(genF)",)
_F2 = ("genF(genF, genF)",)
_PLAIN = _F1[0], "genI(genI)"
_ONES = ("float", "int", "uint")
_PAIR = tuple(f"gen{k}(gen{k}, {other})" for k, one in zip("FIU", _ONES) for other in (f"gen{k}", one))
_SAMPLE = ("vec4(sampler2D, vec2", "vec4(sampler3D, vec3", "vec4(samplerCube, vec3")
_REDUCE = ("float(vecF, vecF)", "float(float, float)")
_LOG = "WGSL, Vulkan: 3 ulp, but an absolute error of 2^-21 for x in [0.5, 2]"
_EXP = "WGSL, Vulkan: 3 + 2·|x| ulp; taken at |x| = 88"
_EXP2 = "WGSL, Vulkan: 3 + 2·|x| ulp; taken at |x| = 128"
_HYPERBOLIC = "WGSL, Vulkan: that of the formula with exp, 3 + 2·|x| ulp, which cancels near 0"
_TRIG = "WGSL, Vulkan: absolute error of 2^-11 in [-pi, pi]; D3D: 0.0008"
_ASIN = (
    "GLSL: no bound (Mesa: absolute error of 4e-4); WGSL: 6.81e-5, or that of the formula with atan; Vulkan: the latter"
)
_ATAN = "WGSL, Vulkan: 4096 ulp"
_BY_LOG = "WGSL, Vulkan: that of the formula with log, whose own error is absolute"
_ACOSH = "WGSL, Vulkan: that of log(x + sqrt(x·x - 1)), which cancels near 1"
_EIGHT_BITS = "D3D: filter weights of 8 bits; WGSL, Vulkan, GLSL: no bound"
_SUM = "WGSL, Vulkan: that of the formula, whose sum rounds in any order"
_NAN, _INF = float("nan"), float("inf")
_HALF_PI, _PI = 1.5707963267948966, 3.141592653589793


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
BUILTINS: dict[str, Builtin] = _table(
    # 8.1 Angle and trigonometry
    Builtin("radians", _F1, "Degrees to radians: x·pi/180.",
        range="x * 0.017453292519943295",
        vectors=(((90.0,), _HALF_PI), ((0.0,), 0.0), ((-30.0,), -0.5235987755982989)),
    ),
    Builtin("degrees", _F1, "Radians to degrees: x·180/pi.",
        range="x * 57.29577951308232",
        vectors=(((1.0,), 57.29577951308232), ((0.0,), 0.0), ((-0.5,), -28.64788975654116)),
    ),
    Builtin("sin", _F1, "Sine of an angle in radians.",
        range="hull(-1, 1)",
        inside="abs(x) <= 3.1415928",
        domain="accurate for |x| <= pi", kind="transcendental", cost=4, absolute=2.0**-11, clause=_TRIG,
        vectors=(((1.0,), 0.8414709848078965), ((0.0,), 0.0), ((-0.5,), -0.479425538604203)),
    ),
    Builtin("cos", _F1, "Cosine of an angle in radians.",
        range="hull(-1, 1)",
        inside="abs(x) <= 3.1415928",
        domain="accurate for |x| <= pi", kind="transcendental", cost=4, absolute=2.0**-11, clause=_TRIG,
        vectors=(((1.0,), 0.5403023058681398), ((0.0,), 1.0), ((2.5,), -0.8011436155469337)),
    ),
    Builtin("tan", _F1, "Tangent of an angle in radians.",
        range="hull(-1e7, 1e7)",
        guards=(Guard("absolute(x).high <= 1.5", "a tangent near 90 degrees", "clamp(tan(x), -1.0e7, 1.0e7)"),),
        inside="abs(x) <= 1.0",
        domain="cos(x) != 0; accurate for |x| <= 1", kind="transcendental", cost=12, ulp=8192.0,
        absolute=2.0**-10, clause="WGSL, Vulkan: that of sin(x)/cos(x)",
        vectors=(((1.0,), 1.5574077246549023), ((0.0,), 0.0), ((-0.5,), -0.5463024898437905)),
    ),
    Builtin("asin", _F1, "Arc sine, in [-pi/2, pi/2].",
        range="hull(-1.5708, 1.5708)",
        guards=(Guard("-1.0 <= x.low and x.high <= 1.0", "an arc sine beyond -1..1", "clamp(x, -1.0, 1.0)", "x"),),
        inside="abs(x) <= 1.0",
        domain="-1 <= x <= 1", kind="transcendental", cost=16, ulp=4096.0, absolute=2.0**-11, clause=_ASIN,
        vectors=(((1.0,), _HALF_PI), ((0.0,), 0.0), ((-0.5,), -0.5235987755982989)),
    ),
    Builtin("acos", _F1, "Arc cosine, in [0, pi].",
        range="hull(0, 3.1416)",
        guards=(Guard("-1.0 <= x.low and x.high <= 1.0", "an arc cosine beyond -1..1", "clamp(x, -1.0, 1.0)", "x"),),
        inside="abs(x) <= 1.0",
        domain="-1 <= x <= 1", kind="transcendental", cost=16, ulp=4096.0, absolute=2.0**-11, clause=_ASIN,
        vectors=(((1.0,), 0.0), ((0.5,), 1.0471975511965979), ((-1.0,), _PI)),
    ),
    Builtin("atan", ("genF(genF)", "genF(genF, genF)"),
        "Arc tangent: of x, in [-pi/2, pi/2]; of x/y in the quadrant of (y, x), in [-pi, pi].",
        range="hull(-3.1416, 3.1416) if y else hull(-1.5708, 1.5708)",
        guards=(Guard("not y or not x.has_zero() or not y.has_zero()", "the angle of (0, 0)", "y + step(abs(x) + abs(y), genF(0.0))", "y"),),
        domain="with two arguments: x != 0 or y != 0, and x != -0, whose sign may be lost; accurate for y != 0 and |y| < 2^126",
        inside="(floatBitsToInt(x) != -2**31) & (abs(y) >= 2.0**-126) & (abs(y) <= 2.0**126)",
        texts={"hlsl/genF,genF": "atan2", "wgsl/genF,genF": "atan2"}, kind="transcendental", cost=16,
        ulp=4096.0, clause=_ATAN,
        vectors=(
            ((1.0,), 0.7853981633974483), ((-3.0,), -1.2490457723982544), ((0.0,), 0.0),
            ((1.0, -1.0), 2.356194490192345), ((0.0, -1.0), _PI), ((-2.0, 0.0), -_HALF_PI),
        ),
    ),
    Builtin("sinh", _F1, "Hyperbolic sine.",
        range="rising(math.sinh, x)",
        guards=(Guard("x.size < 0.6 * F.exponent", "exp overflows in it", "clamp(x, -0.6 * EXPONENT, 0.6 * EXPONENT)", "x"),),
        inside="abs(x) < 88.0",
        domain="|x| < 88", kind="transcendental", cost=11, ulp=184.0, absolute=2.0**-20, clause=_HYPERBOLIC,
        vectors=(((1.0,), 1.1752011936438014), ((0.0,), 0.0), ((-0.5,), -0.5210953054937474)),
    ),
    Builtin("cosh", _F1, "Hyperbolic cosine.",
        range="rising(math.cosh, absolute(x))",
        guards=(Guard("x.size < 0.6 * F.exponent", "exp overflows in it", "clamp(x, -0.6 * EXPONENT, 0.6 * EXPONENT)", "x"),),
        inside="abs(x) < 88.0",
        domain="|x| < 88", kind="transcendental", cost=11, ulp=184.0, clause=_HYPERBOLIC,
        vectors=(((1.0,), 1.5430806348152437), ((0.0,), 1.0), ((-2.0,), 3.7621956910836314)),
    ),
    Builtin("tanh", _F1, "Hyperbolic tangent.",
        range="hull(-1, 1)",
        guards=(Guard("x.size <= 0.3 * F.exponent", "exp overflows in it", "clamp(x, -0.3 * EXPONENT, 0.3 * EXPONENT)", "x"),),
        inside="abs(x) < 44.0",
        domain="|x| < 44, as sinh(x)/cosh(x) may overflow beyond", kind="transcendental", cost=14, ulp=184.0,
        absolute=1e-5, clause="WGSL: absolute error of 1e-5, or that of sinh(x)/cosh(x); Vulkan: the latter",
        vectors=(((0.5,), 0.46211715726000974), ((0.0,), 0.0), ((-20.0,), -1.0)),
    ),
    Builtin("asinh", _F1, "Inverse hyperbolic sine.",
        range="rising(math.asinh, x)",
        guards=(Guard("x.size < 0.5 * F.largest**0.5", "its square overflows", "clamp(x, -0.5 * ROOT, 0.5 * ROOT)", "x"),),
        inside="abs(x) < 1e19",
        domain="|x| < 1e19", texts={"glsl": "", "hlsl": "", "wgsl": ""},  # NVIDIA and SwiftShader lose large negative x
        polyfill="genF asinh(genF x) { return sign(x) * log(abs(x) + sqrt(x * x + 1.0)); }",
        kind="transcendental", cost=14, absolute=2.0**-20, clause=_BY_LOG,
        vectors=(((1.0,), 0.881373587019543), ((0.0,), 0.0), ((-2.0,), -1.4436354751788103)),
    ),
    Builtin("acosh", _F1, "Inverse hyperbolic cosine, not negative.",
        range="rising(math.acosh, maximum(x, 1.0))",
        guards=(Guard("1.0 <= x.low and x.high < 0.5 * F.largest**0.5", "below 1, or its square overflows", "clamp(x, 1.0, 0.5 * ROOT)", "x"),),
        inside="(x >= 1.0) & (x < 1e19)",
        domain="1 <= x < 1e19", texts={"hlsl": ""},
        polyfill="genF acosh(genF x) { return log(x + sqrt((x - 1.0) * (x + 1.0))); }", kind="transcendental",
        cost=13, absolute=2.0**-12, clause=_ACOSH,
        vectors=(((1.0,), 0.0), ((1.5,), 0.9624236501192069), ((2.0,), 1.3169578969248168)),
    ),
    Builtin("atanh", _F1, "Inverse hyperbolic tangent.",
        range="rising(math.atanh, clip(x, -1.0 + 0.5 * F.epsilon, 1.0 - 0.5 * F.epsilon))",
        guards=(Guard("-1.0 < x.low and x.high < 1.0", "at or beyond -1 and 1", "clamp(x, EPSILON - 1.0, 1.0 - EPSILON)", "x"),),
        inside="abs(x) < 1.0",
        domain="-1 < x < 1", texts={"hlsl": ""},
        polyfill="genF atanh(genF x) { return 0.5 * log((1.0 + x) / (1.0 - x)); }", kind="transcendental",
        cost=12, absolute=2.0**-20, clause=_BY_LOG,
        vectors=(((0.5,), 0.5493061443340549), ((0.0,), 0.0), ((-0.25,), -0.25541281188299536)),
    ),
    # 8.2 Exponentials
    Builtin("pow", _F2, "x to the power y.",
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
    Builtin("exp", _F1, "e to the power x.",
        range="rising(math.exp, x)",
        guards=(Guard("x.high < 0.69 * F.exponent", "exp overflows", "min(x, 0.69 * EXPONENT)", "x"),),
        inside="x < 88.0",
        domain="x < 88", kind="transcendental", cost=5, ulp=179.0, clause=_EXP,
        vectors=(((1.0,), 2.718281828459045), ((0.0,), 1.0), ((-2.0,), 0.1353352832366127)),
    ),
    Builtin("log", _F1, "Natural logarithm.",
        range="rising(math.log, maximum(x, F.tiny))",
        guards=(Guard("x.low > 0.0", "the logarithm of 0 or less", "max(x, TINY)", "x"),),
        inside="x > 0.0",
        domain="x > 0", kind="transcendental", cost=5, absolute=2.0**-21, clause=_LOG,
        vectors=(((1.0,), 0.0), ((10.0,), 2.302585092994046), ((0.5,), -0.6931471805599453)),
    ),
    Builtin("exp2", _F1, "2 to the power x.",
        range="rising(math.exp2, x)",
        guards=(Guard("x.high < F.exponent + 1.0", "exp2 overflows", "min(x, EXPONENT)", "x"),),
        inside="x < 128.0",
        domain="x < 128", kind="transcendental", cost=4, ulp=259.0, clause=_EXP2,
        vectors=(((0.5,), 1.4142135623730951), ((0.0,), 1.0), ((-3.0,), 0.125)),
    ),
    Builtin("log2", _F1, "Binary logarithm.",
        range="rising(math.log2, maximum(x, F.tiny))",
        guards=(Guard("x.low > 0.0", "the logarithm of 0 or less", "max(x, TINY)", "x"),),
        inside="x > 0.0",
        domain="x > 0", kind="transcendental", cost=4, absolute=2.0**-21, clause=_LOG,
        vectors=(((3.0,), 1.584962500721156), ((1.0,), 0.0), ((0.125,), -3.0)),
    ),
    Builtin("sqrt", _F1, "Square root.",
        range="rising(math.sqrt, maximum(x, 0.0))",
        guards=(Guard("x.low >= 0.0", "the square root of less than 0", "max(x, 0.0)", "x"),),
        inside="x >= 0.0",
        domain="x >= 0", kind="transcendental", cost=4, ulp=6.0,
        clause="WGSL, Vulkan: that of 1/inversesqrt(x), with 2 and 2.5 ulp",
        vectors=(((2.0,), 1.4142135623730951), ((0.0,), 0.0), ((0.0625,), 0.25)),
    ),
    Builtin("inversesqrt", _F1, "1/sqrt(x).",
        range="falling(lambda v: v**-0.5, maximum(x, F.tiny))",
        guards=(Guard("x.low > 0.0", "the inverse square root of 0 or less", "max(x, TINY)", "x"),),
        inside="x > 0.0",
        domain="x > 0", texts={"hlsl": "rsqrt", "wgsl": "inverseSqrt"}, kind="transcendental", cost=4,
        vectors=(((2.0,), 0.7071067811865476), ((1.0,), 1.0), ((0.0625,), 4.0)),
    ),
    # 8.3 Common
    Builtin("abs", _PLAIN, "Absolute value.",
        range="absolute(x)",
        inside="x != -2147483648",
        domain="for an int: x > -2147483648",
        ulp=0.0, vectors=(((-1.5,), 1.5), ((0.0,), 0.0), ((-7,), 7), (((1, -2),), (1, 2))),
    ),
    Builtin("sign", _PLAIN, "1 for x > 0, -1 for x < 0, else 0.",
        range="signs(x)",
        texts={"hlsl/genF": "{type}(sign({0}))"},
        ulp=0.0, vectors=(((-2.5,), -1.0), ((0.0,), 0.0), ((0.125,), 1.0), ((-3,), -1), ((0,), 0)),
    ),
    Builtin("floor", _F1, "Largest integer not above x.",
        range="rising(math.floor, x)",
        ulp=0.0, vectors=(((1.75,), 1.0), ((-0.25,), -1.0), ((-2.0,), -2.0)),
    ),
    Builtin("ceil", _F1, "Smallest integer not below x.",
        range="rising(math.ceil, x)",
        ulp=0.0, vectors=(((1.25,), 2.0), ((-1.75,), -1.0), ((2.0,), 2.0)),
    ),
    Builtin("trunc", _F1, "Nearest integer not larger in size: x rounded towards 0.",
        range="rising(math.trunc, x)",
        ulp=0.0, vectors=(((1.75,), 1.0), ((-1.75,), -1.0), ((3.0,), 3.0)),
    ),
    Builtin("round", _F1,
        "Nearest integer; of two, the even one (GLSL leaves that choice open, so it is written roundEven there).",
        range="rising(round, x)",
        texts={"glsl": "roundEven"}, ulp=0.0, vectors=(((1.75,), 2.0), ((0.5,), 0.0), ((-1.5,), -2.0), ((2.5,), 2.0)),
    ),
    Builtin("roundEven", _F1, "Nearest integer; of two, the even one.",
        range="rising(round, x)",
        texts={"hlsl": "round", "wgsl": "round"},
        ulp=0.0, vectors=(((1.25,), 1.0), ((0.5,), 0.0), ((1.5,), 2.0), ((-2.5,), -2.0)),
    ),
    Builtin("fract", _F1, "x - floor(x), in [0, 1); may round to 1 for a tiny negative x.",
        range="fraction(x)",
        texts={"hlsl": "frac"}, vectors=(((1.75,), 0.75), ((-0.25,), 0.75), ((-3.0,), 0.0)),
    ),
    Builtin("mod", ("genF(genF, genF)", "genF(genF, float)"),
        "Floored remainder x - y·floor(x/y); has the sign of y. Not HLSL's fmod, which truncates.",
        range="remainder(x, y)",
        guards=(Guard("not y.has_zero()", "a remainder of division by 0", NONZERO, "y"),),
        inside="(y != 0.0) & ((x == 0.0) | (abs(x / y) > 1e-36)) & (abs(x / y - round(x / y)) >= 2.0**-20 * abs(x / y))", size="max(abs(x), abs(y))",
        domain="y != 0; where x/y is within rounding of an integer the result may wrap", texts={"hlsl": "", "wgsl": ""},
        polyfill="""
genF mod(genF x, genF y) { return x - y * floor(x / y); }
vecF mod(vecF x, float y) { return x - y * floor(x / y); }
""",
        cost=4,
        vectors=(
            ((5.5, 2.0), 1.5), ((-0.5, 2.0), 1.5), ((5.5, -2.0), -0.5), (((5.5, -0.5), 2.0), (1.5, 1.5)),
        ),
    ),
    Builtin("fmod", ("genF(genF, genF)", "genF(genF, float)"),
        "Truncated remainder x - y·trunc(x/y), as in C and HLSL; has the sign of x. Written out in HLSL, where glslang "
        "takes fmod for the floored one.",
        range="truncated(x, y)",
        guards=(Guard("not y.has_zero()", "a remainder of division by 0", NONZERO, "y"),),
        inside="(y != 0.0) & ((x == 0.0) | (abs(x / y) > 1e-36)) & (abs(x / y - round(x / y)) >= 2.0**-20 * abs(x / y))", size="max(abs(x), abs(y))",
        domain="y != 0; where x/y is within rounding of an integer the result may wrap", texts={"glsl": "", "hlsl": "", "wgsl": "op:%"},
        polyfill="""
genF fmod(genF x, genF y) { return x - y * trunc(x / y); }
vecF fmod(vecF x, float y) { return x - y * trunc(x / y); }
""",
        splat=(), cost=4,
        vectors=(
            ((5.5, 2.0), 1.5), ((-0.5, 2.0), -0.5), ((5.5, -2.0), 1.5), (((5.5, -0.5), 2.0), (1.5, -0.5)),
        ),
    ),
    Builtin("min", _PAIR, "The smaller; either one where one is NaN.",
        range="minimum(x, y)",
        domain="neither is NaN",
        ulp=0.0, vectors=(
            ((1.0, -2.0), -2.0), ((3, 3), 3), (((1.0, 4.0), 2.0), (1.0, 2.0)), (((1, -4), (-1, 2)), (-1, -4)),
        ),
    ),
    Builtin("max", _PAIR, "The larger; either one where one is NaN.",
        range="maximum(x, y)",
        domain="neither is NaN",
        ulp=0.0, vectors=(
            ((1.0, -2.0), 1.0), ((3, 3), 3), (((1.0, 4.0), 2.0), (2.0, 4.0)), (((1, -4), (-1, 2)), (1, 2)),
        ),
    ),
    Builtin("clamp",
        tuple(f"gen{k}(gen{k}, {bound}, {bound})" for k, one in zip("FIU", _ONES) for bound in (f"gen{k}", one)),
        "min(max(x, y), z).",
        range="clip(x, y, z)",
        guards=(Guard("y.high <= z.low or ordered(y, z)", "the lower bound above the upper one", "min(max(x, y), z)"),),
        inside="y <= z",
        domain="y <= z; x is not NaN", cost=2,
        ulp=0.0, vectors=(
            ((0.5, 0.0, 1.0), 0.5), ((-0.5, 0.0, 1.0), 0.0), ((7, 1, 4), 4),
            (((-1.0, 3.0), 0.0, 2.0), (0.0, 2.0)),
        ),
    ),
    Builtin("saturate", _F1, "clamp(x, 0, 1). Of our own: HLSL and WGSL have it, GLSL has not.",
        range="clip(x, 0.0, 1.0)",
        domain="x is not NaN", texts={"glsl": ""},
        polyfill="genF saturate(genF x) { return clamp(x, 0.0, 1.0); }",
        ulp=0.0, vectors=(((0.25,), 0.25), ((-1.0,), 0.0), ((1.5,), 1.0), (((2.0, -0.0, 1.0),), (1.0, 0.0, 1.0))),
    ),
    Builtin("mix", ("genF(genF, genF, genF)", "genF(genF, genF, float)", "genF(genF, genF, genB)"),
        "Linear blend x·(1 - z) + y·z; with a bool, z ? y : x, where the other one may be infinite or NaN.",
        range="blend(x, y, z)",
        inside="(np.asarray(z).dtype == bool) | (max(abs(x), abs(y)) * max(abs(z), 1.0) < 1e38)", size="max(abs(x), abs(y)) * max(abs(z), 1.0)",
        domain="x and y finite, unless z is a bool",
        texts={"hlsl": "lerp", "hlsl/genF,genF,genB": "", "wgsl/genF,genF,genB": "select"},
        polyfill="""
float mix(float x, float y, bool a) { return a ? y : x; }
vec2 mix(vec2 x, vec2 y, bvec2 a) { return vec2(a.x ? y.x : x.x, a.y ? y.y : x.y); }
vec3 mix(vec3 x, vec3 y, bvec3 a) { return vec3(a.x ? y.x : x.x, a.y ? y.y : x.y, a.z ? y.z : x.z); }
vec4 mix(vec4 x, vec4 y, bvec4 a) {
    return vec4(a.x ? y.x : x.x, a.y ? y.y : x.y, a.z ? y.z : x.z, a.w ? y.w : x.w);
}
""",
        splat=(), cost=2,
        vectors=(
            ((0.0, 10.0, 0.25), 2.5), ((1.0, 3.0, 0.0), 1.0), (((0.0, 2.0), (4.0, 4.0), 0.5), (2.0, 3.0)),
            (((1.0, 2.0), (3.0, 4.0), (True, False)), (3.0, 2.0)), ((_INF, 4.0, True), 4.0),
        ),
    ),
    Builtin("step", ("genF(genF, genF)", "genF(float, genF)"), "0 for y < x, else 1.",
        range="hull(0, 1)",
        ulp=0.0, vectors=(((0.5, 0.25), 0.0), ((0.5, 0.5), 1.0), ((1.0, (0.0, 2.0)), (0.0, 1.0))),
    ),
    Builtin("smoothstep", ("genF(genF, genF, genF)", "genF(float, float, genF)"),
        "Cubic step t·t·(3 - 2·t) with t = clamp((z - x)/(y - x), 0, 1).",
        range="hull(0, 1)",
        guards=(Guard("(y - x).low > 0.0 and (y - x).high <= F.largest", "edges in the wrong order, or one", "{ genF t = clamp((z - x) / clamp(y - x, DIVISOR, LARGEST), 0.0, 1.0); return t * t * (3.0 - 2.0 * t); }",
            doc="smoothstep; with edges in the wrong order or one, a step."),),
        inside="(x < y) & (y - x < 1e30)",
        domain="x < y", cost=8, ulp=16.0,
        clause="WGSL, Vulkan: that of the formula, with 2.5 ulp for the division",
        vectors=(((0.0, 2.0, 0.5), 0.15625), ((0.0, 1.0, 0.0), 0.0), ((0.0, 1.0, (0.5, 3.0)), (0.5, 1.0))),
    ),
    Builtin("isnan", ("genB(genF)",),
        "Whether x is not a number, by its bits: compilers may take it that no NaN occurs.",
        range="hull(0, 1)",
        texts={"glsl": "", "hlsl": "", "wgsl": ""},
        polyfill="""
bool isnan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
vecB isnan(vecF x) { return greaterThan(floatBitsToUint(x) & vecU(0x7fffffffu), vecU(0x7f800000u)); }
""",
        cost=2, vectors=(((_NAN,), True), ((_INF,), False), ((0.0,), False), (((1.0, _NAN),), (False, True))),
    ),
    Builtin("isinf", ("genB(genF)",), "Whether x is infinite, by its bits, as isnan.",
        range="hull(0, 1)",
        texts={"glsl": "", "hlsl": "", "wgsl": ""},
        polyfill="""
bool isinf(float x) { return (floatBitsToUint(x) & 0x7fffffffu) == 0x7f800000u; }
vecB isinf(vecF x) { return equal(floatBitsToUint(x) & vecU(0x7fffffffu), vecU(0x7f800000u)); }
""",
        cost=2,
        vectors=(((-_INF,), True), ((_NAN,), False), ((2.0**127,), False), (((1.0, _INF),), (False, True))),
    ),
    Builtin("floatBitsToInt", ("genI(genF)",), "The float32's bits, as an int.",
        texts={"hlsl": "asint", "wgsl": "bitcast<{type}>({0})"},
        vectors=(((1.0,), 0x3F800000), ((-2.0,), -0x40000000), ((0.0,), 0)),
    ),
    Builtin("floatBitsToUint", ("genU(genF)",), "The float32's bits, as a uint.",
        texts={"hlsl": "asuint", "wgsl": "bitcast<{type}>({0})"},
        vectors=(((1.0,), 0x3F800000), ((-2.0,), 0xC0000000), ((0.0,), 0)),
    ),
    Builtin("intBitsToFloat", ("genF(genI)",), "The float32 with these bits.",
        guards=(Guard("False", "bits of no finite number", FINITE, "result"),),
        inside="abs(intBitsToFloat(x)) < 1e39",
        domain="the bits are those of a finite float",
        texts={"hlsl": "asfloat", "wgsl": "bitcast<{type}>({0})"},
        ulp=0.0, vectors=(((0x3F800000,), 1.0), ((-0x40000000,), -2.0), ((0,), 0.0)),
    ),
    Builtin("uintBitsToFloat", ("genF(genU)",), "The float32 with these bits.",
        guards=(Guard("False", "bits of no finite number", FINITE, "result"),),
        inside="abs(uintBitsToFloat(x)) < 1e39",
        domain="the bits are those of a finite float",
        texts={"hlsl": "asfloat", "wgsl": "bitcast<{type}>({0})"},
        ulp=0.0, vectors=(((0x3F800000,), 1.0), ((0xC0000000,), -2.0), ((0,), 0.0)),
    ),
    # 8.4 Packing; the first component goes into the low bits
    Builtin("packSnorm2x16", ("uint(vec2)",),
        "Two numbers in [-1, 1], each as a signed 16-bit fraction of 32767.",
        inside="abs(fract(clamp(x, -1.0, 1.0) * 32767.0) - 0.5) > 0.01",
        texts={"glsl-330": "", "hlsl": "", "wgsl": "pack2x16snorm"},
        polyfill="""
uint packSnorm2x16(vec2 x) {
    ivec2 i = ivec2(round(clamp(x, -1.0, 1.0) * 32767.0));
    return (uint(i.x) & 0xffffu) | (uint(i.y) << 16u);
}
""",
        cost=9, vectors=((((-1.0, 1.0),), 0x7FFF8001), (((0.0, 0.0),), 0), (((4.0, -4.0),), 0x80017FFF)),
    ),
    Builtin("packUnorm2x16", ("uint(vec2)",), "Two numbers in [0, 1], each as a 16-bit fraction of 65535.",
        inside="abs(fract(clamp(x, 0.0, 1.0) * 65535.0) - 0.5) > 0.01",
        texts={"glsl-330": "", "hlsl": "", "wgsl": "pack2x16unorm"},
        polyfill="""
uint packUnorm2x16(vec2 x) {
    uvec2 u = uvec2(round(clamp(x, 0.0, 1.0) * 65535.0));
    return u.x | (u.y << 16u);
}
""",
        cost=8, vectors=((((0.0, 1.0),), 0xFFFF0000), (((0.0, 0.0),), 0), (((2.0, -1.0),), 0xFFFF)),
    ),
    Builtin("packHalf2x16", ("uint(vec2)",), "Two numbers as float16.",
        inside="unpackHalf2x16(packHalf2x16(x)) == x",
        domain="representable in float16: the rounding is the target's",
        texts={"glsl-330": "", "hlsl": "dot(f32tof16({0}), uint2(1u, 65536u))", "hlsl-dx9": "", "wgsl": "pack2x16float"},
        polyfill="""
uint packHalf2x16(vec2 x) {
    uvec2 bits = floatBitsToUint(abs(x));
    uvec2 normal = (bits - 0x37fff001u + ((bits >> 13u) & 1u)) >> 13u;
    uvec2 tiny = uvec2(round(abs(x) * 16777216.0));
    uvec2 halves = uvec2(bits.x < 0x38800000u ? tiny.x : normal.x, bits.y < 0x38800000u ? tiny.y : normal.y);
    halves |= (floatBitsToUint(x) >> 16u) & 0x8000u;
    return halves.x | (halves.y << 16u);
}
""",
        cost=3,
        vectors=((((1.0, -2.0),), 0xC0003C00), (((0.5, 0.0),), 0x3800), (((65504.0, 0.25),), 0x34007BFF)),
    ),
    Builtin("unpackSnorm2x16", ("vec2(uint)",),
        "Two numbers in [-1, 1] from signed 16-bit fractions of 32767.",
        range="hull(-1, 1)",
        texts={"glsl-330": "", "hlsl": "", "wgsl": "unpack2x16snorm"},
        polyfill="""
vec2 unpackSnorm2x16(uint x) {
    return clamp(vec2(float(int(x << 16u) >> 16), float(int(x) >> 16)) / 32767.0, -1.0, 1.0);
}
""",
        cost=4,
        vectors=(((0x80007FFF,), (1.0, -1.0)), ((0,), (0.0, 0.0)), ((0x4000,), (0.500015259254738, 0.0))),
    ),
    Builtin("unpackUnorm2x16", ("vec2(uint)",), "Two numbers in [0, 1] from 16-bit fractions of 65535.",
        range="hull(0, 1)",
        texts={"glsl-330": "", "hlsl": "", "wgsl": "unpack2x16unorm"},
        polyfill="vec2 unpackUnorm2x16(uint x) { return vec2(float(x & 65535u), float(x >> 16u)) / 65535.0; }",
        cost=3,
        vectors=(((0xFFFF,), (1.0, 0.0)), ((0,), (0.0, 0.0)), ((0x80000000,), (0.0, 0.5000076295109483))),
    ),
    Builtin("unpackHalf2x16", ("vec2(uint)",), "Two numbers from float16.",
        range="hull(-65504, 65504)",
        guards=(Guard("False", "bits of no finite number", FINITE, "result"),),
        inside="abs(unpackHalf2x16(x)) < 1e5",
        domain="both are finite",
        texts={
            "glsl-330": "", "hlsl": "f16tof32(({0}) >> uint2(0u, 16u))", "hlsl-dx9": "", "wgsl": "unpack2x16float",
        },
        polyfill="""
vec2 unpackHalf2x16(uint x) {
    uvec2 halves = uvec2(x & 0xffffu, x >> 16u);
    uvec2 bits = halves & 0x7fffu;
    vec2 normal = uintBitsToFloat((bits << 13u) + 0x38000000u);
    vec2 tiny = vec2(bits) / 16777216.0;
    vec2 size = vec2(bits.x < 1024u ? tiny.x : normal.x, bits.y < 1024u ? tiny.y : normal.y);
    return uintBitsToFloat(floatBitsToUint(size) | ((halves & 0x8000u) << 16u));
}
""",
        cost=2,
        ulp=0.0, vectors=(((0xC0003C00,), (1.0, -2.0)), ((0x3800,), (0.5, 0.0)), ((0x34007BFF,), (65504.0, 0.25))),
    ),
    # 8.5 Geometry
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
    # 8.6 Matrices
    Builtin("matrixCompMult", ("mat(mat, mat)",), "Componentwise product.",
        range="x * y",
        inside="abs(x * y) < 1e38",
        texts={"hlsl": "", "wgsl": ""},
        polyfill="""
mat2 matrixCompMult(mat2 x, mat2 y) { return mat2(x[0] * y[0], x[1] * y[1]); }
mat3 matrixCompMult(mat3 x, mat3 y) { return mat3(x[0] * y[0], x[1] * y[1], x[2] * y[2]); }
mat4 matrixCompMult(mat4 x, mat4 y) { return mat4(x[0] * y[0], x[1] * y[1], x[2] * y[2], x[3] * y[3]); }
""",
        vectors=(
            ((((1.0, 2.0), (3.0, 4.0)), ((5.0, 6.0), (7.0, 8.0))), ((5.0, 12.0), (21.0, 32.0))),
            ((((1.0, 0.0), (0.0, 1.0)), ((5.0, 6.0), (7.0, 8.0))), ((5.0, 0.0), (0.0, 8.0))),
            ((((0.0, 0.0), (0.0, 0.0)), ((5.0, 6.0), (7.0, 8.0))), ((0.0, 0.0), (0.0, 0.0))),
        ),
    ),
    Builtin("outerProduct", ("mat2(vec2, vec2)", "mat3(vec3, vec3)", "mat4(vec4, vec4)"),
        "The matrix whose column i is x·y[i].",
        range="whole: outer(x, y)",
        inside="length(x) * length(y) < 1e38",
        texts={"hlsl": "", "wgsl": ""},
        polyfill="""
mat2 outerProduct(vec2 x, vec2 y) { return mat2(x * y.x, x * y.y); }
mat3 outerProduct(vec3 x, vec3 y) { return mat3(x * y.x, x * y.y, x * y.z); }
mat4 outerProduct(vec4 x, vec4 y) { return mat4(x * y.x, x * y.y, x * y.z, x * y.w); }
""",
        vectors=(
            (((1.0, 2.0), (3.0, 4.0)), ((3.0, 6.0), (4.0, 8.0))),
            (((0.0, 0.0), (3.0, 4.0)), ((0.0, 0.0), (0.0, 0.0))),
            (((1.0, 0.0, 2.0), (0.0, 1.0, -1.0)), ((0.0, 0.0, 0.0), (1.0, 0.0, 2.0), (-1.0, 0.0, -2.0))),
        ),
    ),
    Builtin("transpose", ("mat(mat)",), "Rows for columns.",
        range="whole: transposed(x)",
        cost=0,
        ulp=0.0, vectors=(
            ((((1.0, 2.0), (3.0, 4.0)),), ((1.0, 3.0), (2.0, 4.0))),
            ((((1.0, 0.0), (0.0, 1.0)),), ((1.0, 0.0), (0.0, 1.0))),
            ((((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)),), ((1.0, 4.0, 7.0), (2.0, 5.0, 8.0), (3.0, 6.0, 9.0))),
        ),
    ),
    Builtin("determinant", ("float(mat)",), "Determinant.",
        range="whole: determinant(x)",
        cost=8, ulp=32.0, clause="WGSL: no bound",
        vectors=(
            ((((1.0, 2.0), (3.0, 4.0)),), -2.0), ((((1.0, 2.0), (2.0, 4.0)),), 0.0),
            ((((2.0, 0.0, 0.0), (1.0, 3.0, 0.0), (5.0, 7.0, 4.0)),), 24.0),
        ),
    ),
    Builtin("inverse", ("mat(mat)",), "Inverse matrix.",
        guards=(Guard("False", "a matrix without an inverse", "", doc="The inverse; of a matrix without one, large numbers."),),
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
    # 8.7 Vector relations
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
    # 8.8 Texture reads
    Builtin("unpackNormal", ("vec3(vec4)",),
        "The tangent-space normal of a normal map's texel, y up. Unity may pack it when it imports the map.",
        range="whole: normal_texel(x)",
        size="max(2.0 * abs(x[:3]), 1.0)",
        texts={"glsl": "", "hlsl": "", "wgsl": "", "hlsl-dx9": "UnpackNormal", "hlsl-macros": "UnpackNormal"},
        polyfill="vec3 unpackNormal(vec4 texel) { return texel.xyz * 2.0 - 1.0; }", cost=2,
        vectors=(
            (((0.5, 0.5, 1.0, 1.0),), (0.0, 0.0, 1.0)), (((1.0, 0.0, 0.5, 0.0),), (1.0, -1.0, 0.0)),
            (((0.75, 0.25, 1.0, 1.0),), (0.5, -0.5, 1.0)),
        ),
    ),
    Builtin("textureSize", ("ivec2(sampler2D, int)", "ivec3(sampler3D, int)", "ivec2(samplerCube, int)"),
        "Size in texels of level y. HLSL has it only as a statement, so it is refused there.",
        range="hull(0, 65536)", domain="the level exists", texts={"hlsl": "", "wgsl": "{type}(textureDimensions({texture}, {1}))"},
        splat=(), kind="fetch",
    ),
    Builtin("texture", (*(f"{read})" for read in _SAMPLE), *(f"{read}, float)" for read in _SAMPLE)),
        "Filtered texture read; the level comes from screen-space derivatives, with z added to it.",
        range="whole: texels(x)",
        domain="uniform control flow",
        texts={
            "hlsl": "{texture}.Sample({sampler}, {1})",
            "hlsl/sampler2D,vec2,float": "{texture}.SampleBias({sampler}, {1}, {2})",
            "hlsl/sampler3D,vec3,float": "{texture}.SampleBias({sampler}, {1}, {2})",
            "hlsl/samplerCube,vec3,float": "{texture}.SampleBias({sampler}, {1}, {2})",
            "hlsl-dx9": "tex{dim}({texture}, {1})",
            "hlsl-dx9/sampler2D,vec2,float": "tex2Dbias({texture}, float4({1}, 0.0, {2}))",
            "hlsl-dx9/sampler3D,vec3,float": "tex3Dbias({texture}, float4({1}, {2}))",
            "hlsl-dx9/samplerCube,vec3,float": "texCUBEbias({texture}, float4({1}, {2}))",
            "hlsl-macros": "SAMPLE_TEXTURE{dim}({texture}, {sampler}, {1})",
            "hlsl-macros/sampler2D,vec2,float": "SAMPLE_TEXTURE2D_BIAS({texture}, {sampler}, {1}, {2})",
            "hlsl-macros/sampler3D,vec3,float": "{bare_texture}.SampleBias({bare_sampler}, {1}, {2})",
            "hlsl-macros/samplerCube,vec3,float": "SAMPLE_TEXTURECUBE_BIAS({texture}, {sampler}, {1}, {2})",
            "wgsl": "textureSample({texture}, {sampler}, {1})",
            "wgsl/sampler2D,vec2,float": "textureSampleBias({texture}, {sampler}, {1}, {2})",
            "wgsl/sampler3D,vec3,float": "textureSampleBias({texture}, {sampler}, {1}, {2})",
            "wgsl/samplerCube,vec3,float": "textureSampleBias({texture}, {sampler}, {1}, {2})",
        },
        splat=(), kind="fetch", absolute=2.0**-7, clause=_EIGHT_BITS,
    ),
    Builtin("textureLod", tuple(f"{read}, float)" for read in _SAMPLE), "Filtered texture read at level z.",
        range="whole: texels(x)",
        texts={
            "hlsl": "{texture}.SampleLevel({sampler}, {1}, {2})",
            "hlsl-dx9": "tex{dim}lod({texture}, float4({1}, {2}))",
            "hlsl-dx9/sampler2D,vec2,float": "tex2Dlod({texture}, float4({1}, 0.0, {2}))",
            "hlsl-macros": "SAMPLE_TEXTURE{dim}_LOD({texture}, {sampler}, {1}, {2})",
            "wgsl": "textureSampleLevel({texture}, {sampler}, {1}, {2})",
        },
        splat=(), kind="fetch", absolute=2.0**-7, clause=_EIGHT_BITS,
    ),
    Builtin("textureGrad",
        ("vec4(sampler2D, vec2, vec2, vec2)", *(f"{read}, vec3, vec3)" for read in _SAMPLE[1:])),
        "Filtered texture read; the level comes from the given derivatives of the coordinate along screen x and y.",
        range="whole: texels(x)",
        texts={
            "hlsl": "{texture}.SampleGrad({sampler}, {1}, {2}, {3})",
            "hlsl-dx9": "tex{dim}grad({texture}, {1}, {2}, {3})",
            "hlsl-macros": "{bare_texture}.SampleGrad({bare_sampler}, {1}, {2}, {3})",
            "hlsl-macros/sampler2D,vec2,vec2,vec2": "SAMPLE_TEXTURE2D_GRAD({texture}, {sampler}, {1}, {2}, {3})",
            "wgsl": "textureSampleGrad({texture}, {sampler}, {1}, {2}, {3})",
        },
        splat=(), kind="fetch", absolute=2.0**-7, clause=_EIGHT_BITS,
    ),
    Builtin("texelFetch", ("vec4(sampler2D, ivec2, int)", "vec4(sampler3D, ivec3, int)"),
        "The texel at y of level z, unfiltered.",
        range="whole: texels(x)",
        domain="the texel and the level exist",
        texts={
            "hlsl": "{texture}.Load(int3({1}, {2}))",
            "hlsl/sampler3D,ivec3,int": "{texture}.Load(int4({1}, {2}))", "hlsl-dx9": "",
            "hlsl-macros": "LOAD_TEXTURE{dim}_LOD({texture}, {1}, {2})",
            "wgsl": "textureLoad({texture}, {1}, {2})",
        },
        splat=(), kind="fetch", ulp=0.0,
    ),
    # 8.9 Derivatives
    Builtin("dFdx", _F1, "Change of x from one pixel to the next, to the right.",
        range="x - x",
        domain="uniform control flow", texts={"hlsl": "ddx", "wgsl": "dpdx"}, kind="derivative",
    ),
    Builtin("dFdy", _F1,
        "Change of x from one pixel to the next along framebuffer y: up in OpenGL, down in D3D and WebGPU.",
        range="x - x",
        domain="uniform control flow", texts={"hlsl": "ddy", "wgsl": "dpdy"}, kind="derivative",
    ),
    Builtin("fwidth", _F1, "abs(dFdx(x)) + abs(dFdy(x)).",
        range="absolute(x - x) * 2.0",
        domain="uniform control flow", kind="derivative", cost=3,
    ),
)
