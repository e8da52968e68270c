// reference: https://github.com/armory3d/armory/pull/2880
// kind: division
// With a roughness of 0 and the half vector along the normal, the denominator of GGX is 0: bloom flickers white.

float ggx(float dotNH, float roughness) // sssgen: assume 0 <= dotNH <= 1, 0 <= roughness <= 1
{
    float a = roughness * roughness;
    float a2 = a * a;
    float d = dotNH * dotNH * (a2 - 1.0) + 1.0;
    return a2 / (3.14159265 * d * d); // fails
}

float ggx_mended(float dotNH, float roughness) // sssgen: assume 0 <= dotNH <= 1, 0 <= roughness <= 1
{
    float a = roughness * roughness;
    float a2 = a * a;
    float d = dotNH * dotNH * (a2 - 1.0) + 1.0;
    return a2 / max(3.14159265 * d * d, 1e-7);
}
