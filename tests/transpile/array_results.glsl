#version 330
// Functions that return arrays, which HLSL has not.

float[3] thirds(float x) {
    float made[3] = float[](x, x * 2.0, x * 3.0);
    return made;
}

float middle(float x) {
    float parts[] = thirds(x);
    return parts[1] + thirds(x * 0.5)[2];
}
