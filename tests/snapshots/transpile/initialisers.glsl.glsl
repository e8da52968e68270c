// initialisers
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct Material {
    vec3 colour;
    float rough;
};

struct Scene {
    Material materials[2];
    mat2 turn;
    int count;
};

const Material WAX = Material(vec3(1.0, 0.5, 0.25), 0.75);
const vec2 TABLE[2] = vec2[2](vec2(1.0, 2.0), vec2(4.0));

float in_braces(float x, int i) {
    vec3 v = vec3(x, 1.0, 2.0);
    float list[3] = float[3](x, 2.0, 3.0);
    float open[2] = float[2](1.0, x);
    mat2 m = mat2(vec2(1.0, x), vec2(0.0, 1.0));
    Material material = Material(v, 0.5);
    Scene scene = Scene(Material[2](material, Material(vec3(x), 1.0)), m, 2);
    vec2 p = scene.turn * vec2(list[i & 1], open[1]);
    return p.x + p.y + scene.materials[i & 1].colour.z + scene.materials[1].rough + float(scene.count);
}

float of_constants(int i) {
    return TABLE[i & 1][1] + TABLE[1][0] + WAX.colour.y;
}
