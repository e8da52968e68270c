// reference: https://github.com/levy-street/world-of-claudecraft/pull/2790
// kind: nan
// 1 minus the size of a cosine of unit vectors is below 0 by rounding where the surface faces the eye.

float rim(vec3 vN, vec3 vV, float power) // sssgen: assume nonzero vN, nonzero vV, 1 <= power <= 8
{
    return pow(1.0 - abs(dot(normalize(vN), normalize(vV))), power); // fails
}

float rim_mended(vec3 vN, vec3 vV, float power) // sssgen: assume nonzero vN, nonzero vV, 1 <= power <= 8
{
    return pow(max(1.0 - abs(dot(normalize(vN), normalize(vV))), 0.0), power);
}
