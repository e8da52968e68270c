// blur
// Made by sssgen for Metal. Change the source and emit it again rather than this file.
// Threads of a threadgroup: 32 x 1 x 1.
// Compile it with fast math off (-fno-fast-math): fast math may remove guards and reorder sums.
#include <metal_stdlib>

using namespace metal;

template <typename T, int N>
struct fixed_array {
    T items[N];
};

struct Result {
    float4 colors[1];
};

struct Material {
    fixed_array<float, 3> weights;
};

float4 texel(int2 at, int2 size, texture2d<float> picture, sampler picture_sampler) {
    return picture.read(uint2(clamp(at, int2(0), size - 1)), uint(0));
}

void main_(device Result& result, threadgroup fixed_array<float4, 36>& row, uint3 GlobalInvocationID_,
    uint3 LocalInvocationID_, texture2d<float> picture, sampler picture_sampler,
    fixed_array<float, 3> weights) {
    int2 size = int2(picture.get_width(uint(0)), picture.get_height(uint(0)));
    int2 at = int2(GlobalInvocationID_.xy);
    int lane = int(LocalInvocationID_.x);
    row.items[lane + 2] = texel(at, size, picture, picture_sampler);
    if (lane < 2) {
        row.items[lane] = texel(at - int2(2, 0), size, picture, picture_sampler);
        row.items[lane + 34] = texel(at + int2(32, 0), size, picture, picture_sampler);
    }
    threadgroup_barrier(mem_flags::mem_threadgroup);
    float4 sum = row.items[lane + 2] * weights.items[0];
    for (int i = 1; i < 3; i++) {
        sum += (row.items[lane + 2 - i] + row.items[lane + 2 + i]) * weights.items[i];
    }
    if (at.x < size.x && at.y < size.y) {
        result.colors[at.y * size.x + at.x] = sum;
    }
}

kernel void compute_main(
    uint3 GlobalInvocationID [[thread_position_in_grid]],
    uint3 LocalInvocationID [[thread_position_in_threadgroup]],
    constant Material& material [[buffer(0)]],
    device Result& result [[buffer(1)]],
    texture2d<float> picture [[texture(0)]],
    sampler picture_sampler [[sampler(0)]]
) {
    threadgroup fixed_array<float4, 36> row;
    main_(result, row, GlobalInvocationID, LocalInvocationID, picture, picture_sampler, material.weights);
}
