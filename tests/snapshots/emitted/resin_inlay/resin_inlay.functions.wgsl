// Resin inlay: A picture under two centimetres of clear resin: it moves with the eye as if it lay
// below.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.

struct Surface {
    albedo: vec3f,
    metallic: f32,
    roughness: f32,
}

const FLAT_FRAME: f32 = 0.01;

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// The components of `v` along unit T, unit B and N. A frame that spans no space gives (0, 0, dot(v, N)).
fn tangent_from_world(v: vec3f, T: vec3f, B: vec3f, N: vec3f) -> vec3f {
    let volume = dot(T, cross(B, N));
    if (abs(volume) < FLAT_FRAME) {
        return vec3f(0.0, 0.0, dot(v, N));
    }
    let along = vec3f(dot(v, cross(B, N)) * length(T), dot(v, cross(N, T)) * length(B), dot(v, cross(T, B)));
    return along / volume;
}

// The texture coordinates where `ray`, going in, meets the inner layer.
fn slide(uv: vec2f, ray: vec3f, T: vec3f, B: vec3f, N: vec3f, depth: f32, uv_per_unit: vec2f) -> vec2f {
    let r = tangent_from_world(ray, T, B, N);
    // to the surface itself, which a sheared frame does not lie in
    let cosine = -dot(ray, N);
    // 1 / cosine, but smoothly down to 0 where a grazing ray would slide without end
    let x = clamp(cosine / 0.2, 0.0, 1.0);
    let reciprocal = x * x * (4.0 - 3.0 * x) / max(cosine, 0.2);
    return uv + depth * reciprocal * uv_per_unit * r.xy;
}

// Subsurface parallax with refraction: the texture as if it were cast into resin, glass or ice.
fn parallax_refracted(uv: vec2f, V: vec3f, T: vec3f, B: vec3f, N: vec3f, ior: f32, depth: f32,
    uv_per_unit: vec2f) -> vec2f {
    let facing = faceForward(N, -V, N);
    // past the critical angle refract() gives 0, which slides nothing
    let ray = refract(-V, facing, 1.0 / ior);
    return slide(uv, ray, T, B, facing, depth, uv_per_unit);
}

// Colour and opacity from a texture and a tint.
fn base_color(uv: vec2f, albedo: ptr<function, vec3f>, alpha: ptr<function, f32>, tint: vec4f,
    base_color_texture: texture_2d<f32>, base_color_texture_sampler: sampler) {
    let texel = tint * textureSample(base_color_texture, base_color_texture_sampler, uv);
    *albedo = texel.xyz;
    *alpha = texel.w;
}

// The same metalness and roughness everywhere.
fn pbr_constants(metallic: ptr<function, f32>, roughness: ptr<function, f32>, metalness: f32,
    surface_roughness: f32) {
    *metallic = metalness;
    *roughness = surface_roughness;
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
fn evaluate_surface(uv_in: vec2f, V: vec3f, T: vec3f, B: vec3f, N: vec3f, ior: f32, depth: f32,
    uv_per_unit: vec2f, tint: vec4f, base_color_texture: texture_2d<f32>,
    base_color_texture_sampler: sampler, metalness: f32, surface_roughness: f32) -> Surface {
    var uv = uv_in;
    uv = parallax_refracted(uv, V, T, B, N, ior, depth, uv_per_unit);
    var albedo: vec3f;
    var alpha: f32;
    base_color(uv, &albedo, &alpha, tint, base_color_texture, base_color_texture_sampler);
    var metallic: f32;
    var roughness: f32;
    pbr_constants(&metallic, &roughness, metalness, surface_roughness);
    return Surface(albedo, metallic, roughness);
}

// What one light adds from the front.
fn evaluate_lighting(surface: Surface, N: vec3f, V: vec3f, L: vec3f, light_color: vec3f) -> vec3f {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}
