// The parallax techniques written by hand from their formulas, in a frame that may be sheared or mirrored.

uniform float depth;
uniform float grazing_fade;
uniform vec2 uv_per_unit;
uniform float ior;
uniform float outside_ior;

vec2 slide(vec2 uv, vec3 ray, vec3 T, vec3 B, vec3 N) {
    vec3 across = cross(B, N);
    float volume = dot(T, across);
    if (abs(volume) < 0.01) {
        return uv;
    }
    vec2 along = vec2(dot(ray, across) * length(T), dot(ray, cross(N, T)) * length(B)) / volume;
    float cosine = -dot(ray, N);
    float x = clamp(cosine / grazing_fade, 0.0, 1.0);
    return uv + along * uv_per_unit * (depth * x * x * (4.0 - 3.0 * x) / max(cosine, grazing_fade));
}

vec2 parallax_straight(vec2 uv, vec3 V, vec3 T, vec3 B, vec3 N) {
    return slide(uv, -V, T, B, faceforward(N, -V, N));
}

vec2 parallax_refracted(vec2 uv, vec3 V, vec3 T, vec3 B, vec3 N) {
    vec3 facing = faceforward(N, -V, N);
    return slide(uv, refract(-V, facing, outside_ior / ior), T, B, facing);
}

uniform float relative_ior;

vec2 parallax_orthonormal(vec2 uv, vec3 V, vec3 T, vec3 B) {
    vec2 across = vec2(dot(V, T), dot(V, B));
    float reciprocal = min(inversesqrt(max(relative_ior * relative_ior - dot(across, across), 1.0e-6)), 5.0);
    return uv - uv_per_unit * across * (depth * reciprocal);
}
