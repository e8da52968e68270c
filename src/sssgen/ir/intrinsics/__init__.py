"""The intrinsic table: everything the project knows about each builtin function, in one place.

From it come the checker's overloads, the printers' text, the polyfills, the static cost, the documentation
(`docs/intrinsics.md`), and an executed test of every builtin on every target. It holds the functions of chapter 8 of
the GLSL specifications, from ES 1.00 to 4.60, and some of our own: `saturate`, the truncated remainder `fmod`,
`unpackNormal`, and reads of textures with the layer or the reference apart. Each chapter has a file. Builtins with out
parameters and projective reads are functions, in `ir.out_builtins`; old names stand in `ir.old_names`.

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
  method), `{dim}` its dimension (2D, 3D, CUBE), `{channel}` the colour that the last argument numbers, if it is a literal
  int, else Red, and `{type}` the result's type as the target spells it; arguments stand only where a call's argument could;
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

from sssgen.ir.intrinsics import (
    common,
    derivatives,
    exponential,
    integers,
    matrices,
    packing,
    relations,
    textures,
    trigonometry,
)
from sssgen.ir.intrinsics import (
    geometric as geometry,
)
from sssgen.ir.intrinsics.table import FINITE, NONZERO, Builtin, Guard, Level, Samples, with_constants

__all__ = ["BUILTINS", "FINITE", "NONZERO", "Builtin", "Guard", "Level", "Samples", "with_constants"]

CHAPTERS = (
    trigonometry, exponential, common, packing, geometry, matrices, relations, integers, textures, derivatives,
)  # fmt: skip

BUILTINS: dict[str, Builtin] = {row.name: row for chapter in CHAPTERS for row in chapter.ROWS}
"""All rows by their names, chapter by chapter."""
