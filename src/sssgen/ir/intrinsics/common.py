"""Common componentwise functions: 8.3 of the specification."""

from __future__ import annotations

import math
import struct
from typing import Any

from sssgen.ir.component_ranges import (
    any_number,
    floored_remainder,
    fused_product_sum,
    linear_blend,
    power_of_two_product,
    truncated_remainder,
    within,
)
from sssgen.ir.intervals import INF, Range, absolute, clip, fraction, maximum, minimum, rising, signs
from sssgen.ir.intrinsics.table import F1, LARGEST, NAN, NONZERO, NOT_FINITE_BITS, Builtin, Guard, Samples, check_domain

_PLAIN = F1[0], "genI(genI)"
_ONES = ("float", "int", "uint")
_PAIR = tuple(f"gen{k}(gen{k}, {other})" for k, one in zip("FIU", _ONES) for other in (f"gen{k}", one))


def _blend(x: float, y: float, z: float | bool) -> float:
    return (y if z else x) if isinstance(z, bool) else x * (1.0 - z) + y * z


def _smoothstep(x: float, y: float, z: float) -> float:
    t = min(max((z - x) / (y - x), 0.0), 1.0)
    return float(check_domain(x < y, t * t * (3.0 - 2.0 * t)))


_POWER = "clamp(ldexp(x, clamp(y, -126, 127)), -LARGEST, LARGEST)"
_STEP = "{ genF t = clamp((z - x) / clamp(y - x, DIVISOR, LARGEST), 0.0, 1.0); return t * t * (3.0 - 2.0 * t); }"
_STEP_DOC = "smoothstep; a step if the edges are equal or in the wrong order."


def _step_advice(x: Range, y: Range, z: Range) -> str:
    reverse = "1.0 - smoothstep(y, x, z)"
    if x.low > y.high:
        return f"{reverse} in place of the call"
    if x.low == x.high == y.low == y.high:
        return "step(x, z) in place of the call"
    text = "t * t * (3.0 - 2.0 * t), with t = clamp((z - x) / max(y - x, DIVISOR), 0.0, 1.0), in place of the call"
    return text if x.high <= y.low else f"{text}; or {reverse} where x > y"


def _bits(x: float) -> int:
    return int.from_bytes(struct.pack("<f", x), "little")


def _from_bits(x: int) -> float:
    return float(struct.unpack("<f", (x & 0xFFFFFFFF).to_bytes(4, "little"))[0])


def _off_integer_quotients(rt: Any, x: Any, y: Any, rounding: float = 2.0**-20) -> Any:
    """Where x/y is not within `rounding` of an integer."""
    quotient = x / y
    distance = abs(quotient - rt.round(quotient))
    return (y != 0.0) & ((x == 0.0) | (abs(quotient) > 1e-36)) & (distance >= rounding * abs(quotient))


_REMAINDER = Guard(
    lambda F, x, y: not y.has_zero(), "division", "a remainder of division by 0", NONZERO, "y", function="nonzero",
    argument=lambda F, y: Range(y.low, y.high, max(y.gap, F.divisor)),
    result=lambda F, range: range,  # not finite, where the quotient overflows
)  # fmt: skip


def _choice(scalar: str, vector: str) -> str:
    """The polyfill of `mix` with bools, for one kind of number."""
    definitions = [f"{scalar} mix({scalar} x, {scalar} y, bool a) {{ return a ? y : x; }}"]
    for size in (2, 3, 4):
        parts = ", ".join(f"a.{at} ? y.{at} : x.{at}" for at in "xyzw"[:size])
        definitions.append(
            f"{vector}{size} mix({vector}{size} x, {vector}{size} y, bvec{size} a) {{ return {vector}{size}({parts}); }}"
        )
    return "\n".join(definitions)


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("abs", _PLAIN, "Absolute value.",
        es=100, fold=abs, relation="abs",
        same_quantity=3, quantity="argument", range=lambda F, x: absolute(x),
        defined=lambda rt, x: x != -2147483648,
        domain="for an int: x > -2147483648",
        ulp=0.0, vectors=(((-1.5,), 1.5), ((0.0,), 0.0), ((-7,), 7), (((1, -2),), (1, 2))),
    ),
    Builtin("sign", _PLAIN, "1 for x > 0, -1 for x < 0, else 0.",
        es=100, fold=lambda x: (x > 0) - (x < 0), range=lambda F, x: signs(x),
        texts={"hlsl/genF": "{type}(sign({0}))", "wgsl-metal/genI": ""}, polyfill="genI sign(genI x) { return clamp(x, -1, 1); }",
        ulp=0.0, vectors=(((-2.5,), -1.0), ((0.0,), 0.0), ((0.125,), 1.0), ((-3,), -1), ((0,), 0)),
    ),
    Builtin("floor", F1, "Largest integer not above x.",
        es=100, fold=math.floor, range=lambda F, x: rising(math.floor, x),
        ulp=0.0, vectors=(((1.75,), 1.0), ((-0.25,), -1.0), ((-2.0,), -2.0)),
    ),
    Builtin("ceil", F1, "Smallest integer not below x.",
        es=100, fold=math.ceil, range=lambda F, x: rising(math.ceil, x),
        ulp=0.0, vectors=(((1.25,), 2.0), ((-1.75,), -1.0), ((2.0,), 2.0)),
    ),
    Builtin("trunc", F1, "Nearest integer not larger in size: x rounded towards 0.",
        es=300, fold=math.trunc, range=lambda F, x: rising(math.trunc, x),
        ulp=0.0, vectors=(((1.75,), 1.0), ((-1.75,), -1.0), ((3.0,), 3.0)),
    ),
    Builtin("round", F1,
        "Nearest integer; of two, the even one (undefined in GLSL, where roundEven is used).",
        es=300, not_constant=("hlsl",), fold=round, range=lambda F, x: rising(round, x), defined=lambda rt, x: abs(x - rt.trunc(x)) != 0.5, inside=lambda rt, x: x == x,
        texts={"glsl": "roundEven", "wgsl-metal": "rint"}, ulp=0.0, vectors=(((1.75,), 2.0), ((0.5,), 0.0), ((-1.5,), -2.0), ((2.5,), 2.0)),
    ),
    Builtin("roundEven", F1, "Nearest integer; of two, the even one.",
        es=300, not_constant=("hlsl",), fold=round, range=lambda F, x: rising(round, x),
        texts={"hlsl": "round", "wgsl": "round", "wgsl-metal": "rint", "tsl": ""},
        polyfill="""
genF roundEven(genF x) {
    genF low = floor(x);
    genF part = x - low;
    genF odd = low - 2.0 * floor(0.5 * low);
    return low + mix(1.0 - step(part, genF(0.5)), step(0.5, part), odd);
}
""",
        ulp=0.0, vectors=(((1.25,), 1.0), ((0.5,), 0.0), ((1.5,), 2.0), ((-2.5,), -2.0)),
    ),
    Builtin("fract", F1, "x - floor(x), in [0, 1); may round to 1 for a tiny negative x.",
        es=100, fold=lambda x: x - math.floor(x), range=lambda F, x: fraction(x),
        texts={"hlsl": "frac"}, vectors=(((1.75,), 0.75), ((-0.25,), 0.75), ((-3.0,), 0.0)),
    ),
    Builtin("mod", ("genF(genF, genF)", "genF(genF, float)"),
        "Floored remainder x - y·floor(x/y); has the sign of y. Not HLSL's fmod, which truncates.",
        es=100, fold=lambda x, y: x - y * math.floor(x / y), overflow_is_nan=True, range=floored_remainder,
        guards=(_REMAINDER,),
        inside=_off_integer_quotients, size=lambda rt, x, y: rt.max(abs(x), abs(y)),
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
        "Truncated remainder x - y·trunc(x/y), as in C and HLSL; has the sign of x. Written as a polyfill in HLSL, where "
        "glslang takes fmod for the floored one.",
        fold=lambda x, y: x - y * math.trunc(x / y), overflow_is_nan=True, range=truncated_remainder,
        guards=(_REMAINDER,),
        inside=_off_integer_quotients, size=lambda rt, x, y: rt.max(abs(x), abs(y)),
        domain="y != 0; where x/y is within rounding of an integer the result may wrap", texts={
            "glsl": "", "hlsl": "", "tsl": "", "wgsl": "op:%", "wgsl-metal": "fmod", "wgsl-metal/genF,float": "fmod({0}, {type}({1}))",
        },
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
        es=100, fold=min, relation="min", same_quantity=3, quantity="argument", range=lambda F, x, y: minimum(x, y),
        domain="neither is NaN",
        ulp=0.0, vectors=(
            ((1.0, -2.0), -2.0), ((3, 3), 3), (((1.0, 4.0), 2.0), (1.0, 2.0)), (((1, -4), (-1, 2)), (-1, -4)),
        ),
    ),
    Builtin("max", _PAIR, "The larger; either one where one is NaN.",
        es=100, fold=max, relation="max", same_quantity=3, quantity="argument", range=lambda F, x, y: maximum(x, y),
        domain="neither is NaN",
        ulp=0.0, vectors=(
            ((1.0, -2.0), 1.0), ((3, 3), 3), (((1.0, 4.0), 2.0), (2.0, 4.0)), (((1, -4), (-1, 2)), (1, 2)),
        ),
    ),
    Builtin("clamp",
        tuple(f"gen{k}(gen{k}, {bound}, {bound})" for k, one in zip("FIU", _ONES) for bound in (f"gen{k}", one)),
        "min(max(x, y), z).",
        es=100, fold=lambda x, y, z: check_domain(y <= z, min(max(x, y), z)), same_quantity=3, quantity="argument",
        range=lambda F, x, y, z: clip(x, y, z),
        guards=(Guard(lambda F, x, y, z: y.high <= z.low, "undefined", "the lower bound above the upper one", "min(max(x, y), z)", ordered=(1, 2)),),
        defined=lambda rt, x, y, z: y <= z, checked=(1, 2),
        domain="y <= z; x is not NaN", cost=2,
        ulp=0.0, vectors=(
            ((0.5, 0.0, 1.0), 0.5), ((-0.5, 0.0, 1.0), 0.0), ((7, 1, 4), 4),
            (((-1.0, 3.0), 0.0, 2.0), (0.0, 2.0)),
        ),
    ),
    Builtin("saturate", F1, "clamp(x, 0, 1). HLSL and WGSL have it, GLSL does not.",
        fold=lambda x: min(max(x, 0.0), 1.0), same_quantity=3, quantity="argument",
        range=lambda F, x: clip(x, 0.0, 1.0),
        domain="x is not NaN", texts={"glsl": ""},
        polyfill="genF saturate(genF x) { return clamp(x, 0.0, 1.0); }",
        ulp=0.0, vectors=(((0.25,), 0.25), ((-1.0,), 0.0), ((1.5,), 1.0), (((2.0, -0.0, 1.0),), (1.0, 0.0, 1.0))),
    ),
    Builtin("mix",
        ("genF(genF, genF, genF)", "genF(genF, genF, float)", *(f"gen{k}(gen{k}, gen{k}, genB)" for k in "FIUB")),
        "Linear blend x·(1 - z) + y·z; with a bool, z ? y : x, and the number that is not chosen may be infinite or NaN.",
        es=100, not_constant=("wgsl",), chooses=True, fold=_blend, samples=Samples(floats=((-LARGEST, LARGEST), (-LARGEST, LARGEST), (0.0, 1.0))),
        same_quantity=2, quantity="blend", overflow_is_nan=True, range=linear_blend,
        inside=lambda rt, x, y, z: (z.dtype == bool) | (rt.max(abs(x), abs(y)) * rt.max(abs(z), 1.0) < 1e38), size=lambda rt, x, y, z: rt.max(abs(x), abs(y)) * rt.max(abs(z), 1.0),
        domain="x and y finite, unless z is a bool",
        texts={
            "hlsl": "lerp", **{f"glsl/gen{k},gen{k},genB": "" for k in "IUB"}, "glsl-godot/genF,genF,genB": "",
            "wgsl-metal/genF,genF,float": "mix({0}, {1}, {type}({2}))", "wgsl-metal/genB,genB,genB": "",
            **{f"hlsl/gen{k},gen{k},genB": "" for k in "FIUB"}, **{f"wgsl/gen{k},gen{k},genB": "select" for k in "FIUB"},
            **{f"tsl/gen{k},gen{k},genB": "select({2}, {1}, {0})" for k in "FIUB"},
        },
        polyfill="\n".join(map(_choice, ("float", "int", "uint", "bool"), ("vec", "ivec", "uvec", "bvec"))),
        splat=(), explicit_type=("wgsl",), cost=2,
        vectors=(
            ((0.0, 10.0, 0.25), 2.5), ((1.0, 3.0, 0.0), 1.0), (((0.0, 2.0), (4.0, 4.0), 0.5), (2.0, 3.0)),
            (((1.0, 2.0), (3.0, 4.0), (True, False)), (3.0, 2.0)), ((INF, 4.0, True), 4.0),
            ((3, -4, True), -4), (((True, False), (False, True), (True, False)), (False, False)),
        ),
    ),
    Builtin("step", ("genF(genF, genF)", "genF(float, genF)"), "0 for y < x, else 1.",
        es=100, fold=lambda x, y: 0.0 if y < x else 1.0, same_quantity=2, range=within(0.0, 1.0),
        ulp=0.0, vectors=(((0.5, 0.25), 0.0), ((0.5, 0.5), 1.0), ((1.0, (0.0, 2.0)), (0.0, 1.0))),
    ),
    Builtin("smoothstep", ("genF(genF, genF, genF)", "genF(float, float, genF)"),
        "Cubic step t·t·(3 - 2·t) with t = clamp((z - x)/(y - x), 0, 1).",
        es=100, not_constant=("wgsl",), fold=_smoothstep, same_quantity=3, range=within(0.0, 1.0),
        guards=(
            Guard(lambda F, x, y, z: (y - x).low >= F.tiny, "undefined", "edges in the wrong order, or equal", _STEP, doc=_STEP_DOC, advice=_step_advice),
            Guard(lambda F, x, y, z: (y - x).high <= F.largest, "overflow", "a difference of the edges that overflows", _STEP, doc=_STEP_DOC, advice=_step_advice),
        ),
        defined=lambda rt, x, y, z: x < y, checked=(0, 1), inside=lambda rt, x, y, z: (x < y) & (y - x < 1e30),
        domain="x < y", explicit_type=("wgsl",), cost=8, ulp=16.0,
        clause="WGSL, Vulkan: that of the formula, with 2.5 ulp for the division",
        vectors=(((0.0, 2.0, 0.5), 0.15625), ((0.0, 1.0, 0.0), 0.0), ((0.0, 1.0, (0.5, 3.0)), (0.5, 1.0))),
    ),
    Builtin("isnan", ("genB(genF)",),
        "Whether x is not a number, from its bits, as compilers may assume that there is no NaN.",
        es=300, not_constant=("wgsl",), samples=Samples(special=True), range=within(0.0, 1.0),
        texts={"glsl": "", "hlsl": "", "wgsl": "", "tsl": ""},
        polyfill="""
bool isnan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
vecB isnan(vecF x) { return greaterThan(floatBitsToUint(x) & vecU(0x7fffffffu), vecU(0x7f800000u)); }
""",
        cost=2, vectors=(((NAN,), True), ((INF,), False), ((0.0,), False), (((1.0, NAN),), (False, True))),
    ),
    Builtin("isinf", ("genB(genF)",), "Whether x is infinite, from its bits, as isnan.",
        es=300, not_constant=("wgsl",), samples=Samples(special=True), range=within(0.0, 1.0),
        texts={"glsl": "", "hlsl": "", "wgsl": "", "tsl": ""},
        polyfill="""
bool isinf(float x) { return (floatBitsToUint(x) & 0x7fffffffu) == 0x7f800000u; }
vecB isinf(vecF x) { return equal(floatBitsToUint(x) & vecU(0x7fffffffu), vecU(0x7f800000u)); }
""",
        cost=2,
        vectors=(((-INF,), True), ((NAN,), False), ((2.0**127,), False), (((1.0, INF),), (False, True))),
    ),
    Builtin("floatBitsToInt", ("genI(genF)",), "The float32's bits, as an int.",
        es=300, fold=_bits, float32_bits=True, not_constant=("wgsl",), range=any_number,
        texts={"hlsl": "asint", "wgsl": "bitcast<{type}>({0})", "wgsl-metal": "as_type<{type}>({0})"},
        vectors=(((1.0,), 0x3F800000), ((-2.0,), -0x40000000), ((0.0,), 0)),
    ),
    Builtin("floatBitsToUint", ("genU(genF)",), "The float32's bits, as a uint.",
        es=300, fold=_bits, float32_bits=True, not_constant=("wgsl",), range=any_number,
        texts={"hlsl": "asuint", "wgsl": "bitcast<{type}>({0})", "wgsl-metal": "as_type<{type}>({0})"},
        vectors=(((1.0,), 0x3F800000), ((-2.0,), 0xC0000000), ((0.0,), 0)),
    ),
    Builtin("intBitsToFloat", ("genF(genI)",), "The float32 with these bits.",
        es=300, fold=_from_bits, float32_bits=True, not_constant=("wgsl",), range=any_number,
        guards=(NOT_FINITE_BITS,),
        inside=lambda rt, x: abs(rt.intBitsToFloat(x)) < 1e39,
        domain="the bits are those of a finite float",
        texts={"hlsl": "asfloat", "wgsl": "bitcast<{type}>({0})", "wgsl-metal": "as_type<{type}>({0})"},
        ulp=0.0, vectors=(((0x3F800000,), 1.0), ((-0x40000000,), -2.0), ((0,), 0.0)),
    ),
    Builtin("uintBitsToFloat", ("genF(genU)",), "The float32 with these bits.",
        es=300, fold=_from_bits, float32_bits=True, not_constant=("wgsl",), range=any_number,
        guards=(NOT_FINITE_BITS,),
        inside=lambda rt, x: abs(rt.uintBitsToFloat(x)) < 1e39,
        domain="the bits are those of a finite float",
        texts={"hlsl": "asfloat", "wgsl": "bitcast<{type}>({0})", "wgsl-metal": "as_type<{type}>({0})"},
        ulp=0.0, vectors=(((0x3F800000,), 1.0), ((0xC0000000,), -2.0), ((0,), 0.0)),
    ),
    Builtin("fma", ("genF(genF, genF, genF)",), "x·y + z, rounded once or twice.",
        es=320, fold=lambda x, y, z: x * y + z, range=fused_product_sum,
        inside=lambda rt, x, y, z: abs(x * y) + abs(z) < 1e38, size=lambda rt, x, y, z: rt.max(abs(x * y), abs(z)),
        texts={"glsl": "", "hlsl": "", "tsl": ""},  # DXC crashes on mad() in code that is never reached
        polyfill="genF fma(genF x, genF y, genF z) { return x * y + z; }", cost=2,
        vectors=(
            ((2.0, 3.0, -1.0), 5.0), ((0.0, 4.0, 0.5), 0.5), (((1.5, -2.0), (2.0, 0.25), (1.0, 0.5)), (4.0, 0.0)),
        ),
    ),
    Builtin("ldexp", ("genF(genF, genI)",), "x·2^y.",
        es=310, not_constant=("wgsl",), fold=math.ldexp, samples=Samples(integers={1: (-126, 127)}), range=power_of_two_product,
        guards=(
            Guard(lambda F, x, y: y.low >= -126.0 and y.high <= 127.0, "undefined", "the power is beyond the exponents of a float", _POWER),
            Guard(lambda F, x, y: (absolute(x) * rising(math.exp2, y)).high < F.largest, "overflow", "a product that overflows", _POWER),
        ),
        defined=lambda rt, x, y: (y >= -126) & (y <= 127),
        inside=lambda rt, x, y: (y >= -126) & (y <= 127) & (abs(rt.ldexp(x, y)) < 1e38) & ((x == 0.0) | (abs(rt.ldexp(x, y)) > 1e-37)),
        domain="-126 <= y <= 127, and the result is 0 or a normal number", texts={"glsl": "", "hlsl": "", "tsl": ""},
        polyfill="""
genF ldexp(genF x, genI y) {
    genI whole = clamp(y, -252, 254);
    genI part = whole >> 1u;
    return x * intBitsToFloat((part + 127) << 23u) * intBitsToFloat((whole - part + 127) << 23u);
}
""",
        cost=8,
        vectors=(((0.75, 3), 6.0), ((-1.0, -2), -0.25), ((0.0, 100), 0.0), (((1.0, 3.0), (0, 1)), (1.0, 6.0))),
    ),
)
