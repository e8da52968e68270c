// The lighting techniques written by hand from their formulas; the scene is a ball.

uniform vec3 center;
uniform float radius;
uniform vec3 key_direction;
uniform float shadow_sharpness;
uniform vec3 sky_color;

float lobe(vec3 across, float NoL, float NoV, float NoH, float roughness) {
    float a = max(roughness, 0.045);
    a *= a;
    // in this form the peak of a mirror is exact
    float spread = dot(across, across) + NoH * NoH * a * a;
    return a * a / (spread * spread) * 0.5 / mix(2.0 * NoL * NoV, NoL + NoV, a);
}

// A fit to what a white sheen of this roughness reflects.
float charlie_share(float cosine, float r) {
    float grazing = (2.31 - 3.95 * r + 2.23 * r * r) * exp(-(9.86 - 19.53 * r + 11.69 * r * r) * cosine);
    return clamp(grazing + 0.051 * r * r, 0.0, 1.0);
}

vec3 standard(vec3 N, vec3 V, vec3 L, vec3 albedo, float metallic, float roughness, vec3 light_color,
        float specular, float clearcoat, float clearcoat_roughness, vec3 sheen_color, float sheen_roughness) {
    vec3 H = normalize(V + L);
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 1.0e-4);
    float NoH = max(dot(N, H), 0.0);
    vec3 across = cross(N, H);
    float grazing = pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    vec3 F0 = mix(vec3(specular), albedo, metallic);
    vec3 F = F0 + (1.0 - F0) * grazing;
    vec3 base = albedo * (1.0 - metallic) * (1.0 - F) + lobe(across, NoL, NoV, NoH, roughness) * F;
    float strongest = max(sheen_color.x, max(sheen_color.y, sheen_color.z));
    if (strongest > 0.0) {
        float share = max(charlie_share(NoL, sheen_roughness), charlie_share(NoV, sheen_roughness));
        float n = 1.0 / max(sheen_roughness * sheen_roughness, 0.005);
        float fibres = (2.0 + n) * pow(length(across), n) / (8.0 * max(NoL + NoV - NoL * NoV, 1.0e-4));
        base = base * max(1.0 - strongest * share, 0.0) + sheen_color * fibres;
    }
    if (clearcoat > 0.0) {
        float coat = clearcoat * (0.04 + 0.96 * grazing);
        base = mix(base, vec3(lobe(across, NoL, NoV, NoH, clearcoat_roughness)), coat);
    }
    return base * NoL * light_color;
}

float scene(vec3 p) {
    return length(p - center) - radius;
}

float soft_shadow(vec3 p, vec3 L) {
    float t = 0.001;
    float free = 1.0;
    for (int i = 0; i < 25 && free > 0.0; i++) {
        float gap = scene(p + L * t);
        free = min(free, shadow_sharpness * gap / t);
        t += clamp(gap, 0.001, 2.0);
    }
    return clamp(free, 0.0, 1.0);
}

vec3 studio(vec3 P, vec3 N, vec3 albedo, vec3 translucency) {
    vec3 key = normalize(key_direction);
    float shadow = soft_shadow(P + N * 0.001, key);
    vec3 light = vec3(0.2) * shadow;
    light += vec3(0.82, 0.8, 0.82) * max(dot(N, key), 0.0) * shadow;
    light += vec3(0.26, 0.32, 0.334) * (0.2 + 0.8 * clamp(N.y, 0.0, 1.0));
    light += vec3(0.3, 0.21, 0.23) * (0.2 + 0.8 * clamp(-N.y, 0.0, 1.0));
    light += vec3(0.2, 0.21, 0.23) * max(dot(N, vec3(-key.x, 0.0, -key.z)), 0.0);
    return albedo * (light + translucency);
}

vec3 sky_background(vec3 ray_direction) {
    return mix(sky_color, vec3(1.0), clamp(ray_direction.y * 5.0, 0.0, 1.0));
}
