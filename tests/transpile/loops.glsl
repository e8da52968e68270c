#version 330
// Loops of all kinds, with what their heads may hold.

int do_with_continue(int start) {
    int i = start, sum = 0;
    do {
        i++;
        if ((i & 1) == 1) {
            continue;
        }
        sum += i;
        if (sum > 40) break;
    } while (i < 12);
    return sum;
}

int assignment_in_the_condition(int start) {
    int left = start & 31, last = 0, rounds = 0;
    while ((last = left - 3) > 0) {
        left = last;
        ++rounds;
    }
    return rounds * 100 + last;
}

int counts_down(int n) {
    int sum = 0, left = n & 15;
    while (left-- > 0) {
        if (left == 4) continue;
        sum += left;
    }
    return sum;
}

float two_counters(float x) {
    float sum = 0.0;
    for (int i = 0, j = 10; i < j; i++, j -= 2) {
        if (i == 1) {
            continue;
        }
        sum += x * float(i + j);
    }
    return sum;
}

int no_head(int n) {
    int i = 0;
    for (;;) {
        if (++i > (n & 7)) {
            return i;
        }
    }
    return -1;
}

float fractional_steps(float x) {
    float sum = 0.0, weight = 1.0;
    for (float t = 0.0; t < 1.0; t += 0.25, weight *= 0.5)
        sum += weight * (x - t);
    return sum;
}

int keeps_the_condition(int n) {
    int left = n & 7, sum = 0;
    bool more;
    while (more = left > 2) {
        left--;
        sum += more ? left : 0;
    }
    return sum;
}

int nested_leaves(int n) {
    int hits = 0;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            if (j > i) break;
            if (i == (n & 3)) continue;
            hits += i * j;
        }
        if (hits > 30) return -hits;
    }
    return hits;
}

void do_once(inout vec2 p) {
    do p = p.yx * 0.5; while (false);
}

int once_or_for_ever(int n) {
    int sum = 0;
    do {
        if (n > 3) continue;
        sum += 1;
    } while (false);
    do {
        if (sum > 5) break;
        sum += 2;
    } while (true);
    return sum;
}
