// vertex
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

cbuffer Material : register(b3) {
    row_major float4x4 view_projection_;
};

Texture2D heights : register(t0);
SamplerState heights_sampler : register(s0);

static float3 position;
static float2 texcoord;
static float4x4 instance;
static float2 uv;
static int kind;
static int VertexID;
static int InstanceID;
static float PointSize;
static float4 Position;

void main_() {
    float row = float(VertexID / 8 + InstanceID);
    float3 p = position;
    p.y += heights.SampleLevel(heights_sampler, texcoord, 0.0).r + row * 0.25;
    uv = texcoord * 2.0 - 1.0;
    kind = VertexID % 3;
    PointSize = 4.0;
    Position = mul(float4(p, 1.0), mul(instance, view_projection_));
}

struct VertexOutput {
    nointerpolation int kind : KIND;
    float2 uv : UV;
    float4 Position : SV_Position;
};

VertexOutput vertex_main(float3 position_in : ATTR0, float2 texcoord_in : ATTR1, float4 instance_in_0
    : ATTR2, float4 instance_in_1 : ATTR3, float4 instance_in_2 : ATTR4, float4 instance_in_3 : ATTR5,
    uint VertexID_in : SV_VertexID, uint InstanceID_in : SV_InstanceID) {
    position = position_in;
    texcoord = texcoord_in;
    instance[0] = instance_in_0;
    instance[1] = instance_in_1;
    instance[2] = instance_in_2;
    instance[3] = instance_in_3;
    VertexID = int(VertexID_in);
    InstanceID = int(InstanceID_in);
    main_();
    Position.z = (Position.z + Position.w) * 0.5;
    VertexOutput output;
    output.kind = kind;
    output.uv = uv;
    output.Position = Position;
    return output;
}
