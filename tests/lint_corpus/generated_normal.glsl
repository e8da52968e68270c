// reference: https://github.com/Unity-Technologies/Graphics/pull/437
// kind: nan
// A node graph can compute a normal of length 0, which was then normalized: lighting flashes.

vec3 blended_normal(vec3 base, vec3 detail, float weight) // sssgen: assume 0 <= weight <= 1
{
    return normalize(mix(base, detail, weight)); // fails
}

vec3 blended_normal_mended(vec3 base, vec3 detail, float weight) // sssgen: assume 0 <= weight <= 1
{
    vec3 n = mix(base, detail, weight);
    return n * inversesqrt(max(dot(n, n), 1e-20));
}
