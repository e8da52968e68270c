// reference: https://github.com/Unity-Technologies/Graphics/pull/346
// kind: division
// The sum in the denominator of the joint Smith term is 0 at grazing angles of both directions.

float visibility(float nl, float nv, float roughness) // sssgen: assume 0 <= nl <= 1, 0 <= nv <= 1, 0 <= roughness <= 1
{
    float a2 = roughness * roughness;
    float lambdaV = nl * sqrt((1.0 - a2) * nv * nv + a2);
    float lambdaL = nv * sqrt((1.0 - a2) * nl * nl + a2);
    return 0.5 / (lambdaV + lambdaL); // fails
}

float visibility_mended(float nl, float nv, float roughness) // sssgen: assume 0 <= nl <= 1, 0 <= nv <= 1, 0 <= roughness <= 1
{
    float a2 = roughness * roughness;
    float lambdaV = nl * sqrt((1.0 - a2) * nv * nv + a2);
    float lambdaL = nv * sqrt((1.0 - a2) * nl * nl + a2);
    return 0.5 / max(lambdaV + lambdaL, 1e-5);
}
