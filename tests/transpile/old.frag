#version 100
// GLSL ES 1.00: WebGL 1.
#extension GL_OES_standard_derivatives : enable
#extension GL_EXT_shader_texture_lod : enable
precision mediump float;
precision lowp int;

varying highp vec2 v_uv;
varying vec3 v_normal;
uniform sampler2D u_map;
uniform samplerCube u_sky;
uniform lowp vec4 u_tint;

highp float grain(highp vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

void main() {
    vec3 n = normalize(v_normal);
    vec4 base = texture2D(u_map, v_uv) * u_tint;
    base += texture2DLodEXT(u_map, v_uv, 2.0) * 0.25;
    base += texture2D(u_map, v_uv * 2.0, 1.0) + texture2DProj(u_map, vec3(v_uv, 2.0));
    vec3 sky = textureCube(u_sky, reflect(vec3(0.0, 0.0, -1.0), n)).rgb;
    mediump float lines = length(dFdx(v_uv)) + grain(v_uv);
    gl_FragColor = vec4(base.rgb * sky, base.a);
    gl_FragColor.a *= lines;
}
