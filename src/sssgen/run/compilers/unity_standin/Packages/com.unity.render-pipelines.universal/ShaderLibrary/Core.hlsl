// Stand-in (see the README above): what every pass includes first.
#ifndef SSSGEN_STANDIN_CORE
#define SSSGEN_STANDIN_CORE
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Common.hlsl"
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Packing.hlsl"
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/UnityInstancing.hlsl"
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/SpaceTransforms.hlsl"

// Lists of lights for each part of the screen, under the names of each version.
#define STANDIN_TILES (defined(_CLUSTER_LIGHT_LOOP) || defined(_FORWARD_PLUS) || defined(_CLUSTERED_RENDERING))
#if UNITY_VERSION >= 60000100
#define USE_CLUSTER_LIGHT_LOOP defined(_CLUSTER_LIGHT_LOOP)
#elif UNITY_VERSION >= 202220
#define USE_FORWARD_PLUS defined(_FORWARD_PLUS)
#else
#define USE_CLUSTERED_LIGHTING defined(_CLUSTERED_RENDERING)
#endif
#if STANDIN_TILES
#define _ADDITIONAL_LIGHTS 1
#endif
#define MAX_VISIBLE_LIGHTS 256

float4 unity_FogColor;
float4 unity_FogParams;
float4 _MainLightPosition;
half4 _MainLightColor;
half4 unity_SHAr, unity_SHAg, unity_SHAb;
half4 _AdditionalLightsCount;
float unity_RenderingLayer;
uint _MainLightLayerMask;
uint _AdditionalLightsLayerMask;  // of all of them
half3 standin_cookie;             // of every light
#if UNITY_VERSION >= 202220
float4 unity_RendererBounds_Min;  // the box of the object in the world
float4 unity_RendererBounds_Max;
#endif
#if STANDIN_TILES && UNITY_VERSION >= 202220
float4 _FPParams0;
#define URP_FP_DIRECTIONAL_LIGHTS_COUNT ((uint)_FPParams0.w)
#elif STANDIN_TILES
uint _AdditionalLightsDirectionalCount;
#endif
float4 _AdditionalLightsPosition[MAX_VISIBLE_LIGHTS];  // w: 1 a position, 0 a direction
half4 _AdditionalLightsColor[MAX_VISIBLE_LIGHTS];

struct InputData
{
    float3 positionWS;
    float4 positionCS;
    half3 normalWS;
    half3 viewDirectionWS;
    float4 shadowCoord;
    half fogCoord;
    half3 vertexLighting;
    half3 bakedGI;
    float2 normalizedScreenSpaceUV;
    half4 shadowMask;
    half3x3 tangentToWorld;
};

struct VertexPositionInputs
{
    float3 positionWS;
    float3 positionVS;
    float4 positionCS;
    float4 positionNDC;
};

struct VertexNormalInputs
{
    real3 tangentWS;
    real3 bitangentWS;
    float3 normalWS;
};

VertexPositionInputs GetVertexPositionInputs(float3 positionOS)
{
    VertexPositionInputs positions;
    positions.positionWS = TransformObjectToWorld(positionOS);
    positions.positionVS = mul(UNITY_MATRIX_V, float4(positions.positionWS, 1.0)).xyz;
    positions.positionCS = TransformWorldToHClip(positions.positionWS);
    positions.positionNDC = positions.positionCS;
    return positions;
}

VertexNormalInputs GetVertexNormalInputs(float3 normalOS, float4 tangentOS)
{
    VertexNormalInputs frame;
    frame.normalWS = TransformObjectToWorldNormal(normalOS);
    frame.tangentWS = TransformObjectToWorldDir(tangentOS.xyz);
    frame.bitangentWS = cross(frame.normalWS, frame.tangentWS) * tangentOS.w * GetOddNegativeScale();
    return frame;
}

float3 GetCameraPositionWS()
{
    return _WorldSpaceCameraPos;
}

float3 GetCurrentViewPosition()
{
    return _WorldSpaceCameraPos;
}

float3 GetWorldSpaceViewDir(float3 positionWS)
{
    return _WorldSpaceCameraPos - positionWS;
}

float3 GetWorldSpaceNormalizeViewDir(float3 positionWS)
{
    return normalize(GetWorldSpaceViewDir(positionWS));
}

float2 GetNormalizedScreenSpaceUV(float4 positionCS)
{
    return positionCS.xy / _ScreenParams.xy;
}

real ComputeFogFactor(float zPositionCS)
{
    return zPositionCS * unity_FogParams.z + unity_FogParams.w;
}

half3 MixFog(half3 fragColor, half fogFactor)
{
#if defined(FOG_LINEAR) || defined(FOG_EXP) || defined(FOG_EXP2)
    return lerp(unity_FogColor.rgb, fragColor, saturate(fogFactor));
#else
    return fragColor;
#endif
}

#endif
