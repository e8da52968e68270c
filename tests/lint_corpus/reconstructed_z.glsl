// reference: https://github.com/Unity-Technologies/ScriptableRenderPipeline/pull/2952
// kind: nan
// A node that reconstructs z from x and y, for values that are no part of a unit vector.

vec3 reconstructed(vec2 xy)
{
    return normalize(vec3(xy, sqrt(1.0 - dot(xy, xy)) + 1e-6)); // fails
}

vec3 reconstructed_mended(vec2 xy)
{
    return normalize(vec3(xy, sqrt(1.0 - clamp(dot(xy, xy), 0.0, 1.0)) + 1e-6));
}
