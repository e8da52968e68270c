#version 330 core
// vertex
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

uniform mat4 view_projection;

uniform sampler2D heights;

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 texcoord;
in mat4 instance;
out vec2 uv;
flat out int kind;

void main() {
    float row = float(gl_VertexID / 8 + gl_InstanceID);
    vec3 p = position;
    p.y += textureLod(heights, texcoord, 0.0).r + row * 0.25;
    uv = texcoord * 2.0 - 1.0;
    kind = gl_VertexID % 3;
    gl_PointSize = 4.0;
    gl_Position = view_projection * instance * vec4(p, 1.0);
}
