#version 330 core
// uniforms
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

struct Light {
    vec3 position;
    vec3 color;
    float range;
};

struct Fog {
    vec3 color;
    float density;
};

uniform mat4 view;
uniform vec3 eye;
uniform vec4 shading_base;
uniform float shading_weights[2];
uniform Light lights[2];
uniform Fog fog;
uniform float time;
uniform float exposure;
uniform int count;
uniform uint mask;
uniform bool foggy;
uniform vec2 points[3];
uniform mat3 turn;

uniform sampler2D albedo;
uniform samplerCube sky;

in vec3 v_position;
in vec3 v_normal;
layout(location = 0) out vec4 color;

vec3 lit(Light light, vec3 p, vec3 n) {
    vec3 to = light.position - p;
    float fade = max(1.0 - length(to) / light.range, 0.0);
    return light.color * max(dot(normalize(to), n), 0.0) * fade;
}

void main() {
    vec3 n = normalize(turn * v_normal);
    vec3 sum = texture(sky, n).rgb * shading_weights[0];
    for (int i = 0; i < 2; i++) {
        if (i >= count || (mask & (1u << uint(i))) == 0u) {
            continue;
        }
        sum += lit(lights[i], v_position, n) * shading_weights[1];
    }
    if (foggy) {
        sum = mix(sum, fog.color, 1.0 - exp(-fog.density * distance(eye, v_position)));
    }
    vec2 uv = (view * vec4(v_position, 1.0)).xy + points[2] * time;
    color = vec4(sum * exposure, 1.0) * shading_base * texture(albedo, uv);
}
