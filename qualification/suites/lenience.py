"""The classes of programs that drivers refuse and sssgen accepts, each with its reason."""

from __future__ import annotations

import re
from typing import NamedTuple


class Lenience(NamedTuple):
    """A class."""

    cases: str
    """A regular expression for the names of its cases"""
    why: str


OTHER = "other"
LENIENCE = {
    "precision": Lenience(
        r"precision_conflict|unspecified_precision|differing_precision|default-precision|precision-mismatch"
        r"|without-precision|block-precision",
        "no other language has precisions: they are left out, so that those of two stages need not agree",
    ),
    "interpolation": Lenience(
        r"interpolation_mismatch",
        "the fragment shader decides on the interpolation, as in GLSL from 4.40 on",
    ),
    "Vulkan and OpenGL": Lenience(
        r"glslang/(nonVulkan|spv\.|vk\.|glspv)", "a text may have what OpenGL's GLSL and what Vulkan's has"
    ),
    "invariance": Lenience(
        r"[Ii]nvarian", "no other language has it: `invariant` is left out, so that two stages need not agree"
    ),
    "rules of WebGL": Lenience(
        r"webgl\w*[-_](identifier|field|function|struct|variable)|-(257|1025)-character|essl3-shaders-with-webgl1"
        r"|struct-nesting-exceeds|forbidden-operators|ternary-operator-on-arrays|uniform-block-layouts",
        "GLSL has no such rule: names that begin with webgl_ and long names, structs in structs, operators of arrays "
        "and void, layouts of blocks, GLSL ES 3.00 in WebGL 1",
    ),
    "limits of GLSL ES 1.00": Lenience(
        r"arbitrary-indexing|-(do|while)-loop|uniform-in-loop-condition|global-variable-init|-dfdx|-frag-depth",
        "what drivers of GLSL ES 1.00 need not have: loops that do not count, indices that vary, values at file scope "
        "that are not constant, what an extension adds",
    ),
    OTHER: Lenience("", "no reason: to be refused"),
}
"""Name → class; the last one has all other cases."""


def class_of(case: str) -> str:
    """The class of a case by its name."""
    return next(name for name, lenience in LENIENCE.items() if re.search(lenience.cases, case))
