// steps
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct A {
    matrix: i32,
    halves: f32,
}

fn modf_(x: f32, whole: ptr<function, f32>) -> f32 {
    *whole = trunc(x);
    return x - *whole;
}

// What a loop does between its rounds, and in which order.
fn f(n: i32) -> i32 {
    var k = n & 3;
    for (var i = 0; i < 6; ) {
        let i_before = i;
        i++;
        k += i_before;
    }
    return k;
}

fn f2(n: i32) -> i32 {
    var r = 0;
    for (var i = n & 3; i < 9; i++) {
        if (i == 3) {
            i *= 2;
            continue;
        }
        r += i;
        i *= 2;
    }
    return r;
}

fn st(i: ptr<function, i32>) -> bool {
    *i++;
    return *i > 2;
}

fn f3(n: i32) -> i32 {
    var j = 0;
    var i = 0;
    for (i = 0; i < 5; ) {
        let st_value = st(&i);
        j += select(10, 1, st_value);
    }
    return j;
}

fn f5(v_in: vec3i) -> vec3i {
    var v = v_in;
    v += 1;
    let v_before = v;
    v -= 1;
    return v_before;
}

fn f6(self_: f32) -> f32 {
    let a = A(1, self_);
    var w: f32;
    let m = modf_(self_, &w);
    return a.halves + m * w;
}

fn f7(x: f32, n: i32) -> f32 {
    var r = 0.0;
    var j = 9;
    for (var i = 0; i < j; i++) {
        if (i == (n & 3)) {
            j--;
            continue;
        }
        r += x;
        j--;
    }
    return r;
}
