// Stand-in (see the README above): normals and numbers in textures.
#ifndef SSSGEN_STANDIN_PACKING
#define SSSGEN_STANDIN_PACKING
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Common.hlsl"

real3 UnpackNormal(real4 packedNormal)
{
    return packedNormal.xyz * 2.0 - 1.0;
}

real3 UnpackNormalScale(real4 packedNormal, real scale)
{
    return UnpackNormal(packedNormal) * real3(scale, scale, 1.0);
}

float2 PackNormalOctQuadEncode(float3 n)
{
    n /= max(dot(abs(n), 1.0), 1e-6);
    return n.xy;
}

float3 PackFloat2To888(float2 f)
{
    return float3(f, 0.0);
}

#endif
