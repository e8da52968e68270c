// switches
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// Every way into, through and out of a switch.
fn falling(kind: i32) -> i32 {
    var sum = 0;
    if (kind == 0) {
        sum++;
        sum += 10;
    } else if (kind == 1) {
        sum += 10;
    } else if (kind == 2 || kind == 3) {
        sum += 100;
        sum += 1000;
    } else {
        sum += 1000;
    }
    return sum;
}

fn default_in_the_middle(kind: i32) -> f32 {
    var x = 0.5;
    if (kind == -1) {
        x = 1.0;
    } else if (kind == 7) {
        x *= 2.0;
    } else {
        x += 4.0;
        x *= 2.0;
    }
    return x;
}

fn break_inside_an_if(kind: i32, limit: f32) -> f32 {
    var x = 0.0;
    for (var once = 0; once < 1; once++) {
        if (kind == 1) {
            x = 1.0;
            if (limit > 0.5) {
                break;
            }
            x += 2.0;
        } else if (kind == 2) {
            let kept = limit * 2.0;
            x = kept;
        }
    }
    return x;
}

fn continue_of_the_loop(count: i32) -> i32 {
    var sum = 0;
    for (var i = 0; i < 8; i++) {
        let selected = i % 4;
        var goes_on = false;
        for (var once = 0; once < 1; once++) {
            if (selected == 0) {
                goes_on = true;
                break;
            } else if (selected == 1) {
                if (count > 3) {
                    break;
                }
                sum += 5;
                sum++;
            } else {
                sum++;
            }
        }
        if (goes_on) {
            continue;
        }
        sum += 100;
    }
    return sum;
}

fn leaves_at_once(kind: u32) -> vec3f {
    if (kind == 0u) {
        return vec3f(1.0, 0.0, 0.0);
    } else if (kind == 1u) {
        return vec3f(0.0, 1.0, 0.0);
    }
    return vec3f(0.0, 0.0, 1.0);
}

fn nested(a: i32, b: i32) -> i32 {
    var found = 0;
    if (a == 0) {
        if (b == 0) {
            found = 1;
        } else {
            found = 2;
        }
        found *= 3;
    } else if (a == 1) {
        for (var i = 0; i < 4; i++) {
            if (i == b) {
                break;
            }
            found += i;
        }
        found += 50;
    }
    return found;
}

fn counted_once(n: ptr<function, i32>) -> i32 {
    let n_before = *n;
    *n++;
    if (n_before == 0) {
        return 10;
    } else if (n_before == 1) {
        *n += 5;
    } else {
        *n = 0;
    }
    return *n;
}
