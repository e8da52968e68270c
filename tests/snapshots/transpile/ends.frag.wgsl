// ends
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Hit {
    t: f32,
    steps: i32,
}

struct Material {
    limit: f32,
    rounds: i32,
}
@group(1) @binding(0) var<uniform> material: Material;

var<private> uv: vec2f;
var<private> color: vec4f;

// Discards in loops: a discarded invocation must end in every language.
fn march(start: f32) -> Hit {
    var t = start;
    for (var i = 0; i < 8; i++) {
        if (t > material.limit) {
            discard;
            return Hit(0.0, 0);
        }
        t += 0.25;
    }
    return Hit(t, 8);
}

fn below(x: f32) -> f32 {
    if (x < material.limit) {
        return x;
    }
    discard;
    return 0.0;
}

fn either(x: f32) -> f32 {
    if (x < material.limit) {
        discard;
    } else {
        return 2.0 * x;
    }
    return 0.0;
}

fn main_() {
    color = vec4f(march(uv.x).t, below(uv.y), either(uv.x), 1.0);
    for (; ; ) {
        color.x += 0.5;
        if (color.x > material.limit) {
            break;
        }
    }
    if (material.rounds > 50) {
        for (; ; ) {
            color.z += uv.x;
            discard;
            return;
        }
    }
}

@fragment
fn fragment_main(@location(0) uv_in: vec2f) -> @location(0) vec4f {
    uv = uv_in;
    main_();
    return color;
}
