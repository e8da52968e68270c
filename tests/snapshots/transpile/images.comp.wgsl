// images
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

@group(1) @binding(1) var source: texture_storage_2d<r32float, read>;
@group(1) @binding(2) var picture: texture_storage_2d<rgba8unorm, write>;
@group(1) @binding(3) var counts: texture_storage_2d<r32uint, read_write>;
@group(1) @binding(4) var layers: texture_storage_2d_array<rgba32float, write>;
var<private> GlobalInvocationID: vec3u;

// The mean of a texel and its mirror image.
fn mirrored(at: vec2i) -> f32 {
    var size: vec2i;
    size = vec2i(textureDimensions(source));
    let last = size - 1;
    var texel: vec4f;
    texel = textureLoad(source, at);
    var texel_2: vec4f;
    texel_2 = textureLoad(source, vec2i(last.x - at.x, at.y));
    return 0.5 * (texel.r + texel_2.r);
}

fn main_() {
    let at = vec2i(GlobalInvocationID.xy);
    textureStore(picture, at, vec4f(mirrored(at), 1.0, 0.0, 1.0));
    var texel: vec4u;
    texel = textureLoad(counts, at);
    textureStore(counts, at, texel + 1u);
    var texel_2: vec4u;
    texel_2 = textureLoad(counts, at);
    textureStore(counts, at, texel_2 * 2u);
    var size: vec3i;
    size = vec3i(vec2i(textureDimensions(layers)), i32(textureNumLayers(layers)));
    var texel_3: vec4u;
    texel_3 = textureLoad(counts, at);
    let texel_4 = vec3i(at, size.z - 1);
    textureStore(layers, texel_4.xy, texel_4.z, vec4f(texel_3));
}

@compute @workgroup_size(4, 4, 1)
fn compute_main(@builtin(global_invocation_id) GlobalInvocationID_in: vec3u) {
    GlobalInvocationID = GlobalInvocationID_in;
    main_();
}
