// uniforms
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

struct Light {
    float3 position;
    float3 color;
    float range;
};

struct Fog {
    float3 color;
    float density;
};

cbuffer Material : register(b3) {
    row_major float4x4 view;
    float3 eye;
    float4 shading_base;
    float4 shading_weights[2];
    float4 lights_position[2];
    float4 lights_color[2];
    float4 lights_range[2];
    float3 fog_color;
    float fog_density;
    float time;
    float exposure;
    int count;
    uint mask;
    int foggy;
    float4 points[3];
    float4 turn[3];
};

Texture2D albedo : register(t0);
SamplerState albedo_sampler : register(s0);
TextureCube sky : register(t1);
SamplerState sky_sampler : register(s1);

static float3 v_position;
static float3 v_normal;
static float4 color;

float3 lit_(Light light, float3 p, float3 n) {
    float3 to = light.position - p;
    float fade = max(1.0 - length(to) / light.range, 0.0);
    return light.color * max(dot(normalize(to), n), 0.0) * fade;
}

void main_() {
    float3 n = normalize(mul(v_normal, float3x3(turn[0].xyz, turn[1].xyz, turn[2].xyz)));
    float3 sum = sky.Sample(sky_sampler, n).rgb * shading_weights[0].x;
    [unroll]
    for (int i = 0; i < 2; i++) {
        if (i >= count || (mask & (1u << uint(i))) == 0u) {
            continue;
        }
        Light light = { lights_position[i].xyz, lights_color[i].xyz, lights_range[i].x };
        sum += lit_(light, v_position, n) * shading_weights[1].x;
    }
    if (foggy != 0) {
        sum = lerp(sum, fog_color, 1.0 - exp(-fog_density * distance(eye, v_position)));
    }
    float2 uv = mul(float4(v_position, 1.0), view).xy + points[2].xy * time;
    color = float4(sum * exposure, 1.0) * shading_base * albedo.Sample(albedo_sampler, uv);
}

float4 fragment_main(float3 v_normal_in : V__NORMAL, float3 v_position_in : V__POSITION) : SV_Target0 {
    v_normal = v_normal_in;
    v_position = v_position_in;
    main_();
    return color;
}
