// Stand-in (see ../README.md): what the engine sets for every shader.
#ifndef SSSGEN_STANDIN_SHADER_VARIABLES
#define SSSGEN_STANDIN_SHADER_VARIABLES
#include "HLSLSupport.cginc"

float4 _Time;
float4 _SinTime;
float4 _CosTime;
float3 _WorldSpaceCameraPos;
float4 _ProjectionParams;
float4 _ScreenParams;
float4 _ZBufferParams;
float4 _WorldSpaceLightPos0;
float4x4 unity_ObjectToWorld;
float4x4 unity_WorldToObject;
float4 unity_WorldTransformParams;  // w: the sign of the object's scale
float4x4 unity_MatrixV;
float4x4 unity_MatrixVP;
float4 unity_FogColor;
float4 unity_FogParams;
float4 unity_SHAr, unity_SHAg, unity_SHAb;
float4 unity_SpecCube0_HDR;
float4 unity_SpecCube1_HDR;

#define UNITY_MATRIX_M unity_ObjectToWorld
#define UNITY_MATRIX_V unity_MatrixV
#define UNITY_MATRIX_VP unity_MatrixVP
#define UNITY_LIGHTMODEL_AMBIENT float4(unity_SHAr.w, unity_SHAg.w, unity_SHAb.w, 1.0)

#endif
