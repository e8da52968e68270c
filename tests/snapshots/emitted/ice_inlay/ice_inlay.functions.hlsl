// Ice with an inlay: Leaves frozen into a sheet of ice: they lie below its surface, and the sun shines
// through around them.
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the material and emit it again rather than this file.
#ifndef ICE_INLAY_HLSL_INCLUDED
#define ICE_INLAY_HLSL_INCLUDED

struct Surface {
    float3 albedo;
    float metallic;
    float roughness;
    float transmittance;
};

static const float FLAT_FRAME = 0.01;
static const float OPAQUE_DISTANCE = 1.0e-6;
static const float ENDLESS = 10000.0;
static const float OPAQUE_DEPTH = 80.0;

// A texel within its range; 0 in place of NaN.
float valid_texel(float x) {
    return (asuint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
}

// The direction of `x`; of a zero vector, 0.
float3 safe_normalize(float3 x) {
    return x * rsqrt(max(dot(x, x), 1.0e-30));
}

// The components of `v` along unit T, unit B and N. A frame that spans no space gives (0, 0, dot(v, N)).
float3 tangent_from_world(float3 v, float3 T, float3 B, float3 N) {
    float volume = dot(T, cross(B, N));
    if (abs(volume) < FLAT_FRAME) {
        return float3(0.0, 0.0, dot(v, N));
    }
    float3 along = float3(dot(v, cross(B, N)) * length(T), dot(v, cross(N, T)) * length(B),
        dot(v, cross(T, B)));
    return along / volume;
}

// The texture coordinates where `ray`, going in, meets the inner layer.
float2 slide(float2 uv, float3 ray, float3 T, float3 B, float3 N, float depth, float2 uv_per_unit) {
    float3 r = tangent_from_world(ray, T, B, N);
    // to the surface itself, which a sheared frame does not lie in
    float cosine = -dot(ray, N);
    // 1 / cosine, but smoothly down to 0 where a grazing ray would slide without end
    float x = clamp(cosine / 0.2, 0.0, 1.0);
    float reciprocal = x * x * (4.0 - 3.0 * x) / max(cosine, 0.2);
    return uv + depth * reciprocal * uv_per_unit * r.xy;
}

// Subsurface parallax with refraction: the texture as if it were cast into resin, glass or ice.
float2 parallax_refracted(float2 uv, float3 V, float3 T, float3 B, float3 N, float ior, float depth,
    float2 uv_per_unit) {
    float3 facing = faceforward(N, -V, N);
    // past the critical angle refract() gives 0, which slides nothing
    float3 ray = refract(-V, facing, 1.0 / ior);
    return slide(uv, ray, T, B, facing, depth, uv_per_unit);
}

// Thickness from a baked map, bright where the body is thick.
float thickness_map(float2 uv, float thickness_factor, Texture2D thickness_texture,
    SamplerState thickness_texture_sampler) {
    return thickness_factor * valid_texel(thickness_texture.Sample(thickness_texture_sampler, uv).r);
}

// `d` in mean free paths, 0 or more.
float optical_depth(float d, float mean_free_path) {
    float path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Thickness to transmittance: what absorption leaves of the light.
float beer_lambert(float d, float attenuation_distance) {
    return exp(-min(optical_depth(d, attenuation_distance), OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint, Texture2D base_color_texture,
    SamplerState base_color_texture_sampler) {
    float4 texel = tint * base_color_texture.Sample(base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
float3 glow(float lobe, float through, float3 subsurface_color, float scale, float ambient) {
    return subsurface_color * ((lobe * scale + ambient) * through);
}

// The back-light lobe of GDC 2011: the eye looks into light that comes through, bent by the normal.
float3 lobe_gdc2011(float3 V, float3 N, float3 L, float through, float distortion, float3 subsurface_color,
    float scale, float ambient, float power) {
    float3 bent = L + N * distortion;
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, scale, ambient);
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
Surface evaluate_surface(float2 uv, float3 V, float3 T, float3 B, float3 N, float ior, float depth,
    float2 uv_per_unit, float thickness_factor, Texture2D thickness_texture,
    SamplerState thickness_texture_sampler, float attenuation_distance, float4 tint,
    Texture2D base_color_texture, SamplerState base_color_texture_sampler, float metalness,
    float surface_roughness) {
    uv = parallax_refracted(uv, V, T, B, N, ior, depth, uv_per_unit);
    float thickness = thickness_map(uv, thickness_factor, thickness_texture, thickness_texture_sampler);
    float transmittance = beer_lambert(thickness, attenuation_distance);
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture, base_color_texture_sampler);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    Surface surface = { albedo, metallic, roughness, transmittance };
    return surface;
}

// What one light adds from behind, as a factor on its colour.
float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L, float distortion,
    float3 subsurface_color, float scale, float ambient, float power) {
    return lobe_gdc2011(V, N, L, surface.transmittance, distortion, subsurface_color, scale, ambient, power);
}

// What one light adds from the front.
float3 evaluate_lighting(Surface surface, float3 N, float3 V, float3 L, float3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

#endif
