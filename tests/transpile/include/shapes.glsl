#ifndef SHAPES
#define SHAPES

// The distance to a ball.
float sphere(vec3 p, float radius) {
    return length(p) - radius;
}

#include "box.glsl"
#endif
