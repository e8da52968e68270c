// reference: https://github.com/ValveResourceFormat/ValveResourceFormat/pull/1207
// kind: nan
// 0 to the power 0 is NaN where pow is computed by logarithms; a clamp makes it the brightest white of the bloom.

float highlight(float shade, float gloss) // sssgen: assume 0 <= shade <= 1, 0 <= gloss <= 64
{
    return pow(shade, gloss); // fails
}

float highlight_mended(float shade, float gloss) // sssgen: assume 0 <= shade <= 1, 0 <= gloss <= 64
{
    return shade > 0.0 ? pow(max(shade, 1e-6), gloss) : 0.0;
}
