// images
// Made by sssgen for Metal. Change the source and emit it again rather than this file.
// Threads of a threadgroup: 4 x 4 x 1.
// Compile it with fast math off (-fno-fast-math): fast math may remove guards and reorder sums.
#include <metal_stdlib>

using namespace metal;

// The mean of a texel and its mirror image.
float mirrored(int2 at, texture2d<float, access::read> source) {
    int2 size;
    size = int2(source.get_width(), source.get_height());
    int2 last = size - 1;
    float4 texel;
    texel = source.read(uint2(at));
    float4 texel_2;
    texel_2 = source.read(uint2(int2(last.x - at.x, at.y)));
    return 0.5 * (texel.r + texel_2.r);
}

void main_(texture2d<float, access::read> source, texture2d<float, access::write> picture,
    texture2d<uint, access::read_write> counts, texture2d_array<float, access::write> layers,
    uint3 GlobalInvocationID_) {
    int2 at = int2(GlobalInvocationID_.xy);
    picture.write(float4(mirrored(at, source), 1.0, 0.0, 1.0), uint2(at));
    uint4 texel;
    texel = counts.read(uint2(at));
    counts.write(texel + 1u, uint2(at));
    counts.fence();
    uint4 texel_2;
    texel_2 = counts.read(uint2(at));
    counts.write(texel_2 * 2u, uint2(at));
    counts.fence();
    int3 size;
    size = int3(layers.get_width(), layers.get_height(), layers.get_array_size());
    uint4 texel_3;
    texel_3 = counts.read(uint2(at));
    int3 texel_4 = int3(at, size.z - 1);
    layers.write(float4(texel_3), uint2(texel_4.xy), uint(texel_4.z));
}

kernel void compute_main(
    uint3 GlobalInvocationID [[thread_position_in_grid]],
    texture2d<float, access::read> source [[texture(0)]],
    texture2d<float, access::write> picture [[texture(1)]],
    texture2d<uint, access::read_write> counts [[texture(2)]],
    texture2d_array<float, access::write> layers [[texture(3)]]
) {
    main_(source, picture, counts, layers, GlobalInvocationID);
}
