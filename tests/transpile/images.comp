#version 430
// Images that are loaded, stored, and both.
layout(local_size_x = 4, local_size_y = 4) in;
layout(r32f, binding = 0) readonly uniform image2D source;
layout(rgba8, binding = 1) writeonly uniform image2D picture;
layout(r32ui, binding = 2) uniform uimage2D counts;
layout(rgba32f, binding = 3) writeonly uniform image2DArray layers;

/// The mean of a texel and its mirror image.
float mirrored(ivec2 at) {
    ivec2 last = imageSize(source) - 1;
    return 0.5 * (imageLoad(source, at).r + imageLoad(source, ivec2(last.x - at.x, at.y)).r);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageStore(picture, at, vec4(mirrored(at), 1.0, 0.0, 1.0));
    imageStore(counts, at, imageLoad(counts, at) + 1u);
    imageStore(counts, at, imageLoad(counts, at) * 2u);
    imageStore(layers, ivec3(at, imageSize(layers).z - 1), vec4(imageLoad(counts, at)));
}
