// histogram
// Made by sssgen for Metal. Change the source and emit it again rather than this file.
// Threads of a threadgroup: 8 x 8 x 1.
// Compile it with fast math off (-fno-fast-math): fast math may remove guards and reorder sums.
#include <metal_stdlib>

using namespace metal;

template <typename T, int N>
struct fixed_array {
    T items[N];
};

struct Texel {
    float2 place;
    float value;
    uint weight;
};

struct Texels {
    Texel texels[1];
};

struct Bins {
    fixed_array<atomic_uint, 16> bins;
};

struct Extremes {
    atomic_int extremes[1];
};

struct Material {
    uint count;
    float scale;
};

void add(uint bin, uint weight, threadgroup fixed_array<atomic_uint, 16>& counts) {
    atomic_fetch_add_explicit(&counts.items[bin], weight, memory_order_relaxed);
}

void main_(const device Texels& data, device Bins& bins_buffer, device Extremes& extremes_buffer,
    threadgroup fixed_array<atomic_uint, 16>& counts, threadgroup atomic_int& lowest,
    uint LocalInvocationIndex_, uint3 WorkGroupID_, uint count, float scale) {
    uint lane = LocalInvocationIndex_;
    uint i = WorkGroupID_.x * 64u + lane;
    if (lane < 16u) {
        atomic_store_explicit(&counts.items[lane], 0u, memory_order_relaxed);
    }
    if (lane == 0u) {
        atomic_store_explicit(&lowest, 1000, memory_order_relaxed);
    }
    threadgroup_barrier(mem_flags::mem_threadgroup);
    if (i < count) {
        Texel texel = data.texels[i];
        add(uint(clamp(texel.value * scale, 0.0, 15.0)), texel.weight, counts);
        atomic_fetch_min_explicit(&lowest, int(texel.place.x), memory_order_relaxed);
        int before;
        before = atomic_fetch_max_explicit(&extremes_buffer.extremes[1], int(texel.place.y),
            memory_order_relaxed);
        if (before < 0) {
            atomic_fetch_or_explicit(&extremes_buffer.extremes[2], 1, memory_order_relaxed);
        }
        uint seen;
        seen = 0u;
        while (!atomic_compare_exchange_weak_explicit(&bins_buffer.bins.items[15], &seen, 0u,
                memory_order_relaxed, memory_order_relaxed) && seen == 0u) {
        }
        atomic_fetch_xor_explicit(&extremes_buffer.extremes[3], int(seen) * 0 + int(i), memory_order_relaxed);
        int old;
        old = atomic_exchange_explicit(&extremes_buffer.extremes[5], 7, memory_order_relaxed);
        atomic_store_explicit(&extremes_buffer.extremes[4], old, memory_order_relaxed);
    }
    threadgroup_barrier(mem_flags::mem_threadgroup);
    if (lane < 16u && atomic_load_explicit(&counts.items[lane], memory_order_relaxed) > 0u) {
        atomic_fetch_add_explicit(&bins_buffer.bins.items[lane],
            atomic_load_explicit(&counts.items[lane], memory_order_relaxed), memory_order_relaxed);
    }
    if (lane == 0u) {
        atomic_fetch_min_explicit(&extremes_buffer.extremes[0],
            atomic_load_explicit(&lowest, memory_order_relaxed), memory_order_relaxed);
    }
}

kernel void compute_main(
    uint LocalInvocationIndex [[thread_index_in_threadgroup]],
    uint3 WorkGroupID [[threadgroup_position_in_grid]],
    constant Material& material [[buffer(0)]],
    const device Texels& data [[buffer(1)]],
    device Bins& bins_buffer [[buffer(2)]],
    device Extremes& extremes_buffer [[buffer(3)]]
) {
    threadgroup fixed_array<atomic_uint, 16> counts;
    threadgroup atomic_int lowest;
    main_(data, bins_buffer, extremes_buffer, counts, lowest, LocalInvocationIndex, WorkGroupID,
        material.count, material.scale);
}
