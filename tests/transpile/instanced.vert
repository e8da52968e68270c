#version 300 es
// Instances, morph targets and batches in textures, several views, as engines for the web have them.
precision highp float;
precision highp int;
precision mediump sampler2DArray;

layout(num_views = 2) in;

#define TARGETS 3

uniform sampler2DArray morph_texture;
uniform highp sampler2D batch_texture;
uniform highp usampler2D batch_ids;
uniform float morph_weights[TARGETS];
uniform float base_weight;
uniform mat4 view_projections[2];
uniform mat4 model;

in vec3 position;
in vec3 normal;
in uvec4 joints;
layout(location = 5) in mat4 instance;
layout(location = 9) in vec3 instance_color;

out vec3 v_normal;
flat out uvec2 v_joints;
flat out vec3 v_color;
out highp float v_depth;
invariant gl_Position;

vec4 morph(const in int vertex, const in int target, const in int part) {
    int width = textureSize(morph_texture, 0).x;
    int texel = vertex * 2 + part;
    return texelFetch(morph_texture, ivec3(texel % width, texel / width, target), 0);
}

mat4 batched(const in uint id) {
    int size = textureSize(batch_texture, 0).x;
    int first = int(id) * 4;
    ivec2 at = ivec2(first % size, first / size);
    return mat4(texelFetch(batch_texture, at, 0), texelFetch(batch_texture, at + ivec2(1, 0), 0),
        texelFetch(batch_texture, at + ivec2(2, 0), 0), texelFetch(batch_texture, at + ivec2(3, 0), 0));
}

uint batch_id(const in int draw) {
    int size = textureSize(batch_ids, 0).x;
    return texelFetch(batch_ids, ivec2(draw % size, draw / size), 0).r;
}

void main() {
    vec3 p = position * base_weight;
    vec3 n = normal * base_weight;
    for (int i = 0; i < TARGETS; i++) {
        if (morph_weights[i] != 0.0) {
            p += morph(gl_VertexID, i, 0).xyz * morph_weights[i];
            n += morph(gl_VertexID, i, 1).xyz * morph_weights[i];
        }
    }
    mat3 turn = mat3(instance);
    n /= vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
    v_normal = mat3(model) * (turn * n);
    v_joints = joints.xy;
    v_color = instance_color * float(gl_InstanceID);
    vec4 world = model * batched(batch_id(gl_DrawID)) * instance * vec4(p, 1.0);
    gl_Position = view_projections[gl_ViewID_OVR] * world;
    v_depth = gl_Position.w;
}
