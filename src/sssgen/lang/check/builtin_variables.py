"""The variables and constants of GLSL whose names begin with gl_."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    VEC2,
    VEC4,
    Array,
    Field,
    Struct,
    Type,
    Vector,
    passed_locations,
    vector_of,
)
from sssgen.lang.check.context import CheckContext
from sssgen.lang.check.name_scope import GlobalValue
from sssgen.lang.syntax import tree as s

BUILTIN_VARIABLES: dict[str, tuple[Type, str]] = {
    "gl_FragCoord": (VEC4, "in"),
    "gl_FrontFacing": (BOOL, "in"),
    "gl_PointCoord": (VEC2, "in"),
    "gl_SampleID": (INT, "in"),
    "gl_SamplePosition": (VEC2, "in"),
    "gl_SampleMaskIn": (Array(INT, 1), "in"),
    "gl_SampleMask": (Array(INT, 1), "out"),
    "gl_VertexID": (INT, "in"),
    "gl_VertexIndex": (INT, "in"),
    "gl_InstanceID": (INT, "in"),
    "gl_InstanceIndex": (INT, "in"),
    "gl_Position": (VEC4, "out"),
    "gl_PointSize": (FLOAT, "out"),
    "gl_FragDepth": (FLOAT, "out"),
    "gl_FragDepthEXT": (FLOAT, "out"),
    "gl_FragColor": (VEC4, "out"),
    "gl_FragData": (Array(VEC4, 8), "out"),
    "gl_GlobalInvocationID": (Vector("uint", 3), "in"),
    "gl_LocalInvocationID": (Vector("uint", 3), "in"),
    "gl_WorkGroupID": (Vector("uint", 3), "in"),
    "gl_NumWorkGroups": (Vector("uint", 3), "in"),
    "gl_LocalInvocationIndex": (UINT, "in"),
}
"""The variables that have a counterpart in other languages: type, and whether a stage reads or writes them."""

INVOCATION = {
    name for name in BUILTIN_VARIABLES if name.startswith(("gl_Global", "gl_Local", "gl_WorkGroup", "gl_Num"))
}
"""Those that compute shaders alone have."""

DRAW_UNIFORMS: dict[str, Type] = {
    "gl_ViewID_OVR": UINT, "gl_DrawID": INT, "gl_BaseVertex": INT, "gl_BaseInstance": INT,
    "gl_DrawIDARB": INT, "gl_BaseVertexARB": INT, "gl_BaseInstanceARB": INT,
}  # fmt: skip
"""The variables that are the same in a whole draw call (OVR_multiview2, ANGLE_multi_draw) and that WebGPU and D3D lack.
They become uniforms, which a loop over views or draws sets."""

_DEPTH_RANGE = Struct("gl_DepthRangeParameters", tuple([Field(name, FLOAT, "") for name in ("near", "far", "diff")]))
"""The type of gl_DepthRange, which becomes a uniform: WebGPU and D3D have it in the viewport alone."""

_SAME = {"gl_FragDepthEXT": "gl_FragDepth", "gl_VertexIndex": "gl_VertexID", "gl_InstanceIndex": "gl_InstanceID"}

_LIMITS = {
    "gl_MaxDrawBuffers": 8, "gl_MaxTextureImageUnits": 16, "gl_MaxVertexAttribs": 16, "gl_MaxVertexUniformVectors": 256,
    "gl_MaxFragmentUniformVectors": 256, "gl_MaxVaryingVectors": 15, "gl_MaxCombinedTextureImageUnits": 32,
    "gl_MaxVertexTextureImageUnits": 16, "gl_MaxVertexOutputVectors": 15, "gl_MaxFragmentInputVectors": 15,
    "gl_MinProgramTexelOffset": -8, "gl_MaxProgramTexelOffset": 7, "gl_MaxSamples": 4, "gl_MaxImageUnits": 8,
    "gl_MaxVertexImageUniforms": 0, "gl_MaxFragmentImageUniforms": 4, "gl_MaxComputeImageUniforms": 4,
    "gl_MaxComputeTextureImageUnits": 16, "gl_MaxComputeUniformComponents": 1024,
    "gl_MaxComputeWorkGroupCount": (65535, 65535, 65535), "gl_MaxComputeWorkGroupSize": (256, 256, 64),
    # desktop GLSL alone
    "gl_MaxVertexUniformComponents": 1024, "gl_MaxFragmentUniformComponents": 1024, "gl_MaxVaryingComponents": 60,
    "gl_MaxVaryingFloats": 60, "gl_MaxVertexOutputComponents": 60, "gl_MaxFragmentInputComponents": 60,
    "gl_MaxClipDistances": 8, "gl_MaxClipPlanes": 6, "gl_MaxLights": 8, "gl_MaxTextureUnits": 2,
    "gl_MaxTextureCoords": 8,
}  # fmt: skip
"""GLSL's implementation limits, with the values that WebGPU guarantees, and those of the fixed pipeline, with the least
that GLSL allows."""


_FRAGMENT = {
    name for name in BUILTIN_VARIABLES if name.startswith(("gl_Frag", "gl_FrontFacing", "gl_PointCoord", "gl_Sample"))
}
"""Those that fragment shaders alone have."""


_SAMPLES = ("GL_OES_sample_variables", "GL_ANDROID_extension_pack_es31a")
"""The extensions that have gl_SampleID and its kin."""


def check_stage(context: CheckContext, name: s.Name) -> None:
    """Reports a variable that a vertex shader of GLSL ES, or the version, does not have."""
    text, language = name.text, context.language
    if context.es and language.vertex and text in _FRAGMENT:
        raise context.fail(name.span, f"'{text}' belongs to fragment shaders", "write it in the other stage")
    if text.startswith("gl_Sample") and 0 < context.es < 320 and language.extensions.isdisjoint(_SAMPLES):
        hint = "write #version 320 es, or #extension GL_OES_sample_variables : require"
        raise context.fail(name.span, f"{text} needs GLSL ES 3.20", hint)


def check_colors(context: CheckContext) -> None:
    """Reports colours of GLSL ES that have no place of their own.

    A shader writes gl_FragColor or gl_FragData; several outputs have locations, from 3.00 on (section 4.3.8.2).
    """
    colors = [context.variables[name] for name in ("gl_FragColor", "gl_FragData") if name in context.variables]
    if context.es and len(colors) > 1:
        last = max(colors, key=lambda variable: variable.span[1:3])
        message = "a shader of GLSL ES has either gl_FragColor or gl_FragData"
        context.reporter.error(last.span, message, "write gl_FragData[0] for gl_FragColor")
    is_es = context.es >= 300
    if not is_es and not context.language.desktop:
        return
    if is_es and (context.language.vertex or any("blend_func" in name for name in context.language.extensions)):
        return
    taken: set[int] = set()
    outputs = [each for each in context.variables.values() if each.storage == "out" and not each.builtin]
    for variable in outputs if len(outputs) > 1 else ():
        places = set(range(variable.location, variable.location + passed_locations(variable.type)))
        if variable.name in context.sharing or (variable.location < 0 and not is_es):
            continue  # the linker chooses a location
        if variable.location < 0:
            message = f"'{variable.name}' needs a location, as this shader has several outputs"
            context.reporter.error(variable.span, message, "write layout(location = 0) before it")
        elif places & taken:
            message = f"'{variable.name}' has the location of another output"
            context.reporter.error(variable.span, message, "choose another location")
        taken |= places


def builtin_variable(context: CheckContext, name: s.Name) -> GlobalValue | None:
    """The variable or constant that a gl_ name stands for in plain GLSL. The first use of a variable declares it."""
    text = name.text
    if not context.plain:
        return None
    if text in _LIMITS:
        value = _LIMITS[text]
        numbers = value if isinstance(value, tuple) else (value,)
        limit = context.globals[text] = GlobalValue(vector_of("int", len(numbers)), "", numbers, True)
        return limit
    if text == "gl_WorkGroupSize" and context.workgroup:
        size = context.globals[text] = GlobalValue(Vector("uint", 3), "", context.workgroup, True)
        return size
    if text in DRAW_UNIFORMS:
        uniform = ir.Uniform(text, DRAW_UNIFORMS[text], (0.0,), (), "", "", name.span)
        context.draw_uniforms.append(uniform)
        constant = context.globals[text] = GlobalValue(uniform.type, "")
        message = f"{text} becomes a uniform: set it for each draw call"
        context.reporter.warn(name.span, message)
        return constant
    if text == "gl_DepthRange":
        context.structs[_DEPTH_RANGE.name] = _DEPTH_RANGE
        context.struct_declarations.append(ir.StructDecl(_DEPTH_RANGE, "", name.span))
        context.draw_uniforms.append(ir.Uniform(text, _DEPTH_RANGE, (0.0, 1.0, 1.0), (), "", "", name.span))
        depths = context.globals[text] = GlobalValue(_DEPTH_RANGE, "")
        context.reporter.warn(name.span, "gl_DepthRange becomes a uniform: set its members to the viewport's depths")
        return depths
    if text not in BUILTIN_VARIABLES:
        return None
    check_stage(context, name)
    type_, storage = BUILTIN_VARIABLES[text]
    context.variables[text] = ir.Variable(text, type_, storage, None, _SAME.get(text, text), "", -1, "", name.span)
    value = context.globals[text] = GlobalValue(type_, "", writable=storage == "out")
    return value
