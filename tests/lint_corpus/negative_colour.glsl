// reference: https://github.com/PixarAnimationStudios/OpenUSD/issues/2016
// kind: nan
// A base colour with negative components reaches the power of the conversion to sRGB.

vec3 encoded(vec3 colour)
{
    return pow(colour, vec3(1.0 / 2.2)); // fails
}

vec3 encoded_mended(vec3 colour)
{
    return pow(max(colour, 0.0), vec3(1.0 / 2.2));
}
