#version 300 es
// Several outputs of several types.
precision highp float;
precision highp int;

in vec3 v_normal;
flat in uvec2 v_joints;
flat in vec3 v_color;
in highp float v_depth;

layout(location = 0) out vec4 layers[2];
layout(location = 2) out uvec4 ids;
layout(location = 3) out ivec2 cell;

void main() {
    if (v_depth > 100.0) {
        discard;
    }
    layers[0] = vec4(v_color, 1.0);
    layers[1].rgb = normalize(v_normal) * 0.5 + 0.5;
    layers[1].a = v_depth;
    ids = uvec4(v_joints, 0u, 1u);
    cell = ivec2(v_normal.xy * 8.0);
}
