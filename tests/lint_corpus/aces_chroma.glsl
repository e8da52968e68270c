// reference: https://github.com/Unity-Technologies/ScriptableRenderPipeline/pull/5852
// kind: nan
// The chroma of a colour by a sum of products that is 0 for greys, and less than 0 by rounding.

float chroma(vec3 rgb) // sssgen: assume 0 <= rgb <= 1000
{
    return sqrt(rgb.b * (rgb.b - rgb.g) + rgb.g * (rgb.g - rgb.r) + rgb.r * (rgb.r - rgb.b)); // fails
}

float chroma_mended(vec3 rgb) // sssgen: assume 0 <= rgb <= 1000
{
    float k = rgb.b * (rgb.b - rgb.g) + rgb.g * (rgb.g - rgb.r) + rgb.r * (rgb.r - rgb.b);
    return k > 0.0 ? sqrt(k) : 0.0;
}
