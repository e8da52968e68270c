// prefix_sum
// Made by sssgen for Metal. Change the source and emit it again rather than this file.
// Threads of a threadgroup: 64 x 1 x 1.
// Compile it with fast math off (-fno-fast-math): fast math may remove guards and reorder sums.
#include <metal_stdlib>

using namespace metal;

template <typename T, int N>
struct fixed_array {
    T items[N];
};

struct Input {
    float values[1];
};

struct Output {
    float sums[1];
};

struct Totals {
    float totals[1];
};

struct Material {
    int values_length;  // The number of elements of Input.values
    int sums_length;  // The number of elements of Output.sums
};

void main_(const device Input& input, device Output& output, device Totals& totals_buffer,
    threadgroup fixed_array<fixed_array<float, 64>, 2>& partial, uint3 GlobalInvocationID_,
    uint3 LocalInvocationID_, uint3 WorkGroupID_, int values_length, int sums_length) {
    uint i = GlobalInvocationID_.x;
    uint lane = LocalInvocationID_.x;
    int from = 0;
    int count;
    count = values_length;
    partial.items[from].items[lane] = i < uint(count) ? input.values[i] : 0.0;
    threadgroup_barrier(mem_flags::mem_threadgroup);
    for (uint offset = 1u; offset < 64u; offset *= 2u) {
        int to = 1 - from;
        float sum = partial.items[from].items[lane];
        if (lane >= offset) {
            sum += partial.items[from].items[lane - offset];
        }
        partial.items[to].items[lane] = sum;
        threadgroup_barrier(mem_flags::mem_threadgroup);
        from = to;
    }
    int count_2;
    count_2 = sums_length;
    if (i < uint(count_2)) {
        output.sums[i] = partial.items[from].items[lane];
    }
    if (lane == 64u - 1u) {
        totals_buffer.totals[WorkGroupID_.x] = partial.items[from].items[lane];
    }
}

kernel void compute_main(
    uint3 GlobalInvocationID [[thread_position_in_grid]],
    uint3 LocalInvocationID [[thread_position_in_threadgroup]],
    uint3 WorkGroupID [[threadgroup_position_in_grid]],
    constant Material& material [[buffer(0)]],
    const device Input& input [[buffer(1)]],
    device Output& output [[buffer(2)]],
    device Totals& totals_buffer [[buffer(3)]]
) {
    threadgroup fixed_array<fixed_array<float, 64>, 2> partial;
    main_(input, output, totals_buffer, partial, GlobalInvocationID, LocalInvocationID, WorkGroupID,
        material.values_length, material.sums_length);
}
