#version 430 core
// A prefix sum of each workgroup, whose last value goes to a second buffer.

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Input {
    float values[];
};
layout(std430, binding = 1) buffer Output {
    float sums[];
};
layout(std430, binding = 2) writeonly buffer Totals {
    float totals[];
};

shared float partial[2][gl_WorkGroupSize.x];

void main() {
    uint i = gl_GlobalInvocationID.x;
    uint lane = gl_LocalInvocationID.x;
    int from = 0;
    partial[from][lane] = i < uint(values.length()) ? values[i] : 0.0;
    memoryBarrierShared();
    barrier();
    for (uint offset = 1u; offset < gl_WorkGroupSize.x; offset *= 2u) {
        int to = 1 - from;
        float sum = partial[from][lane];
        if (lane >= offset) {
            sum += partial[from][lane - offset];
        }
        partial[to][lane] = sum;
        barrier();
        from = to;
    }
    if (i < uint(sums.length())) {
        sums[i] = partial[from][lane];
    }
    if (lane == gl_WorkGroupSize.x - 1u) {
        totals[gl_WorkGroupID.x] = partial[from][lane];
    }
}
