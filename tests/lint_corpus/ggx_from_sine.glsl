// reference: https://github.com/godotengine/godot/pull/59123
// kind: division
// A distribution of microfacets whose denominator rounds to 0 for roughnesses below 0.01.

float distribution(float cosine, float alpha) // sssgen: assume 0 <= cosine <= 1, 0 <= alpha <= 1
{
    float alpha2 = alpha * alpha;
    float d = 1.0 + (alpha2 - 1.0) * cosine * cosine;
    return alpha2 / (3.14159265 * d * d); // fails
}

float distribution_mended(float cosine, float alpha) // sssgen: assume 0 <= cosine <= 1, 0.001 <= alpha <= 1
{
    float sine2 = max(1.0 - cosine * cosine, 0.0);
    float a = cosine * alpha;
    float k = alpha / max(sine2 + a * a, 1e-6);
    return k * k * (1.0 / 3.14159265);
}
