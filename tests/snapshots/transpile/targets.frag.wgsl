// targets
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

var<private> v_normal: vec3f;
var<private> v_joints: vec2u;
var<private> v_color: vec3f;
var<private> v_depth: f32;
var<private> layers: array<vec4f, 2>;
var<private> ids: vec4u;
var<private> cell: vec2i;

fn main_() {
    if (v_depth > 100.0) {
        discard;
    }
    layers[0] = vec4f(v_color, 1.0);
    let layers_xyz = normalize(v_normal) * 0.5 + 0.5;
    layers[1] = vec4f(layers_xyz, layers[1].w);
    layers[1].a = v_depth;
    ids = vec4u(v_joints, 0u, 1u);
    cell = vec2i(v_normal.xy * 8.0);
}

struct FragmentOutput {
    @location(0) layers_0: vec4f,
    @location(1) layers_1: vec4f,
    @location(2) ids: vec4u,
    @location(3) cell: vec2i,
}

@fragment
fn fragment_main(@location(0) @interpolate(flat) v_color_in: vec3f, @location(1) v_depth_in: f32,
    @location(2) @interpolate(flat) v_joints_in: vec2u, @location(3) v_normal_in: vec3f) -> FragmentOutput {
    v_color = v_color_in;
    v_depth = v_depth_in;
    v_joints = v_joints_in;
    v_normal = v_normal_in;
    main_();
    return FragmentOutput(layers[0], layers[1], ids, cell);
}
