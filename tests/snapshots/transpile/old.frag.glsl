#version 330 core
// old
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

uniform vec4 u_tint;

uniform sampler2D u_map;
uniform samplerCube u_sky;

in vec2 v_uv;
in vec3 v_normal;
out vec4 FragColor;

float grain(vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

void main() {
    vec3 n = normalize(v_normal);
    vec4 base = texture(u_map, v_uv) * u_tint;
    base += textureLod(u_map, v_uv, 2.0) * 0.25;
    vec3 place = vec3(v_uv, 2.0);
    base += texture(u_map, v_uv * 2.0, 1.0) + texture(u_map, place.xy / place.z);
    vec3 sky = texture(u_sky, reflect(vec3(0.0, 0.0, -1.0), n)).rgb;
    float lines = length(dFdx(v_uv)) + grain(v_uv);
    FragColor = vec4(base.rgb * sky, base.a);
    FragColor.a *= lines;
}
