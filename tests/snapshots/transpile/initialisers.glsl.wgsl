// initialisers
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Material_ {
    colour: vec3f,
    rough: f32,
}

struct Scene {
    materials: array<Material_, 2>,
    turn: mat2x2f,
    count: i32,
}

const WAX: Material_ = Material_(vec3f(1.0, 0.5, 0.25), 0.75);
const TABLE: array<vec2f, 2> = array<vec2f, 2>(vec2f(1.0, 2.0), vec2f(4.0));

fn in_braces(x: f32, i: i32) -> f32 {
    let v = vec3f(x, 1.0, 2.0);
    let list = array<f32, 3>(x, 2.0, 3.0);
    let open = array<f32, 2>(1.0, x);
    let m = mat2x2f(vec2f(1.0, x), vec2f(0.0, 1.0));
    let material_ = Material_(v, 0.5);
    let scene = Scene(array<Material_, 2>(material_, Material_(vec3f(x), 1.0)), m, 2);
    let p = scene.turn * vec2f(list[i & 1], open[1]);
    return p.x + p.y + scene.materials[i & 1].colour.z + scene.materials[1].rough + f32(scene.count);
}

fn of_constants(i: i32) -> f32 {
    return TABLE[i & 1][1] + TABLE[1][0] + WAX.colour.y;
}
