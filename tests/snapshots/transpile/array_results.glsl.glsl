// array_results
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

// Functions that return arrays, which HLSL has not.
float[3] thirds(float x) {
    float made[3] = float[3](x, x * 2.0, x * 3.0);
    return made;
}

float middle(float x) {
    float parts[3] = thirds(x);
    return parts[1] + thirds(x * 0.5)[2];
}
