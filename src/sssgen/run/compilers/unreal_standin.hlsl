// The project's own stand-in for what Unreal's material shaders declare before the files that a Custom node includes:
// only the names that the emitted text uses.
#define MaterialFloat float
#define MaterialFloat2 float2
#define MaterialFloat3 float3
#define MaterialFloat4 float4

struct FMaterialPixelParameters {
    float4 SvPosition;
};

float4 Texture2DSample(Texture2D map, SamplerState s, float2 uv) { return map.Sample(s, uv); }
float4 Texture2DSampleBias(Texture2D map, SamplerState s, float2 uv, float bias) { return map.SampleBias(s, uv, bias); }
float4 Texture2DSampleLevel(Texture2D map, SamplerState s, float2 uv, float level) { return map.SampleLevel(s, uv, level); }
float4 Texture2DSampleGrad(Texture2D map, SamplerState s, float2 uv, float2 dx, float2 dy) { return map.SampleGrad(s, uv, dx, dy); }
float4 Texture3DSample(Texture3D map, SamplerState s, float3 uvw) { return map.Sample(s, uvw); }
float4 Texture3DSampleBias(Texture3D map, SamplerState s, float3 uvw, float bias) { return map.SampleBias(s, uvw, bias); }
float4 Texture3DSampleLevel(Texture3D map, SamplerState s, float3 uvw, float level) { return map.SampleLevel(s, uvw, level); }
float4 Texture3DSampleGrad(Texture3D map, SamplerState s, float3 uvw, float3 dx, float3 dy) { return map.SampleGrad(s, uvw, dx, dy); }
float4 TextureCubeSample(TextureCube map, SamplerState s, float3 way) { return map.Sample(s, way); }
float4 TextureCubeSampleBias(TextureCube map, SamplerState s, float3 way, float bias) { return map.SampleBias(s, way, bias); }
float4 TextureCubeSampleLevel(TextureCube map, SamplerState s, float3 way, float level) { return map.SampleLevel(s, way, level); }
float4 TextureCubeSampleGrad(TextureCube map, SamplerState s, float3 way, float3 dx, float3 dy) { return map.SampleGrad(s, way, dx, dy); }

// Unreal's normal maps have y down: the import flips the green channel of the maps that a material here is made for.
float4 UnpackNormalMap(float4 texel) {
    float3 imported = float3(texel.x, 1.0 - texel.y, texel.z);
    return float4(imported * 2.0 - 1.0, 1.0);
}
