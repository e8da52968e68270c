// Stand-in (see the README above): a graph's texture ports.
#ifndef SSSGEN_STANDIN_TEXTURE
#define SSSGEN_STANDIN_TEXTURE
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Common.hlsl"

struct UnitySamplerState
{
    SamplerState samplerstate;
};

#define STANDIN_TEXTURE(name, type, vector)                                                                     \
    struct name                                                                                                 \
    {                                                                                                           \
        type tex;                                                                                               \
        SamplerState samplerstate;                                                                              \
        float4 texelSize;                                                                                       \
        float4 scaleTranslate;                                                                                  \
        float4 Sample(UnitySamplerState s, vector at) { return tex.Sample(s.samplerstate, at); }                \
        float4 SampleLevel(UnitySamplerState s, vector at, float lod)                                           \
        {                                                                                                       \
            return tex.SampleLevel(s.samplerstate, at, lod);                                                    \
        }                                                                                                       \
        float4 Sample(SamplerState s, vector at) { return tex.Sample(s, at); }                                  \
        float4 SampleLevel(SamplerState s, vector at, float lod) { return tex.SampleLevel(s, at, lod); }        \
        STANDIN_MEMBERS                                                                                         \
    };                                                                                                          \
    name name##Build(type tex, SamplerState samplerstate, float4 texelSize, float4 scaleTranslate)              \
    {                                                                                                           \
        name result;                                                                                            \
        result.tex = tex;                                                                                       \
        result.samplerstate = samplerstate;                                                                     \
        STANDIN_SET                                                                                             \
        return result;                                                                                          \
    }

#define STANDIN_SET result.texelSize = texelSize; result.scaleTranslate = scaleTranslate;
#define STANDIN_MEMBERS                                                                                         \
    float2 GetTransformedUV(float2 uv) { return uv * scaleTranslate.xy + scaleTranslate.zw; }                   \
    float4 SampleBias(UnitySamplerState s, float2 uv, float bias)                                               \
    {                                                                                                           \
        return tex.SampleBias(s.samplerstate, uv, bias);                                                        \
    }                                                                                                           \
    float4 SampleBias(SamplerState s, float2 uv, float bias) { return tex.SampleBias(s, uv, bias); }            \
    float4 SampleGrad(UnitySamplerState s, float2 uv, float2 dx, float2 dy)                                     \
    {                                                                                                           \
        return tex.SampleGrad(s.samplerstate, uv, dx, dy);                                                      \
    }                                                                                                           \
    float4 SampleGrad(SamplerState s, float2 uv, float2 dx, float2 dy) { return tex.SampleGrad(s, uv, dx, dy); } \
    float4 Load(int3 pixel) { return tex.Load(pixel); }
STANDIN_TEXTURE(UnityTexture2D, Texture2D, float2)
#undef STANDIN_MEMBERS
#define STANDIN_MEMBERS float4 Load(int4 pixel) { return tex.Load(pixel); }
STANDIN_TEXTURE(UnityTexture3D, Texture3D, float3)
#undef STANDIN_MEMBERS
#define STANDIN_MEMBERS                                                                                         \
    float4 SampleBias(UnitySamplerState s, float3 dir, float bias)                                              \
    {                                                                                                           \
        return tex.SampleBias(s.samplerstate, dir, bias);                                                       \
    }
STANDIN_TEXTURE(UnityTextureCube, TextureCube, float3)
#undef STANDIN_MEMBERS

UnitySamplerState UnityBuildSamplerStateStruct(SamplerState samplerstate)
{
    UnitySamplerState result;
    result.samplerstate = samplerstate;
    return result;
}

#define UnityBuildTexture2DStruct(n) UnityTexture2DBuild(n, sampler##n, n##_TexelSize, n##_ST)
#define UnityBuildTexture3DStruct(n) UnityTexture3DBuild(n, sampler##n, 0.0, 0.0)
#define UnityBuildTextureCubeStruct(n) UnityTextureCubeBuild(n, sampler##n, 0.0, 0.0)

float4 tex2D(UnityTexture2D tex, float2 uv)
{
    return tex.Sample(tex.samplerstate, uv);
}

#endif
