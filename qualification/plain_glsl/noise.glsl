// Value and gradient noise over an integer hash.

float lattice(ivec2 p) {
    int n = p.x * 3 + p.y * 113;
    n = (n << 13) ^ n;
    n = n * (n * n * 15731 + 789221) + 1376312589;
    return -1.0 + 2.0 * float(n & 0x0fffffff) / float(0x0fffffff);
}

float value_noise(vec2 p) {
    ivec2 i = ivec2(floor(p));
    vec2 f = fract(p);
    vec2 u = f * f * (3.0 - 2.0 * f);
    return mix(mix(lattice(i), lattice(i + ivec2(1, 0)), u.x),
               mix(lattice(i + ivec2(0, 1)), lattice(i + ivec2(1, 1)), u.x), u.y);
}

float gradient(int hash, vec3 d) {
    int h = hash & 15;
    float u = h < 8 ? d.x : d.y;
    float v = h < 4 ? d.y : (h == 12 || h == 14) ? d.x : d.z;
    return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
}

float fbm(vec2 p, int octaves) {
    float sum = 0.0, amplitude = 0.5;
    for (int i = 0; i < octaves; i++) {
        sum += amplitude * value_noise(p);
        p = p * 2.0 + vec2(17.0, -3.0);
        amplitude *= 0.5;
    }
    return sum;
}

float ridged(float n) {
    n = 1.0 - abs(n);
    return n * n;
}
