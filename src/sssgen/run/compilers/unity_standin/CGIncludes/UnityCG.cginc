// Stand-in (see ../README.md): vertex data, spaces, colours, packing, fog.
#ifndef SSSGEN_STANDIN_CG
#define SSSGEN_STANDIN_CG
#include "UnityShaderVariables.cginc"
#include "UnityShaderUtilities.cginc"

#define UNITY_PI 3.14159265359f
#define UNITY_TWO_PI 6.28318530718f
#define UNITY_INV_PI 0.31830988618f
#define UNITY_HALF_PI 1.57079632679f

// One object at a time and one eye: instancing and stereo leave nothing behind.
#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_VERTEX_OUTPUT_STEREO
#define UNITY_SETUP_INSTANCE_ID(input)
#define UNITY_TRANSFER_INSTANCE_ID(input, output)
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output)
#define UNITY_TRANSFER_VERTEX_OUTPUT_STEREO(input, output)
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input)
#define UNITY_INSTANCING_BUFFER_START(name)
#define UNITY_INSTANCING_BUFFER_END(name)
#define UNITY_DEFINE_INSTANCED_PROP(type, name) type name;
#define UNITY_ACCESS_INSTANCED_PROP(buffer, name) name

struct appdata_base
{
    float4 vertex : POSITION;
    float3 normal : NORMAL;
    float4 texcoord : TEXCOORD0;
};

struct appdata_tan
{
    float4 vertex : POSITION;
    float4 tangent : TANGENT;
    float3 normal : NORMAL;
    float4 texcoord : TEXCOORD0;
};

struct appdata_full
{
    float4 vertex : POSITION;
    float4 tangent : TANGENT;
    float3 normal : NORMAL;
    float4 texcoord : TEXCOORD0;
    float4 texcoord1 : TEXCOORD1;
    float4 texcoord2 : TEXCOORD2;
    float4 texcoord3 : TEXCOORD3;
    fixed4 color : COLOR;
};

#define TRANSFORM_TEX(tex, name) (tex.xy * name##_ST.xy + name##_ST.zw)

float3 UnityObjectToWorldDir(float3 dir)
{
    return normalize(mul((float3x3)unity_ObjectToWorld, dir));
}

float3 UnityWorldToObjectDir(float3 dir)
{
    return normalize(mul((float3x3)unity_WorldToObject, dir));
}

float3 UnityObjectToWorldNormal(float3 normal)
{
    return normalize(mul(normal, (float3x3)unity_WorldToObject));
}

float4 UnityWorldToClipPos(float3 pos)
{
    return mul(UNITY_MATRIX_VP, float4(pos, 1.0));
}

float3 UnityWorldSpaceViewDir(float3 worldPos)
{
    return _WorldSpaceCameraPos - worldPos;
}

float3 UnityWorldSpaceLightDir(float3 worldPos)
{
    return _WorldSpaceLightPos0.xyz - worldPos * _WorldSpaceLightPos0.w;
}

float3 WorldSpaceViewDir(float4 localPos)
{
    return UnityWorldSpaceViewDir(mul(unity_ObjectToWorld, localPos).xyz);
}

float3 ObjSpaceViewDir(float4 v)
{
    return mul(unity_WorldToObject, float4(_WorldSpaceCameraPos, 1.0)).xyz - v.xyz;
}

float4 ComputeScreenPos(float4 pos)
{
    return float4(0.5 * (pos.xy + pos.w), pos.zw);
}

fixed3 UnpackNormal(fixed4 packednormal)
{
    return packednormal.xyz * 2.0 - 1.0;
}

half3 UnpackScaleNormal(half4 packednormal, half scale)
{
    return UnpackNormal(packednormal) * half3(scale, scale, 1.0);
}

half3 ShadeSH9(half4 normal)
{
    return half3(dot(unity_SHAr, normal), dot(unity_SHAg, normal), dot(unity_SHAb, normal));
}

half Luminance(half3 color)
{
    return dot(color, half3(0.2126, 0.7152, 0.0722));
}

half3 GammaToLinearSpace(half3 color)
{
    return pow(max(color, 0.0), 2.2);
}

half3 LinearToGammaSpace(half3 color)
{
    return pow(max(color, 0.0), 1.0 / 2.2);
}

#if defined(FOG_LINEAR) || defined(FOG_EXP) || defined(FOG_EXP2)
#define UNITY_FOG_COORDS(index) float1 fogCoord : TEXCOORD##index;
#define UNITY_TRANSFER_FOG(output, position) output.fogCoord.x = (position).z * unity_FogParams.z + unity_FogParams.w
#define UNITY_APPLY_FOG_COLOR(coord, color, fogColor) color.rgb = lerp((fogColor).rgb, (color).rgb, saturate((coord).x))
#else
#define UNITY_FOG_COORDS(index)
#define UNITY_TRANSFER_FOG(output, position)
#define UNITY_APPLY_FOG_COLOR(coord, color, fogColor)
#endif
#define UNITY_APPLY_FOG(coord, color) UNITY_APPLY_FOG_COLOR(coord, color, unity_FogColor)

#endif
