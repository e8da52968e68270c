// Jelly cubes: Two jelly cubes on a floor, drawn from distance functions; their thin parts glow with
// the sky.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Group 0: camera and lights; group 1: the material; group 2: the object.

const MAX_STEPS: i32 = 200;
const CUBE_SPACING: f32 = 1.45;
const CUBE_HEIGHT: f32 = 0.48;
const CUBES_HALF: vec3f = vec3f(1.4322, 0.5, 0.7072);
const COS_45: f32 = 0.70710677;
const HALF_SIZE: f32 = 0.5;
const HIT_TOLERANCE: f32 = 0.001;
const NOTHING: f32 = 0.004;
const LEVEL: f32 = 1.0e-6;

struct Material {
    orbit_radius: f32,  // Radius of the orbit about the vertical axis
    orbit_height: f32,  // Height of the orbit
    look_at: vec3f,  // What the camera looks at
    aspect: f32,  // Width of the image over its height
    focal_length: f32,  // Focal length, where the image is 2 high: the larger, the narrower the view
    max_distance: f32,  // A ray that is longer than this meets nothing
    reach: f32,  // How deep the taps reach below the surface
    jelly_color: vec3f,  // Colour of the cubes
    glow_strength: f32,  // Strength of the glow: 0.9 x 0.38667, since thinness was 0..0.38667 in the source
    sky_color: vec3f,  // Colour of the sky at the horizon; it turns white towards the zenith
    key_direction: vec3f,  // Towards the key light; any length
}
@group(1) @binding(0) var<uniform> material: Material;

fn mod_(x: vec3f, y: f32) -> vec3f {
    return x - y * floor(x / y);
}

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// The direction in which the camera at `eye` sees the image point `uv` ((0, 0) to (1, 1), v up).
fn camera_ray(eye: vec3f, uv: vec2f) -> vec3f {
    let front = safe_normalize(material.look_at - eye);
    let right = safe_normalize(cross(front, vec3f(0.0, 1.0, 0.0)));
    let up = cross(right, front);
    let image = uv * 2.0 - 1.0;
    return safe_normalize(right * (image.x * material.aspect) + up * image.y + front * material.focal_length);
}

// A camera that circles the scene, one radian a second.
fn camera_orbit(uv: vec2f, time: f32, ray_origin: ptr<function, vec3f>, ray_direction: ptr<function, vec3f>) {
    *ray_origin = vec3f(material.orbit_radius * cos(time), material.orbit_height, material.orbit_radius
        * sin(time));
    *ray_direction = camera_ray(*ray_origin, uv);
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
    V: ptr<function, vec3f>) -> bool {
    var t = 0.0;
    var hit = false;
    for (var i = 0; i < MAX_STEPS && t < material.max_distance; i++) {
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
fn thinness_traced(P: vec3f, N: vec3f) -> f32 {
    var depth = material.reach;
    var here = clamp(depth + jelly_cubes(P - N * depth), 0.0, 2.0 * depth);
    // how much farther up it would be 0 if it went on in a straight line
    var way = 0.5 * here;
    var area = 0.0;
    // with nothing there, or nothing but emptiness, what lies farther up is known
    for (var i = 1; i < 4 && here > NOTHING * material.reach && here < 2.0 * depth; i++) {
        let stride = select(way, 0.5 * way, i + 1 < 4);
        let next = depth - stride;
        let there = max(min(next + jelly_cubes(P - N * next), min(here, 2.0 * next)), 0.0);
        area += stride * (here + there);
        depth = next;
        way = min(there / max(here - there, LEVEL) * stride, depth);
        here = there;
    }
    return min(0.5 * (area + way * here) / (material.reach * material.reach), 1.0);
}

// The colours of 42yeah's scene: jelly cubes on a faint checker floor, through which no light comes.
fn jelly_surface(P: vec3f, albedo: ptr<function, vec3f>, th: ptr<function, f32>) {
    *albedo = material.jelly_color;
    if (ground_plane(P) < jelly_cubes(P)) {
        let tile = mod_(floor(P * 2.0), 2.0);
        *albedo = vec3f(1.0 - 0.1 * abs(tile.x - tile.z));
        *th = 0.0;
    }
}

// The light that comes from `direction`.
fn sky(direction: vec3f) -> vec3f {
    return mix(material.sky_color, vec3f(1.0), clamp(direction.y * 5.0, 0.0, 1.0));
}

// Thin parts show the sky behind them: light that needs no lamp.
fn sky_glow(V: vec3f, th: f32) -> vec3f {
    let mirrored = vec3f(-V.x, V.y, -V.z);
    return material.glow_strength * th * sky(mirrored);
}

// The sky behind a raymarched scene: the colour where a ray meets nothing.
fn sky_background(ray_direction: vec3f) -> vec3f {
    return sky(ray_direction);
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
fn studio(P: vec3f, N: vec3f, albedo: vec3f, translucency: vec3f) -> vec3f {
    let key = safe_normalize(material.key_direction);
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
fn evaluate_color(uv: vec2f, time: f32) -> vec4f {
    var ray_origin: vec3f;
    var ray_direction: vec3f;
    camera_orbit(uv, time, &ray_origin, &ray_direction);
    var P: vec3f;
    var N: vec3f;
    var V: vec3f;
    let hit = raymarch(ray_origin, ray_direction, &P, &N, &V);
    var color = sky_background(ray_direction);
    if (hit) {
        var thinness = thinness_traced(P, N);
        var albedo: vec3f;
        jelly_surface(P, &albedo, &thinness);
        let translucency = sky_glow(V, thinness);
        color = studio(P, N, albedo, translucency);
    }
    color = gamma(color);
    return vec4f(color, 1.0);
}

struct Camera {
    view_projection: mat4x4f,
    inverse_view_projection: mat4x4f,
    position: vec3f,
    time: f32,  // s
}
@group(0) @binding(0) var<uniform> camera: Camera;

struct Varyings {
    @builtin(position) clip_position: vec4f,
    @location(3) uv: vec2f,
}

// One triangle covers the screen: draw 3 vertices, no vertex buffer.
@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varyings {
    let corner = vec2f(select(-1.0, 3.0, index == 1u), select(-1.0, 3.0, index == 2u));
    var output: Varyings;
    output.clip_position = vec4f(corner, 0.0, 1.0);
    output.uv = 0.5 * corner + 0.5;
    return output;
}

@fragment
fn fragment_main(input: Varyings) -> @location(0) vec4f {
    return evaluate_color(input.uv, camera.time);
}
