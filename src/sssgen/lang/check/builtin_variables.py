"""The variables and constants of GLSL whose names begin with gl_."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL, FLOAT, INT, UINT, VEC2, VEC4, Array, Field, Struct, Type, Vector
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
    "gl_MaxVertexTextureImageUnits": 16,
}  # fmt: skip
"""GLSL's implementation limits, with the values that WebGPU guarantees."""


def check_colors(context: CheckContext) -> None:
    """Reports the second of gl_FragColor and gl_FragData in GLSL ES: a shader writes one of them."""
    colors = [context.variables[name] for name in ("gl_FragColor", "gl_FragData") if name in context.variables]
    if context.es and len(colors) > 1:
        last = max(colors, key=lambda variable: variable.span[1:3])
        message = "a shader of GLSL ES has either gl_FragColor or gl_FragData"
        context.reporter.error(last.span, message, "write gl_FragData[0] for gl_FragColor")


def builtin_variable(context: CheckContext, name: s.Name) -> GlobalValue | None:
    """The variable or constant that a gl_ name stands for in plain GLSL. The first use of a variable declares it."""
    text = name.text
    if not context.plain:
        return None
    if text in _LIMITS:
        limit = context.globals[text] = GlobalValue(INT, "", (_LIMITS[text],), True)
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
    type_, storage = BUILTIN_VARIABLES[text]
    context.variables[text] = ir.Variable(text, type_, storage, None, _SAME.get(text, text), "", -1, "", name.span)
    value = context.globals[text] = GlobalValue(type_, "", writable=storage == "out")
    return value
