// The thickness techniques written by hand from their formulas; the body is a ball.

uniform vec3 center;
uniform float radius;
uniform float reach;
uniform float decay;
uniform float falloff;
uniform float thickness_factor;
uniform sampler2D thickness_texture;
uniform sampler2D thinness_texture;
uniform sampler2D transmittance_texture;
uniform sampler2D light_depth_map;
uniform mat4 light_matrix;
uniform float bias;
uniform float cell_count;
uniform float bevel;
uniform float variation;
uniform vec3 box_min;
uniform vec3 box_max;
uniform sampler3D distance_map;
uniform float distance_range;
uniform float object_scale;

const int TAPS = 29;
const int TRACED_TAPS = 4;
const int HASHED_TAPS = 6;
const int RAYS = 24;
const int RAY_STEPS = 16;
const int LIGHT_MARCH = 32;
const int TRACED_STEPS = 12;
const int VIEW_STEPS = 8;
const int LIGHT_STEPS = 8;

float body(vec3 p) {
    return length(p - center) - radius;
}

float constant_thickness() {
    return thickness_factor;
}

float thickness_map(vec2 uv) {
    return thickness_factor * texture(thickness_texture, uv).r;
}

float thinness_map(vec2 uv) {
    return texture(thinness_texture, uv).r;
}

float transmittance_map(vec2 uv) {
    return texture(transmittance_texture, uv).r;
}

float depth_map_thickness(vec3 P) {
    vec4 lit = light_matrix * vec4(P, 1.0);
    vec2 at = lit.xy / lit.w;
    if (lit.w <= 0.0 || any(greaterThan(abs(at - 0.5), vec2(0.5)))) {
        return 0.0;
    }
    return max(lit.z - textureLod(light_depth_map, at, 0.0).r - bias, 0.0);
}

float thinness_uniform(vec3 P, vec3 N) {
    float total = 0.0;
    float most = 0.0;
    for (int i = 1; i <= TAPS; i++) {
        float d = reach * float(i) / float(TAPS + 1);
        total += clamp(d + body(P - N * d), 0.0, 2.0 * d);
        most += 2.0 * d;
    }
    return total / most;
}

float thinness_attenuated(vec3 P, vec3 N) {
    float total = 0.0;
    float most = 0.0;
    float weight = 1.0;
    for (int i = 1; i <= TAPS; i++) {
        float d = reach * float(i) / float(TAPS + 1);
        total += weight * clamp(d + body(P - N * d), 0.0, 2.0 * d);
        most += weight * 2.0 * d;
        weight *= decay;
    }
    return total / most;
}

float thinness_traced(vec3 P, vec3 N) {
    float d = reach;
    float f = clamp(d + body(P - N * d), 0.0, 2.0 * d);
    float way = 0.5 * f;
    float area = 0.0;
    for (int i = 1; i < TRACED_TAPS && f > 0.004 * reach && f < 2.0 * d; i++) {
        float h = i + 1 < TRACED_TAPS ? 0.5 * way : way;
        float next = clamp(d - h + body(P - N * (d - h)), 0.0, min(f, 2.0 * (d - h)));
        d -= h;
        area += h * (f + next);
        way = min(h * next / max(f - next, 1.0e-6), d);
        f = next;
    }
    return 0.5 * (area + way * f) / (reach * reach);
}

uint scrambled(uint x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

float unit_hash(uint x) {
    return float(scrambled(x) >> 8) / 16777216.0;
}

float thinness_xt95(vec3 P, vec3 N) {
    float total = 0.0;
    float most = 0.0;
    for (int i = 0; i < HASHED_TAPS; i++) {
        float l = reach * (float(i) + unit_hash(uint(i + 1))) / float(HASHED_TAPS);
        float weight = pow(1.0 + l, -falloff);
        total += weight * clamp(l + body(P - N * l), 0.0, 2.0 * l);
        most += weight * 2.0 * l;
    }
    return total / most;
}

float thinness_hemisphere(vec3 P, vec3 N) {
    float left = 0.0;
    float total = 0.0;
    for (int i = 0; i < RAYS; i++) {
        float z = (float(i) + 0.5) / float(RAYS);
        float turn = 2.39996323 * float(i);
        vec3 ray = vec3(sqrt(1.0 - z * z) * vec2(cos(turn), sin(turn)), z);
        float inward = -dot(ray, N);
        ray *= sign(inward);
        total += abs(inward);
        float t = 0.01 * reach;
        for (int j = 0; j <= RAY_STEPS; j++) {
            float gap = body(P + ray * t);
            if (gap > 0.0) {
                left += abs(inward);
                break;
            }
            if (t >= reach) {
                break;
            }
            t = min(t + max(-gap, reach / float(RAY_STEPS)), reach);
        }
    }
    return left / total;
}

float inside_part(float a, float b) {
    return (max(-a, 0.0) + max(-b, 0.0)) / (abs(a) + abs(b));
}

float march_light(vec3 P, vec3 L) {
    float h = reach / float(LIGHT_MARCH);
    float inside = 0.0;
    float before = body(P);
    for (int i = 1; i <= LIGHT_MARCH; i++) {
        float after = body(P + L * (h * float(i)));
        inside += inside_part(before, after);
        before = after;
    }
    return inside * h;
}

float march_light_traced(vec3 P, vec3 L) {
    float t = 0.0;
    float inside = 0.0;
    float before = body(P);
    for (int i = 0; i < TRACED_STEPS && t + max(before, 0.0) < reach; i++) {
        float left = reach - t;
        float least = left * float(2 * i + 1) / float((TRACED_STEPS + i) * (TRACED_STEPS - i));
        float h = min(max(abs(before), least), left);
        float after = body(P + L * (t + h));
        if (before * after < 0.0 && abs(before) + abs(after) < 0.9 * h) {
            float first = 0.5 * (h + abs(before) - abs(after));
            float between = body(P + L * (t + first));
            inside += first * inside_part(before, between) + (h - first) * inside_part(between, after);
        } else {
            inside += h * inside_part(before, after);
        }
        t += h;
        before = after;
    }
    return inside;
}

// Everything in the box's own coordinates, 0 to 1.
float stored(vec3 uvw) {
    return (2.0 * textureLod(distance_map, clamp(uvw, 0.0, 1.0), 0.0).r - 1.0) * distance_range;
}

float way_out(vec3 uvw, vec3 along) {
    vec3 exits = (step(0.0, along) - uvw) / along;
    return max(min(exits.x, min(exits.y, exits.z)), 0.0);
}

float to_light(vec3 uvw, vec3 along) {
    float h = way_out(uvw, along) / float(LIGHT_STEPS);
    float inside = 0.0;
    float before = stored(uvw);
    for (int i = 1; i <= LIGHT_STEPS; i++) {
        float after = stored(uvw + along * (h * float(i)));
        inside += inside_part(before, after);
        before = after;
    }
    return inside * h;
}

float march_distance_texture(vec3 P_object, vec3 V_object, vec3 L_object) {
    vec3 size = box_max - box_min;
    vec3 uvw = (P_object - box_min) / size;
    vec3 view = -V_object / size;
    vec3 light = L_object / size;
    float far = way_out(uvw, view);
    float seen = 0.0;
    float way = 0.0;
    float last = 0.0;
    float before = stored(uvw);
    for (int i = 1; i <= VIEW_STEPS; i++) {
        float x = float(i) / float(VIEW_STEPS);
        float t = far * x * x;
        float after = stored(uvw + view * t);
        float inside = (t - last) * inside_part(before, after);
        if (inside > 0.0) {
            float middle = before < after ? last + 0.5 * inside : t - 0.5 * inside;
            way += inside * (seen + 0.5 * inside + to_light(uvw + view * middle, light));
            seen += inside;
        }
        before = after;
        last = t;
    }
    return object_scale * (seen > 0.0 ? way / seen : to_light(uvw, light));
}

float voronoi_thickness(vec2 uv) {
    vec2 p = uv * cell_count;
    vec2 home = floor(p);
    vec2 within = p - home;
    float first = 16.0;
    float second = 16.0;
    uint owner = 0u;
    for (int j = -1; j <= 1; j++) {
        for (int i = -1; i <= 1; i++) {
            ivec2 cell = ivec2(home) + ivec2(i, j);
            uint seed = scrambled(uint(cell.x) + scrambled(uint(cell.y) + 1u));
            vec2 jitter = vec2(unit_hash(seed + 1u), unit_hash(seed + 2u)) - 0.5;
            vec2 way = vec2(i, j) + 0.5 + 0.6 * jitter - within;
            float square = dot(way, way);
            if (square < first) {
                second = first;
                first = square;
                owner = seed;
            } else {
                second = min(second, square);
            }
        }
    }
    float level = 1.0 - variation * unit_hash(owner + 3u);
    return thickness_factor * level * smoothstep(0.0, bevel, sqrt(second) - sqrt(first));
}
