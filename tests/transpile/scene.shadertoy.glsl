// A scene as Shadertoy has them, with the mouse, the time and a texture.
#define MARCH 40
#define t iTime

mat2 turn(float a) {
    vec2 v = sin(vec2(1.570796, 0) + a);
    return mat2(v, -v.y, v.x);
}

float map(vec3 p) {
    p.xz *= turn(t * .5);
    vec3 q = abs(p) - .6;
    return length(max(q, 0.)) + min(max(q.x, max(q.y, q.z)), 0.) - .1;
}

vec3 normal(vec3 p) {
    vec2 e = vec2(1, -1) * .001;
    return normalize(e.xyy * map(p + e.xyy) + e.yyx * map(p + e.yyx) + e.yxy * map(p + e.yxy) + e.xxx * map(p + e.xxx));
}

void mainImage(out vec4 O, in vec2 F)
{
    vec2 R = iResolution.xy, uv = (F + F - R) / R.y;
    vec2 mouse = iMouse.z > 0. ? iMouse.xy / R : vec2(.5);
    vec3 ro = vec3(0, 0, -3), rd = normalize(vec3(uv, 1.5)), p;
    float d = 0., h;
    int i = 0;
    for (; i < MARCH; i++) {
        p = ro + rd * d;
        d += h = map(p);
        if (h < .001 || d > 20.) break;
    }
    O = vec4(0);
    if (d < 20.) {
        vec3 n = normal(p);
        O.rgb = texture(iChannel0, n.xy * .5 + .5).rgb * max(dot(n, normalize(vec3(mouse, -1))), 0.);
    }
    O = pow(O + float(iFrame % 2) * .01, vec4(1. / 2.2));
}
