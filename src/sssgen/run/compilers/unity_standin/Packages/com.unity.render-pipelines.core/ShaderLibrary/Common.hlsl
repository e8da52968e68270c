// Stand-in (see the README above): types, buffers, textures, and small mathematics.
#ifndef SSSGEN_STANDIN_COMMON
#define SSSGEN_STANDIN_COMMON

#define real float
#define real2 float2
#define real3 float3
#define real4 float4
#define real3x3 float3x3

#define PI 3.14159265358979323846
#define TWO_PI 6.28318530717958647693
#define HALF_PI 1.57079632679489661923
#define INV_PI 0.31830988618379067154
#define HALF_MIN 6.103515625e-5
#define FLT_EPS 5.960464478e-8

#define UNITY_REVERSED_Z 1
#define UNITY_NEAR_CLIP_VALUE 1.0
#define UNITY_UV_STARTS_AT_TOP 1

#define FRONT_FACE_SEMANTIC SV_IsFrontFace
#define FRONT_FACE_TYPE bool
#define IS_FRONT_VFACE(value, front, back) ((value) ? (front) : (back))
#define UNITY_BRANCH [branch]
#define UNITY_FLATTEN [flatten]
#define UNITY_UNROLL [unroll]
#define UNITY_LOOP [loop]
#define ZERO_INITIALIZE(type, name) name = (type)0;

#define CBUFFER_START(name) cbuffer name {
#define CBUFFER_END };

#define TEXTURE2D(name) Texture2D name
#define TEXTURE3D(name) Texture3D name
#define TEXTURECUBE(name) TextureCube name
#define SAMPLER(name) SamplerState name
#define TEXTURE2D_PARAM(name, samplerName) Texture2D name, SamplerState samplerName
#define TEXTURE2D_ARGS(name, samplerName) name, samplerName
#define TEXTURE3D_PARAM(name, samplerName) Texture3D name, SamplerState samplerName
#define TEXTURE3D_ARGS(name, samplerName) name, samplerName
#define TEXTURECUBE_PARAM(name, samplerName) TextureCube name, SamplerState samplerName
#define TEXTURECUBE_ARGS(name, samplerName) name, samplerName
#define SAMPLE_TEXTURE2D(name, state, uv) name.Sample(state, uv)
#define SAMPLE_TEXTURE2D_LOD(name, state, uv, lod) name.SampleLevel(state, uv, lod)
#define SAMPLE_TEXTURE2D_BIAS(name, state, uv, bias) name.SampleBias(state, uv, bias)
#define SAMPLE_TEXTURE2D_GRAD(name, state, uv, dx, dy) name.SampleGrad(state, uv, dx, dy)
#define SAMPLE_TEXTURE3D(name, state, uvw) name.Sample(state, uvw)
#define SAMPLE_TEXTURE3D_LOD(name, state, uvw, lod) name.SampleLevel(state, uvw, lod)
#define SAMPLE_TEXTURECUBE(name, state, dir) name.Sample(state, dir)
#define SAMPLE_TEXTURECUBE_LOD(name, state, dir, lod) name.SampleLevel(state, dir, lod)
#define SAMPLE_TEXTURECUBE_BIAS(name, state, dir, bias) name.SampleBias(state, dir, bias)
#define LOAD_TEXTURE2D(name, pixel) name.Load(int3(pixel, 0))
#define LOAD_TEXTURE2D_LOD(name, pixel, lod) name.Load(int3(pixel, lod))
#define LOAD_TEXTURE3D_LOD(name, pixel, lod) name.Load(int4(pixel, lod))

#define TRANSFORM_TEX(uv, name) ((uv.xy) * name##_ST.xy + name##_ST.zw)

float Sq(float x)
{
    return x * x;
}

float3 SafeNormalize(float3 v)
{
    return v * rsqrt(max(HALF_MIN, dot(v, v)));
}

// Window coordinates in [0, 1] with y down, of a position under a view-projection matrix.
float2 ComputeNormalizedDeviceCoordinates(float3 position, float4x4 clipSpaceTransform)
{
    float4 clip = mul(clipSpaceTransform, float4(position, 1.0));
    return clip.xy / clip.w * float2(0.5, -0.5) + 0.5;
}

#endif
