// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for Unity Shader Graph, Custom Function. Change the material and emit it again rather than this file.
// Call these from Custom Function nodes of your own; they need no more than Unity's texture types.
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

#endif
