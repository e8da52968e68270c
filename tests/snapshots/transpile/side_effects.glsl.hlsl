// side_effects
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef SIDE_EFFECTS_HLSL_INCLUDED
#define SIDE_EFFECTS_HLSL_INCLUDED

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
    int i_before = i;
    i++;
    float a = values[i_before];
    i++;
    float b = values[i];
    return a * 10.0 + b + float(i);
}

int steps_in_arguments(int n) {
    int k = n & 63;
    int k_before = k;
    k++;
    int a = max(k_before, 5);
    k--;
    int before = k;
    int twice_value = twice(k);
    int b = min(before, twice_value);
    return a * 1000 + b + k;
}

int either_side_of_and(int n) {
    int a = n & 7;
    int b = 0;
    int a_before = a;
    a++;
    bool chosen;
    if (a_before < 4) {
        chosen = above(b, a - 3);
    } else {
        chosen = false;
    }
    if (chosen) {
        return a * 10 + b;
    }
    bool chosen_2;
    bool above_value = above(a, 6);
    if (above_value) {
        chosen_2 = true;
    } else {
        chosen_2 = above(b, 1);
    }
    bool either = chosen_2;
    return (either ? 100 : 200) + a * 10 + b;
}

int not_both(int n) {
    int a = n & 3;
    int b = n & 1;
    bool above_value = above(a, 2);
    bool above_value_2 = above(b, 1);
    return above_value != above_value_2 ? a - b : a + b;
}

int commas(int n) {
    int a;
    int b;
    b = n & 15;
    b += 2;
    a = b * 3;
    b++;
    a -= b;
    return a * 100 + b;
}

float chained(float x) {
    float a;
    float b;
    float c;
    c = x * 0.5;
    b = c;
    a = b;
    b -= c * 0.25;
    a += b;
    return a + b * 10.0 + c * 100.0;
}

int chosen(int n, bool up) {
    int a = n & 15;
    int chosen;
    if (up) {
        int a_before = a;
        a++;
        chosen = a_before;
    } else {
        a -= 2;
        chosen = a;
    }
    int b = chosen;
    if (up) {
        a++;
    } else {
        a--;
    }
    return a * 100 + b;
}

float called_for_its_effect(float x) {
    int n = 3;
    twice(n);
    return x * float(n);
}

float2 in_a_constructor(float2 p) {
    float x = p.x;
    x += 1.0;
    return float2(p.y, x * p.y) * 2.0;
}

float3 floats_step_too(float3 v) {
    float3 v_before = v;
    v += 1.0;
    float3 w = v_before;
    v.y -= 1.0;
    float t = v.y;
    return w * t + v;
}

#endif
