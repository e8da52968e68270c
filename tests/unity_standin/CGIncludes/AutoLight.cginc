// Stand-in (see ../README.md): shadows and attenuation.
#ifndef SSSGEN_STANDIN_AUTO_LIGHT
#define SSSGEN_STANDIN_AUTO_LIGHT

#define UNITY_SHADOW_COORDS(index) float4 _ShadowCoord : TEXCOORD##index;
#define UNITY_TRANSFER_SHADOW(output, uv)
#define UNITY_LIGHT_ATTENUATION(name, input, worldPos) fixed name = saturate(1.0 - input._ShadowCoord.z);

#endif
