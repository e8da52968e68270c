// The output techniques written by hand from their formulas.

uniform float display_gamma;

vec3 gamma(vec3 color) {
    return pow(max(color, 0.0), vec3(1.0 / display_gamma));
}

vec3 srgb(vec3 color) {
    vec3 light = max(color, 0.0);
    vec3 curved = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}
