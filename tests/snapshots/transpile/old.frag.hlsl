// old
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

cbuffer Material : register(b3) {
    float4 u_tint;
};

Texture2D u_map : register(t0);
SamplerState u_map_sampler : register(s0);
TextureCube u_sky : register(t1);
SamplerState u_sky_sampler : register(s1);

static float2 v_uv;
static float3 v_normal;
static float4 FragColor;

float grain(float2 p) {
    return frac(sin(dot(p, float2(12.9898, 78.233))) * 43758.5453);
}

void main_() {
    float3 n = normalize(v_normal);
    float4 base = u_map.Sample(u_map_sampler, v_uv) * u_tint;
    base += u_map.SampleLevel(u_map_sampler, v_uv, 2.0) * 0.25;
    float3 place = float3(v_uv, 2.0);
    base += u_map.SampleBias(u_map_sampler, v_uv * 2.0, 1.0)
        + u_map.Sample(u_map_sampler, place.xy / place.z);
    float3 sky = u_sky.Sample(u_sky_sampler, reflect(float3(0.0, 0.0, -1.0), n)).rgb;
    float lines = length(ddx(v_uv)) + grain(v_uv);
    FragColor = float4(base.rgb * sky, base.a);
    FragColor.a *= lines;
}

float4 fragment_main(float3 v_normal_in : V__NORMAL, float2 v_uv_in : V__UV) : SV_Target0 {
    v_normal = v_normal_in;
    v_uv = v_uv_in;
    main_();
    return FragColor;
}
