#version 330 core
// fragment
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

uniform vec2 resolution;

uniform sampler2D map;

in vec2 uv;
flat in int kind;
centroid in vec3 normal;
noperspective in float along;
in vec4 shade;
layout(location = 0) out vec4 color;
layout(location = 1) out vec2 motion;

float edge(float x) {
    float width = fwidth(x);
    return smoothstep(0.5 - width, 0.5 + width, x);
}

void main() {
    vec2 at = gl_FragCoord.xy / resolution;
    vec4 texel = texture(map, uv);
    vec2 slope = vec2(dFdx(texel.x), dFdy(texel.x));
    float sharp = edge(along);
    if (texel.a < 0.5) {
        discard;
    }
    motion = slope;
    gl_FragDepth = gl_FragCoord.z;
    if (kind == 0) {
        color = vec4(at, 0.0, 1.0);
        return;
    }
    vec3 facing = gl_FrontFacing ? normal : -normal;
    color.rgb = normalize(facing) * 0.5 + 0.5;
    color.a = sharp;
    color *= shade;
}
