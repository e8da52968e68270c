"""The texts of gathers of layers, cubes and comparing textures in the targets; a part of texts_of_builtins.py.

GLSL 3.30 gathers by reads of the four texels, in a function.
"""

from __future__ import annotations

from typing import NamedTuple

from texts_of_offsets import others

START = """    vec2 size = vec2(textureSize(map, 0){size});
    vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
    vec2 high = low + 1.0 / size;
"""
LAYERS = """vec4 textureGatherLayerOffset({highp}sampler2DArray map, vec2 P, int layer, ivec2 offset) {{
{start}    return vec4(textureLod(map, vec3(vec2(low.x, high.y), float(layer)), 0.0).r,
        textureLod(map, vec3(high, float(layer)), 0.0).r,
        textureLod(map, vec3(vec2(high.x, low.y), float(layer)), 0.0).r,
        textureLod(map, vec3(low, float(layer)), 0.0).r);
}}
"""
CHANNEL = """vec4 textureGatherLayerOffset({highp}sampler2DArray map, vec2 P, int layer, ivec2 offset, int channel) {{
{start}    vec4 a = textureLod(map, vec3(vec2(low.x, high.y), float(layer)), 0.0);
    vec4 b = textureLod(map, vec3(high, float(layer)), 0.0);
    vec4 c = textureLod(map, vec3(vec2(high.x, low.y), float(layer)), 0.0);
    vec4 d = textureLod(map, vec3(low, float(layer)), 0.0);
    return vec4(a[channel], b[channel], c[channel], d[channel]);
}}
"""
SHADE = """vec4 textureGatherOffset_({highp}sampler2DShadow map, vec2 P, float reference, ivec2 offset) {{
{start}    return roundEven(vec4(textureLod(map, vec3(vec2(low.x, high.y), reference), 0.0),
        textureLod(map, vec3(high, reference), 0.0),
        textureLod(map, vec3(vec2(high.x, low.y), reference), 0.0),
        textureLod(map, vec3(low, reference), 0.0)));
}}
"""
SHADES = """vec4 textureGatherLayerOffset({highp}sampler2DArrayShadow map, vec2 P, int layer, float reference,{line}ivec2 offset) {{
{start}    return roundEven(vec4(textureGrad(map, vec4(vec2(low.x, high.y), float(layer), reference), vec2(0.0),
        vec2(0.0)), textureGrad(map, vec4(high, float(layer), reference), vec2(0.0), vec2(0.0)),
        textureGrad(map, vec4(vec2(high.x, low.y), float(layer), reference), vec2(0.0), vec2(0.0)),
        textureGrad(map, vec4(low, float(layer), reference), vec2(0.0), vec2(0.0))));
}}
"""


class Gather(NamedTuple):
    """A call, and what it is in each language."""

    call: str
    hlsl: str
    wgsl: str
    function: str = ""
    """The function by which GLSL gathers; '' where GLSL 3.30 has no such texture or cannot read it so."""
    glsl: str = ""
    """The call of that function."""
    urp: str = ""
    """'' means that Unity has no such texture."""


GATHERS_OF_CHANNELS = (
    Gather("textureGather(cube, x3{argument})", "cube.Gather{name}(cube_sampler, x3)", "textureGather({number}, cube, cube_sampler, x3)",
           urp="cube.Gather{name}(samplercube, x3)"),
    Gather("textureGather(layers, x3{argument})", "layers.Gather{name}(layers_sampler, x3)",
           "textureGather({number}, layers, layers_sampler, x3.xy, i32(round(x3.z)))",
           LAYERS, "textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(0){argument})"),
    Gather("textureGather(cubes, x4{argument})", "cubes.Gather{name}(cubes_sampler, x4)",
           "textureGather({number}, cubes, cubes_sampler, x4.xyz, i32(round(x4.w)))"),
    Gather("textureGatherOffset(layers, x3, ivec2(1, -2){argument})", "layers.Gather{name}(layers_sampler, x3, int2(1, -2))",
           "textureGather({number}, layers, layers_sampler, x3.xy, i32(round(x3.z)), vec2i(1, -2))",
           LAYERS, "textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(1, -2){argument})"),
    Gather("textureGatherLayer(layers, x2, i{argument})", "layers.Gather{name}(layers_sampler, float3(x2, float(i)))",
           "textureGather({number}, layers, layers_sampler, x2, i)",
           LAYERS, "textureGatherLayerOffset(layers, x2, i, ivec2(0){argument})"),
    Gather("textureGatherLayer(cubes, x3, i{argument})", "cubes.Gather{name}(cubes_sampler, float4(x3, float(i)))",
           "textureGather({number}, cubes, cubes_sampler, x3, i)"),
    Gather("textureGatherLayerOffset(layers, x2, i, ivec2(1, -2){argument})",
           "layers.Gather{name}(layers_sampler, float3(x2, float(i)), int2(1, -2))",
           "textureGather({number}, layers, layers_sampler, x2, i, vec2i(1, -2))",
           LAYERS, "textureGatherLayerOffset(layers, x2, i, ivec2(1, -2){argument})"),
)  # fmt: skip
"""Each without a channel and with channel 2: the argument, the name in HLSL, the number in WGSL."""

COMPARING_GATHERS = (
    Gather("textureGather(shade, x2, y)", "shade.GatherCmp(shade_sampler, x2, y, int2(0, 0))",
           "textureGatherCompare(shade, shade_sampler, x2, y)",
           SHADE, "textureGatherOffset_(shade, x2, y, ivec2(0))"),
    Gather("textureGather(shadecube, x3, y)", "shadecube.GatherCmp(shadecube_sampler, x3, y)",
           "textureGatherCompare(shadecube, shadecube_sampler, x3, y)"),
    Gather("textureGather(shades, x3, y)", "shades.GatherCmp(shades_sampler, x3, y)",
           "textureGatherCompare(shades, shades_sampler, x3.xy, i32(round(x3.z)), y)",
           SHADES, "textureGatherLayerOffset(shades, x3.xy, int(roundEven(x3.z)), y, ivec2(0))"),
    Gather("textureGatherOffset(shade, x2, y, ivec2(1, -2))", "shade.GatherCmp(shade_sampler, x2, y, int2(1, -2))",
           "textureGatherCompare(shade, shade_sampler, x2, y, vec2i(1, -2))",
           SHADE, "textureGatherOffset_(shade, x2, y, ivec2(1, -2))"),
    Gather("textureGatherOffset(shades, x3, y, ivec2(1, -2))", "shades.GatherCmp(shades_sampler, x3, y, int2(1, -2))",
           "textureGatherCompare(shades, shades_sampler, x3.xy, i32(round(x3.z)), y, vec2i(1, -2))",
           SHADES, "textureGatherLayerOffset(shades, x3.xy, int(roundEven(x3.z)), y, ivec2(1, -2))"),
    Gather("textureGatherLayer(shades, x2, i, y)", "shades.GatherCmp(shades_sampler, float3(x2, float(i)), y)",
           "textureGatherCompare(shades, shades_sampler, x2, i, y)",
           SHADES, "textureGatherLayerOffset(shades, x2, i, y, ivec2(0))"),
    Gather("textureGatherLayerOffset(shades, x2, i, y, ivec2(1, -2))",
           "shades.GatherCmp(shades_sampler, float3(x2, float(i)), y, int2(1, -2))",
           "textureGatherCompare(shades, shades_sampler, x2, i, y, vec2i(1, -2))",
           SHADES, "textureGatherLayerOffset(shades, x2, i, y, ivec2(1, -2))"),
)  # fmt: skip


def of_channel(gather: Gather, argument: str, name: str, number: str) -> Gather:
    """The row of one channel."""

    def filled(text: str) -> str:
        return text.format(argument=argument, name=name, number=number)

    return Gather(
        filled(gather.call),
        filled(gather.hlsl),
        filled(gather.wgsl),
        CHANNEL if argument and gather.function else gather.function,
        filled(gather.glsl),
        filled(gather.urp),
    )


def in_glsl(gather: Gather, highp: str, target: str) -> str:
    """The function and its call; the parameters do not fit into a line of 120 characters with `highp` in one case."""
    if not gather.function:
        return f"error: this target has no {gather.call.partition('(')[0]} ({target})"
    start = START.format(size="" if gather.function == SHADE else ".xy")
    line = "\n    " if highp else " "
    return f"{gather.function.format(highp=highp, start=start, line=line)}\nreturn {gather.glsl};"


def texts(gather: Gather) -> dict[str, str]:
    return {
        **others(gather.call),
        **({"urp": gather.urp} if gather.urp else {}),
        "glsl": in_glsl(gather, "", "glsl-330"),
        "glsl-es": in_glsl(gather, "highp ", "glsl-es-300"),
        "hlsl": gather.hlsl,
        "wgsl": gather.wgsl,
    }


GATHERS = {
    gather.call: texts(gather)
    for gather in (
        *(of_channel(gather, "", "Red", "0") for gather in GATHERS_OF_CHANNELS),
        *(of_channel(gather, ", 2", "Blue", "2") for gather in GATHERS_OF_CHANNELS),
        *COMPARING_GATHERS,
    )
}
