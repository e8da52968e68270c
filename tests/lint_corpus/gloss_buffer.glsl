// reference: https://github.com/ThatOpen/engine_components/issues/644
// kind: nan
// Objects that are not drawn into a buffer leave (0, 0, 0) there, which the next pass normalizes.

uniform sampler2D glossBuffer;

vec3 gloss(vec2 uv, float amount)
{
    vec3 texel = texture(glossBuffer, uv).rgb;
    return normalize(texel) * amount; // fails
}

vec3 gloss_mended(vec2 uv, float amount)
{
    vec3 texel = texture(glossBuffer, uv).rgb;
    float size = length(texel);
    return size > 0.001 ? texel / size * amount : vec3(0.0);
}
