// Conversions of colours.

vec3 to_linear(vec3 c) {
    vec3 low = c / 12.92, high = pow((max(c, 0.0) + 0.055) / 1.055, vec3(2.4));
    return mix(high, low, lessThanEqual(c, vec3(0.04045)));
}

vec3 hsv(vec3 c) {
    vec3 p = abs(fract(c.xxx + vec3(1.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0);
    return c.z * mix(vec3(1.0), clamp(p - 1.0, 0.0, 1.0), c.y);
}

float hue(vec3 c) {
    float high = max(c.r, max(c.g, c.b)), low = min(c.r, min(c.g, c.b)), range = high - low;
    if (range < 0.01) return 0.0;
    float h;
    if (high == c.r) h = (c.g - c.b) / range + (c.g < c.b ? 6.0 : 0.0);
    else if (high == c.g) h = (c.b - c.r) / range + 2.0;
    else h = (c.r - c.g) / range + 4.0;
    return h / 6.0;
}

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

uint packed_color(vec4 c) {
    uvec4 bytes = uvec4(clamp(c, 0.0, 1.0) * 255.0 + 0.25);
    return bytes.r | (bytes.g << 8) | (bytes.b << 16) | (bytes.a << 24);
}

vec4 unpacked_color(uint p) {
    return vec4(p & 0xffu, (p >> 8) & 0xffu, (p >> 16) & 0xffu, p >> 24) / 255.0;
}

vec3 tone(vec3 x, float exposure) {
    x *= exposure;
    return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 temperature(float kelvin) {
    float t = clamp(kelvin, 1000.0, 40000.0) / 100.0;
    vec3 c = vec3(255.0);
    if (t > 66.0) c.r = 329.7 - (t - 60.0) * 0.9;
    if (t <= 19.0) c.b = 0.0;
    else if (t < 66.0) c.b = (t - 19.0) * 5.4;
    return c / 255.0;
}
