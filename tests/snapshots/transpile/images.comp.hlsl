// images
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

RWTexture2D<float> source : register(u0);
RWTexture2D<unorm float4> picture : register(u1);
RWTexture2D<uint> counts : register(u2);
RWTexture2DArray<float4> layers : register(u3);
static uint3 GlobalInvocationID;

// The mean of a texel and its mirror image.
float mirrored(int2 at) {
    int2 size;
    uint2 extent;
    source.GetDimensions(extent.x, extent.y);
    size = int2(extent);
    int2 last = size - 1;
    float4 texel;
    texel = float4(source[at], 0, 0, 1);
    float4 texel_2;
    texel_2 = float4(source[int2(last.x - at.x, at.y)], 0, 0, 1);
    return 0.5 * (texel.r + texel_2.r);
}

void main_() {
    int2 at = (int2)GlobalInvocationID.xy;
    picture[at] = float4(mirrored(at), 1.0, 0.0, 1.0);
    uint4 texel;
    texel = uint4(counts[at], 0, 0, 1);
    counts[at] = (texel + 1u).x;
    uint4 texel_2;
    texel_2 = uint4(counts[at], 0, 0, 1);
    counts[at] = (texel_2 * 2u).x;
    int3 size;
    uint3 extent;
    layers.GetDimensions(extent.x, extent.y, extent.z);
    size = int3(extent);
    uint4 texel_3;
    texel_3 = uint4(counts[at], 0, 0, 1);
    int3 texel_4 = int3(at, size.z - 1);
    layers[texel_4] = (float4)texel_3;
}

[numthreads(4, 4, 1)]
void compute_main(uint3 GlobalInvocationID_in : SV_DispatchThreadID) {
    GlobalInvocationID = GlobalInvocationID_in;
    main_();
}
