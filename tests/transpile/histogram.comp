#version 310 es
// A histogram: counted in shared memory, then added to a buffer; and the other atomics.
precision highp float;

layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

struct Texel {
    vec2 place;
    float value;
    uint weight;
};

layout(std430, binding = 0) readonly buffer Texels { Texel texels[]; } data;
layout(std430, binding = 1) buffer Bins { uint bins[16]; };
layout(std430, binding = 2) buffer Extremes { int extremes[]; };

uniform uint count;
uniform float scale;

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
        int before = atomicMax(extremes[1], int(texel.place.y));
        if (before < 0) {
            atomicOr(extremes[2], 1);
        }
        uint seen = atomicCompSwap(bins[15], 0u, 0u);
        atomicXor(extremes[3], int(seen) * 0 + int(i));
        extremes[4] = atomicExchange(extremes[5], 7);
    }
    barrier();
    if (lane < 16u && counts[lane] > 0u) {
        atomicAdd(bins[lane], counts[lane]);
    }
    if (lane == 0u) {
        atomicMin(extremes[0], lowest);
    }
}
