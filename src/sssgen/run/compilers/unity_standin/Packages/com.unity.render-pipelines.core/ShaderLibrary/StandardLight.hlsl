// Stand-in (see the README above): this project's own standard light (techniques/lighting/standard.sss), for both pipelines.
// Unity's differs a little; with this one a picture is the same as that of the other targets' shells.
#ifndef SSSGEN_STANDIN_STANDARD_LIGHT
#define SSSGEN_STANDIN_STANDARD_LIGHT

// What a light of colour 1 gives; all directions are unit and in world space. `F0` is the reflection at the normal.
float3 standin_layered(
    float3 N, float3 V, float3 L, float3 diffuse, float3 F0, float roughness, float coat, float coat_roughness)
{
    float3 H = (V + L) * rsqrt(max(dot(V + L, V + L), 1e-30));
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 1.0e-4);
    float NoH = saturate(dot(N, H));
    float a = max(roughness, 0.045) * max(roughness, 0.045);
    float3 across = cross(N, H);
    float spread = NoH > 0.0 ? dot(across, across) + NoH * NoH * (a * a) : 1.0;
    float facets = a * a / (spread * spread);
    float visible = 0.5 / lerp(2.0 * NoL * NoV, NoL + NoV, a);
    float3 F = F0 + (1.0 - F0) * pow(1.0 - saturate(dot(V, H)), 5.0);
    float b = max(coat_roughness, 0.045) * max(coat_roughness, 0.045);
    float coat_spread = NoH > 0.0 ? dot(across, across) + NoH * NoH * (b * b) : 1.0;
    float coat_light = b * b / (coat_spread * coat_spread) * 0.5 / lerp(2.0 * NoL * NoV, NoL + NoV, b);
    float veil = coat * (0.04 + 0.96 * pow(1.0 - saturate(dot(V, H)), 5.0));
    return ((diffuse * (1.0 - F) + facets * visible * F) * (1.0 - veil) + veil * coat_light) * NoL;
}

float3 standin_standard(float3 N, float3 V, float3 L, float3 albedo, float metallic, float roughness)
{
    float3 F0 = lerp((float3)0.04, albedo, metallic);
    return standin_layered(N, V, L, albedo * (1.0 - metallic), F0, roughness, 0.0, 0.0);
}

#endif
