// steps
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef STEPS_HLSL_INCLUDED
#define STEPS_HLSL_INCLUDED

struct A {
    int matrix_;
    float halves;
};

float modf_(float x, out float whole) {
    whole = trunc(x);
    return x - whole;
}

// What a loop does between its rounds, and in which order.
int f(int n) {
    int k = n & 3;
    [unroll]
    for (int i = 0; i < 6; ) {
        int i_before = i;
        i++;
        k += i_before;
    }
    return k;
}

int f2(int n) {
    int r = 0;
    [loop]
    for (int i = n & 3; i < 9; i++) {
        if (i == 3) {
            i *= 2;
            continue;
        }
        r += i;
        i *= 2;
    }
    return r;
}

bool st(inout int i) {
    i++;
    return i > 2;
}

int f3(int n) {
    int j = 0;
    int i = 0;
    [loop]
    for (i = 0; i < 5; ) {
        bool st_value = st(i);
        j += st_value ? 1 : 10;
    }
    return j;
}

int3 f5(int3 v) {
    v += 1;
    int3 v_before = v;
    v -= 1;
    return v_before;
}

float f6(float self) {
    A a = { 1, self };
    float w;
    float m = modf_(self, w);
    return a.halves + m * w;
}

float f7(float x, int n) {
    float r = 0.0;
    int j = 9;
    [loop]
    for (int i = 0; i < j; i++) {
        if (i == (n & 3)) {
            j--;
            continue;
        }
        r += x;
        j--;
    }
    return r;
}

#endif
