#version 430 core
// A blur of a picture along its rows: a texture in, a buffer of colours out, with a halo in shared memory.

layout(local_size_x = 32) in;

uniform sampler2D picture;
uniform float weights[3];

layout(std430) buffer Result {
    vec4 colors[];
} result;

shared vec4 row[gl_WorkGroupSize.x + 4u];

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
