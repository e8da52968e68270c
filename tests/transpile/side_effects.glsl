#version 330
// What changes a value in the middle of an expression: the order is from left to right.

int twice(inout int n) {
    n *= 2;
    return n;
}

bool above(inout int n, int limit) {
    n++;
    return n > limit;
}

float steps_in_an_index(float values[4], int start) {
    int i = start & 1;
    float a = values[i++];
    float b = values[++i];
    return a * 10.0 + b + float(i);
}

int steps_in_arguments(int n) {
    int k = n & 63;
    int a = max(k++, 5);
    int b = min(--k, twice(k));
    return a * 1000 + b + k;
}

int either_side_of_and(int n) {
    int a = n & 7, b = 0;
    if (a++ < 4 && above(b, a - 3)) {
        return a * 10 + b;
    }
    bool either = above(a, 6) || above(b, 1);
    return (either ? 100 : 200) + a * 10 + b;
}

int not_both(int n) {
    int a = n & 3, b = n & 1;
    return (above(a, 2) ^^ above(b, 1)) ? a - b : a + b;
}

int commas(int n) {
    int a, b;
    a = (b = n & 15, b += 2, b * 3);
    b += 1, a -= b;
    return a * 100 + b;
}

float chained(float x) {
    float a, b, c;
    a = b = c = x * 0.5;
    a += b -= c * 0.25;
    return a + b * 10.0 + c * 100.0;
}

int chosen(int n, bool up) {
    int a = n & 15;
    int b = up ? a++ : (a -= 2);
    up ? a++ : a--;
    return a * 100 + b;
}

float called_for_its_effect(float x) {
    int n = 3;
    twice(n);
    return x * float(n);
}

vec2 in_a_constructor(vec2 p) {
    float x = p.x;
    return vec2(p.y, (x += 1.0) * p.y) * 2.0;
}

vec3 floats_step_too(vec3 v) {
    vec3 w = v++;
    float t = --v.y;
    return w * t + v;
}
