#version 330 core
// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the material and emit it again rather than this file.

struct Surface {
    vec3 albedo;
    vec3 normal;
    float metallic;
    float roughness;
    float transmittance;
};

uniform vec4 tint;  // Multiplies the texture
uniform float normal_scale;  // How strong they are
uniform float metalness;  // 0 = not a metal, 1 = metal
uniform float surface_roughness;  // 0 = a mirror, 1 = chalk
uniform float distortion;  // How much the normal bends the light on its way through: 0 ignores the shape
uniform vec3 subsurface_color;  // Colour of the light that has passed through
uniform float scale;  // Strength of the glow towards the light
uniform float power;  // How tight the glow is around the light: the larger, the smaller the spot

uniform sampler2D thickness_texture;  // White = as thick as thickness_factor, black = nothing
uniform sampler2D base_color_texture;  // Colour of the surface (an sRGB texture), with its opacity in alpha
uniform sampler2D normal_texture;  // Tangent-space normals, y up (OpenGL's way)

// A texel within its range; 0 in place of NaN.
float valid_texel(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
}

// The direction of `x`; of a zero vector, 0.
vec3 safe_normalize(vec3 x) {
    return x * inversesqrt(max(dot(x, x), 1.0e-30));
}

// Thickness from a baked map, bright where the body is thick.
float thickness_map(vec2 uv) {
    return valid_texel(texture(thickness_texture, uv).r);
}

// Thickness to thinness, in a straight line.
float thinness_from_thickness(float d) {
    return clamp(1.0 - d, 0.0, 1.0);
}

// Colour and opacity from a texture and a tint.
void base_color(vec2 uv, out vec3 albedo, out float alpha) {
    vec4 texel = tint * texture(base_color_texture, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
vec3 blend_normals(vec3 base, vec3 detail) {
    return safe_normalize(vec3(base.xy + detail.xy, base.z * detail.z));
}

// Detail in the normal, from a texture.
void normal_map(vec2 uv, inout vec3 normal) {
    vec3 texel = texture(normal_texture, uv).rgb * 2.0 - 1.0;
    normal = blend_normals(normal, vec3(texel.xy * normal_scale, texel.z));
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
vec3 glow(float lobe, float through) {
    return subsurface_color * (lobe * scale * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
vec3 lobe_normalized(vec3 V, vec3 N, vec3 L, float through) {
    vec3 bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through);
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
Surface evaluate_surface(vec2 uv) {
    float thickness = thickness_map(uv);
    float thinness = thinness_from_thickness(thickness);
    float transmittance = thinness;
    vec3 albedo;
    float alpha;
    base_color(uv, albedo, alpha);
    vec3 normal = vec3(0.0, 0.0, 1.0);
    normal_map(uv, normal);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness);
    return Surface(albedo, normal, metallic, roughness, transmittance);
}

// What one light adds from behind, as a factor on its colour.
vec3 evaluate_translucency(Surface surface, vec3 V, vec3 N, vec3 L) {
    return lobe_normalized(V, N, L, surface.transmittance);
}

// What one light adds from the front.
vec3 evaluate_lighting(Surface surface, vec3 N, vec3 V, vec3 L, vec3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

uniform vec3 camera_position;
const int MAX_LIGHTS = 4;
uniform int light_count;
uniform vec4 light_positions[MAX_LIGHTS];  // w = 1: where the light is; w = 0: the direction towards it
uniform vec3 light_colors[MAX_LIGHTS];
uniform vec3 ambient_color;

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
out vec4 fragment_color;

// v / |v|; 0 stays 0, of which normalize makes NaN.
vec3 unit_vector(vec3 v) {
    float square = dot(v, v);
    return square > 1e-30 ? v * inversesqrt(square) : vec3(0.0);
}

void main() {
    vec3 V = unit_vector(camera_position - v_position);
    vec3 N = unit_vector(v_normal);
    vec3 T = unit_vector(v_tangent.xyz);
    vec3 B = cross(N, T) * v_tangent.w;
    Surface surface = evaluate_surface(v_uv);
    N = unit_vector(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);

    vec3 color = ambient_color * surface.albedo;
    for (int i = 0; i < min(light_count, MAX_LIGHTS); i++) {
        vec3 to_light = light_positions[i].xyz - v_position * light_positions[i].w;
        float distance_squared = max(dot(to_light, to_light), 1e-4);
        vec3 L = to_light * inversesqrt(distance_squared);
        vec3 light_color = light_colors[i] * mix(1.0, 1.0 / distance_squared, light_positions[i].w);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, V, N, L) * light_color;
    }
    fragment_color = vec4(color, 1.0);
}
