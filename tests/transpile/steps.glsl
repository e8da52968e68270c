// What a loop does between its rounds, and in which order.

int f(int n) { int k = n & 3; for (int i = 0; i < 6; k += i++) {} return k; }
int f2(int n) { int r = 0; for (int i = n & 3; i < 9; i *= 2, i += 1) { if (i == 3) continue; r += i; } return r; }
bool st(inout int i) { i++; return i > 2; }
int f3(int n) { int j = 0, i = 0; for (i = 0; i < 5; j += st(i) ? 1 : 10) {} return j; }
ivec3 f5(ivec3 v) { v++; return v--; }
struct A { int matrix; float halves; };
float f6(float self) { A a = A(1, self); float w; float m = modf(self, w); return a.halves + m * w; }
float f7(float x, int n) { float r = 0.0; for (int i = 0, j = 9; i < j; i++, j--) { if (i == (n & 3)) continue; r += x; } return r; }
