// Stand-in (see ../README.md).
#ifndef SSSGEN_STANDIN_SHADER_UTILITIES
#define SSSGEN_STANDIN_SHADER_UTILITIES
#include "UnityShaderVariables.cginc"

float4 UnityObjectToClipPos(float3 pos)
{
    return mul(UNITY_MATRIX_VP, mul(unity_ObjectToWorld, float4(pos, 1.0)));
}

float4 UnityObjectToClipPos(float4 pos)
{
    return UnityObjectToClipPos(pos.xyz);
}

#endif
