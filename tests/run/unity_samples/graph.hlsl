// A Custom Function include: what the unity compiler must be able to take.
#ifndef SSSGEN_SAMPLES_GRAPH
#define SSSGEN_SAMPLES_GRAPH

float3 backlight(float3 normal, float3 view, float3 light, float sharpness)
{
    return pow(max(saturate(dot(view, -normalize(light + normal))), 1e-4), sharpness);
}

void Backlit_float(UnityTexture2D map, UnitySamplerState state, UnityTexture3D volume, float2 uv, float3 normal,
    float3 view, float3 positionWS, float sharpness, out float3 Out)
{
    Out = SAMPLE_TEXTURE2D(map, state, uv).rgb + tex2D(map, map.GetTransformedUV(uv)).rgb
        + SAMPLE_TEXTURE3D(volume, volume.samplerstate, positionWS).rgb;
#if defined(SHADERGRAPH_PREVIEW)
    Out *= backlight(normal, view, float3(0.5, 0.5, 0.0), sharpness);
#else
    Light light = GetMainLight(TransformWorldToShadowCoord(positionWS));
    Out *= light.color * light.distanceAttenuation * light.shadowAttenuation
        * backlight(normal, view, light.direction, sharpness);
    for (int i = 0; i < GetAdditionalLightsCount(); i++)
    {
        Light extra = GetAdditionalLight(i, positionWS, half4(1, 1, 1, 1));
        Out += extra.color * backlight(normal, view, extra.direction, sharpness);
    }
#endif
}

void Backlit_half(UnityTexture2D map, UnitySamplerState state, UnityTexture3D volume, half2 uv, half3 normal,
    half3 view, half3 positionWS, half sharpness, out half3 Out)
{
    float3 result;
    Backlit_float(map, state, volume, uv, normal, view, positionWS, sharpness, result);
    Out = result;
}

#endif
