// alike
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef ALIKE_HLSL_INCLUDED
#define ALIKE_HLSL_INCLUDED

// Overloads that differ in a vec4 and a mat2 alone, which HLSL cannot tell apart.
float f_vec4(float4 a) {
    return a.x;
}

float f_mat2(float2x2 a) {
    return a[0].y;
}

float g(float4 v) {
    return f_vec4(v) + f_mat2(float2x2(v.xy, v.zw));
}

#endif
