// reference: https://github.com/godotengine/godot/issues/55888
// kind: division
// A constant over the mean of a pixel's channels: transparent pixels are black, and the result depends on the device.

uniform sampler2D picture;

float inverted(vec2 uv)
{
    vec4 pixel = texture(picture, uv);
    return 0.15 / ((pixel.r + pixel.g + pixel.b) / 3.0); // fails
}

float inverted_mended(vec2 uv)
{
    vec4 pixel = texture(picture, uv);
    return 0.15 / ((pixel.r + pixel.g + pixel.b + 0.01) / 3.0);
}
