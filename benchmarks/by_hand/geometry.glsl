// The geometry techniques written by hand from their formulas; the scene is a ball.

uniform vec3 center;
uniform float radius;
uniform float max_distance;
uniform vec3 look_at;
uniform float focal_length;
uniform float aspect;
uniform float orbit_radius;
uniform float orbit_height;
uniform vec3 eye;

float scene(vec3 p) {
    return length(p - center) - radius;
}

bool raymarch(vec3 ray_origin, vec3 ray_direction, out vec3 P, out vec3 N, out vec3 V) {
    float t = 0.0;
    bool hit = false;
    for (int i = 0; i < 200 && t < max_distance; i++) {
        float gap = scene(ray_origin + ray_direction * t);
        if (gap < 0.001) {
            hit = true;
            break;
        }
        t += gap;
    }
    P = ray_origin + ray_direction * t;
    V = -ray_direction;
    N = V;
    if (hit) {
        vec2 e = vec2(0.001, -0.001);
        N = normalize(e.xyy * scene(P + e.xyy) + e.yyx * scene(P + e.yyx) + e.yxy * scene(P + e.yxy)
            + e.xxx * scene(P + e.xxx));
    }
    return hit;
}

vec3 camera_ray(vec3 from, vec2 uv) {
    vec3 front = normalize(look_at - from);
    vec3 right = normalize(cross(front, vec3(0.0, 1.0, 0.0)));
    vec2 image = uv * 2.0 - 1.0;
    return normalize(right * (image.x * aspect) + cross(right, front) * image.y + front * focal_length);
}

void camera_orbit(vec2 uv, float time, out vec3 ray_origin, out vec3 ray_direction) {
    ray_origin = vec3(orbit_radius * cos(time), orbit_height, orbit_radius * sin(time));
    ray_direction = camera_ray(ray_origin, uv);
}

void camera_still(vec2 uv, out vec3 ray_origin, out vec3 ray_direction) {
    ray_origin = eye;
    ray_direction = camera_ray(eye, uv);
}
