// textures
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

Texture2D map : register(t0);
SamplerState map_sampler : register(s0);
TextureCube sky : register(t1);
SamplerState sky_sampler : register(s1);
Texture3D fog : register(t2);
SamplerState fog_sampler : register(s2);
Texture2DArray layers : register(t3);
SamplerState layers_sampler : register(s3);
Texture2D<int4> numbers : register(t4);
SamplerState numbers_sampler : register(s4);

static float3 place;
static float4 color;
static float4 FragCoord;

float4 from(Texture2D source, SamplerState source_sampler, float2 uv) {
    return source.Sample(source_sampler, uv);
}

int2 texture_size(Texture2D map, int level) {
    uint width, height, levels;
    map.GetDimensions(level, width, height, levels);
    return int2(width, height);
}

float3 blurred(Texture2D source, SamplerState source_sampler, float2 uv, float radius) {
    float2 texel = 1.0 / (float2)texture_size(source, 0);
    float3 sum = (float3)0.0;
    [unroll]
    for (int y = -1; y <= 1; y++) {
        [unroll]
        for (int x = -1; x <= 1; x++) {
            sum += source.SampleLevel(source_sampler, uv + float2(float(x), float(y)) * texel * radius,
                0.0).rgb;
        }
    }
    return sum / 9.0;
}

int2 texture_size(TextureCube map, int level) {
    uint width, height, levels;
    map.GetDimensions(level, width, height, levels);
    return int2(width, height);
}

int3 texture_size(Texture3D map, int level) {
    uint width, height, depth, levels;
    map.GetDimensions(level, width, height, depth, levels);
    return int3(width, height, depth);
}

void main_() {
    float2 uv = place.xy;
    float2 dx = ddx(uv);
    float2 dy = -ddy(uv);
    float4 sum = map.Sample(map_sampler, uv) + map.SampleBias(map_sampler, uv, 0.5)
        + sky.Sample(sky_sampler, place) + fog.Sample(fog_sampler, place);
    sum += layers.Sample(layers_sampler, float3(uv, 1.0));
    sum += map.SampleLevel(map_sampler, uv, 1.0) + sky.SampleLevel(sky_sampler, place, 2.0)
        + map.SampleGrad(map_sampler, uv, dx, dy);
    sum += map.Sample(map_sampler, uv, int2(1, -1)) + map.SampleLevel(map_sampler, uv, 0.0, int2(0, 2));
    float3 place_ = float3(uv, 2.0);
    float4 place_2 = float4(uv, 0.0, 2.0);
    sum += map.Sample(map_sampler, place_.xy / place_.z) + map.Sample(map_sampler, place_2.xy / place_2.w);
    sum += map.Load(int3((int2)FragCoord.xy, 0)) + map.Load(int3((int2)uv + (int2)1, 0));
    sum += (float4)numbers.Load(int3(int2(3, 4), 0)) + map.GatherRed(map_sampler, uv);
    sum.xy += (float2)texture_size(sky, 0) + (float2)texture_size(fog, 1).xy;
    sum += from(map, map_sampler, uv * 2.0);
    sum.rgb += blurred(map, map_sampler, uv, 2.0);
    color = sum;
}

float4 fragment_main(float3 place_in : PLACE, float4 FragCoord_in : SV_Position) : SV_Target0 {
    place = place_in;
    FragCoord = FragCoord_in;
    FragCoord.w = 1.0 / FragCoord.w;
    main_();
    return color;
}
