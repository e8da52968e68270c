// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the material and emit it again rather than this file.
#ifndef PAPER_LANTERN_HLSL_INCLUDED
#define PAPER_LANTERN_HLSL_INCLUDED

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
float thickness_map(float2 uv, Texture2D thickness_texture, SamplerState thickness_texture_sampler) {
    return valid_texel(thickness_texture.Sample(thickness_texture_sampler, uv).r);
}

// Thickness to thinness, in a straight line.
float thinness_from_thickness(float d) {
    return clamp(1.0 - d, 0.0, 1.0);
}

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint, Texture2D base_color_texture,
    SamplerState base_color_texture_sampler) {
    float4 texel = tint * base_color_texture.Sample(base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
float3 blend_normals(float3 base, float3 detail) {
    return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
}

// Detail in the normal, from a texture.
void normal_map(float2 uv, inout float3 normal, Texture2D normal_texture,
    SamplerState normal_texture_sampler, float normal_scale) {
    float3 texel = normal_texture.Sample(normal_texture_sampler, uv).rgb * 2.0 - 1.0;
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

// The standard light of plain targets: Lambert and GGX with metallic and roughness, for one light.
float3 standard(float3 N, float3 V, float3 L, float3 albedo, float metallic, float roughness,
    float3 light_color) {
    float3 H = safe_normalize(V + L);
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 0.0001);
    float NoH = clamp(dot(N, H), 0.0, 1.0);
    float a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but exact where N and H nearly meet and a mirror has its peak; never below a^2
    float3 across = cross(N, H);
    float spread = NoH > 0.0 ? max(dot(across, across) + NoH * NoH * (a * a), a * a) : 1.0;
    // D times pi
    float facets = a * a / (spread * spread);
    // masking and shadowing, over 4 dot(N, L) dot(N, V)
    float visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // nothing reflects more than all
    float3 F0 = lerp((float3)0.04, min(albedo, 1.0), metallic);
    float3 F = F0 + (1.0 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    float3 diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    return (diffuse + facets * visible * F) * NoL * light_color;
}

// Everything about the surface that does not depend on a light.
Surface evaluate_surface(float2 uv, Texture2D thickness_texture, SamplerState thickness_texture_sampler,
    float4 tint, Texture2D base_color_texture, SamplerState base_color_texture_sampler,
    Texture2D normal_texture, SamplerState normal_texture_sampler, float normal_scale, float metalness,
    float surface_roughness) {
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

// What one light adds from the front.
float3 evaluate_lighting(Surface surface, float3 N, float3 V, float3 L, float3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

#endif
