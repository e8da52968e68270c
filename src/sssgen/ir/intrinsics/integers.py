"""Functions of the bits of integers: chapter 8.8 of GLSL 4.60; 3.30 and ES 3.00 lack them."""

from __future__ import annotations

from sssgen.ir.component_ranges import any_number, within
from sssgen.ir.intrinsics.table import Builtin, Samples, check_domain

_BOTH = ("genI(genI)", "genI(genU)")
_MOST = 0xFFFFFFFF
_FIELD = "y >= 0, z >= 0, and y + z <= 32"


def _of_both(definition: str) -> str:
    """A polyfill for uints and for ints: in the definition FROM is the type, BITS the bits of x as a uint."""
    unsigned = definition.replace("FROM", "genU").replace("BITS", "x")
    signed = definition.replace("FROM", "genI").replace("BITS", "genU(x)")
    return unsigned + signed


def _extracted(x: int, y: int, z: int) -> int:
    """The bits of a field."""
    bits: int = check_domain(y >= 0 and z >= 0 and y + z <= 32, (x & _MOST) >> y & ((1 << z) - 1))
    return bits


def _extracted_sign(x: int, y: int, z: int) -> int:
    """The bits of a field; the highest one is the sign."""
    bits = _extracted(x, y, z)
    return bits - (1 << z) if z and bits >> (z - 1) else bits


def _inserted(x: int, y: int, z: int, w: int) -> int:
    mask: int = check_domain(z >= 0 and w >= 0 and z + w <= 32, ((1 << w) - 1) << z)
    return (x & ~mask) | ((y << z) & mask)


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("bitCount", _BOTH, "How many bits are 1.",
        es=310, fold=lambda x: (x & _MOST).bit_count(), range=within(0.0, 32.0),
        texts={
            "glsl": "", "tsl": "", "hlsl": "{type}(countbits(asuint({0})))", "hlsl/genU": "{type}(countbits({0}))", "hlsl-dx9": "",
            "wgsl": "countOneBits", "wgsl/genU": "{type}(countOneBits({0}))",
            "wgsl-metal": "popcount", "wgsl-metal/genU": "{type}(popcount({0}))",
        },
        polyfill=_of_both("""
genI bitCount(FROM x) {
    genU bits = BITS;
    bits -= (bits >> 1u) & 0x55555555u;
    bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
    bits = (bits + (bits >> 4u)) & 0x0f0f0f0fu;
    return genI((bits * 0x01010101u) >> 24u);
}
"""),
        cost=10, vectors=(((7,), 3), ((0,), 0), ((-1,), 32), ((0x80000001,), 2), (((5, -2),), (2, 31))),
    ),
    Builtin("findLSB", _BOTH, "The number of the lowest bit that is 1; of 0, -1.",
        es=310, fold=lambda x: (x & -x).bit_length() - 1, range=within(-1.0, 31.0),
        texts={
            "glsl": "", "tsl": "", "hlsl": "{type}(firstbitlow({0}))", "hlsl-dx9": "",
            "wgsl": "firstTrailingBit", "wgsl/genU": "{type}(firstTrailingBit({0}))", "wgsl-metal": "",
        },
        polyfill=_of_both("""
genI findLSB(FROM x) {
    genU bits = BITS;
    genI count = bitCount(~bits & (bits - 1u));
    return count | -(count >> 5u);
}
"""),
        cost=14, vectors=(((12,), 2), ((0,), -1), ((-2147483648,), 31), ((0x80000000,), 31), (((1, 6),), (0, 1))),
    ),
    Builtin("findMSB", _BOTH,
        "The number of the highest bit that is 1, of a negative int that is 0; where there is none, -1.",
        es=310, fold=lambda x: (x if x >= 0 else ~x).bit_length() - 1, range=within(-1.0, 31.0),
        texts={
            "glsl": "", "tsl": "", "hlsl": "", "hlsl/genU": "{type}(firstbithigh({0}))", "hlsl-dx9": "",  # DXC takes an int for a uint
            "wgsl": "firstLeadingBit", "wgsl/genU": "{type}(firstLeadingBit({0}))", "wgsl-metal": "",
        },
        polyfill=_of_both("""
genI findMSB(FROM x) {
    genU bits = BITS;
    bits |= bits >> 1u;
    bits |= bits >> 2u;
    bits |= bits >> 4u;
    bits |= bits >> 8u;
    bits |= bits >> 16u;
    return bitCount(bits) - 1;
}
""").replace("genU(x)", "genU(x ^ (x >> 31u))"),
        cost=20, vectors=(((12,), 3), ((0,), -1), ((-1,), -1), ((-9,), 3), ((0x80000000,), 31), (((1, 6),), (0, 2))),
    ),
    Builtin("bitfieldReverse", ("genI(genI)", "genU(genU)"), "The bits in the opposite order.",
        es=310, fold=lambda x: int(f"{x & _MOST:032b}"[::-1], 2), range=any_number,
        texts={
            "glsl": "", "tsl": "", "hlsl": "asint(reversebits(asuint({0})))", "hlsl/genU": "reversebits", "hlsl-dx9": "",
            "wgsl": "reverseBits", "wgsl-metal": "reverse_bits",
        },
        polyfill="".join(f"""
gen{kind} bitfieldReverse(gen{kind} x) {{
    genU bits = genU(x);
    bits = ((bits >> 1u) & 0x55555555u) | ((bits & 0x55555555u) << 1u);
    bits = ((bits >> 2u) & 0x33333333u) | ((bits & 0x33333333u) << 2u);
    bits = ((bits >> 4u) & 0x0f0f0f0fu) | ((bits & 0x0f0f0f0fu) << 4u);
    bits = ((bits >> 8u) & 0x00ff00ffu) | ((bits & 0x00ff00ffu) << 8u);
    return gen{kind}((bits >> 16u) | (bits << 16u));
}}
""" for kind in "IU"),
        cost=23,
        vectors=(((1,), -2147483648), ((-1,), -1), ((0x80000000,), 1), ((0,), 0), (((6, 2),), (0x60000000, 0x40000000))),
    ),
    Builtin("bitfieldExtract", ("genI(genI, int, int)", "genU(genU, int, int)"),
        "The z bits of x from bit y on, in the low bits; of an int, with the sign of the highest of them.",
        es=310, fold=_extracted_sign, fold_uint=_extracted,
        not_constant=("wgsl",), samples=Samples(integers={1: (0, 32), 2: (0, 32)}), range=any_number,
        defined=lambda rt, x, y, z: (y >= 0) & (z >= 0) & (y <= 32) & (z <= 32) & (y + z <= 32), domain=_FIELD,
        texts={"glsl": "", "tsl": "", "hlsl": "", "wgsl": "extractBits({0}, u32({1}), u32({2}))", "wgsl-metal": ""},
        polyfill="""
genI bitfieldExtract(genI x, int y, int z) {
    return z == 0 ? genI(0) : (x << (uint(32 - y - z) & 31u)) >> (uint(32 - z) & 31u);
}
genU bitfieldExtract(genU x, int y, int z) {
    return z == 0 ? genU(0u) : (x << (uint(32 - y - z) & 31u)) >> (uint(32 - z) & 31u);
}
""",
        splat=(), cost=3, vectors=(
            ((0xABC, 4, 5), 11), ((-1, 3, 0), 0), ((0xF0000000, 28, 4), 15), ((-5, 0, 32), -5), ((14, 1, 3), -1),
            (((255, 15), 2, 3), (-1, 3)),
        ),
    ),
    Builtin("bitfieldInsert", ("genI(genI, genI, int, int)", "genU(genU, genU, int, int)"),
        "x with its w bits from bit z on replaced by the low ones of y.",
        es=310, not_constant=("wgsl",), fold=_inserted,
        samples=Samples(integers={2: (0, 32), 3: (0, 32)}), range=any_number,
        defined=lambda rt, x, y, z, w: (z >= 0) & (w >= 0) & (z <= 32) & (w <= 32) & (z + w <= 32), domain="z >= 0, w >= 0, and z + w <= 32",
        texts={"glsl": "", "tsl": "", "hlsl": "", "wgsl": "insertBits({0}, {1}, u32({2}), u32({3}))", "wgsl-metal": ""},
        polyfill="".join(f"""
gen{kind} bitfieldInsert(gen{kind} x, gen{kind} y, int z, int w) {{
    gen{kind} mask = gen{kind}((w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u));
    return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
}}
""" for kind in "IU"),
        splat=(), cost=7, vectors=(
            ((0, 7, 4, 2), 48), ((-1, 0, 0, 32), 0), ((5, 9, 32, 0), 5), ((0xFFFFFFFF, 0, 8, 8), 0xFFFF00FF),
            (((1, 2), (3, 0), 1, 1), (3, 0)),
        ),
    ),
)
