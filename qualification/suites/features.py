"""What shaders of outside suites use and WGSL has no words for: cases with it are skipped."""

from __future__ import annotations

import re
from typing import NamedTuple

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


class Feature(NamedTuple):
    """A feature of some GLSL that no other target can express."""

    words: re.Pattern[str]
    """What a text with it contains"""
    why: str


def _feature(words: str, why: str) -> Feature:
    return Feature(re.compile(words), why)


_EXTENSION = r"#\s*extension\s+GL_(?:ARB|EXT|KHR|NV|AMD|ARM|INTEL|QCOM|HUAWEI|OES|OVR|GOOGLE)_"
FEATURES = (
    _feature(
        r"\bd(?:ouble|vec[234]|mat[234])\b|\b[ui]?(?:int|float)(?:8|16|64)|\b[ui]?(?:8|16|64)vec|\bf(?:8|16|64)"
        r"|explicit_arithmetic_types|gpu_shader_(?:int64|fp64|half_float|int16)|_float_[eum]|bfloat16|long_vector|\d(?:lf|LF|ul|UL|hf|HF|s)\b",
        "numbers of 8, 16 or 64 bits",
    ),
    _feature(r"\bsubgroup|gl_Sub[gG]roup|shader_(?:group_vote|ballot)|subgroup", "operations of subgroups"),
    _feature(r"ray_query|rayQuery|ray_tracing|accelerationStructure", "rays"),
    _feature(r"buffer_reference", "references to buffers"),
    _feature(r"cooperative_|ARM_tensors|\btensorARM", "matrices and tensors of workgroups"),
    _feature(r"subpassInput|attachmentEXT|tile_image|tile_shading|fragment_mask", "reads of attachments"),
    _feature(
        rf"{_EXTENSION}(?:fragment_shader_interlock|shader_stencil_export|post_depth_coverage|spirv_intrinsics"
        r"|nonuniform_qualifier|descriptor_heap|structured_descriptor_heap|device_group|sparse_texture|mesh_shader"
        r"|fragment_shading_rate|fragment_shader_barycentric|shader_trinary_minmax|image_processing|shader_clock"
        r"|shader_realtime_clock|conservative_raster|explicit_vertex_parameter|gcn_shader|quad_control"
        r"|shader_quad_control|viewport_layer_array|shader_viewport_layer_array|split_barrier|shared_memory_block"
        r"|expect_assume|debug_printf|memory_scope_semantics|EGL_image_external|sm_builtins|invocation_density"
        r"|fragment_invocation_density|gpu_shader5|compute_shader_derivatives|texture_gather_bias_lod|viewport_array2"
        r"|shader_atomic_float|shader_image_int64|cluster_acceleration|multiview\b|texture_rectangle|shader_fragment_mask"
        r"|opacity_micromap|primitive_restart|abort|demote_to_helper)",
        "extensions of Vulkan and OpenGL",
    ),
    _feature(
        r"#\s*include\b[^\n]*hlsl|\[\[spv|\bspirv_|\bSamplerState\b|\bcbuffer\b|\bfloat4\b", "text of another language"
    ),
    _feature(
        r"\b[ui]?(?:sampler|texture|image)(?:2DRect\w*|Buffer|2DMSArray|CubeArrayShadow)\b"
        r"|\b[ui]?image(?:1DArray|Cube\w*|2DMS)\b",
        "textures that WebGPU lacks",
    ),
    _feature(r"\batomic_uint\b", "counters apart from memory"),
    _feature(r"\bimageAtomic\w*", "atomics on pixels"),
    _feature(
        r"\bgl_(?:ClipDistance|CullDistance|PointCoord|Layer|ViewportIndex|PrimitiveID|ViewIndex|SamplePosition|NumSamples"
        r"|HelperInvocation|FragStencilRef\w*|in|out|PatchVerticesIn|DeviceIndex|BaryCoord\w*|PointSize|PositionPerViewNV"
        r"|ViewportMask\w*|SecondaryPosition\w*|DepthRangeParameters|ClipVertex|TexCoord|FrontColor|BackColor|Color"
        r"|SecondaryColor|FogFragCoord|FrontSecondaryColor|Vertex|Normal|MultiTexCoord\d|ModelView\w*|Projection\w*"
        r"|TextureMatrix\w*|NormalMatrix|LightSource|FrontMaterial|BackMaterial|Fog|Point|LightModel)\b",
        "builtins of a fixed pipeline",
    ),
    _feature(
        r"\binterpolateAt\w+|\btextureQueryLOD\b|\bsparse\w+ARB|\bgl_FragColor\b.*\bindex\b",
        "reads that WGSL lacks",
    ),
    _feature(r"layout\s*\([^)]*\b(?:index|xfb_\w+|stream|component)\s*=", "places within a location"),
    _feature(r"\bsubroutine\b", "functions that a program chooses"),
    _feature(r"\bpatch\s+(?:in|out)\b|\bperprimitive\w+|\bpervertex\w*", "values of patches and primitives"),
)
"""The first that a text has is the reason."""


def unsayable(text: str) -> str:
    """Why no text of WGSL says the same; '' where one may."""
    code = _COMMENT.sub(" ", text)
    return next((feature.why for feature in FEATURES if feature.words.search(code)), "")
