// histogram
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

struct Texel {
    float2 place;
    float value;
    uint weight;
};

cbuffer Material : register(b3) {
    uint count;
    float scale;
};

StructuredBuffer<Texel> data : register(t0);
RWStructuredBuffer<uint> bins_buffer : register(u1);
RWStructuredBuffer<int> extremes_buffer : register(u2);
groupshared uint counts[16];
groupshared int lowest;
static uint LocalInvocationIndex;
static uint3 WorkGroupID;

void add(uint bin, uint weight) {
    InterlockedAdd(counts[bin], weight);
}

void main_() {
    uint lane = LocalInvocationIndex;
    uint i = WorkGroupID.x * 64u + lane;
    if (lane < 16u) {
        counts[lane] = 0u;
    }
    if (lane == 0u) {
        lowest = 1000;
    }
    GroupMemoryBarrierWithGroupSync();
    if (i < count) {
        Texel texel = data[i];
        add(uint(clamp(texel.value * scale, 0.0, 15.0)), texel.weight);
        InterlockedMin(lowest, int(texel.place.x));
        int before;
        InterlockedMax(extremes_buffer[1], int(texel.place.y), before);
        if (before < 0) {
            InterlockedOr(extremes_buffer[2], 1);
        }
        uint seen;
        InterlockedCompareExchange(bins_buffer[15], 0u, 0u, seen);
        InterlockedXor(extremes_buffer[3], int(seen) * 0 + int(i));
        int old;
        InterlockedExchange(extremes_buffer[5], 7, old);
        extremes_buffer[4] = old;
    }
    GroupMemoryBarrierWithGroupSync();
    if (lane < 16u && counts[lane] > 0u) {
        InterlockedAdd(bins_buffer[lane], counts[lane]);
    }
    if (lane == 0u) {
        InterlockedMin(extremes_buffer[0], lowest);
    }
}

[numthreads(8, 8, 1)]
void compute_main(uint LocalInvocationIndex_in : SV_GroupIndex, uint3 WorkGroupID_in : SV_GroupID) {
    LocalInvocationIndex = LocalInvocationIndex_in;
    WorkGroupID = WorkGroupID_in;
    main_();
}
