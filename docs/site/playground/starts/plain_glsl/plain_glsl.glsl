// Plain GLSL: a shader as Shadertoy has it. The picture is the translation to GLSL ES 3.00.

float blob(vec2 at, vec2 center, float radius) {
    return radius / max(length(at - center), 0.001);
}

void mainImage(out vec4 color, in vec2 pixel) {
    vec2 at = (2.0 * pixel - iResolution.xy) / iResolution.y;
    float sum = 0.0;
    for (int i = 0; i < 5; i++) {
        float turn = float(i) * 1.2566 + iTime * (0.3 + 0.1 * float(i));
        sum += blob(at, 0.55 * vec2(cos(turn), sin(1.3 * turn)), 0.12);
    }
    float inside = smoothstep(0.9, 1.4, sum);
    vec3 wax = mix(vec3(0.95, 0.35, 0.08), vec3(1.0, 0.8, 0.45), smoothstep(1.2, 3.0, sum));
    color = vec4(mix(vec3(0.06, 0.05, 0.07), wax, inside), 1.0);
}
