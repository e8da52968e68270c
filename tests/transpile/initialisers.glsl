#version 420
// Values in braces, which have the type of what they are given to.

struct Material {
    vec3 colour;
    float rough;
};

struct Scene {
    Material materials[2];
    mat2 turn;
    int count;
};

float in_braces(float x, int i) {
    vec3 v = {x, 1.0, 2};
    float list[3] = {x, 2.0, 3};
    float open[] = {1.0, x};
    mat2 m = {{1.0, x}, {0.0, 1.0}};
    Material material = {v, 0.5};
    Scene scene = {{material, {vec3(x), 1}}, m, 2};
    vec2 p = scene.turn * vec2(list[i & 1], open[1]);
    return p.x + p.y + scene.materials[i & 1].colour.z + scene.materials[1].rough + float(scene.count);
}

const Material WAX = {{1.0, 0.5, 0.25}, 0.75};
const vec2 TABLE[2] = {{1.0, 2.0}, vec2(4.0)};

float of_constants(int i) {
    return TABLE[i & 1][1] + TABLE[1][0] + WAX.colour.y;
}
