// Jelly cubes: Two jelly cubes on a floor, drawn from distance functions; their thin parts glow with
// the sky.
// Made by sssgen for GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0). Change the material and emit it again rather than this file.
// Paste it below the #version and precision of your own shader.

const int MAX_STEPS = 200;
const float CUBE_SPACING = 1.45;
const float CUBE_HEIGHT = 0.48;
const vec3 CUBES_HALF = vec3(1.4322, 0.5, 0.7072);
const float COS_45 = 0.70710677;
const float HALF_SIZE = 0.5;
const float HIT_TOLERANCE = 0.001;
const float NOTHING = 0.004;
const float LEVEL = 1.0e-6;

// The direction of `x`; of a zero vector, 0.
vec3 safe_normalize(vec3 x) {
    return x * inversesqrt(max(dot(x, x), 1.0e-30));
}

// The direction in which the camera at `eye` sees the image point `uv` ((0, 0) to (1, 1), v up).
vec3 camera_ray(vec3 eye, vec2 uv, vec3 look_at, float aspect, float focal_length) {
    vec3 front = safe_normalize(look_at - eye);
    vec3 right = safe_normalize(cross(front, vec3(0.0, 1.0, 0.0)));
    vec3 up = cross(right, front);
    vec2 image = uv * 2.0 - 1.0;
    return safe_normalize(right * (image.x * aspect) + up * image.y + front * focal_length);
}

// A camera that circles the scene, one radian a second.
void camera_orbit(vec2 uv, float time, out vec3 ray_origin, out vec3 ray_direction, float orbit_radius,
    float orbit_height, vec3 look_at, float aspect, float focal_length) {
    ray_origin = vec3(orbit_radius * cos(time), orbit_height, orbit_radius * sin(time));
    ray_direction = camera_ray(ray_origin, uv, look_at, aspect, focal_length);
}

// The signed distance to the ground, y = 0.
float ground_plane(vec3 p) {
    return p.y;
}

// A cube about the origin, turned by 45 degrees about the y axis.
float turned_cube(vec3 p) {
    vec3 turned = vec3((p.x - p.z) * COS_45, p.y, (p.x + p.z) * COS_45);
    vec3 q = abs(turned) - HALF_SIZE;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// The two jelly cubes of 42yeah, without the floor: the body that light shines through.
float jelly_cubes(vec3 p) {
    // each is the other's mirror image in the plane between them, so the nearer one is all there is to ask
    float middle = 0.5 * CUBE_SPACING;
    return turned_cube(vec3(abs(p.x - middle) - middle, p.y - CUBE_HEIGHT, p.z));
}

// The scene of 42yeah: two jelly cubes on the ground.
float jelly_scene(vec3 p) {
    float ground = ground_plane(p);
    // where the ground is nearer than their box, the cubes need no look
    vec3 q = abs(p - vec3(0.5 * CUBE_SPACING, CUBE_HEIGHT, 0.0)) - CUBES_HALF;
    if (max(q.x, max(q.y, q.z)) > ground) {
        return ground;
    }
    return min(jelly_cubes(p), ground);
}

// The gradient of the scene at `p`, from the four corners of a tetrahedron about it.
vec3 scene_normal(vec3 p) {
    vec2 e = HIT_TOLERANCE * vec2(1.0, -1.0);
    float a = jelly_scene(p + e.xyy);
    float b = jelly_scene(p + e.yyx);
    float c = jelly_scene(p + e.yxy);
    float d = jelly_scene(p + e.xxx);
    // nearly equal numbers, whose differences are exact
    return safe_normalize(vec3(a - b + (d - c), c - a + (d - b), b - a + (d - c)));
}

// Sphere tracing: draws a scene given as a distance function; where a ray meets nothing it returns false.
bool raymarch(vec3 ray_origin, vec3 ray_direction, out vec3 P, out vec3 N, out vec3 V, float max_distance) {
    float t = 0.0;
    bool hit = false;
    for (int i = 0; i < MAX_STEPS && t < max_distance; i++) {
        float gap = jelly_scene(ray_origin + ray_direction * t);
        if (gap < HIT_TOLERANCE) {
            hit = true;
            break;
        }
        t += gap;
    }
    P = ray_origin + ray_direction * t;
    V = -ray_direction;
    N = V;
    if (hit) {
        N = scene_normal(P);
    }
    return hit;
}

// thinness_uniform in full, from a few taps: from the deepest one up, each halfway to where the sum would end.
float thinness_traced(vec3 P, vec3 N, float reach) {
    float depth = reach;
    float here = clamp(depth + jelly_cubes(P - N * depth), 0.0, 2.0 * depth);
    // how much farther up it would be 0 if it went on in a straight line
    float way = 0.5 * here;
    float area = 0.0;
    // with nothing there, or nothing but emptiness, what lies farther up is known
    for (int i = 1; i < 4 && here > NOTHING * reach && here < 2.0 * depth; i++) {
        float stride = i + 1 < 4 ? 0.5 * way : way;
        float next = depth - stride;
        float there = max(min(next + jelly_cubes(P - N * next), min(here, 2.0 * next)), 0.0);
        area += stride * (here + there);
        depth = next;
        way = min(there / max(here - there, LEVEL) * stride, depth);
        here = there;
    }
    return min(0.5 * (area + way * here) / (reach * reach), 1.0);
}

// The colours of 42yeah's scene: jelly cubes on a faint checker floor, through which no light comes.
void jelly_surface(vec3 P, out vec3 albedo, inout float th, vec3 jelly_color) {
    albedo = jelly_color;
    if (ground_plane(P) < jelly_cubes(P)) {
        vec3 tile = mod(floor(P * 2.0), 2.0);
        albedo = vec3(1.0 - 0.1 * abs(tile.x - tile.z));
        th = 0.0;
    }
}

// The light that comes from `direction`.
vec3 sky(vec3 direction, vec3 sky_color) {
    return mix(sky_color, vec3(1.0), clamp(direction.y * 5.0, 0.0, 1.0));
}

// Thin parts show the sky behind them: light that needs no lamp.
vec3 sky_glow(vec3 V, float th, float glow_strength, vec3 sky_color) {
    vec3 mirrored = vec3(-V.x, V.y, -V.z);
    return glow_strength * th * sky(mirrored, sky_color);
}

// The sky behind a raymarched scene: the colour where a ray meets nothing.
vec3 sky_background(vec3 ray_direction, vec3 sky_color) {
    return sky(ray_direction, sky_color);
}

// How much of the key light reaches `p`: the narrower the gap that it passes, the less.
float soft_shadow(vec3 p, vec3 L) {
    float t = 0.001;
    float free = 1.0;
    // it only falls: below 0 there is no need to stop
    for (int i = 0; i < 25 && t < 4.0; i++) {
        float gap = jelly_scene(p + L * t);
        free = min(free, 20.0 * gap / t);
        t += clamp(gap, 0.001, 2.0);
    }
    return clamp(free, 0.0, 1.0);
}

// A small studio: key light with soft shadow, sky dome, bounce, light from behind, and what comes through.
vec3 studio(vec3 P, vec3 N, vec3 albedo, vec3 translucency, vec3 key_direction) {
    vec3 key = safe_normalize(key_direction);
    vec3 behind = vec3(-key.x, 0.0, -key.z);
    float shadow = soft_shadow(P + N * 0.001, key);
    vec3 light = vec3(0.2) * shadow;
    light += vec3(0.82, 0.8, 0.82) * (max(dot(N, key), 0.0) * shadow);
    light += vec3(0.26, 0.32, 0.334) * (0.2 + 0.8 * clamp(N.y, 0.0, 1.0));
    light += vec3(0.3, 0.21, 0.23) * (0.2 + 0.8 * clamp(-N.y, 0.0, 1.0));
    light += vec3(0.2, 0.21, 0.23) * max(dot(N, behind), 0.0);
    return albedo * (light + translucency);
}

// Encodes linear colour for a display of a plain gamma.
vec3 gamma(vec3 color) {
    return pow(max(color, 0.0), vec3(0.45454544));
}

// The colour of one fragment.
vec4 evaluate_color(vec2 uv, float time, float orbit_radius, float orbit_height, vec3 look_at, float aspect,
    float focal_length, float max_distance, float reach, vec3 jelly_color, float glow_strength,
    vec3 sky_color, vec3 key_direction) {
    vec3 ray_origin;
    vec3 ray_direction;
    camera_orbit(uv, time, ray_origin, ray_direction, orbit_radius, orbit_height, look_at, aspect,
        focal_length);
    vec3 P;
    vec3 N;
    vec3 V;
    bool hit = raymarch(ray_origin, ray_direction, P, N, V, max_distance);
    vec3 color = sky_background(ray_direction, sky_color);
    if (hit) {
        float thinness = thinness_traced(P, N, reach);
        vec3 albedo;
        jelly_surface(P, albedo, thinness, jelly_color);
        vec3 translucency = sky_glow(V, thinness, glow_strength, sky_color);
        color = studio(P, N, albedo, translucency, key_direction);
    }
    color = gamma(color);
    return vec4(color, 1.0);
}
