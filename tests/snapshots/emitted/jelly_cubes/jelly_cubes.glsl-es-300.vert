#version 300 es
// Jelly cubes: Two jelly cubes on a floor, drawn from distance functions; their thin parts glow with
// the sky.
// Made by sssgen for GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0). Change the material and emit it again rather than this file.

// One triangle covers the screen: draw 3 vertices, no vertex buffer.
out vec2 v_uv;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_uv = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, 0.0, 1.0);
}
