// Stand-in (see the README above): the engine's matrices and positions, and what converts between spaces.
#ifndef SSSGEN_STANDIN_SPACE_TRANSFORMS
#define SSSGEN_STANDIN_SPACE_TRANSFORMS
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Common.hlsl"

float4x4 unity_ObjectToWorld;
float4x4 unity_WorldToObject;
float4 unity_WorldTransformParams;  // w: the sign of the object's scale
float4x4 unity_MatrixV;
float4x4 unity_MatrixVP;
float3 _WorldSpaceCameraPos;
float4 _ProjectionParams;
float4 _ScreenParams;
float4 _ScaledScreenParams;
float4 _Time;

#define UNITY_MATRIX_M unity_ObjectToWorld
#define UNITY_MATRIX_I_M unity_WorldToObject
#define UNITY_MATRIX_V unity_MatrixV
#define UNITY_MATRIX_VP unity_MatrixVP

float3 GetAbsolutePositionWS(float3 positionRWS)
{
    return positionRWS;
}

float4x4 GetObjectToWorldMatrix()
{
    return UNITY_MATRIX_M;
}

float4x4 GetWorldToObjectMatrix()
{
    return UNITY_MATRIX_I_M;
}

float4x4 GetWorldToHClipMatrix()
{
    return UNITY_MATRIX_VP;
}

real GetOddNegativeScale()
{
    return unity_WorldTransformParams.w >= 0.0 ? 1.0 : -1.0;
}

float3 TransformObjectToWorld(float3 positionOS)
{
    return mul(GetObjectToWorldMatrix(), float4(positionOS, 1.0)).xyz;
}

float3 TransformWorldToObject(float3 positionWS)
{
    return mul(GetWorldToObjectMatrix(), float4(positionWS, 1.0)).xyz;
}

float4 TransformWorldToHClip(float3 positionWS)
{
    return mul(GetWorldToHClipMatrix(), float4(positionWS, 1.0));
}

float4 TransformObjectToHClip(float3 positionOS)
{
    return TransformWorldToHClip(TransformObjectToWorld(positionOS));
}

float3 TransformObjectToWorldDir(float3 dirOS, bool doNormalize = true)
{
    float3 dir = mul((float3x3)GetObjectToWorldMatrix(), dirOS);
    return doNormalize ? SafeNormalize(dir) : dir;
}

float3 TransformWorldToObjectDir(float3 dirWS, bool doNormalize = true)
{
    float3 dir = mul((float3x3)GetWorldToObjectMatrix(), dirWS);
    return doNormalize ? normalize(dir) : dir;
}

float3 TransformObjectToWorldNormal(float3 normalOS, bool doNormalize = true)
{
    float3 normal = mul(normalOS, (float3x3)GetWorldToObjectMatrix());
    return doNormalize ? SafeNormalize(normal) : normal;
}

float3 TransformWorldToObjectNormal(float3 normalWS, bool doNormalize = true)
{
    float3 normal = mul(normalWS, (float3x3)GetObjectToWorldMatrix());
    return doNormalize ? SafeNormalize(normal) : normal;
}

real3 TransformTangentToWorld(float3 dirTS, real3x3 tangentToWorld)
{
    return mul(dirTS, tangentToWorld);
}

real3 TransformWorldToTangent(real3 dirWS, real3x3 tangentToWorld)
{
    return mul(tangentToWorld, dirWS);
}

#endif
