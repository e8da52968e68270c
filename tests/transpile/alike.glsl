// Overloads that differ in a vec4 and a mat2 alone, which HLSL cannot tell apart.

float f(vec4 a) { return a.x; }
float f(mat2 a) { return a[0].y; }
float g(vec4 v) { return f(v) + f(mat2(v)); }
