#version 430 core
// blur
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

uniform float weights[3];

uniform sampler2D picture;

layout(local_size_x = 32, local_size_y = 1, local_size_z = 1) in;

layout(std430, binding = 0) buffer Result {
    vec4 colors[];
} result;
shared vec4 row[36];

vec4 texel(ivec2 at, ivec2 size) {
    return texelFetch(picture, clamp(at, ivec2(0), size - 1), 0);
}

void main() {
    ivec2 size = textureSize(picture, 0);
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int lane = int(gl_LocalInvocationID.x);
    row[lane + 2] = texel(at, size);
    if (lane < 2) {
        row[lane] = texel(at - ivec2(2, 0), size);
        row[lane + 34] = texel(at + ivec2(32, 0), size);
    }
    barrier();
    vec4 sum = row[lane + 2] * weights[0];
    for (int i = 1; i < 3; i++) {
        sum += (row[lane + 2 - i] + row[lane + 2 + i]) * weights[i];
    }
    if (at.x < size.x && at.y < size.y) {
        result.colors[at.y * size.x + at.x] = sum;
    }
}
