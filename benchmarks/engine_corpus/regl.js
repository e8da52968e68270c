// regl has no shaders of its own: packages that draw with it, and commands in the style of its users (GLSL ES 1.00).

import createREGL from 'regl';
import createLine from 'regl-line2d';
import createScatter from 'regl-scatter2d';
import createError from 'regl-error2d';
import { canvas, run } from './pages_common.js';

const regl = createREGL({
  canvas: canvas(),
  extensions: ['OES_standard_derivatives', 'ANGLE_instanced_arrays', 'OES_element_index_uint'],
  optionalExtensions: ['EXT_frag_depth', 'EXT_shader_texture_lod', 'WEBGL_draw_buffers', 'OES_texture_float'],
});
const points = [0, 0, 1, 1, 2, 0, 3, 1];
const VERTEX = 'precision highp float; attribute vec2 corner; varying vec2 at; void main() { at = 0.5 * corner + 0.5; gl_Position = vec4(corner, 0, 1); }';
const HEAD = 'precision mediump float; varying vec2 at; uniform float time; uniform sampler2D image; uniform vec3 colors[3]; uniform mat3 turn;';

const FRAGMENTS = {
  gradient: `${HEAD} void main() { gl_FragColor = vec4(mix(colors[0], colors[1], at.x), 1); }`,
  image: `${HEAD} void main() { gl_FragColor = texture2D(image, (turn * vec3(at, 1)).xy, -1.0); }`,
  blur: `${HEAD} const int R = 3; void main() { vec4 sum = vec4(0); for (int i = -R; i <= R; i++) sum += texture2D(image, at + vec2(i, 0) / 32.0); gl_FragColor = sum / float(2 * R + 1); }`,
  edges: `#extension GL_OES_standard_derivatives : enable\n${HEAD} void main() { float d = length(at - 0.5) - 0.3; float w = fwidth(d); gl_FragColor = vec4(vec3(smoothstep(-w, w, d)), 1); }`,
  life: `${HEAD} float cell(vec2 by) { return step(0.5, texture2D(image, fract(at + by / 32.0)).r); } void main() { float n = 0.0; for (int y = -1; y <= 1; ++y) for (int x = -1; x <= 1; ++x) if (x != 0 || y != 0) n += cell(vec2(x, y)); gl_FragColor = vec4(vec3(n == 3.0 || (n == 2.0 && cell(vec2(0)) > 0.5) ? 1.0 : 0.0), 1); }`,
  noise: `${HEAD} float hash(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); } float noise(vec2 p) { vec2 i = floor(p), f = fract(p); f *= f * (3.0 - 2.0 * f); return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + 1.0), f.x), f.y); } void main() { float v = 0.0, a = 0.5; vec2 p = at * 8.0; for (int i = 0; i < 5; i++) { v += a * noise(p + time); p *= 2.0; a *= 0.5; } gl_FragColor = vec4(vec3(v), 1); }`,
  spheres: `${HEAD} float scene(vec3 p) { return min(length(p) - 0.5, p.y + 0.5); } void main() { vec3 ro = vec3(0, 0, 2), rd = normalize(vec3(at - 0.5, -1)); float t = 0.0; for (int i = 0; i < 40; i++) { float d = scene(ro + t * rd); if (d < 0.001) break; t += d; } vec2 e = vec2(0.001, 0); vec3 p = ro + t * rd; vec3 n = normalize(vec3(scene(p + e.xyy) - scene(p - e.xyy), scene(p + e.yxy) - scene(p - e.yxy), scene(p + e.yyx) - scene(p - e.yyx))); gl_FragColor = vec4(t > 10.0 ? colors[2] : max(dot(n, normalize(colors[0])), 0.0) * colors[1], 1); }`,
  depth: `#extension GL_EXT_frag_depth : enable\n${HEAD} void main() { gl_FragDepthEXT = at.x; gl_FragColor = vec4(at, gl_FrontFacing ? 1.0 : 0.0, 1.0); }`,
  level: `#extension GL_EXT_shader_texture_lod : enable\n${HEAD} void main() { gl_FragColor = texture2DLodEXT(image, at, 2.0) + texture2DGradEXT(image, at, vec2(0.1), vec2(0.2)); }`,
  outputs: `#extension GL_EXT_draw_buffers : require\n${HEAD} void main() { gl_FragData[0] = vec4(at, 0, 1); gl_FragData[1] = texture2D(image, at); }`,
  metaballs: `${HEAD} uniform vec3 balls[8]; void main() { float v = 0.0; for (int i = 0; i < 8; i++) { vec2 d = at - balls[i].xy; v += balls[i].z * balls[i].z / dot(d, d); } if (v < 1.0) discard; gl_FragColor = vec4(v, 0.0, 0.0, 1.0); }`,
};

function command(frag, vert = VERTEX, more = {}) {
  const two = frag.includes('gl_FragData');
  const framebuffer = two ? regl.framebuffer({ colorCount: 2, width: 8, height: 8, depthStencil: false }) : null;
  const balls = Object.fromEntries(Array.from({ length: 8 }, (_, index) => [`balls[${index}]`, [0.1 * index, 0.5, 0.1]]));
  regl({
    frag, vert, framebuffer, attributes: { corner: [[-4, -4], [4, -4], [0, 4]], ...more.attributes }, count: 3, ...more.command,
    uniforms: { time: 1, image: regl.texture({ radius: 4, mipmap: true, min: 'mipmap' }), 'colors[0]': [1, 0, 0], 'colors[1]': [0, 1, 0], 'colors[2]': [0, 0, 1], turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], ...balls, ...more.uniforms },
  })();
}

run([
  ...Object.entries(FRAGMENTS).map(([name, text]) => [name, () => command(text)]),
  ['instances', () => command(
    'precision mediump float; varying vec4 tint; void main() { gl_FragColor = tint; }',
    'attribute vec2 corner; attribute vec2 offset; attribute vec4 color; uniform mat4 view; varying vec4 tint; void main() { tint = color; gl_PointSize = 4.0; gl_Position = view * vec4(corner * 0.1 + offset, 0, 1); }',
    { attributes: { offset: { buffer: [[0, 0], [1, 1]], divisor: 1 }, color: { buffer: [[1, 0, 0, 1], [0, 1, 0, 1]], divisor: 1 } }, command: { instances: 2 }, uniforms: { view: Array.from({ length: 16 }, (_, index) => +(index % 5 === 0)) } },
  )],
  ['points', () => command('precision mediump float; void main() { vec2 d = gl_PointCoord - 0.5; if (dot(d, d) > 0.25) discard; gl_FragColor = vec4(1); }', 'attribute vec2 corner; void main() { gl_PointSize = 8.0; gl_Position = vec4(corner, 0, 1); }', { command: { primitive: 'points' } })],
  ['regl-line2d', () => createLine(regl).render({ positions: points, thickness: 4, color: 'red', join: 'round' })],
  ['regl-line2d, rectangles, dashes', () => createLine(regl).render({ positions: points, thickness: 2, dash: [4, 4], fill: 'blue', join: 'rect' })],
  ['regl-scatter2d', () => createScatter(regl)({ positions: points, size: 8, color: 'blue' })],
  ['regl-scatter2d, markers', () => createScatter(regl)({ positions: points, size: 8, color: 'blue', markers: [null, new Array(64).fill(0.5), null, new Array(64).fill(0.2)] })],
  ['regl-error2d', () => createError(regl)({ positions: points, errors: points.flatMap(() => [0.1, 0.1]).slice(0, 16) })],
]);
