// What PlayCanvas draws a body with in the passes of a material: shaders that write the distance from the eye or from the light's
// plane, and what a white matt body reflects.

import * as pc from 'playcanvas';
import { LAYERS, PACKING } from './frame_passes.js';

const ATTRIBUTES = {
  vertex_position: pc.SEMANTIC_POSITION, vertex_boneIndices: pc.SEMANTIC_BLENDINDICES, vertex_boneWeights: pc.SEMANTIC_BLENDWEIGHT,
  instance_line1: pc.SEMANTIC_ATTR11, instance_line2: pc.SEMANTIC_ATTR12,
  instance_line3: pc.SEMANTIC_ATTR14, instance_line4: pc.SEMANTIC_ATTR15,
};

/** A material's vertex shader has no text for instances: here is PlayCanvas's own. */
const matricesOf = (device, language) => `
#include "transformCoreVS"
#ifdef INSTANCING
${pc.ShaderChunks.get(device, language).get('transformInstancingVS')}
#endif`;

const vertexGlsl = (matrices) => `${matrices}
uniform mat4 matrix_view;
varying vec3 sss_place;
void main() {
  vec4 place = getModelMatrix() * vec4(getLocalPosition(vertex_position.xyz), 1.0);
  sss_place = (matrix_view * place).xyz;
  gl_Position = matrix_viewProjection * place;
}`;

const vertexWgsl = (matrices) => `${matrices}
uniform matrix_view: mat4x4f;
varying sss_place: vec3f;
@vertex
fn vertexMain(input: VertexInput) -> VertexOutput {
  var output: VertexOutput;
  let place = getModelMatrix() * vec4f(getLocalPosition(vertex_position.xyz), 1.0);
  output.sss_place = (uniform.matrix_view * place).xyz;
  output.position = uniform.matrix_viewProjection * place;
  return output;
}`;

// A layer that peels has the surfaces behind those of the layer before. camera_params.z is where a camera's view begins.
const FRAGMENT_GLSL = `
varying vec3 sss_place;
uniform float sss_from_plane;
uniform vec4 camera_params;
#ifdef SSS_PEELS
uniform float sss_margin;
uniform highp sampler2D sss_front;
#endif
void main() {
  float distance = sss_from_plane > 0.0 ? -sss_place.z - camera_params.z : length(sss_place);
#ifdef SSS_PEELS
  if (distance < texelFetch(sss_front, ivec2(gl_FragCoord.xy), 0).r + sss_margin) discard;
#endif
  gl_FragColor = vec4(distance, 0.0, 0.0, 1.0);
}`;

const FRAGMENT_WGSL = `
varying sss_place: vec3f;
uniform sss_from_plane: f32;
uniform camera_params: vec4f;
#ifdef SSS_PEELS
uniform sss_margin: f32;
var sss_front: texture_2d<uff>;
#endif
@fragment
fn fragmentMain(input: FragmentInput) -> FragmentOutput {
  var output: FragmentOutput;
  let distance = select(length(input.sss_place), -input.sss_place.z - uniform.camera_params.z, uniform.sss_from_plane > 0.0);
#ifdef SSS_PEELS
  if (distance < textureLoad(sss_front, vec2i(pcPosition.xy), 0).r + uniform.sss_margin) { discard; }
#endif
  output.color = vec4f(distance, 0.0, 0.0, 1.0);
  return output;
}`;

/** A material that writes the distances of front or back faces; `peels`: of those behind the layer before. */
export function distanceMaterial(device, back, peels) {
  const material = new pc.ShaderMaterial({
    uniqueName: 'sss_distance', attributes: ATTRIBUTES,
    vertexGLSL: vertexGlsl(matricesOf(device, pc.SHADERLANGUAGE_GLSL)), fragmentGLSL: FRAGMENT_GLSL,
    vertexWGSL: vertexWgsl(matricesOf(device, pc.SHADERLANGUAGE_WGSL)), fragmentWGSL: FRAGMENT_WGSL,
  });
  material.cull = back ? pc.CULLFACE_FRONT : pc.CULLFACE_BACK;
  if (peels) material.setDefine('SSS_PEELS', '');
  material.update();
  return material;
}

/**
 * A material that writes what white matt bodies reflect, and the distance from the eye's plane: all but its last lines are those of
 * a material of the engine.
 */
export function mattMaterial() {
  const material = new pc.StandardMaterial();
  material.useFog = false;
  const glsl = material.getShaderChunks(pc.SHADERLANGUAGE_GLSL), wgsl = material.getShaderChunks(pc.SHADERLANGUAGE_WGSL);
  glsl.set('litUserDeclarationPS', 'uniform mat4 matrix_view;\nuniform vec4 camera_params;');
  glsl.set('outputPS', 'gl_FragColor = vec4(dDiffuseLight, -(matrix_view * vec4(vPositionW, 1.0)).z - camera_params.z);');
  wgsl.set('litUserDeclarationPS', 'uniform matrix_view: mat4x4f;\nuniform camera_params: vec4f;');
  wgsl.set('outputPS', 'output.color = vec4f(vec3f(dDiffuseLight), -(uniform.matrix_view * vec4f(vPositionW, 1.0)).z - uniform.camera_params.z);');
  material.update();
  return material;
}

/** Writes four layers into one picture. */
export function packingPass(device) {
  const pass = new pc.RenderPassShaderQuad(device);
  pass.shader = pc.ShaderUtils.createShader(device, {
    uniqueName: 'sss_packing', attributes: { vertex_position: pc.SEMANTIC_POSITION }, vertexChunk: 'fullscreenQuadVS',
    fragmentGLSL: PACKING.glsl,
    fragmentWGSL: `
${LAYERS.map((name) => `var ${name}: texture_2d<uff>;`).join('\n')}
@fragment
fn fragmentMain(input: FragmentInput) -> FragmentOutput {
  var output: FragmentOutput;
  let at = vec2i(pcPosition.xy);
  output.color = ${PACKING.wgsl};
  return output;
}`,
  });
  return pass;
}
