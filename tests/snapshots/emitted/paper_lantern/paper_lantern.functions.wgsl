// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.

struct Surface {
    albedo: vec3f,
    normal: vec3f,
    metallic: f32,
    roughness: f32,
    transmittance: f32,
}

// A texel within its range; 0 in place of NaN.
fn valid_texel(x: f32) -> f32 {
    return select(clamp(x, 0.0, 1.0), 0.0, (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u);
}

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// Thickness from a baked map, bright where the body is thick.
fn thickness_map(uv: vec2f, thickness_texture: texture_2d<f32>, thickness_texture_sampler: sampler) -> f32 {
    return valid_texel(textureSample(thickness_texture, thickness_texture_sampler, uv).r);
}

// Thickness to thinness, in a straight line.
fn thinness_from_thickness(d: f32) -> f32 {
    return clamp(1.0 - d, 0.0, 1.0);
}

// Colour and opacity from a texture and a tint.
fn base_color(uv: vec2f, albedo: ptr<function, vec3f>, alpha: ptr<function, f32>, tint: vec4f,
    base_color_texture: texture_2d<f32>, base_color_texture_sampler: sampler) {
    let texel = tint * textureSample(base_color_texture, base_color_texture_sampler, uv);
    *albedo = texel.xyz;
    *alpha = texel.w;
}

// Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
fn blend_normals(base: vec3f, detail: vec3f) -> vec3f {
    return safe_normalize(vec3f(base.xy + detail.xy, base.z * detail.z));
}

// Detail in the normal, from a texture.
fn normal_map(uv: vec2f, normal: ptr<function, vec3f>, normal_texture: texture_2d<f32>,
    normal_texture_sampler: sampler, normal_scale: f32) {
    let texel = textureSample(normal_texture, normal_texture_sampler, uv).rgb * 2.0 - 1.0;
    *normal = blend_normals(*normal, vec3f(texel.xy * normal_scale, texel.z));
}

// The same metalness and roughness everywhere.
fn pbr_constants(metallic: ptr<function, f32>, roughness: ptr<function, f32>, metalness: f32,
    surface_roughness: f32) {
    *metallic = metalness;
    *roughness = surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
fn glow(lobe: f32, through: f32, subsurface_color: vec3f, scale: f32) -> vec3f {
    return subsurface_color * (lobe * scale * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
fn lobe_normalized(V: vec3f, N: vec3f, L: vec3f, through: f32, distortion: f32, subsurface_color: vec3f,
    scale: f32, power: f32) -> vec3f {
    let bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, scale);
}

// The standard light of plain targets: Lambert and GGX with metallic and roughness, for one light.
fn standard(N: vec3f, V: vec3f, L: vec3f, albedo: vec3f, metallic: f32, roughness: f32,
    light_color: vec3f) -> vec3f {
    let H = safe_normalize(V + L);
    let NoL = max(dot(N, L), 0.0);
    let NoV = max(dot(N, V), 0.0001);
    let NoH = clamp(dot(N, H), 0.0, 1.0);
    let a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but exact where N and H nearly meet and a mirror has its peak; never below a^2
    let across = cross(N, H);
    let spread = select(1.0, max(dot(across, across) + NoH * NoH * (a * a), a * a), NoH > 0.0);
    // D times pi
    let facets = a * a / (spread * spread);
    // masking and shadowing, over 4 dot(N, L) dot(N, V)
    let visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // nothing reflects more than all
    let F0 = mix(vec3f(0.04), min(albedo, vec3f(1.0)), metallic);
    let F = F0 + (1.0 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    let diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    return (diffuse + facets * visible * F) * NoL * light_color;
}

// Everything about the surface that does not depend on a light.
fn evaluate_surface(uv: vec2f, thickness_texture: texture_2d<f32>, thickness_texture_sampler: sampler,
    tint: vec4f, base_color_texture: texture_2d<f32>, base_color_texture_sampler: sampler,
    normal_texture: texture_2d<f32>, normal_texture_sampler: sampler, normal_scale: f32, metalness: f32,
    surface_roughness: f32) -> Surface {
    let thickness = thickness_map(uv, thickness_texture, thickness_texture_sampler);
    let thinness = thinness_from_thickness(thickness);
    let transmittance = thinness;
    var albedo: vec3f;
    var alpha: f32;
    base_color(uv, &albedo, &alpha, tint, base_color_texture, base_color_texture_sampler);
    var normal = vec3f(0.0, 0.0, 1.0);
    normal_map(uv, &normal, normal_texture, normal_texture_sampler, normal_scale);
    var metallic: f32;
    var roughness: f32;
    pbr_constants(&metallic, &roughness, metalness, surface_roughness);
    return Surface(albedo, normal, metallic, roughness, transmittance);
}

// What one light adds from behind, as a factor on its colour.
fn evaluate_translucency(surface: Surface, V: vec3f, N: vec3f, L: vec3f, distortion: f32,
    subsurface_color: vec3f, scale: f32, power: f32) -> vec3f {
    return lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, scale, power);
}

// What one light adds from the front.
fn evaluate_lighting(surface: Surface, N: vec3f, V: vec3f, L: vec3f, light_color: vec3f) -> vec3f {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}
