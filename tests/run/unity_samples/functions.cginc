// Functions to paste into a shader for the built-in pipeline: what the unity compiler must be able to take.
float3 backlight(sampler2D map, float2 uv, float3 normal, float3 view, float3 light, inout float weight)
{
    weight *= saturate(dot(view, -normalize(light + normal)));
    return tex2D(map, uv).rgb * weight * _LightColor0.rgb;
}
