// targets
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

static float3 v_normal;
static uint2 v_joints;
static float3 v_color;
static float v_depth;
static float4 layers[2];
static uint4 ids;
static int2 cell;

void main_() {
    if (v_depth > 100.0) {
        discard;
    }
    layers[0] = float4(v_color, 1.0);
    layers[1].rgb = normalize(v_normal) * 0.5 + 0.5;
    layers[1].a = v_depth;
    ids = uint4(v_joints, 0u, 1u);
    cell = (int2)(v_normal.xy * 8.0);
}

struct FragmentOutput {
    float4 layers_0 : SV_Target0;
    float4 layers_1 : SV_Target1;
    uint4 ids : SV_Target2;
    int2 cell : SV_Target3;
};

FragmentOutput fragment_main(nointerpolation float3 v_color_in : V__COLOR, float v_depth_in : V__DEPTH,
    nointerpolation uint2 v_joints_in : V__JOINTS, float3 v_normal_in : V__NORMAL) {
    v_color = v_color_in;
    v_depth = v_depth_in;
    v_joints = v_joints_in;
    v_normal = v_normal_in;
    main_();
    FragmentOutput output;
    output.layers_0 = layers[0];
    output.layers_1 = layers[1];
    output.ids = ids;
    output.cell = cell;
    return output;
}
