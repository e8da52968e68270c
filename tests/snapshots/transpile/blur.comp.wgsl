// blur
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Result {
    colors: array<vec4f>,
}

struct Material {
    weights: array<vec4f, 3>,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var picture: texture_2d<f32>;
@group(1) @binding(2) var picture_sampler: sampler;

@group(1) @binding(3) var<storage, read_write> result: Result;
var<workgroup> row: array<vec4f, 36>;
var<private> GlobalInvocationID: vec3u;
var<private> LocalInvocationID: vec3u;

fn texel(at: vec2i, size: vec2i) -> vec4f {
    return textureLoad(picture, clamp(at, vec2i(0), size - 1), 0);
}

fn main_() {
    let size = vec2i(textureDimensions(picture, 0));
    let at = vec2i(GlobalInvocationID.xy);
    let lane = i32(LocalInvocationID.x);
    row[lane + 2] = texel(at, size);
    if (lane < 2) {
        row[lane] = texel(at - vec2i(2, 0), size);
        row[lane + 34] = texel(at + vec2i(32, 0), size);
    }
    workgroupBarrier();
    var sum = row[lane + 2] * material.weights[0].x;
    for (var i = 1; i < 3; i++) {
        sum += (row[lane + 2 - i] + row[lane + 2 + i]) * material.weights[i].x;
    }
    if (at.x < size.x && at.y < size.y) {
        result.colors[at.y * size.x + at.x] = sum;
    }
}

@compute @workgroup_size(32, 1, 1)
fn compute_main(@builtin(global_invocation_id) GlobalInvocationID_in: vec3u,
    @builtin(local_invocation_id) LocalInvocationID_in: vec3u) {
    GlobalInvocationID = GlobalInvocationID_in;
    LocalInvocationID = LocalInvocationID_in;
    main_();
}
