#version 430 core
// prefix_sum
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

struct FloatRow64 {
    float items[64];
};

layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;

layout(std430, binding = 0) readonly buffer Input {
    float values[];
} input_;
layout(std430, binding = 1) buffer Output {
    float sums[];
} output_;
layout(std430, binding = 2) writeonly buffer Totals {
    float totals[];
} totals_buffer;
shared FloatRow64 partial[2];

void main() {
    uint i = gl_GlobalInvocationID.x;
    uint lane = gl_LocalInvocationID.x;
    int from = 0;
    int count;
    count = input_.values.length();
    partial[from].items[lane] = i < uint(count) ? input_.values[i] : 0.0;
    memoryBarrierShared();
    barrier();
    for (uint offset = 1u; offset < 64u; offset *= 2u) {
        int to = 1 - from;
        float sum = partial[from].items[lane];
        if (lane >= offset) {
            sum += partial[from].items[lane - offset];
        }
        partial[to].items[lane] = sum;
        barrier();
        from = to;
    }
    int count_2;
    count_2 = output_.sums.length();
    if (i < uint(count_2)) {
        output_.sums[i] = partial[from].items[lane];
    }
    if (lane == 64u - 1u) {
        totals_buffer.totals[gl_WorkGroupID.x] = partial[from].items[lane];
    }
}
