// Stand-in (see ../README.md): what lighting functions are given.
#ifndef SSSGEN_STANDIN_LIGHTING_COMMON
#define SSSGEN_STANDIN_LIGHTING_COMMON
#include "UnityShaderVariables.cginc"

fixed4 _LightColor0;
fixed4 _SpecColor;

struct UnityLight
{
    half3 color;
    half3 dir;
    half ndotl;
};

struct UnityIndirect
{
    half3 diffuse;
    half3 specular;
};

struct UnityGI
{
    UnityLight light;
    UnityIndirect indirect;
};

struct UnityGIInput
{
    UnityLight light;
    float3 worldPos;
    half3 worldViewDir;
    half atten;
    half3 ambient;
    float4 lightmapUV;
    float4 probeHDR[2];
};

#endif
