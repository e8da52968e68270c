// Stand-in (see ../README.md): shadows and attenuation.
#ifndef SSSGEN_STANDIN_AUTO_LIGHT
#define SSSGEN_STANDIN_AUTO_LIGHT

#define UNITY_SHADOW_COORDS(index) float4 _ShadowCoord : TEXCOORD##index;
#define UNITY_TRANSFER_SHADOW(output, uv)

#if defined(POINT)
// A table over the square of the distance, as Unity's; unity_WorldToLight takes its end to distance 1.
sampler2D _LightTexture0;
float4x4 unity_WorldToLight;

float standin_falloff(float3 worldPos)
{
    float3 away = mul(unity_WorldToLight, float4(worldPos, 1.0)).xyz;
    return tex2D(_LightTexture0, dot(away, away).xx).r;
}
#define UNITY_LIGHT_ATTENUATION(name, input, worldPos) fixed name = standin_falloff(worldPos);
#else
#define UNITY_LIGHT_ATTENUATION(name, input, worldPos) fixed name = saturate(1.0 - input._ShadowCoord.z);
#endif

#endif
