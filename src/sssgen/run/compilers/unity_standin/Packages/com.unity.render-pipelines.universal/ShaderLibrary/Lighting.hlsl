// Stand-in (see the README above): the lights, and the standard lighting.
#ifndef SSSGEN_STANDIN_LIGHTING
#define SSSGEN_STANDIN_LIGHTING
#define UNIVERSAL_LIGHTING_INCLUDED
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

#if STANDIN_TILES
// The loop reads the fragment's place from `inputData`, as Unity's does. Directional lights come before its lights.
#if UNITY_VERSION >= 202220
#define STANDIN_FIRST URP_FP_DIRECTIONAL_LIGHTS_COUNT
#else
#define STANDIN_FIRST _AdditionalLightsDirectionalCount
#endif
#define LIGHT_LOOP_BEGIN(lightCount)                                                                            \
    uint standin_tile = uint(abs(inputData.normalizedScreenSpaceUV.x + inputData.positionWS.z));                \
    for (uint lightIndex = STANDIN_FIRST + min(standin_tile, 0u); lightIndex < uint(_AdditionalLightsCount.x); ++lightIndex) {
#else
#define LIGHT_LOOP_BEGIN(lightCount) for (uint lightIndex = 0u; lightIndex < lightCount; ++lightIndex) {
#endif
#define LIGHT_LOOP_END }

#if UNITY_VERSION >= 202220
uint GetMeshRenderingLayer()
#else
uint GetMeshRenderingLightLayer()
#endif
{
    return asuint(unity_RenderingLayer);
}

bool IsMatchingLightLayer(uint lightLayers, uint renderingLayers)
{
    return (lightLayers & renderingLayers) != 0u;
}

Light standin_through_cookie(Light light)
{
#if defined(_LIGHT_COOKIES)
    light.color *= standin_cookie;
#endif
    return light;
}

Light GetMainLight()
{
    Light light;
    light.direction = _MainLightPosition.xyz;
    light.color = _MainLightColor.rgb;
    light.distanceAttenuation = 1.0;
    light.shadowAttenuation = 1.0;
    light.layerMask = _MainLightLayerMask;
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
    return standin_through_cookie(light);
}

int GetAdditionalLightsCount()
{
#if STANDIN_TILES
    return 0;
#else
    return int(_AdditionalLightsCount.x);
#endif
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
    light.layerMask = _AdditionalLightsLayerMask;
    return light;
}

Light GetAdditionalLight(uint i, float3 positionWS, half4 shadowMask)
{
    Light light = GetAdditionalLight(i, positionWS);
    light.shadowAttenuation = AdditionalLightShadow(GetPerObjectLightIndex(i), positionWS, light.direction, shadowMask, 1.0);
    return standin_through_cookie(light);
}

half3 SampleSH(half3 normalWS)
{
    half4 normal = half4(normalWS, 1.0);
    return half3(dot(unity_SHAr, normal), dot(unity_SHAg, normal), dot(unity_SHAb, normal));
}

#if UNITY_VERSION >= 60000000 && (defined(PROBE_VOLUMES_L1) || defined(PROBE_VOLUMES_L2))
half3 SampleProbeVolumePixel(half3 vertexValue, float3 absolutePositionWS, float3 normalWS, float3 viewDir, float2 positionSS)
{
    return SampleSH(normalWS);
}
#endif

struct AmbientOcclusionFactor
{
    half indirectAmbientOcclusion;
    half directAmbientOcclusion;
};

// Nothing is occluded.
AmbientOcclusionFactor GetScreenSpaceAmbientOcclusion(float2 normalizedScreenSpaceUV)
{
    AmbientOcclusionFactor factor;
    factor.indirectAmbientOcclusion = factor.directAmbientOcclusion = 1.0;
    return factor;
}

struct BRDFData
{
    half3 diffuse;
    half3 specular;
    half roughness;
};

void InitializeBRDFData(
    half3 albedo, half metallic, half3 specular, half smoothness, inout half alpha, out BRDFData outBRDFData)
{
#if defined(_SPECULAR_SETUP)
    outBRDFData.diffuse = albedo;
    outBRDFData.specular = specular;
#else
    outBRDFData.diffuse = albedo * (1.0 - metallic);
    outBRDFData.specular = lerp((half3)0.04, albedo, metallic);
#endif
    outBRDFData.roughness = (1.0 - smoothness) * (1.0 - smoothness);
}

half3 LightingLambert(half3 lightColor, half3 lightDir, half3 normal)
{
    return lightColor * saturate(dot(normal, lightDir));
}

half3 standin_received(Light light, InputData inputData, SurfaceData surfaceData)
{
#if defined(_LIGHT_LAYERS)
    if (!IsMatchingLightLayer(light.layerMask, asuint(unity_RenderingLayer)))
    {
        return 0.0;
    }
#endif
    half3 F0 = lerp((half3)0.04, surfaceData.albedo, surfaceData.metallic);
    half3 diffuse = surfaceData.albedo * (1.0 - surfaceData.metallic);
    half coat = 0.0;
#if defined(_SPECULAR_SETUP)
    F0 = surfaceData.specular;
    diffuse = surfaceData.albedo;
#endif
#if defined(_CLEARCOAT)
    coat = surfaceData.clearCoatMask;
#endif
    return light.color * light.distanceAttenuation * light.shadowAttenuation
        * standin_layered(inputData.normalWS, inputData.viewDirectionWS, light.direction, diffuse, F0,
            1.0 - surfaceData.smoothness, coat, 1.0 - surfaceData.clearCoatSmoothness);
}

half4 UniversalFragmentPBR(InputData inputData, SurfaceData surfaceData)
{
    Light light = GetMainLight(inputData.shadowCoord, inputData.positionWS, inputData.shadowMask);
    half3 color = surfaceData.albedo * inputData.bakedGI * surfaceData.occlusion + surfaceData.emission;
    color += standin_received(light, inputData, surfaceData);
#if STANDIN_TILES
    for (uint number = 0u; number < STANDIN_FIRST; ++number)
    {
        light = GetAdditionalLight(number, inputData.positionWS, inputData.shadowMask);
        color += standin_received(light, inputData, surfaceData);
    }
#endif
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
