// Stand-in (see the README above). Needs CommonMaterial.hlsl before it, as Unity's does.
#ifndef SSSGEN_STANDIN_SHADOWS
#define SSSGEN_STANDIN_SHADOWS
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"

float4x4 _MainLightWorldToShadow;
float4 _ShadowBias;
half4 _MainLightShadowParams;

float4 TransformWorldToShadowCoord(float3 positionWS)
{
    return float4(mul(_MainLightWorldToShadow, float4(positionWS, 1.0)).xyz, 0.0);
}

half MainLightRealtimeShadow(float4 shadowCoord)
{
    return LerpWhiteTo(step(shadowCoord.z, 0.5), _MainLightShadowParams.x);
}

float3 ApplyShadowBias(float3 positionWS, float3 normalWS, float3 lightDirection)
{
    return positionWS + lightDirection * _ShadowBias.x + normalWS * _ShadowBias.y;
}

#endif
