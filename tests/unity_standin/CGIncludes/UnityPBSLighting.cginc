// Stand-in (see ../README.md): the standard lighting model.
#ifndef SSSGEN_STANDIN_PBS_LIGHTING
#define SSSGEN_STANDIN_PBS_LIGHTING
#include "UnityCG.cginc"
#include "UnityLightingCommon.cginc"

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
    half3 diffuse = gi.light.color * saturate(dot(s.Normal, gi.light.dir)) + gi.indirect.diffuse;
    half sheen = saturate(dot(s.Normal, normalize(viewDir + gi.light.dir))) * s.Smoothness * s.Metallic;
    return half4(s.Albedo * diffuse + sheen * gi.light.color + gi.indirect.specular, s.Alpha);
}

void LightingStandard_GI(SurfaceOutputStandard s, UnityGIInput data, inout UnityGI gi)
{
    UNITY_GI(gi, s, data);
}

#endif
