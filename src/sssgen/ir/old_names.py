"""Names of functions in older versions and extensions of GLSL, and their present names.

    new_name("texture2D", 3)         # "texture": the third argument is the bias in both
    new_name("texture2DLodEXT", 3)   # "textureLod"
    new_name("mix", 3)               # None

The arguments are the same, in the same order. The new name is that of a builtin of the intrinsic table or of one of
`ir.out_builtins`. The shadow reads of GLSL 1.20, which returned a vec4, are
functions there under their old names.
Source: chapter 8.7 of GLSL 1.20 and of GLSL ES 1.00; GL_ARB_shader_texture_lod, GL_EXT_shader_texture_lod,
GL_EXT_gpu_shader4, GL_EXT_shadow_samplers.
"""

from __future__ import annotations

_RENAMED = (
    ("texture1D texture2D texture3D textureCube texture1DArray texture2DArray", "texture", (2, 3)),
    (
        "texture1DLod texture2DLod texture3DLod textureCubeLod texture1DArrayLod texture2DArrayLod texture2DLodEXT "
        "texture3DLodEXT textureCubeLodEXT",
        "textureLod",
        (3,),
    ),
    (
        "texture1DGrad texture2DGrad texture3DGrad textureCubeGrad texture2DArrayGrad "
        "texture1DGradARB texture2DGradARB texture3DGradARB textureCubeGradARB "
        "texture2DGradEXT texture3DGradEXT textureCubeGradEXT",
        "textureGrad",
        (4,),
    ),
    ("texture1DProj texture2DProj texture3DProj", "textureProj", (2, 3)),
    (
        "texture1DProjLod texture2DProjLod texture3DProjLod texture2DProjLodEXT texture3DProjLodEXT",
        "textureProjLod",
        (3,),
    ),
    (
        "texture2DProjGrad texture3DProjGrad texture2DProjGradARB texture3DProjGradARB texture2DProjGradEXT "
        "texture3DProjGradEXT",
        "textureProjGrad",
        (4,),
    ),
    ("texelFetch1D texelFetch2D texelFetch3D texelFetch1DArray texelFetch2DArray", "texelFetch", (3,)),
    ("shadow2DEXT", "texture", (2,)),
    ("shadow2DProjEXT", "textureProj", (2,)),
    (
        "textureSize1D textureSize2D textureSize3D textureSizeCube textureSize1DArray textureSize2DArray",
        "textureSize",
        (2,),
    ),
)
"""Old names, the new name, the possible numbers of arguments."""

OLD_NAMES: dict[str, tuple[str, tuple[int, ...]]] = {
    old: (new, counts) for names, new, counts in _RENAMED for old in names.split()
}
"""Old name → the new name, and the possible numbers of arguments."""


def new_name(name: str, count: int) -> str | None:
    """The new name of an old function with this many arguments; None if there is no such old function."""
    new, counts = OLD_NAMES.get(name, ("", ()))
    return new if count in counts else None
