// The translucency techniques written by hand from their formulas, to be compared with what is emitted of them.

uniform float distortion;
uniform float power;
uniform float scale;
uniform float ambient;
uniform float attenuation;
uniform vec3 subsurface_color;
uniform float anisotropy;
uniform float weight;
uniform float wrap;
uniform vec3 attenuation_color;
uniform float attenuation_distance;
uniform float diffuse_transmission_factor;
uniform vec3 diffuse_transmission_color;
uniform float glow_strength;
uniform vec3 sky_color;

vec3 lobe_gdc2011(vec3 V, vec3 N, vec3 L, float through) {
    float lobe = pow(clamp(-dot(V, L + N * distortion), 0.0, 1.0), power);
    return subsurface_color * ((lobe * scale + ambient) * attenuation * through);
}

vec3 lobe_normalized(vec3 V, vec3 N, vec3 L, float through) {
    float lobe = pow(clamp(-dot(V, normalize(L + N * distortion)), 0.0, 1.0), power);
    return subsurface_color * ((lobe * scale + ambient) * attenuation * through);
}

vec3 lobe_exp2(vec3 V, vec3 N, vec3 L, float through) {
    float lobe = exp2(clamp(-dot(V, L + N * distortion), 0.0, 1.0) * power - power);
    return subsurface_color * ((lobe * scale + ambient) * attenuation * through);
}

vec3 lobe_henyey_greenstein(vec3 V, vec3 L, float through) {
    float g = anisotropy;
    float s = 1.0 + g * g + 2.0 * g * dot(V, L);
    return subsurface_color * (weight * through * (1.0 - g * g) / (s * sqrt(s)));
}

vec3 wrap_lighting(vec3 N, vec3 L) {
    float facing = dot(N, L);
    return subsurface_color * (max((facing + wrap) / (1.0 + wrap), 0.0) - max(facing, 0.0));
}

vec3 absorption_tint(float d) {
    return weight * pow(attenuation_color, vec3(d / attenuation_distance));
}

vec3 gltf_diffuse_transmission(vec3 V, vec3 N, vec3 L, float through) {
    float behind = max(-dot(faceforward(N, -V, N), L), 0.0);
    return diffuse_transmission_color * (diffuse_transmission_factor * behind * through);
}

vec3 sky_glow(vec3 V, float th) {
    return glow_strength * th * mix(sky_color, vec3(1.0), clamp(V.y * 5.0, 0.0, 1.0));
}
