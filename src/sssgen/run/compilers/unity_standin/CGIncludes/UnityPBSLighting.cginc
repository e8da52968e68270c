// Stand-in (see ../README.md): the standard lighting model.
#ifndef SSSGEN_STANDIN_PBS_LIGHTING
#define SSSGEN_STANDIN_PBS_LIGHTING
#include "UnityCG.cginc"
#include "UnityLightingCommon.cginc"
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/StandardLight.hlsl"

struct SurfaceOutputStandard
{
    fixed3 Albedo;
    float3 Normal;
    half3 Emission;
    half Metallic;
    half Smoothness;
    half Occlusion;
    fixed Alpha;
};

UnityGI UnityGlobalIllumination(UnityGIInput data, half occlusion, half3 normal)
{
    UnityGI gi;
    gi.light = data.light;
    gi.light.color *= data.atten;
    gi.indirect.diffuse = (data.ambient + ShadeSH9(half4(normal, 1.0))) * occlusion;
    gi.indirect.specular = 0.0;
    return gi;
}

#define UNITY_GI(x, s, data) x = UnityGlobalIllumination(data, s.Occlusion, s.Normal);

half4 LightingStandard(SurfaceOutputStandard s, float3 viewDir, UnityGI gi)
{
    float3 normal = normalize(s.Normal);
    half3 direct = standin_standard(normal, viewDir, gi.light.dir, s.Albedo, s.Metallic, 1.0 - s.Smoothness);
    return half4(s.Albedo * gi.indirect.diffuse + direct * gi.light.color + gi.indirect.specular, s.Alpha);
}

struct SurfaceOutputStandardSpecular
{
    fixed3 Albedo;
    fixed3 Specular;
    float3 Normal;
    half3 Emission;
    half Smoothness;
    half Occlusion;
    fixed Alpha;
};

half4 LightingStandardSpecular(SurfaceOutputStandardSpecular s, float3 viewDir, UnityGI gi)
{
    float3 normal = normalize(s.Normal);
    half3 direct = standin_layered(normal, viewDir, gi.light.dir, s.Albedo, s.Specular, 1.0 - s.Smoothness, 0.0, 0.0);
    return half4(s.Albedo * gi.indirect.diffuse + direct * gi.light.color + gi.indirect.specular, s.Alpha);
}

void LightingStandardSpecular_GI(SurfaceOutputStandardSpecular s, UnityGIInput data, inout UnityGI gi)
{
    UNITY_GI(gi, s, data);
}

void LightingStandard_GI(SurfaceOutputStandard s, UnityGIInput data, inout UnityGI gi)
{
    UNITY_GI(gi, s, data);
}

#endif
