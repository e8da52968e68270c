// The rest pose of a skinned body in three's shaders: techniques that read a volume of the body take the place of a point without its bones,
// and directions there, turned back by the rotation of the blended bones. Other bodies are at rest as they are.

import * as TSL from 'three/tsl';

/** WebGLRenderer: what goes into three's shaders. three computes `skinMatrix` for the normal. */
export const REST_POSE = {
  skinned: {
    varyings: /* glsl */ `
varying vec3 sss_P_rest;
varying mat3 sss_to_rest;
`,
    vertex: /* glsl */ `
{
  vec3 x = normalize(skinMatrix[0].xyz);
  vec3 z = normalize(cross(x, skinMatrix[1].xyz));
  sss_P_rest = (modelMatrix * vec4(position, 1.0)).xyz;
  sss_to_rest = mat3(modelMatrix) * transpose(mat3(x, cross(z, x), z)) * inverse(mat3(modelMatrix));
}
`,
    variables: /* glsl */ `
#define sss_at_rest(P) sss_P_rest
vec3 sss_turned_back(vec3 way) {
  vec3 turned = sss_to_rest * way;
  return turned * inversesqrt(max(dot(turned, turned), 1e-30));
}
`,
  },
  rigid: {
    varyings: '',
    vertex: '',
    variables: /* glsl */ `
#define sss_at_rest(P) P
#define sss_turned_back(way) way
`,
  },
};

// WebGPURenderer: nodes.

/** v / |v|; 0 stays 0, of which normalize makes NaN. */
export const unit = (v) => v.mul(v.dot(v).max(1e-30).inverseSqrt());

/**
 * The directions x, y and z behind the rotation of the blended bones, in the object's space.
 * @returns {any[]}
 */
function bonesAt(object) {
  /** @type {any} three's types of these have too many parameters, and no `element` */
  const { reference, referenceBuffer } = TSL;
  const bones = referenceBuffer('skeleton.boneMatrices', 'mat4', object.skeleton.bones.length);
  const index = TSL.attribute('skinIndex', 'uvec4'), weight = TSL.attribute('skinWeight', 'vec4');
  const blended = ['x', 'y', 'z', 'w'].map((part) => bones.element(index[part]).mul(weight[part])).reduce((sum, matrix) => sum.add(matrix));
  const skin = reference('bindMatrixInverse', 'mat4').mul(blended).mul(reference('bindMatrix', 'mat4'));
  const x = unit(skin.element(0).xyz), z = unit(x.cross(skin.element(1).xyz));
  return [x, z.cross(x), z].map((axis) => TSL.varying(axis));
}

/** Where a point is without its bones, in world space. */
export const restPosition = TSL.Fn((_, { object }) => {
  if (!object.isSkinnedMesh) return TSL.positionWorld;
  return TSL.varying(TSL.modelWorldMatrix.mul(TSL.vec4(TSL.positionGeometry, 1)).xyz);
}, 'vec3')();

/** A direction in world space, turned back. */
export const turnedBack = (way) => TSL.Fn((_, { object }) => {
  if (!object.isSkinnedMesh) return way;
  const own = TSL.modelWorldMatrixInverse.mul(TSL.vec4(way, 0)).xyz;
  const [x, y, z] = bonesAt(object).map((axis) => axis.dot(own));
  return unit(TSL.modelWorldMatrix.mul(TSL.vec4(x, y, z, 0)).xyz);
}, 'vec3')();
