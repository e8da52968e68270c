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
        r"block-precision|uniform-precision-unused",
        "no other language has precisions: those of the members of blocks, and of uniforms that one of the stages does "
        "not use, need not agree",
    ),
    "interpolation": Lenience(
        r"interpolation_mismatch|centroid-mismatched",
        "the fragment shader decides on the interpolation, as in GLSL from 4.40 on",
    ),
    "attributes": Lenience(
        r"functionControlAttributes", "what stands between [[ and ]] is advice to a compiler and is left out unread"
    ),
    "Vulkan and OpenGL": Lenience(
        r"glslang/(nonVulkan|spv\.|vk\.|glspv|glsl\.\d+\.layoutOffset)",
        "a text may have what OpenGL's GLSL and what Vulkan's has, such as offsets of members in old versions",
    ),
    "invariance": Lenience(
        r"[Ii]nvarian", "no other language has it: `invariant` is left out, so that two stages need not agree"
    ),
    "rules of WebGL": Lenience(
        r"webgl\w*[-_](identifier|field|function|struct|variable)|-(257|1025)-character|essl3-shaders-with-webgl1"
        r"|functional-scoping|struct-nesting-exceeds|forbidden-operators|ternary-operator-on-arrays|uniform-block-layouts",
        "GLSL has no such rule: names that begin with webgl_ and long names, structs in structs, operators of arrays "
        "and void, layouts of blocks, GLSL ES 3.00 in WebGL 1. A variable of "
        "GLSL ES 1.00 may hide a parameter in drivers, and in VK-GL-CTS",
    ),
    "limits of GLSL ES 1.00": Lenience(
        r"arbitrary-indexing|-(do|while)-loop|uniform-in-loop-condition|global-variable-init|-dfdx|-frag-depth",
        "what drivers of GLSL ES 1.00 need not have: loops that do not count, indices that vary, values at file scope "
        "that are not constant, what an extension adds",
    ),
    "above #version": Lenience(
        r"misplaced-version-directive|versionsClean|version2_V100",
        "build tools leave comments, blank lines and pragmas there, and the translation has its own #version",
    ),
    "versions of stages": Lenience(
        r"shader-linking\.html#(ES3VertexShader,ESSL1|ESSL1VertexShader,ES3)",
        "both stages become texts of one version",
    ),
    "later and earlier GLSL": Lenience(
        r"gl33/arrays\.invalid\.multidimensional|gl42-compat/\w+\.\w+\.core_",
        "a desktop text may have what another version of desktop GLSL has, as many drivers allow: arrays of arrays, "
        "gl_FragColor, varying",
    ),
    "macros": Lenience(
        r"glslang/(badMacroArgs|cppBad[23])\.",
        "an empty argument is an argument, as in C; an argument whose macro would end behind it counts if it is used",
    ),
    "parts of shaders": Lenience(
        r"glslang/noMain\.|no_local_work_size|mix_compute_and_non_compute",
        "a file is translated that has only functions, and a compute shader whose workgroup has one invocation",
    ),
    "unused and unlike": Lenience(
        r"different-offset-across|different-bindings|uniform-type-mismatch|member-count-mismatch|name-mismatch"
        r"|storage.block\.mismatch_block_array_size|storage-block-different-size",
        "uniforms, blocks and members that no code of a stage reads are left out; bindings and offsets are the "
        "translation's own, by names; each element of an array of storage blocks is a buffer of its own",
    ),
    OTHER: Lenience("", "no reason: to be refused"),
}
"""Name → class; the last one has all other cases."""


def class_of(case: str) -> str:
    """The class of a case by its name."""
    return next(name for name, lenience in LENIENCE.items() if re.search(lenience.cases, case))
