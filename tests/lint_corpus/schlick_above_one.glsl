// reference: https://github.com/JoeyDeVries/LearnOpenGL/issues/217
// kind: nan
// The cosine of two unit vectors rounds to a little more than 1, so the base of the power is below 0: a black disc.

vec3 fresnel(vec3 n, vec3 v, vec3 f0, float roughness) // sssgen: assume unit n, unit v, 0 <= f0 <= 1, 0 <= roughness <= 1
{
    float cosine = max(dot(n, v), 0.0);
    return f0 + (max(vec3(1.0 - roughness), f0) - f0) * pow(1.0 - cosine, 5.0); // fails
}

vec3 fresnel_mended(vec3 n, vec3 v, vec3 f0, float roughness) // sssgen: assume unit n, unit v, 0 <= f0 <= 1, 0 <= roughness <= 1
{
    float cosine = max(dot(n, v), 0.0);
    return f0 + (max(vec3(1.0 - roughness), f0) - f0) * pow(max(1.0 - cosine, 0.0), 5.0);
}
