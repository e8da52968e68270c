// blur
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

cbuffer Material : register(b3) {
    float4 weights[3];
};

Texture2D picture : register(t0);
SamplerState picture_sampler : register(s0);

RWStructuredBuffer<float4> result : register(u0);
groupshared float4 row[36];
static uint3 GlobalInvocationID;
static uint3 LocalInvocationID;

float4 texel(int2 at, int2 size) {
    return picture.Load(int3(clamp(at, (int2)0, size - 1), 0));
}

int2 texture_size(Texture2D map, int level) {
    uint width, height, levels;
    map.GetDimensions(level, width, height, levels);
    return int2(width, height);
}

void main_() {
    int2 size = texture_size(picture, 0);
    int2 at = (int2)GlobalInvocationID.xy;
    int lane = int(LocalInvocationID.x);
    row[lane + 2] = texel(at, size);
    if (lane < 2) {
        row[lane] = texel(at - int2(2, 0), size);
        row[lane + 34] = texel(at + int2(32, 0), size);
    }
    GroupMemoryBarrierWithGroupSync();
    float4 sum = row[lane + 2] * weights[0].x;
    [unroll]
    for (int i = 1; i < 3; i++) {
        sum += (row[lane + 2 - i] + row[lane + 2 + i]) * weights[i].x;
    }
    if (at.x < size.x && at.y < size.y) {
        result[at.y * size.x + at.x] = sum;
    }
}

[numthreads(32, 1, 1)]
void compute_main(uint3 GlobalInvocationID_in : SV_DispatchThreadID, uint3 LocalInvocationID_in
    : SV_GroupThreadID) {
    GlobalInvocationID = GlobalInvocationID_in;
    LocalInvocationID = LocalInvocationID_in;
    main_();
}
