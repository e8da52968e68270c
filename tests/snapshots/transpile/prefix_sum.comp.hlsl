// prefix_sum
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

StructuredBuffer<float> input : register(t0);
RWStructuredBuffer<float> output : register(u1);
RWStructuredBuffer<float> totals_buffer : register(u2);
groupshared float partial[2][64];
static uint3 GlobalInvocationID;
static uint3 LocalInvocationID;
static uint3 WorkGroupID;

void main_() {
    uint i = GlobalInvocationID.x;
    uint lane = LocalInvocationID.x;
    int from = 0;
    int count;
    uint count_size, count_stride;
    input.GetDimensions(count_size, count_stride);
    count = int(count_size);
    partial[from][lane] = i < uint(count) ? input[i] : 0.0;
    GroupMemoryBarrier();
    GroupMemoryBarrierWithGroupSync();
    [loop]
    for (uint offset = 1u; offset < 64u; offset *= 2u) {
        int to = 1 - from;
        float sum = partial[from][lane];
        if (lane >= offset) {
            sum += partial[from][lane - offset];
        }
        partial[to][lane] = sum;
        GroupMemoryBarrierWithGroupSync();
        from = to;
    }
    int count_2;
    uint count_2_size, count_2_stride;
    output.GetDimensions(count_2_size, count_2_stride);
    count_2 = int(count_2_size);
    if (i < uint(count_2)) {
        output[i] = partial[from][lane];
    }
    if (lane == 64u - 1u) {
        totals_buffer[WorkGroupID.x] = partial[from][lane];
    }
}

[numthreads(64, 1, 1)]
void compute_main(uint3 GlobalInvocationID_in : SV_DispatchThreadID, uint3 LocalInvocationID_in
    : SV_GroupThreadID, uint3 WorkGroupID_in : SV_GroupID) {
    GlobalInvocationID = GlobalInvocationID_in;
    LocalInvocationID = LocalInvocationID_in;
    WorkGroupID = WorkGroupID_in;
    main_();
}
