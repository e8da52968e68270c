// reference: https://github.com/pelicanmapping/rocky/issues/39
// kind: overflow
// A camera below the surface makes the exponent of the air's density positive and large: infinity, then NaN.

float density(float radius, float height, float scale) // sssgen: assume 0 <= radius <= 10, 0 <= height <= 10, 0.001 <= scale <= 1
{
    return exp((radius - height) / scale); // fails
}

float density_mended(float radius, float height, float scale) // sssgen: assume 0 <= radius <= 10, 0 <= height <= 10, 0.001 <= scale <= 1
{
    return exp(min(radius - height, 0.0) / scale);
}
