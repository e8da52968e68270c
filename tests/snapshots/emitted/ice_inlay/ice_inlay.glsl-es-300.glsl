// Ice with an inlay: Leaves frozen into a sheet of ice: they lie below its surface, and the sun shines
// through around them.
// Made by sssgen for GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0). Change the material and emit it again rather than this file.
// Paste it below the #version and precision of your own shader.

precision highp sampler2D;

struct Surface {
    vec3 albedo;
    float metallic;
    float roughness;
    float transmittance;
};

const float FLAT_FRAME = 0.01;
const float OPAQUE_DISTANCE = 1.0e-6;
const float ENDLESS = 10000.0;
const float OPAQUE_DEPTH = 80.0;

// A texel within its range; 0 in place of NaN.
float valid_texel(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
}

// The direction of `x`; of a zero vector, 0.
vec3 safe_normalize(vec3 x) {
    return x * inversesqrt(max(dot(x, x), 1.0e-30));
}

// The components of `v` along unit T, unit B and N. A frame that spans no space gives (0, 0, dot(v, N)).
vec3 tangent_from_world(vec3 v, vec3 T, vec3 B, vec3 N) {
    float volume = dot(T, cross(B, N));
    if (abs(volume) < FLAT_FRAME) {
        return vec3(0.0, 0.0, dot(v, N));
    }
    vec3 along = vec3(dot(v, cross(B, N)) * length(T), dot(v, cross(N, T)) * length(B), dot(v, cross(T, B)));
    return along / volume;
}

// The texture coordinates where `ray`, going in, meets the inner layer.
vec2 slide(vec2 uv, vec3 ray, vec3 T, vec3 B, vec3 N, float depth, vec2 uv_per_unit) {
    vec3 r = tangent_from_world(ray, T, B, N);
    // to the surface itself, which a sheared frame does not lie in
    float cosine = -dot(ray, N);
    // 1 / cosine, but smoothly down to 0 where a grazing ray would slide without end
    float x = clamp(cosine / 0.2, 0.0, 1.0);
    float reciprocal = x * x * (4.0 - 3.0 * x) / max(cosine, 0.2);
    return uv + depth * reciprocal * uv_per_unit * r.xy;
}

// Subsurface parallax with refraction: the texture as if it were cast into resin, glass or ice.
vec2 parallax_refracted(vec2 uv, vec3 V, vec3 T, vec3 B, vec3 N, float ior, float depth, vec2 uv_per_unit) {
    vec3 facing = faceforward(N, -V, N);
    // past the critical angle refract() gives 0, which slides nothing
    vec3 ray = refract(-V, facing, 1.0 / ior);
    return slide(uv, ray, T, B, facing, depth, uv_per_unit);
}

// Thickness from a baked map, bright where the body is thick.
float thickness_map(vec2 uv, float thickness_factor, sampler2D thickness_texture) {
    return thickness_factor * valid_texel(texture(thickness_texture, uv).r);
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
void base_color(vec2 uv, out vec3 albedo, out float alpha, vec4 tint, sampler2D base_color_texture) {
    vec4 texel = tint * texture(base_color_texture, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
vec3 glow(float lobe, float through, vec3 subsurface_color, float scale, float ambient) {
    return subsurface_color * ((lobe * scale + ambient) * through);
}

// The back-light lobe of GDC 2011: the eye looks into light that comes through, bent by the normal.
vec3 lobe_gdc2011(vec3 V, vec3 N, vec3 L, float through, float distortion, vec3 subsurface_color,
    float scale, float ambient, float power) {
    vec3 bent = L + N * distortion;
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, scale, ambient);
}

// The standard light of plain targets: Lambert and GGX with metallic and roughness, for one light.
vec3 standard(vec3 N, vec3 V, vec3 L, vec3 albedo, float metallic, float roughness, vec3 light_color) {
    vec3 H = safe_normalize(V + L);
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 0.0001);
    float NoH = clamp(dot(N, H), 0.0, 1.0);
    float a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but exact where N and H nearly meet and a mirror has its peak; never below a^2
    vec3 across = cross(N, H);
    float spread = NoH > 0.0 ? max(dot(across, across) + NoH * NoH * (a * a), a * a) : 1.0;
    // D times pi
    float facets = a * a / (spread * spread);
    // masking and shadowing, over 4 dot(N, L) dot(N, V)
    float visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // nothing reflects more than all
    vec3 F0 = mix(vec3(0.04), min(albedo, 1.0), metallic);
    vec3 F = F0 + (1.0 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    vec3 diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    return (diffuse + facets * visible * F) * NoL * light_color;
}

// Everything about the surface that does not depend on a light.
Surface evaluate_surface(vec2 uv, vec3 V, vec3 T, vec3 B, vec3 N, float ior, float depth, vec2 uv_per_unit,
    float thickness_factor, sampler2D thickness_texture, float attenuation_distance, vec4 tint,
    sampler2D base_color_texture, float metalness, float surface_roughness) {
    uv = parallax_refracted(uv, V, T, B, N, ior, depth, uv_per_unit);
    float thickness = thickness_map(uv, thickness_factor, thickness_texture);
    float transmittance = beer_lambert(thickness, attenuation_distance);
    vec3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    return Surface(albedo, metallic, roughness, transmittance);
}

// What one light adds from behind, as a factor on its colour.
vec3 evaluate_translucency(Surface surface, vec3 V, vec3 N, vec3 L, float distortion, vec3 subsurface_color,
    float scale, float ambient, float power) {
    return lobe_gdc2011(V, N, L, surface.transmittance, distortion, subsurface_color, scale, ambient, power);
}

// What one light adds from the front.
vec3 evaluate_lighting(Surface surface, vec3 N, vec3 V, vec3 L, vec3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}
