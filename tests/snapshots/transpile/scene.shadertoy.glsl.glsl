#version 330 core
// scene
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

const int MARCH = 40;

uniform vec3 iResolution;
uniform float iTime;
uniform int iFrame;
uniform vec4 iMouse;

uniform sampler2D iChannel0;

out vec4 shadertoy_color;

// A scene as Shadertoy has them, with the mouse, the time and a texture.
mat2 turn(float a) {
    vec2 v = sin(vec2(1.570796, 0.0) + a);
    return mat2(v, -v.y, v.x);
}

float map(vec3 p) {
    p.xz = p.xz * turn(iTime * 0.5);
    vec3 q = abs(p) - 0.6;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0) - 0.1;
}

vec3 normal(vec3 p) {
    vec2 e = vec2(1.0, -1.0) * 0.001;
    return normalize(e.xyy * map(p + e.xyy) + e.yyx * map(p + e.yyx) + e.yxy * map(p + e.yxy) + e.xxx
        * map(p + e.xxx));
}

void mainImage(out vec4 O, vec2 F) {
    vec2 R = iResolution.xy;
    vec2 uv = (F + F - R) / R.y;
    vec2 mouse = iMouse.z > 0.0 ? iMouse.xy / R : vec2(0.5);
    vec3 ro = vec3(0.0, 0.0, -3.0);
    vec3 rd = normalize(vec3(uv, 1.5));
    vec3 p;
    float d = 0.0;
    float h;
    int i = 0;
    for (; i < MARCH; i++) {
        p = ro + rd * d;
        h = map(p);
        d += h;
        if (h < 0.001 || d > 20.0) {
            break;
        }
    }
    O = vec4(0.0);
    if (d < 20.0) {
        vec3 n = normal(p);
        O.rgb = texture(iChannel0, n.xy * 0.5 + 0.5).rgb * max(dot(n, normalize(vec3(mouse, -1.0))), 0.0);
    }
    O = pow(O + float(iFrame % 2) * 0.01, vec4(1.0 / 2.2));
}

void main() {
    mainImage(shadertoy_color, gl_FragCoord.xy);
}
