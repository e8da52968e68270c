#version 330 core
// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the material and emit it again rather than this file.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;  // w: handedness, +1 or -1
layout(location = 3) in vec2 uv;

uniform mat4 model;
uniform mat4 inverse_model;
uniform mat4 view_projection;

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;

void main() {
    vec4 world_position = model * vec4(position, 1.0);
    gl_Position = view_projection * world_position;
    v_position = world_position.xyz;
    v_normal = normal * mat3(inverse_model);
    v_tangent = vec4(mat3(model) * tangent.xyz, tangent.w * sign(determinant(mat3(model))));
    v_uv = uv;
}
