// side_effects
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// What changes a value in the middle of an expression: the order is from left to right.
fn twice(n: ptr<function, i32>) -> i32 {
    *n *= 2;
    return *n;
}

fn above(n: ptr<function, i32>, limit: i32) -> bool {
    *n++;
    return *n > limit;
}

fn steps_in_an_index(values: array<f32, 4>, start: i32) -> f32 {
    var i = start & 1;
    let i_before = i;
    i++;
    let a = values[i_before];
    i++;
    let b = values[i];
    return a * 10.0 + b + f32(i);
}

fn steps_in_arguments(n: i32) -> i32 {
    var k = n & 63;
    let k_before = k;
    k++;
    let a = max(k_before, 5);
    k--;
    let before = k;
    let twice_value = twice(&k);
    let b = min(before, twice_value);
    return a * 1000 + b + k;
}

fn either_side_of_and(n: i32) -> i32 {
    var a = n & 7;
    var b = 0;
    let a_before = a;
    a++;
    var chosen: bool;
    if (a_before < 4) {
        chosen = above(&b, a - 3);
    } else {
        chosen = false;
    }
    if (chosen) {
        return a * 10 + b;
    }
    var chosen_2: bool;
    let above_value = above(&a, 6);
    if (above_value) {
        chosen_2 = true;
    } else {
        chosen_2 = above(&b, 1);
    }
    let either = chosen_2;
    return select(200, 100, either) + a * 10 + b;
}

fn not_both(n: i32) -> i32 {
    var a = n & 3;
    var b = n & 1;
    let above_value = above(&a, 2);
    let above_value_2 = above(&b, 1);
    return select(a + b, a - b, above_value != above_value_2);
}

fn commas(n: i32) -> i32 {
    var a: i32;
    var b: i32;
    b = n & 15;
    b += 2;
    a = b * 3;
    b++;
    a -= b;
    return a * 100 + b;
}

fn chained(x: f32) -> f32 {
    var a: f32;
    var b: f32;
    var c: f32;
    c = x * 0.5;
    b = c;
    a = b;
    b -= c * 0.25;
    a += b;
    return a + b * 10.0 + c * 100.0;
}

fn chosen(n: i32, up: bool) -> i32 {
    var a = n & 15;
    var chosen: i32;
    if (up) {
        let a_before = a;
        a++;
        chosen = a_before;
    } else {
        a -= 2;
        chosen = a;
    }
    let b = chosen;
    if (up) {
        a++;
    } else {
        a--;
    }
    return a * 100 + b;
}

fn called_for_its_effect(x: f32) -> f32 {
    var n = 3;
    twice(&n);
    return x * f32(n);
}

fn in_a_constructor(p: vec2f) -> vec2f {
    var x = p.x;
    x += 1.0;
    return vec2f(p.y, x * p.y) * 2.0;
}

fn floats_step_too(v_in: vec3f) -> vec3f {
    var v = v_in;
    let v_before = v;
    v += 1.0;
    let w = v_before;
    v.y -= 1.0;
    let t = v.y;
    return w * t + v;
}
