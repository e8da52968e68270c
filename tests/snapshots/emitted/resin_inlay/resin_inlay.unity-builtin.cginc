// Resin inlay: A picture under two centimetres of clear resin: it moves with the eye as if it lay
// below.
// Made by sssgen for Unity, built-in pipeline (surface shader). Change the material and emit it again rather than this file.
// #include it after UnityCG.cginc.
#ifndef RESIN_INLAY_UNITY_BUILTIN_INCLUDED
#define RESIN_INLAY_UNITY_BUILTIN_INCLUDED

struct Surface {
    float3 albedo;
    float metallic;
    float roughness;
};

static const float FLAT_FRAME = 0.01;

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

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint, sampler2D base_color_texture) {
    float4 texel = tint * tex2D(base_color_texture, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// Everything about the surface that does not depend on a light.
Surface evaluate_surface(float2 uv, float3 V, float3 T, float3 B, float3 N, float ior, float depth,
    float2 uv_per_unit, float4 tint, sampler2D base_color_texture, float metalness, float surface_roughness) {
    uv = parallax_refracted(uv, V, T, B, N, ior, depth, uv_per_unit);
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    Surface surface = { albedo, metallic, roughness };
    return surface;
}

#endif
