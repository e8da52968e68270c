// scene
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

static const int MARCH = 40;

cbuffer Material : register(b3) {
    float3 iResolution;
    float iTime;
    int iFrame;
    float4 iMouse;
};

Texture2D iChannel0 : register(t0);
SamplerState iChannel0_sampler : register(s0);

static float4 shadertoy_color;
static float4 FragCoord;

// A scene as Shadertoy has them, with the mouse, the time and a texture.
float2x2 turn(float a) {
    float2 v = sin(float2(1.570796, 0.0) + a);
    return float2x2(v, -v.y, v.x);
}

float map(float3 p) {
    p.xz = mul(turn(iTime * 0.5), p.xz);
    float3 q = abs(p) - 0.6;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0) - 0.1;
}

float3 normal(float3 p) {
    float2 e = float2(1.0, -1.0) * 0.001;
    return normalize(e.xyy * map(p + e.xyy) + e.yyx * map(p + e.yyx) + e.yxy * map(p + e.yxy) + e.xxx
        * map(p + e.xxx));
}

void mainImage(out float4 O, float2 F) {
    float2 R = iResolution.xy;
    float2 uv = (F + F - R) / R.y;
    float2 mouse = iMouse.z > 0.0 ? iMouse.xy / R : (float2)0.5;
    float3 ro = float3(0.0, 0.0, -3.0);
    float3 rd = normalize(float3(uv, 1.5));
    float3 p;
    float d = 0.0;
    float h;
    int i = 0;
    [loop]
    for (; i < MARCH; i++) {
        p = ro + rd * d;
        h = map(p);
        d += h;
        if (h < 0.001 || d > 20.0) {
            break;
        }
    }
    O = (float4)0.0;
    float4 iChannel0_sample = iChannel0.Sample(iChannel0_sampler, normal(p).xy * 0.5 + 0.5);
    if (d < 20.0) {
        float3 n = normal(p);
        O.rgb = iChannel0_sample.rgb * max(dot(n, normalize(float3(mouse, -1.0))), 0.0);
    }
    O = pow(O + float(iFrame % 2) * 0.01, (float4)(1.0 / 2.2));
}

void main_() {
    mainImage(shadertoy_color, FragCoord.xy);
}

float4 fragment_main(float4 FragCoord_in : SV_Position) : SV_Target0 {
    FragCoord = FragCoord_in;
    FragCoord.y = iResolution.y - FragCoord.y;
    FragCoord.w = 1.0 / FragCoord.w;
    main_();
    return shadertoy_color;
}
