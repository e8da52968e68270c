// reference: https://github.com/NVIDIA/Q2RTX/issues/23
// kind: nan
// The cosine to the eye is slightly above 1, so the sine's square is below 0: a pixel of a path tracer stays black.

float sine_to_eye(vec3 normal, vec3 direction) // sssgen: assume unit normal, unit direction
{
    float nv = max(-dot(normal, direction), 0.0);
    return sqrt(1.0 - nv * nv); // fails
}

float sine_to_eye_mended(vec3 normal, vec3 direction) // sssgen: assume unit normal, unit direction
{
    float nv = clamp(-dot(normal, direction), 0.0, 1.0);
    return sqrt(1.0 - nv * nv);
}
