// scene
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

const MARCH: i32 = 40;

struct Material {
    iResolution: vec3f,
    iTime: f32,
    iFrame: i32,
    iMouse: vec4f,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var iChannel0: texture_2d<f32>;
@group(1) @binding(2) var iChannel0_sampler: sampler;

var<private> shadertoy_color: vec4f;
var<private> FragCoord: vec4f;

// A scene as Shadertoy has them, with the mouse, the time and a texture.
fn turn(a: f32) -> mat2x2f {
    let v = sin(vec2f(1.570796, 0.0) + a);
    return mat2x2f(v, vec2f(-v.y, v.x));
}

fn map(p_in: vec3f) -> f32 {
    var p = p_in;
    let p_xz = p.xz * turn(material.iTime * 0.5);
    p = vec3f(p_xz.x, p.y, p_xz.y);
    let q = abs(p) - 0.6;
    return length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0) - 0.1;
}

fn normal(p: vec3f) -> vec3f {
    let e = vec2f(1.0, -1.0) * 0.001;
    return normalize(e.xyy * map(p + e.xyy) + e.yyx * map(p + e.yyx) + e.yxy * map(p + e.yxy) + e.xxx
        * map(p + e.xxx));
}

fn mainImage(O: ptr<function, vec4f>, F: vec2f) {
    let R = material.iResolution.xy;
    let uv = (F + F - R) / R.y;
    let mouse = select(vec2f(0.5), material.iMouse.xy / R, material.iMouse.z > 0.0);
    let ro = vec3f(0.0, 0.0, -3.0);
    let rd = normalize(vec3f(uv, 1.5));
    var p: vec3f;
    var d = 0.0;
    var h: f32;
    var i = 0;
    for (; i < MARCH; i++) {
        p = ro + rd * d;
        h = map(p);
        d += h;
        if (h < 0.001 || d > 20.0) {
            break;
        }
    }
    *O = vec4f(0.0);
    let iChannel0_sample = textureSample(iChannel0, iChannel0_sampler, normal(p).xy * 0.5 + 0.5);
    if (d < 20.0) {
        let n = normal(p);
        let O_xyz = iChannel0_sample.rgb * max(dot(n, normalize(vec3f(mouse, -1.0))), 0.0);
        *O = vec4f(O_xyz, (*O).w);
    }
    *O = pow(*O + f32(material.iFrame % 2) * 0.01, vec4f(1.0 / 2.2));
}

fn main_() {
    var O: vec4f;
    mainImage(&O, FragCoord.xy);
    shadertoy_color = O;
}

@fragment
fn fragment_main(@builtin(position) FragCoord_in: vec4f) -> @location(0) vec4f {
    FragCoord = FragCoord_in;
    FragCoord.y = material.iResolution.y - FragCoord.y;
    main_();
    return shadertoy_color;
}
