// Jelly cubes: Two jelly cubes on a floor, drawn from distance functions; their thin parts glow with
// the sky.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.

const MAX_STEPS: i32 = 200;
const CUBE_SPACING: f32 = 1.45;
const CUBE_HEIGHT: f32 = 0.48;
const CUBES_HALF: vec3f = vec3f(1.4322, 0.5, 0.7072);
const COS_45: f32 = 0.70710677;
const HALF_SIZE: f32 = 0.5;
const HIT_TOLERANCE: f32 = 0.001;
const NOTHING: f32 = 0.004;
const LEVEL: f32 = 1.0e-6;

fn mod_(x: vec3f, y: f32) -> vec3f {
    return x - y * floor(x / y);
}

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// The direction in which the camera at `eye` sees the image point `uv` ((0, 0) to (1, 1), v up).
fn camera_ray(eye: vec3f, uv: vec2f, look_at: vec3f, aspect: f32, focal_length: f32) -> vec3f {
    let front = safe_normalize(look_at - eye);
    let right = safe_normalize(cross(front, vec3f(0.0, 1.0, 0.0)));
    let up = cross(right, front);
    let image = uv * 2.0 - 1.0;
    return safe_normalize(right * (image.x * aspect) + up * image.y + front * focal_length);
}

// A camera that circles the scene, one radian a second.
fn camera_orbit(uv: vec2f, time: f32, ray_origin: ptr<function, vec3f>, ray_direction: ptr<function, vec3f>,
    orbit_radius: f32, orbit_height: f32, look_at: vec3f, aspect: f32, focal_length: f32) {
    *ray_origin = vec3f(orbit_radius * cos(time), orbit_height, orbit_radius * sin(time));
    *ray_direction = camera_ray(*ray_origin, uv, look_at, aspect, focal_length);
}

// The signed distance to the ground, y = 0.
fn ground_plane(p: vec3f) -> f32 {
    return p.y;
}

// A cube about the origin, turned by 45 degrees about the y axis.
fn turned_cube(p: vec3f) -> f32 {
    let turned = vec3f((p.x - p.z) * COS_45, p.y, (p.x + p.z) * COS_45);
    let q = abs(turned) - HALF_SIZE;
    return length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// The two jelly cubes of 42yeah, without the floor: the body that light shines through.
fn jelly_cubes(p: vec3f) -> f32 {
    // each is the other's mirror image in the plane between them, so the nearer one is all there is to ask
    let middle = 0.5 * CUBE_SPACING;
    return turned_cube(vec3f(abs(p.x - middle) - middle, p.y - CUBE_HEIGHT, p.z));
}

// The scene of 42yeah: two jelly cubes on the ground.
fn jelly_scene(p: vec3f) -> f32 {
    let ground = ground_plane(p);
    // where the ground is nearer than their box, the cubes need no look
    let q = abs(p - vec3f(0.5 * CUBE_SPACING, CUBE_HEIGHT, 0.0)) - CUBES_HALF;
    if (max(q.x, max(q.y, q.z)) > ground) {
        return ground;
    }
    return min(jelly_cubes(p), ground);
}

// The gradient of the scene at `p`, from the four corners of a tetrahedron about it.
fn scene_normal(p: vec3f) -> vec3f {
    let e = HIT_TOLERANCE * vec2f(1.0, -1.0);
    let a = jelly_scene(p + e.xyy);
    let b = jelly_scene(p + e.yyx);
    let c = jelly_scene(p + e.yxy);
    let d = jelly_scene(p + e.xxx);
    // nearly equal numbers, whose differences are exact
    return safe_normalize(vec3f(a - b + (d - c), c - a + (d - b), b - a + (d - c)));
}

// Sphere tracing: draws a scene given as a distance function; where a ray meets nothing it returns false.
fn raymarch(ray_origin: vec3f, ray_direction: vec3f, P: ptr<function, vec3f>, N: ptr<function, vec3f>,
    V: ptr<function, vec3f>, max_distance: f32) -> bool {
    var t = 0.0;
    var hit = false;
    for (var i = 0; i < MAX_STEPS && t < max_distance; i++) {
        let gap = jelly_scene(ray_origin + ray_direction * t);
        if (gap < HIT_TOLERANCE) {
            hit = true;
            break;
        }
        t += gap;
    }
    *P = ray_origin + ray_direction * t;
    *V = -ray_direction;
    *N = *V;
    if (hit) {
        *N = scene_normal(*P);
    }
    return hit;
}

// thinness_uniform in full, from a few taps: from the deepest one up, each halfway to where the sum would end.
fn thinness_traced(P: vec3f, N: vec3f, reach: f32) -> f32 {
    var depth = reach;
    var here = clamp(depth + jelly_cubes(P - N * depth), 0.0, 2.0 * depth);
    // how much farther up it would be 0 if it went on in a straight line
    var way = 0.5 * here;
    var area = 0.0;
    // with nothing there, or nothing but emptiness, what lies farther up is known
    for (var i = 1; i < 4 && here > NOTHING * reach && here < 2.0 * depth; i++) {
        let stride = select(way, 0.5 * way, i + 1 < 4);
        let next = depth - stride;
        let there = max(min(next + jelly_cubes(P - N * next), min(here, 2.0 * next)), 0.0);
        area += stride * (here + there);
        depth = next;
        way = min(there / max(here - there, LEVEL) * stride, depth);
        here = there;
    }
    return min(0.5 * (area + way * here) / (reach * reach), 1.0);
}

// The colours of 42yeah's scene: jelly cubes on a faint checker floor, through which no light comes.
fn jelly_surface(P: vec3f, albedo: ptr<function, vec3f>, th: ptr<function, f32>, jelly_color: vec3f) {
    *albedo = jelly_color;
    if (ground_plane(P) < jelly_cubes(P)) {
        let tile = mod_(floor(P * 2.0), 2.0);
        *albedo = vec3f(1.0 - 0.1 * abs(tile.x - tile.z));
        *th = 0.0;
    }
}

// The light that comes from `direction`.
fn sky(direction: vec3f, sky_color: vec3f) -> vec3f {
    return mix(sky_color, vec3f(1.0), clamp(direction.y * 5.0, 0.0, 1.0));
}

// Thin parts show the sky behind them: light that needs no lamp.
fn sky_glow(V: vec3f, th: f32, glow_strength: f32, sky_color: vec3f) -> vec3f {
    let mirrored = vec3f(-V.x, V.y, -V.z);
    return glow_strength * th * sky(mirrored, sky_color);
}

// The sky behind a raymarched scene: the colour where a ray meets nothing.
fn sky_background(ray_direction: vec3f, sky_color: vec3f) -> vec3f {
    return sky(ray_direction, sky_color);
}

// How much of the key light reaches `p`: the narrower the gap that it passes, the less.
fn soft_shadow(p: vec3f, L: vec3f) -> f32 {
    var t = 0.001;
    var free = 1.0;
    // it only falls: below 0 there is no need to stop
    for (var i = 0; i < 25 && t < 4.0; i++) {
        let gap = jelly_scene(p + L * t);
        free = min(free, 20.0 * gap / t);
        t += clamp(gap, 0.001, 2.0);
    }
    return clamp(free, 0.0, 1.0);
}

// A small studio: key light with soft shadow, sky dome, bounce, light from behind, and what comes through.
fn studio(P: vec3f, N: vec3f, albedo: vec3f, translucency: vec3f, key_direction: vec3f) -> vec3f {
    let key = safe_normalize(key_direction);
    let behind = vec3f(-key.x, 0.0, -key.z);
    let shadow = soft_shadow(P + N * 0.001, key);
    var light = vec3f(0.2) * shadow;
    light += vec3f(0.82, 0.8, 0.82) * (max(dot(N, key), 0.0) * shadow);
    light += vec3f(0.26, 0.32, 0.334) * (0.2 + 0.8 * clamp(N.y, 0.0, 1.0));
    light += vec3f(0.3, 0.21, 0.23) * (0.2 + 0.8 * clamp(-N.y, 0.0, 1.0));
    light += vec3f(0.2, 0.21, 0.23) * max(dot(N, behind), 0.0);
    return albedo * (light + translucency);
}

// Encodes linear colour for a display of a plain gamma.
fn gamma(color: vec3f) -> vec3f {
    return pow(max(color, vec3f(0.0)), vec3f(0.45454544));
}

// The colour of one fragment.
fn evaluate_color(uv: vec2f, time: f32, orbit_radius: f32, orbit_height: f32, look_at: vec3f, aspect: f32,
    focal_length: f32, max_distance: f32, reach: f32, jelly_color: vec3f, glow_strength: f32,
    sky_color: vec3f, key_direction: vec3f) -> vec4f {
    var ray_origin: vec3f;
    var ray_direction: vec3f;
    camera_orbit(uv, time, &ray_origin, &ray_direction, orbit_radius, orbit_height, look_at, aspect,
        focal_length);
    var P: vec3f;
    var N: vec3f;
    var V: vec3f;
    let hit = raymarch(ray_origin, ray_direction, &P, &N, &V, max_distance);
    var color = sky_background(ray_direction, sky_color);
    if (hit) {
        var thinness = thinness_traced(P, N, reach);
        var albedo: vec3f;
        jelly_surface(P, &albedo, &thinness, jelly_color);
        let translucency = sky_glow(V, thinness, glow_strength, sky_color);
        color = studio(P, N, albedo, translucency, key_direction);
    }
    color = gamma(color);
    return vec4f(color, 1.0);
}
