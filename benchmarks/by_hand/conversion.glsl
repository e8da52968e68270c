// The conversions between thickness, thinness and transmittance, written by hand from their formulas.

uniform float attenuation_distance;
uniform float opaque_thickness;
uniform float reach;

float beer_lambert(float d) {
    return exp(-d / attenuation_distance);
}

float slab_from_thinness(float th) {
    return 2.0 * reach * (1.0 - sqrt(th));
}

float thickness_from_thinness(float th) {
    return (1.0 - th) * opaque_thickness;
}

float thickness_from_transmittance(float through) {
    return -attenuation_distance * log(max(through, 0.002));
}

float thinness_from_thickness(float d) {
    return clamp(1.0 - d / opaque_thickness, 0.0, 1.0);
}
