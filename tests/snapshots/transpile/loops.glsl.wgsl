// loops
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// Loops of all kinds, with what their heads may hold.
fn do_with_continue(start: i32) -> i32 {
    var i = start;
    var sum = 0;
    while (true) {
        i++;
        if ((i & 1) == 1) {
            if (!(i < 12)) {
                break;
            }
            continue;
        }
        sum += i;
        if (sum > 40) {
            break;
        }
        if (!(i < 12)) {
            break;
        }
    }
    return sum;
}

fn assignment_in_the_condition(start: i32) -> i32 {
    var left = start & 31;
    var last = 0;
    var rounds = 0;
    while (true) {
        last = left - 3;
        if (!(last > 0)) {
            break;
        }
        left = last;
        rounds++;
    }
    return rounds * 100 + last;
}

fn counts_down(n: i32) -> i32 {
    var sum = 0;
    var left = n & 15;
    while (true) {
        let left_before = left;
        left--;
        if (!(left_before > 0)) {
            break;
        }
        if (left == 4) {
            continue;
        }
        sum += left;
    }
    return sum;
}

fn two_counters(x: f32) -> f32 {
    var sum = 0.0;
    var j = 10;
    for (var i = 0; i < j; i++) {
        if (i == 1) {
            j -= 2;
            continue;
        }
        sum += x * f32(i + j);
        j -= 2;
    }
    return sum;
}

fn no_head(n: i32) -> i32 {
    var i = 0;
    for (; ; ) {
        i++;
        if (i > (n & 7)) {
            return i;
        }
    }
    return -1;
}

fn fractional_steps(x: f32) -> f32 {
    var sum = 0.0;
    var weight = 1.0;
    for (var t = 0.0; t < 1.0; t += 0.25) {
        sum += weight * (x - t);
        weight *= 0.5;
    }
    return sum;
}

fn keeps_the_condition(n: i32) -> i32 {
    var left = n & 7;
    var sum = 0;
    var more: bool;
    while (true) {
        more = left > 2;
        if (!more) {
            break;
        }
        left--;
        sum += select(0, left, more);
    }
    return sum;
}

fn nested_leaves(n: i32) -> i32 {
    var hits = 0;
    for (var i = 0; i < 5; i++) {
        for (var j = 0; j < 5; j++) {
            if (j > i) {
                break;
            }
            if (i == (n & 3)) {
                continue;
            }
            hits += i * j;
        }
        if (hits > 30) {
            return -hits;
        }
    }
    return hits;
}

fn do_once(p: ptr<function, vec2f>) {
    *p = (*p).yx * 0.5;
}

fn once_or_for_ever(n: i32) -> i32 {
    var sum = 0;
    for (var once = 0; once < 1; once++) {
        if (n > 3) {
            continue;
        }
        sum++;
    }
    while (true) {
        if (sum > 5) {
            break;
        }
        sum += 2;
    }
    return sum;
}
