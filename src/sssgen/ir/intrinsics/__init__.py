"""The intrinsic table: everything that the project knows about each builtin function, in one row.

It has the overloads, the text in each language, polyfills, value ranges and guards, constant folding, quantities, the
static cost, and accuracy; `docs/intrinsics.md` is generated from it, and every row is executed on every target in tests.
A new builtin needs one row, and one function in `targets/numpy_runtime.py`. The table has the functions of chapter 8 of
the GLSL specifications, from ES 1.00 to 4.60, and others: `saturate`, the truncated remainder `fmod`, `unpackNormal`,
and reads of textures with the layer or the reference as a separate argument. Each chapter has a file. Builtins with out
parameters and projective reads are functions, in `ir.out_builtins`; old names are in `ir.old_names`.

Signatures are written as in that specification: `genF` stands for float, vec2, vec3 and vec4 alike (one size throughout
a signature), `vecF` for the vectors alone; likewise genI, genU, genB, vecI, vecU, vecB; `mat` for mat2, mat3 and mat4;
`matCR` for all matrices, of C columns and R rows, with `vecR` for its columns and `vecC` for its rows.
`ir.signatures` reads them.

`texts` maps a language to the text of the builtin in it. A language without a text uses the builtin's own name. A key
may name one signature by its parameters, as in `"hlsl/genF,genF"`; it has precedence over the language's own.
A value is one of
- a name: `"lerp"` is called with the same arguments;
- `"op:<"`: the binary (two arguments) or unary (one argument) operator;
- a pattern: `"{texture}.Sample({sampler}, {1})"`, where `{0}`, `{1}`… are arguments, `{texture}` and `{sampler}` the two
  parts of argument 0 (`{bare_texture}` and `{bare_sampler}` where an engine wraps them into structs that lack the
  method), `{dim}` its dimension (2D, 3D, CUBE), `{channel}` the colour whose number is the last argument, if it is a
  literal int, otherwise Red, and `{type}` the result's type as spelled in the target; arguments are only in places where
  a call's argument could be;
- `""`: the language has no such builtin and uses `polyfill`; without a polyfill the builtin is refused there.
The dialects `hlsl-dx9` (Unity's built-in pipeline), `hlsl-macros` (Unity's SRP) and `hlsl-unreal` fall back to `hlsl`, and
`glsl-330`, which lacks some functions of ES 3.00, to `glsl`. The NumPy function has the builtin's own name (`not_` for `not`).

`polyfill` is source in the project's own language, generic like the signatures; the front end instantiates it for the
types of a call, and it is inlined if it is one expression. It has one function for each signature that some language
lacks.

The arguments of test vectors are exact in float32; their results are correctly rounded to float64. Where a `clause`
grants more than 4 ulp, WGSL means its section "Accuracy of Concrete Floating Point Expressions", Vulkan its appendix
"Precision and Operation of SPIR-V Instructions", and D3D the Direct3D 11.3 functional specification.
"""

from __future__ import annotations

from sssgen.ir.intrinsics import (
    common,
    derivatives,
    exponential,
    integers,
    matrices,
    packing,
    relations,
    texture_parts,
    textures,
    trigonometry,
)
from sssgen.ir.intrinsics import (
    geometric as geometry,
)
from sssgen.ir.intrinsics.table import (
    FINITE,
    KINDS,
    NONZERO,
    Builtin,
    Guard,
    Kind,
    Level,
    Samples,
    by_column,
    with_constants,
)

__all__ = [
    "BUILTINS", "FINITE", "KINDS", "NONZERO", "Builtin", "Guard", "Kind", "Level", "Samples", "by_column", "with_constants",
]  # fmt: skip

CHAPTERS = (
    trigonometry, exponential, common, packing, geometry, matrices, relations, integers, textures, texture_parts,
    derivatives,
)  # fmt: skip

BUILTINS: dict[str, Builtin] = {row.name: row for chapter in CHAPTERS for row in chapter.ROWS}
"""All rows by their names, chapter by chapter."""
