// state
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

var<private> seed: i32 = 17;
var<private> tint: vec3f = vec3f(1.0, 0.5, 0.25);
var<private> last: vec3f;
var<private> history: array<f32, 3>;

fn random() -> f32 {
    seed = (seed * 1103 + 12345) & 65535;
    return f32(seed) / 65536.0;
}

fn random2() -> vec2f {
    let random_value = random();
    let random_value_2 = random();
    return vec2f(random_value, random_value_2);
}

fn use_(x: f32) -> f32 {
    seed = i32(x * 100.0) & 255;
    let p = random2();
    last = tint * p.x;
    let random_value = random();
    let random_value_2 = random();
    last.y += random_value - random_value_2;
    return last.x + last.y + p.y;
}

fn remember(x: f32) -> f32 {
    for (var i = 2; i > 0; i--) {
        history[i] = history[i - 1];
    }
    history[0] = x;
    return history[0] + history[1] * 2.0;
}

fn shadows(tint: f32) -> f32 {
    let x = tint;
    let x_2 = 2.0;
    var tint_2 = x_2 * 3.0;
    if (x_2 > 1.0) {
        var x_3 = 4;
        tint_2 += f32(x_3);
    }
    last.x = tint_2;
    for (var x_3 = 0; x_3 < 2; x_3++) {
        last.x += f32(x_3);
    }
    return x + last.x;
}
