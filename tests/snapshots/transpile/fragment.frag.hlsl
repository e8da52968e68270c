// fragment
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

cbuffer Material : register(b3) {
    float2 resolution;
};

Texture2D map : register(t0);
SamplerState map_sampler : register(s0);

static float2 uv;
static int kind;
static float3 normal;
static float along;
static float4 shade;
static float4 color;
static float2 motion;
static float4 FragCoord;
static float FragDepth;
static bool FrontFacing;

float edge(float x) {
    float width = fwidth(x);
    return smoothstep(0.5 - width, 0.5 + width, x);
}

void main_() {
    float2 at = FragCoord.xy / resolution;
    float4 texel = map.Sample(map_sampler, uv);
    float2 slope = float2(ddx(texel.x), -ddy(texel.x));
    float sharp = edge(along);
    if (texel.a < 0.5) {
        discard;
    }
    motion = slope;
    FragDepth = FragCoord.z;
    if (kind == 0) {
        color = float4(at, 0.0, 1.0);
        return;
    }
    float3 facing = FrontFacing ? normal : -normal;
    color.rgb = normalize(facing) * 0.5 + 0.5;
    color.a = sharp;
    color *= shade;
}

struct FragmentOutput {
    float4 color : SV_Target0;
    float2 motion : SV_Target1;
    float FragDepth : SV_Depth;
};

FragmentOutput fragment_main(noperspective float along_in : ALONG, nointerpolation int kind_in : KIND,
    centroid float3 normal_in : NORMAL, float4 shade_in : SHADE, float2 uv_in : UV, float4 FragCoord_in
    : SV_Position, bool FrontFacing_in : SV_IsFrontFace) {
    along = along_in;
    kind = kind_in;
    normal = normal_in;
    shade = shade_in;
    uv = uv_in;
    FragCoord = FragCoord_in;
    FrontFacing = FrontFacing_in;
    FragCoord.w = 1.0 / FragCoord.w;
    main_();
    FragmentOutput output;
    output.color = color;
    output.motion = motion;
    output.FragDepth = FragDepth;
    return output;
}
