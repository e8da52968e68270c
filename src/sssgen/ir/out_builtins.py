"""Builtins that are written as functions of the language: with out parameters, or of old GLSL.

A builtin of the intrinsic table returns one value and has no out parameters. The front end adds one of these functions
to the module at the file's first call, and every pass and target treats it like the file's own functions. The shadow
reads of old GLSL returned a vec4.

    out_builtin("modf", [VEC3, VEC3])    # the text of vec3 modf(vec3 x, out vec3 whole)

The texts are generic as the table's signatures are (`genF`: float, vec2, vec3, vec4 alike). What GLSL leaves undefined:
the results of `modf` and `frexp` for infinity and NaN. `frexp` treats a subnormal number as 0, as GPUs do.
Source: chapters 8.3 and 8.8 of the GLSL 4.60 specification, and 8.7 of GLSL 1.20.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence

from sssgen.ir.signatures import instantiate
from sssgen.ir.types import Type, components, spell

OUT_BUILTINS: dict[str, str] = {
    "modf": """
genF modf(genF x, out genF whole) {
    whole = trunc(x);
    return x - whole;
}
""",
    "frexp": """
genF frexp(genF x, out genI exponent) {
    genU bits = floatBitsToUint(x);
    genI biased = genI((bits >> 23u) & 0xffu);
    genI normal = min(biased, 1);
    exponent = (biased - 126) * normal;
    return uintBitsToFloat((bits & 0x80000000u) | (((bits & 0x007fffffu) | 0x3f000000u) * genU(normal)));
}
""",
    "uaddCarry": """
genU uaddCarry(genU x, genU y, out genU carry) {
    genU sum = x + y;
    carry = ((x & y) | ((x | y) & ~sum)) >> 31u;
    return sum;
}
""",
    "usubBorrow": """
genU usubBorrow(genU x, genU y, out genU borrow) {
    genU difference = x - y;
    borrow = ((~x & y) | ((~x | y) & difference)) >> 31u;
    return difference;
}
""",
    "umulExtended": """
void umulExtended(genU x, genU y, out genU msb, out genU lsb) {
    genU low = (x & 0xffffu) * (y & 0xffffu);
    genU middle = (x >> 16u) * (y & 0xffffu) + (low >> 16u);
    genU other = (x & 0xffffu) * (y >> 16u) + (middle & 0xffffu);
    msb = (x >> 16u) * (y >> 16u) + (middle >> 16u) + (other >> 16u);
    lsb = x * y;
}
""",
    # the product of the same bits as uints, minus 2^32 times one factor if the other is negative
    "imulExtended": """
void imulExtended(genI x, genI y, out genI msb, out genI lsb) {
    genU a = genU(x);
    genU b = genU(y);
    genU low = (a & 0xffffu) * (b & 0xffffu);
    genU middle = (a >> 16u) * (b & 0xffffu) + (low >> 16u);
    genU other = (a & 0xffffu) * (b >> 16u) + (middle & 0xffffu);
    genU high = (a >> 16u) * (b >> 16u) + (middle >> 16u) + (other >> 16u);
    msb = genI(high) - ((x >> 31u) & y) - ((y >> 31u) & x);
    lsb = x * y;
}
""",
    # the result as a grey, as in GLSL 1.20
    "shadow2D": """
vec4 shadow2D(sampler2DShadow map, vec3 P) { return vec4(vec3(texture(map, P)), 1.0); }
""",
    "shadow2DLod": """
vec4 shadow2DLod(sampler2DShadow map, vec3 P, float level) { return vec4(vec3(textureLod(map, P, level)), 1.0); }
""",
    "shadow2DProj": """
vec4 shadow2DProj(sampler2DShadow map, vec4 P) { return vec4(vec3(texture(map, P.xyz / P.w)), 1.0); }
""",
}
"""Name → its definitions; each ends with the first brace at the end of a line."""

ES_VERSIONS = {"modf": 300} | dict.fromkeys(("frexp", "uaddCarry", "usubBorrow", "umulExtended", "imulExtended"), 310)
"""Name → the first version of GLSL ES that has it; none has the others."""

_GENERIC = re.compile(r"\bgen[FIUB]\b")
_DEFINITION = re.compile(r"^\w.*?\}$", re.MULTILINE | re.DOTALL)


def is_out_builtin(name: str) -> bool:
    """Whether there is such a function, for any types."""
    return name in OUT_BUILTINS


def out_positions(name: str) -> set[int]:
    """The positions of the out parameters of the function `name`; empty for other names."""
    if name not in OUT_BUILTINS:
        return set()
    definition = _DEFINITION.findall(OUT_BUILTINS[name])[0]
    return {index for index, param in enumerate(_listed(definition)) if param.split()[0:1] == ["out"]}


def out_builtin(name: str, types: Sequence[Type]) -> str | None:
    """The text of the function `name` for arguments of exactly these types, or None."""
    return _definition_text(name, tuple(types))


@functools.cache
def _definition_text(name: str, types: tuple[Type, ...]) -> str | None:
    size = max([components(type_) for type_ in types], default=0)
    if size > 4:
        return None

    def sized(match: re.Match[str]) -> str:
        type_ = instantiate(match.group(), size)
        assert type_ is not None
        return spell(type_)

    for source in _DEFINITION.findall(OUT_BUILTINS.get(name, "")):
        text = _GENERIC.sub(sized, source)
        if _parameters(text) == [spell(type_) for type_ in types]:
            return text + "\n"
    return None


def _parameters(definition: str) -> list[str]:
    """The types of a definition's parameters, as spelled in it."""
    return [param.split()[-2] for param in _listed(definition)]


def _listed(definition: str) -> list[str]:
    return definition[definition.index("(") + 1 : definition.index(")")].split(",")
