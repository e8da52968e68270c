// loops
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef LOOPS_HLSL_INCLUDED
#define LOOPS_HLSL_INCLUDED

// Loops of all kinds, with what their heads may hold.
int do_with_continue(int start) {
    int i = start;
    int sum = 0;
    [loop]
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

int assignment_in_the_condition(int start) {
    int left = start & 31;
    int last = 0;
    int rounds = 0;
    [loop]
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

int counts_down(int n) {
    int sum = 0;
    int left = n & 15;
    [loop]
    while (true) {
        int left_before = left;
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

float two_counters(float x) {
    float sum = 0.0;
    int j = 10;
    [loop]
    for (int i = 0; i < j; i++) {
        if (i == 1) {
            j -= 2;
            continue;
        }
        sum += x * float(i + j);
        j -= 2;
    }
    return sum;
}

int no_head(int n) {
    int i = 0;
    [loop]
    for (; ; ) {
        i++;
        if (i > (n & 7)) {
            return i;
        }
    }
    return -1;
}

float fractional_steps(float x) {
    float sum = 0.0;
    float weight = 1.0;
    [unroll]
    for (float t = 0.0; t < 1.0; t += 0.25) {
        sum += weight * (x - t);
        weight *= 0.5;
    }
    return sum;
}

int keeps_the_condition(int n) {
    int left = n & 7;
    int sum = 0;
    bool more;
    [loop]
    while (true) {
        more = left > 2;
        if (!more) {
            break;
        }
        left--;
        sum += more ? left : 0;
    }
    return sum;
}

int nested_leaves(int n) {
    int hits = 0;
    [unroll]
    for (int i = 0; i < 5; i++) {
        [unroll]
        for (int j = 0; j < 5; j++) {
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

void do_once(inout float2 p) {
    p = p.yx * 0.5;
}

int once_or_for_ever(int n) {
    int sum = 0;
    [unroll]
    for (int once = 0; once < 1; once++) {
        if (n > 3) {
            continue;
        }
        sum++;
    }
    [loop]
    while (true) {
        if (sum > 5) {
            break;
        }
        sum += 2;
    }
    return sum;
}

#endif
