// reference: https://github.com/bevyengine/bevy/pull/10905
// kind: nan
// The tip of a cone has a normal of 0, so that no side is preferred; normalized in the vertex shader, all its triangles are black.

vec3 world_normal(mat3 turn, vec3 normal)
{
    return normalize(turn * normal); // fails
}

vec3 world_normal_mended(mat3 turn, vec3 normal)
{
    vec3 n = turn * normal;
    return dot(n, n) > 1e-12 ? normalize(n) : n;
}
