#version 330 core
// What a vertex shader is given and gives.

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 texcoord;
in mat4 instance;

uniform mat4 view_projection;
uniform sampler2D heights;

out vec2 uv;
flat out int kind;
invariant gl_Position;

void main() {
    float row = float(gl_VertexID / 8 + gl_InstanceID);
    vec3 p = position;
    p.y += textureLod(heights, texcoord, 0.0).r + row * 0.25;
    uv = texcoord * 2.0 - 1.0;
    kind = gl_VertexID % 3;
    gl_PointSize = 4.0;
    gl_Position = view_projection * instance * vec4(p, 1.0);
}
