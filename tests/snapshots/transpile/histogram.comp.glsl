#version 430 core
// histogram
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

struct Texel {
    vec2 place;
    float value;
    uint weight;
};

uniform uint count;
uniform float scale;

layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

layout(std430, binding = 0) readonly buffer Texels {
    Texel texels[];
} data;
layout(std430, binding = 1) buffer Bins {
    uint bins[16];
} bins_buffer;
layout(std430, binding = 2) buffer Extremes {
    int extremes[];
} extremes_buffer;
shared uint counts[16];
shared int lowest;

void add(uint bin, uint weight) {
    atomicAdd(counts[bin], weight);
}

void main() {
    uint lane = gl_LocalInvocationIndex;
    uint i = gl_WorkGroupID.x * 64u + lane;
    if (lane < 16u) {
        counts[lane] = 0u;
    }
    if (lane == 0u) {
        lowest = 1000;
    }
    barrier();
    if (i < count) {
        Texel texel = data.texels[i];
        add(uint(clamp(texel.value * scale, 0.0, 15.0)), texel.weight);
        atomicMin(lowest, int(texel.place.x));
        int before;
        before = atomicMax(extremes_buffer.extremes[1], int(texel.place.y));
        if (before < 0) {
            atomicOr(extremes_buffer.extremes[2], 1);
        }
        uint seen;
        seen = atomicCompSwap(bins_buffer.bins[15], 0u, 0u);
        atomicXor(extremes_buffer.extremes[3], int(seen) * 0 + int(i));
        int old;
        old = atomicExchange(extremes_buffer.extremes[5], 7);
        extremes_buffer.extremes[4] = old;
    }
    barrier();
    if (lane < 16u && counts[lane] > 0u) {
        atomicAdd(bins_buffer.bins[lane], counts[lane]);
    }
    if (lane == 0u) {
        atomicMin(extremes_buffer.extremes[0], lowest);
    }
}
