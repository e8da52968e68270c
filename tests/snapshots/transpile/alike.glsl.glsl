// alike
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

// Overloads that differ in a vec4 and a mat2 alone, which HLSL cannot tell apart.
float f(vec4 a) {
    return a.x;
}

float f(mat2 a) {
    return a[0].y;
}

float g(vec4 v) {
    return f(v) + f(mat2(v.xy, v.zw));
}
