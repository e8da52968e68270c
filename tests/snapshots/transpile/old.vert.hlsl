// old
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

cbuffer Material : register(b3) {
    row_major float4x4 u_matrix;
};

// GLSL without a version, which is 1.10.
static float3 a_position;
static float2 a_uv;
static float2 v_uv;
static float4 Position;

void main_() {
    v_uv = a_uv;
    Position = mul(float4(a_position, 1.0), u_matrix);
}

struct VertexOutput {
    float2 v_uv : V__UV;
    float4 Position : SV_Position;
};

VertexOutput vertex_main(float3 a_position_in : ATTR0, float2 a_uv_in : ATTR1) {
    a_position = a_position_in;
    a_uv = a_uv_in;
    main_();
    Position.z = (Position.z + Position.w) * 0.5;
    VertexOutput output;
    output.v_uv = v_uv;
    output.Position = Position;
    return output;
}
