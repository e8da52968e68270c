// Stand-in (see the README above): the lights, and the standard lighting.
#ifndef SSSGEN_STANDIN_LIGHTING
#define SSSGEN_STANDIN_LIGHTING
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/CommonMaterial.hlsl"
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/SurfaceData.hlsl"
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl"
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/StandardLight.hlsl"

struct Light
{
    half3 direction;
    half3 color;
    half distanceAttenuation;
    half shadowAttenuation;
    uint layerMask;
};

#if USE_CLUSTERED_LIGHTING
// The loop reads the fragment's place from `inputData`, as Unity's does.
#define LIGHT_LOOP_BEGIN(lightCount)                                                                            \
    uint standin_tile = uint(inputData.normalizedScreenSpaceUV.x + inputData.positionWS.z);                     \
    for (uint lightIndex = standin_tile % 2u; lightIndex < 8u; ++lightIndex) {
#else
#define LIGHT_LOOP_BEGIN(lightCount) for (uint lightIndex = 0u; lightIndex < lightCount; ++lightIndex) {
#endif
#define LIGHT_LOOP_END }

Light GetMainLight()
{
    Light light;
    light.direction = _MainLightPosition.xyz;
    light.color = _MainLightColor.rgb;
    light.distanceAttenuation = 1.0;
    light.shadowAttenuation = 1.0;
    light.layerMask = 255u;
    return light;
}

Light GetMainLight(float4 shadowCoord)
{
    Light light = GetMainLight();
    light.shadowAttenuation = MainLightRealtimeShadow(shadowCoord);
    return light;
}

Light GetMainLight(float4 shadowCoord, float3 positionWS, half4 shadowMask)
{
    Light light = GetMainLight(shadowCoord);
    light.shadowAttenuation *= shadowMask.x;
    return light;
}

int GetAdditionalLightsCount()
{
    return USE_CLUSTERED_LIGHTING ? 0 : int(_AdditionalLightsCount.x);
}

int GetPerObjectLightIndex(uint index)
{
    return int(index);
}

Light GetAdditionalLight(uint i, float3 positionWS)
{
    Light light;
    float4 position = _AdditionalLightsPosition[i];
    float3 toLight = position.xyz - positionWS * position.w;
    light.direction = SafeNormalize(toLight);
    light.color = _AdditionalLightsColor[i].rgb;
    light.distanceAttenuation = rcp(max(dot(toLight, toLight), HALF_MIN));
    light.shadowAttenuation = 1.0;
    light.layerMask = 255u;
    return light;
}

Light GetAdditionalLight(uint i, float3 positionWS, half4 shadowMask)
{
    Light light = GetAdditionalLight(i, positionWS);
    light.shadowAttenuation = shadowMask.x;
    return light;
}

half3 SampleSH(half3 normalWS)
{
    half4 normal = half4(normalWS, 1.0);
    return half3(dot(unity_SHAr, normal), dot(unity_SHAg, normal), dot(unity_SHAb, normal));
}

half3 standin_received(Light light, InputData inputData, SurfaceData surfaceData)
{
    return light.color * light.distanceAttenuation * light.shadowAttenuation
        * standin_standard(inputData.normalWS, inputData.viewDirectionWS, light.direction, surfaceData.albedo,
            surfaceData.metallic, 1.0 - surfaceData.smoothness);
}

half4 UniversalFragmentPBR(InputData inputData, SurfaceData surfaceData)
{
    Light light = GetMainLight(inputData.shadowCoord, inputData.positionWS, inputData.shadowMask);
    half3 color = surfaceData.albedo * inputData.bakedGI * surfaceData.occlusion + surfaceData.emission;
    color += standin_received(light, inputData, surfaceData);
#if defined(_ADDITIONAL_LIGHTS)
    uint lightCount = GetAdditionalLightsCount();
    LIGHT_LOOP_BEGIN(lightCount)
        light = GetAdditionalLight(lightIndex, inputData.positionWS, inputData.shadowMask);
        color += standin_received(light, inputData, surfaceData);
    LIGHT_LOOP_END
#endif
    return half4(color, surfaceData.alpha);
}

#endif
