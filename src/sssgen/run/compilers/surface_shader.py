"""The entry points that Unity generates for a surface shader, as far as a check and forward rendering need them.

The editor turns `#pragma surface` into vertex and fragment entries (docs.unity3d.com, "Writing Surface
Shaders": the fields of `Input`, the order surface function → GI function → lighting function). That
generator is not available outside of the editor, so this module writes entries that make the same
calls with the same types. Like the editor's, they declare `NAME_ST` for each `uvNAME` input: a shader
that declares it too does not compile.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

BUILTIN_LIGHTING = {"Standard": "SurfaceOutputStandard", "StandardSpecular": "SurfaceOutputStandardSpecular"}

# Defined by the editor in front of the shader's own code, not by a header.
PRELUDE = """\
#define INTERNAL_DATA half3 internalSurfaceTtoW0; half3 internalSurfaceTtoW1; half3 internalSurfaceTtoW2;
#define WorldNormalVector(data, n) half3(dot(data.internalSurfaceTtoW0, n), \
dot(data.internalSurfaceTtoW1, n), dot(data.internalSurfaceTtoW2, n))
#define WorldReflectionVector(data, n) reflect(data.worldRefl, WorldNormalVector(data, n))
"""

_VERTEX = """
struct sssgen_varyings {{
    float4 pos : SV_POSITION;
    float4 uv : TEXCOORD0;
    float3 worldPos : TEXCOORD1;
    float3 worldNormal : TEXCOORD2;
    float3 worldTangent : TEXCOORD3;
    float3 worldBitangent : TEXCOORD4;
    float4 color : COLOR0;
    UNITY_SHADOW_COORDS(5)
    float4 screenPos : TEXCOORD6;
{varyings}
}};
sssgen_varyings sssgen_vertex(appdata_full v) {{
    sssgen_varyings i;
    UNITY_INITIALIZE_OUTPUT(sssgen_varyings, i);
{modifier}
    i.pos = UnityObjectToClipPos(v.vertex);
    i.uv = float4(v.texcoord.xy, v.texcoord1.xy);
    i.worldPos = mul(unity_ObjectToWorld, v.vertex).xyz;
    i.worldNormal = UnityObjectToWorldNormal(v.normal);
    i.worldTangent = UnityObjectToWorldDir(v.tangent.xyz);
    i.worldBitangent = cross(i.worldNormal, i.worldTangent) * v.tangent.w * unity_WorldTransformParams.w;
    i.color = v.color;
    i.screenPos = ComputeScreenPos(i.pos);
{carried}
    return i;
}}
"""

_FRAGMENT = """
float4 sssgen_fragment(sssgen_varyings i, bool front : SV_IsFrontFace) : SV_Target0 {{
    float3 worldViewDir = normalize(UnityWorldSpaceViewDir(i.worldPos));
    Input surfIN;
    UNITY_INITIALIZE_OUTPUT(Input, surfIN);
{inputs}
    {output} o;
    UNITY_INITIALIZE_OUTPUT({output}, o);
    o.Normal = half3(0, 0, 1);
{defaults}
    {surface}(surfIN, o);
    UNITY_LIGHT_ATTENUATION(atten, i, i.worldPos)
    float3 n = o.Normal;
    o.Normal = normalize(n.x * i.worldTangent + n.y * i.worldBitangent + n.z * i.worldNormal);
    UnityGI gi;
    UNITY_INITIALIZE_OUTPUT(UnityGI, gi);
    gi.light.color = _LightColor0.rgb;
    gi.light.dir = normalize(UnityWorldSpaceLightDir(i.worldPos));
#ifdef UNITY_PASS_FORWARDBASE
    UnityGIInput giInput;
    UNITY_INITIALIZE_OUTPUT(UnityGIInput, giInput);
    giInput.light = gi.light;
    giInput.worldPos = i.worldPos;
    giInput.worldViewDir = worldViewDir;
    giInput.atten = atten;
    giInput.probeHDR[0] = unity_SpecCube0_HDR;
    giInput.probeHDR[1] = unity_SpecCube1_HDR;
    {lighting}_GI(o, giInput, gi);
#else
    gi.light.color *= atten;
#endif
    float4 c = {lighting}(o, worldViewDir, gi);
#ifdef UNITY_PASS_FORWARDBASE
    c.rgb += o.Emission;
#else
    c.a = 0.0;
#endif
    return c;
}}
"""

_INPUTS = {
    "viewDir": "worldViewDir",
    "worldPos": "i.worldPos",
    "worldNormal": "i.worldNormal",
    "worldRefl": "reflect(-worldViewDir, i.worldNormal)",
    "screenPos": "i.screenPos",
    "color": "i.color",
    "facing": "front ? 1.0 : -1.0",
    "internalSurfaceTtoW0": "half3(i.worldTangent.x, i.worldBitangent.x, i.worldNormal.x)",
    "internalSurfaceTtoW1": "half3(i.worldTangent.y, i.worldBitangent.y, i.worldNormal.y)",
    "internalSurfaceTtoW2": "half3(i.worldTangent.z, i.worldBitangent.z, i.worldNormal.z)",
}


_TEXTURE_INPUT = re.compile(r"uv(\d?)(_\w+)")


class SurfaceError(ValueError):
    """The surface pragma and the code do not fit together."""


@dataclass(frozen=True)
class _Pragma:
    surface: str
    model: str
    vertex: str | None


def entries(code: str, pragma: str) -> str:
    """`sssgen_vertex` and `sssgen_fragment`, to be appended to `code` with this `#pragma surface`.

    Raises SurfaceError where the pragma names a function that `code` lacks.
    """
    surface_pragma = _read(pragma)
    output = _output_type(code, surface_pragma)
    modifier = re.search(rf"\bvoid\s+{surface_pragma.vertex}\s*\(([^)]*)\)", code) if surface_pragma.vertex else None
    if surface_pragma.vertex and not modifier:
        raise SurfaceError(f"no vertex function {surface_pragma.vertex}")
    second = modifier is not None and "," in modifier[1]
    call = f"    Input custom; {surface_pragma.vertex}(v{', custom' if second else ''});" if modifier else ""
    fields, custom = _input_fields(code), []
    names = [name for _, name in fields]
    if second:
        custom = [(kind, name) for kind, name in fields if name not in _INPUTS and not _TEXTURE_INPUT.fullmatch(name)]
    textures = sorted({m[2] for name in names if (m := _TEXTURE_INPUT.fullmatch(name))})
    for texture in textures:
        if re.search(rf"\b{texture}_ST\s*;", code):
            raise SurfaceError(f"declares {texture}_ST, which Unity declares for the input uv{texture}")
    # As in the editor, which supplies worldNormal only where no tangent frame is needed.
    supplied = [name for name in names if not (name == "worldNormal" and "internalSurfaceTtoW0" in names)]
    inputs = [f"    surfIN.{name} = {value};" for name in supplied if (value := _input(name))]
    inputs += [f"    surfIN.{name} = i.custom_{name};" for _, name in custom]
    varyings = [f"    {kind} custom_{name} : TEXCOORD{7 + k};" for k, (kind, name) in enumerate(custom)]
    carried = [f"    i.custom_{name} = custom.{name};" for _, name in custom]
    return (
        "".join(f"float4 {texture}_ST;\n" for texture in textures)
        + _VERTEX.format(modifier=call, varyings="\n".join(varyings), carried="\n".join(carried))
        + _FRAGMENT.format(
            inputs="\n".join(inputs),
            output=output,
            defaults="    o.Occlusion = 1.0;" if _has_occlusion(code, output) else "",
            surface=surface_pragma.surface,
            lighting=f"Lighting{surface_pragma.model}",
        )
    )


def _read(pragma: str) -> _Pragma:
    words = pragma.split()
    if len(words) < 2:
        raise SurfaceError("#pragma surface names a surface function and a lighting model")
    vertex = next((w.partition(":")[2] for w in words[2:] if w.startswith("vertex:")), None)
    return _Pragma(words[0], words[1], vertex)


def _output_type(code: str, pragma: _Pragma) -> str:
    surface = re.search(rf"\bvoid\s+{pragma.surface}\s*\(\s*Input\s+\w+\s*,\s*inout\s+(\w+)\s+\w+\s*\)", code)
    if not surface:
        raise SurfaceError(f"no function void {pragma.surface}(Input, inout SurfaceOutput…)")
    expected = BUILTIN_LIGHTING.get(pragma.model)
    if expected is None and not re.search(rf"\bLighting{pragma.model}\s*\(", code):
        raise SurfaceError(f"no lighting function Lighting{pragma.model}")
    if expected not in (None, surface[1]):
        raise SurfaceError(
            f"lighting model {pragma.model} requires {expected}, but the surface function has {surface[1]}"
        )
    return surface[1]


def _has_occlusion(code: str, output: str) -> bool:
    own = re.search(rf"\bstruct\s+{output}\s*\{{(.*?)\}}\s*;", code, re.DOTALL)
    return output in BUILTIN_LIGHTING.values() if own is None else bool(re.search(r"\bOcclusion\s*;", own[1]))


def _input_fields(code: str) -> list[tuple[str, str]]:
    """(type, name) of the fields of `Input`."""
    struct = re.search(r"\bstruct\s+Input\s*\{(.*?)\}\s*;", code, re.DOTALL)
    if not struct:
        raise SurfaceError("no struct Input")
    body = re.sub(r"//[^\n]*|/\*.*?\*/|:\s*\w+", "", struct[1], flags=re.DOTALL)
    fields = re.findall(r"(\w+)\s+(\w+)\s*;", body)
    return fields + [("half3", f"internalSurfaceTtoW{k}") for k in range(3) if "INTERNAL_DATA" in body]


def _input(name: str) -> str:
    """The editor's expression for a field; "" for one that the vertex function sets."""
    if match := _TEXTURE_INPUT.fullmatch(name):
        return f"i.uv.{'zw' if match[1] == '2' else 'xy'} * {match[2]}_ST.xy + {match[2]}_ST.zw"
    return _INPUTS.get(name, "")
