#version 320 es
precision highp float;

// What the language leaves undefined at constants, and compilers refuse: it is not executed here.
struct Sphere {
    vec2 center;
    float radius;
};
struct Plane {
    vec3 normal;
};

const int FAR = 40;
uniform int bits;
uniform uint mask;
uniform int rounds;
out vec4 color;

float area(Sphere s) {
    return s.radius * s.radius;
}

float area(Plane p) {
    return p.normal.z;
}

void main() {
    float steps[3] = float[](1.0, 2.0, 3.0);
    vec3 weights = vec3(0.25, 0.5, 1.0);
    int after = 7, before = -1;
    color = vec4(area(Sphere(vec2(1.0), 2.0)), area(Plane(vec3(0.5))), 0.0, 1.0);
    if (rounds > 100) {
        color.x = steps[after] + weights[before] + mat2(1.0)[before][after];
        color.y = float(bitfieldExtract(bits, -1, 1)) + float(bitfieldExtract(mask, FAR, 2));
        color.z = float(bitfieldInsert(mask, 3u, 30, 9));
    }
}
