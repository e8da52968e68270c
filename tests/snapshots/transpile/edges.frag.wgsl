// edges
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Sphere {
    center: vec2f,
    radius: f32,
}

struct Plane {
    normal: vec3f,
}

const FAR: i32 = 40;

struct Material {
    bits: i32,
    mask: u32,
    rounds: i32,
}
@group(1) @binding(0) var<uniform> material: Material;

var<private> color: vec4f;

fn bitfieldInsert(x: u32, y: u32, z: i32, w: i32) -> u32 {
    let mask = select((1u << (u32(w) & 31u)) - 1u, 0xffffffffu, w > 31) << (u32(z) & 31u);
    return (x & ~mask) | ((y << (u32(z) & 31u)) & mask);
}

fn area_Sphere(s: Sphere) -> f32 {
    return s.radius * s.radius;
}

fn area_Plane(p: Plane) -> f32 {
    return p.normal.z;
}

fn main_() {
    let steps = array<f32, 3>(1.0, 2.0, 3.0);
    let weights = vec3f(0.25, 0.5, 1.0);
    let after = 7;
    let before = -1;
    color = vec4f(area_Sphere(Sphere(vec2f(1.0), 2.0)), area_Plane(Plane(vec3f(0.5))), 0.0, 1.0);
    if (material.rounds > 100) {
        color.x = steps[2] + weights[0] + mat2x2f(1.0, 0.0, 0.0, 1.0)[0][1];
        color.y = f32(select((material.bits << (u32(32 - (-1) - 1) & 31u)) >> (u32(32 - 1) & 31u), 0,
            1 == 0)) + f32(select((material.mask << (0xfffffff6u & 31u)) >> (u32(32 - 2) & 31u), 0u, 2 == 0));
        color.z = f32(bitfieldInsert(material.mask, 3u, 30, 9));
    }
}

@fragment
fn fragment_main() -> @location(0) vec4f {
    main_();
    return color;
}
