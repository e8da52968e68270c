// reference: https://github.com/mrdoob/three.js/pull/4862
// kind: nan
// The weight of the sky, half a cosine plus a half, is below 0 by rounding; it is the base of a shininess.

float sky_highlight(vec3 normal, vec3 half_vector, float shininess) // sssgen: assume unit normal, unit half_vector, 1 <= shininess <= 100
{
    float weight = 0.5 * dot(normal, half_vector) + 0.5;
    return pow(weight, shininess); // fails
}

float sky_highlight_mended(vec3 normal, vec3 half_vector, float shininess) // sssgen: assume unit normal, unit half_vector, 1 <= shininess <= 100
{
    float weight = 0.5 * dot(normal, half_vector) + 0.5;
    return pow(max(weight, 0.0), shininess);
}
