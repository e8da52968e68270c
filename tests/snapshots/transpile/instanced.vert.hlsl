// instanced
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

static const int TARGETS = 3;

cbuffer Material : register(b3) {
    float4 morph_weights[3];
    float base_weight;
    row_major float4x4 view_projections[2];
    row_major float4x4 model_;
    int DrawID;
    uint ViewID_OVR;
};

Texture2DArray morph_texture : register(t0);
SamplerState morph_texture_sampler : register(s0);
Texture2D batch_texture : register(t1);
SamplerState batch_texture_sampler : register(s1);
Texture2D<uint4> batch_ids : register(t2);
SamplerState batch_ids_sampler : register(s2);

static float3 position;
static float3 normal;
static uint4 joints;
static float4x4 instance;
static float3 instance_color;
static float3 v_normal;
static uint2 v_joints;
static float3 v_color;
static float v_depth;
static int VertexID;
static int InstanceID;
static float4 Position;

int3 texture_size(Texture2DArray map, int level) {
    uint width, height, layers, levels;
    map.GetDimensions(level, width, height, layers, levels);
    return int3(width, height, layers);
}

float4 morph(int vertex, int target, int part) {
    int width = texture_size(morph_texture, 0).x;
    int texel = vertex * 2 + part;
    return morph_texture.Load(int4(int3(texel % width, texel / width, target), 0));
}

int2 texture_size(Texture2D map, int level) {
    uint width, height, levels;
    map.GetDimensions(level, width, height, levels);
    return int2(width, height);
}

float4x4 batched(uint id) {
    int size = texture_size(batch_texture, 0).x;
    int first = int(id) * 4;
    int2 at = int2(first % size, first / size);
    return float4x4(batch_texture.Load(int3(at, 0)), batch_texture.Load(int3(at + int2(1, 0), 0)),
        batch_texture.Load(int3(at + int2(2, 0), 0)), batch_texture.Load(int3(at + int2(3, 0), 0)));
}

int2 texture_size(Texture2D<uint4> map, int level) {
    uint width, height, levels;
    map.GetDimensions(level, width, height, levels);
    return int2(width, height);
}

uint batch_id(int draw) {
    int size = texture_size(batch_ids, 0).x;
    return batch_ids.Load(int3(int2(draw % size, draw / size), 0)).r;
}

void main_() {
    float3 p = position * base_weight;
    float3 n = normal * base_weight;
    [unroll]
    for (int i = 0; i < TARGETS; i++) {
        if (morph_weights[i].x != 0.0) {
            p += morph(VertexID, i, 0).xyz * morph_weights[i].x;
            n += morph(VertexID, i, 1).xyz * morph_weights[i].x;
        }
    }
    float3x3 turn = float3x3(instance[0].xyz, instance[1].xyz, instance[2].xyz);
    n /= float3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
    v_normal = mul(mul(n, turn), float3x3(model_[0].xyz, model_[1].xyz, model_[2].xyz));
    v_joints = joints.xy;
    v_color = instance_color * float(InstanceID);
    float4 world = mul(float4(p, 1.0), mul(instance, mul(batched(batch_id(DrawID)), model_)));
    Position = mul(world, view_projections[ViewID_OVR]);
    v_depth = Position.w;
}

struct VertexOutput {
    nointerpolation float3 v_color : V__COLOR;
    float v_depth : V__DEPTH;
    nointerpolation uint2 v_joints : V__JOINTS;
    float3 v_normal : V__NORMAL;
    float4 Position : SV_Position;
};

VertexOutput vertex_main(float3 position_in : ATTR0, float3 normal_in : ATTR1, uint4 joints_in : ATTR2,
    float4 instance_in_0 : ATTR5, float4 instance_in_1 : ATTR6, float4 instance_in_2 : ATTR7,
    float4 instance_in_3 : ATTR8, float3 instance_color_in : ATTR9, uint VertexID_in : SV_VertexID,
    uint InstanceID_in : SV_InstanceID) {
    position = position_in;
    normal = normal_in;
    joints = joints_in;
    instance[0] = instance_in_0;
    instance[1] = instance_in_1;
    instance[2] = instance_in_2;
    instance[3] = instance_in_3;
    instance_color = instance_color_in;
    VertexID = int(VertexID_in);
    InstanceID = int(InstanceID_in);
    main_();
    Position.z = (Position.z + Position.w) * 0.5;
    VertexOutput output;
    output.v_color = v_color;
    output.v_depth = v_depth;
    output.v_joints = v_joints;
    output.v_normal = v_normal;
    output.Position = Position;
    return output;
}
