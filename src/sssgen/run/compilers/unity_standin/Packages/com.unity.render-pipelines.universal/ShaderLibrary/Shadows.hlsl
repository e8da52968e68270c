// Stand-in (see the README above). Needs CommonMaterial.hlsl before it, as Unity's does.
#ifndef SSSGEN_STANDIN_SHADOWS
#define SSSGEN_STANDIN_SHADOWS
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"

// The shadow maps have a ball and two boxes. Instead of texels, the way from a place to the light is compared with them; the
// coordinate in the main light's map is the place itself. A strength of 0 is a light without shadows.
half4 _MainLightShadowParams;                       // x: the strength
half4 _AdditionalShadowParams[MAX_VISIBLE_LIGHTS];  // x: the strength
float4 standin_ball;                                // w: the radius
float4 standin_box_min[2];
float4 standin_box_max[2];
float4 _ShadowBias;

// 0 where one of them is on the way, which begins 1 % of a unit from the place, as with a depth bias.
half standin_unshadowed(float3 place, float3 L, float way)
{
    float nearest = dot(standin_ball.xyz - place, L);
    float3 across = standin_ball.xyz - place - L * nearest;
    float half_chord = sqrt(max(standin_ball.w * standin_ball.w - dot(across, across), 0.0));
    half share = half_chord > 0.0 && nearest + half_chord > 0.01 && nearest - half_chord < way ? 0.0 : 1.0;
    float3 slopes = (step(0.0, L) * 2.0 - 1.0) / max(abs(L), 1e-6);
    for (int i = 0; i < 2; i++)
    {
        float3 first = (standin_box_min[i].xyz - place) * slopes;
        float3 second = (standin_box_max[i].xyz - place) * slopes;
        float3 enters = min(first, second), leaves = max(first, second);
        float enter = max(max(max(enters.x, enters.y), enters.z), 0.01);
        float leave = min(min(min(leaves.x, leaves.y), leaves.z), way);
        share *= enter < leave ? 0.0 : 1.0;
    }
    return share;
}

float4 TransformWorldToShadowCoord(float3 positionWS)
{
    return float4(positionWS, 0.0);
}

half MainLightRealtimeShadow(float4 shadowCoord)
{
    return LerpWhiteTo(standin_unshadowed(shadowCoord.xyz, _MainLightPosition.xyz, 1e6), _MainLightShadowParams.x);
}

half MainLightShadow(float4 shadowCoord, float3 positionWS, half4 shadowMask, half4 occlusionProbeChannels)
{
    return MainLightRealtimeShadow(shadowCoord);
}

half AdditionalLightShadow(
    int lightIndex, float3 positionWS, half3 lightDirection, half4 shadowMask, half4 occlusionProbeChannels)
{
    float4 light = _AdditionalLightsPosition[lightIndex];
    float3 toLight = light.xyz - positionWS * light.w;  // also from a place beyond the light
    float way = light.w == 0.0 ? 1e6 : length(toLight);
    return LerpWhiteTo(standin_unshadowed(positionWS, SafeNormalize(toLight), way), _AdditionalShadowParams[lightIndex].x);
}

float3 ApplyShadowBias(float3 positionWS, float3 normalWS, float3 lightDirection)
{
    return positionWS + lightDirection * _ShadowBias.x + normalWS * _ShadowBias.y;
}

#endif
