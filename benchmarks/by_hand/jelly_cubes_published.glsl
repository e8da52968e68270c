#version 330 core
// 42yeah's scene as published, written by hand from its description: 42yeah, Raymarching Cheap Subsurface Scattering.
// Thirty taps in one field with the floor, a field that carries what it is of, normals by backward differences, and
// everything computed for every pixel, whatever it shows.

uniform float time;
uniform float aspect;

in vec2 v_uv;
out vec4 fragment_color;

const vec3 SUN = vec3(0.57735027);

float cube(vec3 p, vec3 center) {
    float turn = radians(45.0);
    vec3 local = p - center;
    local.xz = mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * local.xz;
    vec3 q = abs(local) - 0.5;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// Distance, and what is there: 1 = floor, 2 = jelly.
vec2 field(vec3 p) {
    vec2 found = vec2(p.y, 1.0);
    float left = cube(p, vec3(0.0, 0.48, 0.0));
    if (left < found.x) {
        found = vec2(left, 2.0);
    }
    float right = cube(p, vec3(1.45, 0.48, 0.0));
    if (right < found.x) {
        found = vec2(right, 2.0);
    }
    return found;
}

// The way to what the ray meets, and what that is: 0 = nothing.
vec2 march(vec3 origin, vec3 ray) {
    float way = 0.0;
    for (int i = 0; i < 200; i++) {
        vec2 found = field(origin + ray * way);
        if (abs(found.x) < 0.001) {
            return vec2(way, found.y);
        }
        way += found.x;
    }
    return vec2(way, 0.0);
}

vec3 backward_normal(vec3 p) {
    vec2 e = vec2(0.001, 0.0);
    return normalize(field(p).x - vec3(field(p - e.xyy).x, field(p - e.yxy).x, field(p - e.yyx).x));
}

float soft_shadow(vec3 p, vec3 ray) {
    float way = 0.001;
    float free = 1.0;
    for (int i = 0; i < 25; i++) {
        float gap = field(p + ray * way).x;
        free = min(free, 20.0 * gap / way);
        if (free < 1.0e-6) {
            break;
        }
        way += clamp(gap, 0.001, 2.0);
    }
    return clamp(free, 0.0, 1.0);
}

float thinness(vec3 p, vec3 n) {
    float total = 0.0;
    for (int i = 0; i < 30; i++) {
        float depth = float(i) * 0.4 / 30.0;
        total += depth + field(p - n * depth).x;
    }
    return total / 30.0;
}

vec3 sky(float height) {
    return mix(vec3(0.67, 0.86, 0.98), vec3(1.0), clamp(height * 5.0, 0.0, 1.0));
}

vec3 albedo(float what, vec3 p, vec3 ray) {
    if (what < 0.5) {
        return sky(ray.y);
    }
    if (what < 1.5) {
        vec3 tile = mod(floor(p * 2.0), 2.0);
        return vec3(1.0 - clamp(abs(tile.x - tile.z), 0.0, 0.1));
    }
    return vec3(1.0, 0.5, 0.0);
}

void main() {
    vec3 eye = vec3(3.0 * cos(time), 2.5, 3.0 * sin(time));
    vec3 front = normalize(vec3(0.65, 0.5, 0.0) - eye);
    vec3 right = normalize(cross(front, vec3(0.0, 1.0, 0.0)));
    vec3 up = normalize(cross(right, front));
    vec2 image = v_uv * 2.0 - 1.0;
    vec3 ray = normalize(mat3(right, up, front) * vec3(image.x * aspect, image.y, 2.0));

    vec2 met = march(eye, ray);
    vec3 p = eye + ray * met.x;
    vec3 n = backward_normal(p);
    float shadow = soft_shadow(p + n * 0.001, SUN);
    float thin = thinness(p, n);

    vec3 light = vec3(1.0);
    if (met.y > 0.5) {
        light = vec3(0.2) * shadow;
        light += vec3(0.82, 0.8, 0.82) * max(dot(n, SUN), 0.0) * shadow;
        light += vec3(0.26, 0.32, 0.334) * (0.2 + 0.8 * clamp(n.y, 0.0, 1.0));
        light += vec3(0.3, 0.21, 0.23) * (0.2 + 0.8 * clamp(-n.y, 0.0, 1.0));
        light += vec3(0.2, 0.21, 0.23) * max(dot(n, vec3(-SUN.x, 0.0, -SUN.z)), 0.0);
        light += thin * sky(-ray.y) * 0.9;
    }
    fragment_color = vec4(pow(albedo(met.y, p, ray) * light, vec3(0.4545)), 1.0);
}
