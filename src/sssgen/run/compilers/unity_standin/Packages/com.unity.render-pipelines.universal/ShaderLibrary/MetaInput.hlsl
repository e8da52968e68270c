// Stand-in (see the README above): what the lightmapper asks of a material.
#ifndef SSSGEN_STANDIN_META
#define SSSGEN_STANDIN_META
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"

float4 unity_LightmapST;
float4 unity_DynamicLightmapST;
bool4 unity_MetaVertexControl;    // x: the place is that of uv1; y: of uv2
bool4 unity_MetaFragmentControl;  // x: albedo; y: emission

struct UnityMetaInput
{
    half3 Albedo;
    half3 Emission;
};

float4 UnityMetaVertexPosition(float3 vertex, float2 uv1, float2 uv2)
{
    if (unity_MetaVertexControl.x)
    {
        vertex = float3(uv1 * unity_LightmapST.xy + unity_LightmapST.zw, 0.0);
    }
    if (unity_MetaVertexControl.y)
    {
        vertex = float3(uv2 * unity_DynamicLightmapST.xy + unity_DynamicLightmapST.zw, 0.0);
    }
    return TransformWorldToHClip(vertex);
}

half4 UnityMetaFragment(UnityMetaInput light)
{
    return half4(unity_MetaFragmentControl.x ? light.Albedo : light.Emission, 1.0);
}

#endif
