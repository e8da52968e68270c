// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Matrices are column-major (HLSL's default) and multiply columns: mul(M, v).

struct Surface {
    float3 albedo;
    float3 normal;
    float metallic;
    float roughness;
    float transmittance;
};

cbuffer Material : register(b3) {
    float4 tint;  // Multiplies the texture
    float normal_scale;  // How strong they are
    float metalness;  // 0 = not a metal, 1 = metal
    float surface_roughness;  // 0 = a mirror, 1 = chalk
    float distortion;  // How much the normal bends the light on its way through: 0 ignores the shape
    float3 subsurface_color;  // Colour of the light that has passed through
    float scale;  // Strength of the glow towards the light
    float power;  // How tight the glow is around the light: the larger, the smaller the spot
};

Texture2D thickness_texture : register(t0);
SamplerState thickness_texture_sampler : register(s0);
Texture2D base_color_texture : register(t1);
SamplerState base_color_texture_sampler : register(s1);
Texture2D normal_texture : register(t2);
SamplerState normal_texture_sampler : register(s2);

// A texel within its range; 0 in place of NaN.
float valid_texel(float x) {
    return (asuint(x) & 0x7fffffffu) > 0x7f800000u ? 0.0 : clamp(x, 0.0, 1.0);
}

// The direction of `x`; of a zero vector, 0.
float3 safe_normalize(float3 x) {
    return x * rsqrt(max(dot(x, x), 1.0e-30));
}

// Thickness from a baked map, bright where the body is thick.
float thickness_map(float2 uv) {
    return valid_texel(thickness_texture.Sample(thickness_texture_sampler, uv).r);
}

// Thickness to thinness, in a straight line.
float thinness_from_thickness(float d) {
    return clamp(1.0 - d, 0.0, 1.0);
}

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha) {
    float4 texel = tint * base_color_texture.Sample(base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
float3 blend_normals(float3 base, float3 detail) {
    return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
}

// Detail in the normal, from a texture.
void normal_map(float2 uv, inout float3 normal) {
    float3 texel = normal_texture.Sample(normal_texture_sampler, uv).rgb * 2.0 - 1.0;
    normal = blend_normals(normal, float3(texel.xy * normal_scale, texel.z));
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
float3 glow(float lobe, float through) {
    return subsurface_color * (lobe * scale * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
float3 lobe_normalized(float3 V, float3 N, float3 L, float through) {
    float3 bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through);
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
Surface evaluate_surface(float2 uv) {
    float thickness = thickness_map(uv);
    float thinness = thinness_from_thickness(thickness);
    float transmittance = thinness;
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha);
    float3 normal = float3(0.0, 0.0, 1.0);
    normal_map(uv, normal);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness);
    Surface surface = { albedo, normal, metallic, roughness, transmittance };
    return surface;
}

// What one light adds from behind, as a factor on its colour.
float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L) {
    return lobe_normalized(V, N, L, surface.transmittance);
}

// What one light adds from the front.
float3 evaluate_lighting(Surface surface, float3 N, float3 V, float3 L, float3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

cbuffer Camera : register(b0) {
    float4x4 view_projection;
    float4x4 inverse_view_projection;
    float3 camera_position;
    float time;  // s
};

static const int MAX_LIGHTS = 4;

cbuffer Lights : register(b1) {
    float3 ambient_color;
    int light_count;
    float4 light_positions[MAX_LIGHTS];  // w = 1: where the light is; w = 0: the direction towards it
    float4 light_colors[MAX_LIGHTS];
};

cbuffer Object : register(b2) {
    float4x4 model;
    float4x4 inverse_model;
};

struct VertexInput {
    float3 position : POSITION;
    float3 normal : NORMAL;
    float4 tangent : TANGENT;  // w: handedness, +1 or -1
    float2 uv : TEXCOORD0;
};

struct Varyings {
    float4 clip_position : SV_Position;
    float3 position : POSITION;
    float3 normal : NORMAL;
    float4 tangent : TANGENT;
    float2 uv : TEXCOORD0;
};

Varyings vertex_main(VertexInput input) {
    float4 world_position = mul(model, float4(input.position, 1.0));
    Varyings output;
    output.clip_position = mul(view_projection, world_position);
    output.position = world_position.xyz;
    output.normal = mul(float4(input.normal, 0.0), inverse_model).xyz;
    output.tangent = float4(mul(model, float4(input.tangent.xyz, 0.0)).xyz, input.tangent.w * sign(determinant((float3x3)model)));
    output.uv = input.uv;
    return output;
}

// v / |v|; 0 stays 0, of which normalize makes NaN.
float3 unit_vector(float3 v) {
    float square = dot(v, v);
    return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
}

float4 fragment_main(Varyings input) : SV_Target {
    float3 V = unit_vector(camera_position - input.position);
    float3 N = unit_vector(input.normal);
    float3 T = unit_vector(input.tangent.xyz);
    float3 B = cross(N, T) * input.tangent.w;
    Surface surface = evaluate_surface(input.uv);
    N = unit_vector(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);

    float3 color = ambient_color * surface.albedo;
    for (int i = 0; i < min(light_count, MAX_LIGHTS); i++) {
        float3 to_light = light_positions[i].xyz - input.position * light_positions[i].w;
        float distance_squared = max(dot(to_light, to_light), 1e-4);
        float3 L = to_light * rsqrt(distance_squared);
        float3 light_color = light_colors[i].rgb * lerp(1.0, 1.0 / distance_squared, light_positions[i].w);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, V, N, L) * light_color;
    }
    return float4(color, 1.0);
}
