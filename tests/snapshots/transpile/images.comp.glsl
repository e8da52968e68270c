#version 430 core
// images
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

layout(local_size_x = 4, local_size_y = 4, local_size_z = 1) in;

layout(r32f, binding = 0) readonly uniform image2D source;
layout(rgba8, binding = 1) writeonly uniform image2D picture;
layout(r32ui, binding = 2) uniform uimage2D counts;
layout(rgba32f, binding = 3) writeonly uniform image2DArray layers;

// The mean of a texel and its mirror image.
float mirrored(ivec2 at) {
    ivec2 size;
    size = imageSize(source);
    ivec2 last = size - 1;
    vec4 texel;
    texel = imageLoad(source, at);
    vec4 texel_2;
    texel_2 = imageLoad(source, ivec2(last.x - at.x, at.y));
    return 0.5 * (texel.r + texel_2.r);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageStore(picture, at, vec4(mirrored(at), 1.0, 0.0, 1.0));
    uvec4 texel;
    texel = imageLoad(counts, at);
    imageStore(counts, at, texel + 1u);
    uvec4 texel_2;
    texel_2 = imageLoad(counts, at);
    imageStore(counts, at, texel_2 * 2u);
    ivec3 size;
    size = imageSize(layers);
    uvec4 texel_3;
    texel_3 = imageLoad(counts, at);
    ivec3 texel_4 = ivec3(at, size.z - 1);
    imageStore(layers, texel_4, vec4(texel_3));
}
