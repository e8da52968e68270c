// reference: https://github.com/mrdoob/three.js/issues/17559
// kind: division
// A tangent frame of screen derivatives, where the texture coordinates of a triangle are all equal.

vec3 tangent(vec3 dp1, vec3 dp2, vec2 duv1, vec2 duv2)
{
    float det = duv1.x * duv2.y - duv2.x * duv1.y;
    return (dp1 * duv2.y - dp2 * duv1.y) / det; // fails
}

vec3 tangent_mended(vec3 dp1, vec3 dp2, vec2 duv1, vec2 duv2)
{
    float det = duv1.x * duv2.y - duv2.x * duv1.y;
    float scale = det == 0.0 ? 0.0 : 1.0 / det;
    return (dp1 * duv2.y - dp2 * duv1.y) * scale;
}
