// array_results
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef ARRAY_RESULTS_HLSL_INCLUDED
#define ARRAY_RESULTS_HLSL_INCLUDED

// Functions that return arrays, which HLSL has not.
void thirds(float x, out float result[3]) {
    float made[3] = { x, x * 2.0, x * 3.0 };
    result = made;
}

float middle(float x) {
    float values[3];
    thirds(x, values);
    float parts[3] = values;
    float values_2[3];
    thirds(x * 0.5, values_2);
    return parts[1] + values_2[2];
}

#endif
