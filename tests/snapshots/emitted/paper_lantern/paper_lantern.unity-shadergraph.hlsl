// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for Unity Shader Graph, Custom Function. Change the material and emit it again rather than this file.
// A Custom Function node of Type "File": Name PaperLantern, Source this file, and these ports in this order.
//   uv: UV
//   P: Position, World
//   N: Normal Vector, World
//   T: Tangent Vector, World
//   B: Bitangent Vector, World
//   V: View Direction, World
// The rest are properties of the graph. The _half entry has the same ports and computes in float.
#ifndef PAPER_LANTERN_UNITY_SHADERGRAPH_INCLUDED
#define PAPER_LANTERN_UNITY_SHADERGRAPH_INCLUDED

struct Surface {
    float3 albedo;
    float3 normal;
    float metallic;
    float roughness;
    float transmittance;
};

// A texel within its range; 0 in place of NaN.
float valid_texel(float x) {
    return (asuint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
}

// The direction of `x`; of a zero vector, 0.
float3 safe_normalize(float3 x) {
    return x * rsqrt(max(dot(x, x), 1.0e-30));
}

// Thickness from a baked map, bright where the body is thick.
float thickness_map(float2 uv, UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler) {
    return valid_texel(SAMPLE_TEXTURE2D(thickness_texture, thickness_texture_sampler, uv).r);
}

// Thickness to thinness, in a straight line.
float thinness_from_thickness(float d) {
    return clamp(1.0 - d, 0.0, 1.0);
}

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint,
    UnityTexture2D base_color_texture, UnitySamplerState base_color_texture_sampler) {
    float4 texel = tint * SAMPLE_TEXTURE2D(base_color_texture, base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
float3 blend_normals(float3 base, float3 detail) {
    return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
}

// Detail in the normal, from a texture.
void normal_map(float2 uv, inout float3 normal, UnityTexture2D normal_texture,
    UnitySamplerState normal_texture_sampler, float normal_scale) {
    float3 texel = UnpackNormal(SAMPLE_TEXTURE2D(normal_texture, normal_texture_sampler, uv));
    normal = blend_normals(normal, float3(texel.xy * normal_scale, texel.z));
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
float3 glow(float lobe, float through, float3 subsurface_color, float scale) {
    return subsurface_color * (lobe * scale * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
float3 lobe_normalized(float3 V, float3 N, float3 L, float through, float distortion,
    float3 subsurface_color, float scale, float power) {
    float3 bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, scale);
}

// Everything about the surface that does not depend on a light.
Surface evaluate_surface(float2 uv, UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler, float4 tint, UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler, UnityTexture2D normal_texture,
    UnitySamplerState normal_texture_sampler, float normal_scale, float metalness, float surface_roughness) {
    float thickness = thickness_map(uv, thickness_texture, thickness_texture_sampler);
    float thinness = thinness_from_thickness(thickness);
    float transmittance = thinness;
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture, base_color_texture_sampler);
    float3 normal = float3(0.0, 0.0, 1.0);
    normal_map(uv, normal, normal_texture, normal_texture_sampler, normal_scale);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    Surface surface = { albedo, normal, metallic, roughness, transmittance };
    return surface;
}

// What one light adds from behind, as a factor on its colour.
float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L, float distortion,
    float3 subsurface_color, float scale, float power) {
    return lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, scale, power);
}

// v / |v|; 0 stays 0, of which normalize makes NaN.
float3 unit_vector(float3 v) {
    float square = dot(v, v);
    return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
}

void PaperLantern_float(
    float2 uv,
    float3 P,
    float3 N,
    float3 T,
    float3 B,
    float3 V,
    float4 tint,
    float normal_scale,
    float metalness,
    float surface_roughness,
    float distortion,
    float3 subsurface_color,
    float scale,
    float power,
    UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    UnityTexture2D normal_texture,
    UnitySamplerState normal_texture_sampler,
    out float3 BaseColor,
    out float3 NormalTS,
    out float Metallic,
    out float Smoothness,
    out float Occlusion,
    out float3 Emission,
    out float Alpha) {
    V = unit_vector(V);
    N = unit_vector(N);
    Surface surface = evaluate_surface(uv, thickness_texture, thickness_texture_sampler, tint, base_color_texture, base_color_texture_sampler, normal_texture, normal_texture_sampler, normal_scale, metalness, surface_roughness);
    N = unit_vector(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);
    BaseColor = surface.albedo;
    NormalTS = surface.normal;
    Metallic = surface.metallic;
    Smoothness = 1.0 - surface.roughness;
    Occlusion = 1.0;
    Emission = 0.0;
    Alpha = 1.0;

    // Goes to Emission, without shadow: light that comes through entered on the far side, in the object's own shadow.
#if defined(SHADERGRAPH_PREVIEW)
    float3 L = normalize(float3(0.5, 0.5, -0.5));
    float3 light_color = 1.0;
    Emission += evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, power) * light_color;
#else
    Light light = GetMainLight();
    float3 L = light.direction;
    float3 light_color = light.color * light.distanceAttenuation;
    Emission += evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, power) * light_color;
#if defined(_ADDITIONAL_LIGHTS)
    InputData inputData = (InputData)0;
    inputData.positionWS = P;
    inputData.normalizedScreenSpaceUV = ComputeNormalizedDeviceCoordinates(P, GetWorldToHClipMatrix());
    uint light_count = GetAdditionalLightsCount();
    LIGHT_LOOP_BEGIN(light_count)
        light = GetAdditionalLight(lightIndex, P);
        L = light.direction;
        light_color = light.color * light.distanceAttenuation;
        Emission += evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, power) * light_color;
    LIGHT_LOOP_END
#endif
#endif
}

void PaperLantern_half(
    half2 uv,
    half3 P,
    half3 N,
    half3 T,
    half3 B,
    half3 V,
    half4 tint,
    half normal_scale,
    half metalness,
    half surface_roughness,
    half distortion,
    half3 subsurface_color,
    half scale,
    half power,
    UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    UnityTexture2D normal_texture,
    UnitySamplerState normal_texture_sampler,
    out half3 BaseColor,
    out half3 NormalTS,
    out half Metallic,
    out half Smoothness,
    out half Occlusion,
    out half3 Emission,
    out half Alpha) {
    PaperLantern_float(uv, P, N, T, B, V, tint, normal_scale, metalness, surface_roughness, distortion, subsurface_color, scale, power, thickness_texture, thickness_texture_sampler, base_color_texture, base_color_texture_sampler, normal_texture, normal_texture_sampler, BaseColor, NormalTS, Metallic, Smoothness, Occlusion, Emission, Alpha);
}

#endif
