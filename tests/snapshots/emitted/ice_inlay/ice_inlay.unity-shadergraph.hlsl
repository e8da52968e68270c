// Ice with an inlay: Leaves frozen into a sheet of ice: they lie below its surface, and the sun shines
// through around them.
// Made by sssgen for Unity Shader Graph, Custom Function. Change the material and emit it again rather than this file.
// A Custom Function node of Type "File": Name IceInlay, Source this file, and these ports in this order.
//   uv: UV
//   P: Position, World
//   N: Normal Vector, World
//   T: Tangent Vector, World
//   B: Bitangent Vector, World
//   V: View Direction, World
// The rest are properties of the graph. The _half entry has the same ports and computes in float.
#ifndef ICE_INLAY_UNITY_SHADERGRAPH_INCLUDED
#define ICE_INLAY_UNITY_SHADERGRAPH_INCLUDED

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
float thickness_map(float2 uv, float thickness_factor, UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler) {
    return thickness_factor
        * valid_texel(SAMPLE_TEXTURE2D(thickness_texture, thickness_texture_sampler, uv).r);
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
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint,
    UnityTexture2D base_color_texture, UnitySamplerState base_color_texture_sampler) {
    float4 texel = tint * SAMPLE_TEXTURE2D(base_color_texture, base_color_texture_sampler, uv);
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

// Everything about the surface that does not depend on a light.
Surface evaluate_surface(float2 uv, float3 V, float3 T, float3 B, float3 N, float ior, float depth,
    float2 uv_per_unit, float thickness_factor, UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler, float attenuation_distance, float4 tint,
    UnityTexture2D base_color_texture, UnitySamplerState base_color_texture_sampler, float metalness,
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

// v / |v|; 0 stays 0, of which normalize makes NaN.
float3 unit_vector(float3 v) {
    float square = dot(v, v);
    return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
}

void IceInlay_float(
    float2 uv,
    float3 P,
    float3 N,
    float3 T,
    float3 B,
    float3 V,
    float ior,
    float depth,
    float2 uv_per_unit,
    float thickness_factor,
    float attenuation_distance,
    float4 tint,
    float metalness,
    float surface_roughness,
    float distortion,
    float3 subsurface_color,
    float scale,
    float ambient,
    float power,
    UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    out float3 BaseColor,
    out float3 NormalTS,
    out float Metallic,
    out float Smoothness,
    out float Occlusion,
    out float3 Emission,
    out float Alpha) {
    V = unit_vector(V);
    N = unit_vector(N);
    Surface surface = evaluate_surface(uv, V, T, B, N, ior, depth, uv_per_unit, thickness_factor, thickness_texture, thickness_texture_sampler, attenuation_distance, tint, base_color_texture, base_color_texture_sampler, metalness, surface_roughness);
    BaseColor = surface.albedo;
    NormalTS = float3(0.0, 0.0, 1.0);
    Metallic = surface.metallic;
    Smoothness = 1.0 - surface.roughness;
    Occlusion = 1.0;
    Emission = 0.0;
    Alpha = 1.0;

    // Goes to Emission, without shadow: light that comes through entered on the far side, in the object's own shadow.
#if defined(SHADERGRAPH_PREVIEW)
    float3 L = normalize(float3(0.5, 0.5, -0.5));
    float3 light_color = 1.0;
    Emission += evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, ambient, power) * light_color;
#else
    Light light = GetMainLight();
    float3 L = light.direction;
    float3 light_color = light.color * light.distanceAttenuation;
    Emission += evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, ambient, power) * light_color;
#if defined(_ADDITIONAL_LIGHTS)
    InputData inputData = (InputData)0;
    inputData.positionWS = P;
    inputData.normalizedScreenSpaceUV = ComputeNormalizedDeviceCoordinates(P, GetWorldToHClipMatrix());
    uint light_count = GetAdditionalLightsCount();
    LIGHT_LOOP_BEGIN(light_count)
        light = GetAdditionalLight(lightIndex, P);
        L = light.direction;
        light_color = light.color * light.distanceAttenuation;
        Emission += evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, ambient, power) * light_color;
    LIGHT_LOOP_END
#endif
#endif
}

void IceInlay_half(
    half2 uv,
    half3 P,
    half3 N,
    half3 T,
    half3 B,
    half3 V,
    half ior,
    half depth,
    half2 uv_per_unit,
    half thickness_factor,
    half attenuation_distance,
    half4 tint,
    half metalness,
    half surface_roughness,
    half distortion,
    half3 subsurface_color,
    half scale,
    half ambient,
    half power,
    UnityTexture2D thickness_texture,
    UnitySamplerState thickness_texture_sampler,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    out half3 BaseColor,
    out half3 NormalTS,
    out half Metallic,
    out half Smoothness,
    out half Occlusion,
    out half3 Emission,
    out half Alpha) {
    IceInlay_float(uv, P, N, T, B, V, ior, depth, uv_per_unit, thickness_factor, attenuation_distance, tint, metalness, surface_roughness, distortion, subsurface_color, scale, ambient, power, thickness_texture, thickness_texture_sampler, base_color_texture, base_color_texture_sampler, BaseColor, NormalTS, Metallic, Smoothness, Occlusion, Emission, Alpha);
}

#endif
