// Nodes for WebGPURenderer: calls of a material's functions, with three's own nodes as arguments.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { spreadOf } from './frame_passes.js';
import { restPosition, turnedBack, unit } from './three_rest_pose.js';
import { entryShadow, hasEntryShadow } from './three_shadows.js';
import { surroundings } from './three_surroundings.js';

/**
 * A function of the texts, and its arguments in order.
 * @typedef {object} Call
 * @property {string} name
 * @property {string[]} inputs the keys of INPUTS and of `lightInputs`; `surface`: the variable with the surface
 * @property {string[]} values parameters and textures
 */

/** The variable of the texts that has the surface. */
const SURFACE = 'sss_surface';

/** A direction in another space. */
const turned = (matrix, v) => unit(matrix.mul(TSL.vec4(v, 0)).xyz);
const viewDirection = turned(TSL.cameraWorldMatrix, TSL.positionViewDirection);
/** -1 on a back face, whose normal is reversed. */
const side = TSL.Fn((_, { material }) => (material.side === THREE.DoubleSide ? TSL.faceDirection : TSL.float(1)), 'float')();
const geometryNormal = turned(TSL.cameraWorldMatrix, TSL.negateOnBackSide(TSL.normalViewGeometry));

/**
 * The matrix of one of the bodies that an object draws, in the vertex shader: to the object's space.
 * @returns {any} a node; null where the object is the body
 */
function matrixOfInstance(object) {
  if (object.isInstancedMesh) return TSL.referenceAttribute('instanceMatrix', 'mat4');
  if (!object.isBatchedMesh) return null;
  const texels = TSL.textureLoad(object._matricesTexture), first = TSL.int(TSL.batchIndirectIndex).mul(4);
  /** @type {any} three's types have no size in components */
  const size = TSL.textureSize(texels, TSL.int(0));
  const width = TSL.int(size.x);
  const column = (number) => texels.sample(TSL.ivec2(first.add(number).mod(width), first.add(number).div(width)));
  return TSL.mat4(column(0), column(1), column(2), column(3));
}

/** From the space of the body to the world, in the vertex shader. */
const bodyToWorld = TSL.Fn((_, { object }) => {
  const matrix = matrixOfInstance(object);
  return matrix ? TSL.modelWorldMatrix.mul(matrix) : TSL.modelWorldMatrix;
}, 'mat4')();
/** The inverse, in the fragment shader. */
const worldToBody = TSL.Fn((_, { object }) => {
  const matrix = matrixOfInstance(object);
  if (!matrix) return TSL.modelWorldMatrixInverse;
  /** @type {any} three's types take it for one of two columns */
  const inverse = TSL.inverse(matrix);
  /** @returns {any} */
  const column = (number) => TSL.varying(inverse.element(number)).setInterpolation('flat');
  return TSL.mat4(column(0), column(1), column(2), column(3)).mul(TSL.modelWorldMatrixInverse);
}, 'mat4')();

/** The position on the screen in the texture coordinates of a render target: v counts as its rows do. */
const textureScreenUV = TSL.Fn((_, builder) => {
  const screen = TSL.screenUV;
  return builder.renderer.backend.isWebGPUBackend ? screen : TSL.vec2(screen.x, screen.y.oneMinus());
});

/** The meshes with a warning. @type {WeakSet<THREE.BufferGeometry>} */
const bare = new WeakSet();

/** Texture coordinates, 0 where a mesh has none: that is a warning once for each mesh, not for each shader that three builds of it. */
const coordinates = (channel) => TSL.Fn((_, builder) => {
  const name = channel ? `uv${channel}` : 'uv', { geometry, object } = builder;
  if (geometry.hasAttribute(name)) return TSL.uv(channel);
  if (!bare.has(geometry)) console.warn(`${object.name || object.type}: the geometry has no attribute '${name}', which the material reads: it is 0`);
  bare.add(geometry);
  return TSL.vec2(0);
}, 'vec2')();
const uv = coordinates(0);

/** The tangent or the bitangent: that of the geometry, else from the derivatives of uv. */
const tangentFrame = (bitangent) => TSL.Fn((_, builder) => {
  const N = geometryNormal;
  if (builder.geometry.hasAttribute('tangent')) {
    const T = unit(TSL.varying(bodyToWorld.mul(TSL.vec4(TSL.tangentGeometry.xyz, 0)).xyz));
    const handedness = TSL.varying(TSL.tangentGeometry.w.mul(bodyToWorld.determinant().sign()));
    return bitangent ? N.mul(side).cross(T).mul(handedness) : T;
  }
  const across = TSL.positionWorld.dFdx(), up = TSL.positionWorld.dFdy();
  const a = uv.dFdx(), b = uv.dFdy();
  const first = up.cross(N), second = N.cross(across);
  const T = first.mul(a.x).add(second.mul(b.x)), B = first.mul(a.y).add(second.mul(b.y));
  const longest = T.dot(T).max(B.dot(B)).max(1e-30).inverseSqrt();
  return (bitangent ? B : T).mul(longest);
}, 'vec3')();
const tangent = tangentFrame(false), bitangent = tangentFrame(true);

/** The values at a point of the surface, with their types. */
const INPUTS = {
  uv: [uv, 'vec2'],
  uv2: [coordinates(1), 'vec2'],
  vertex_color: [TSL.vertexColor(), 'vec4'],
  P: [TSL.positionWorld, 'vec3'],
  N: [geometryNormal, 'vec3'],
  V: [viewDirection, 'vec3'],
  T: [tangent, 'vec3'],
  B: [bitangent, 'vec3'],
  P_object: [TSL.positionGeometry, 'vec3'],
  N_object: [unit(TSL.normalGeometry).mul(side), 'vec3'],
  V_object: [turned(worldToBody, viewDirection), 'vec3'],
  P_rest: [restPosition, 'vec3'],
  N_rest: [turnedBack(geometryNormal), 'vec3'],
  V_rest: [turnedBack(viewDirection), 'vec3'],
  screen_uv: [textureScreenUV(), 'vec2'],
  eye_distance: [TSL.positionView.length(), 'float'],
  ray_origin: [TSL.cameraPosition, 'vec3'],
  ray_direction: [viewDirection.negate(), 'vec3'],
  irradiance: [surroundings(geometryNormal), 'vec3'],
  irradiance_behind: [surroundings(geometryNormal.negate()), 'vec3'],
};

/** The values of a light. */
const lightInputs = (L, color, nearness) => ({
  L: [L, 'vec3'],
  L_object: [turned(worldToBody, L), 'vec3'],
  light_color: [color, 'vec3'],
  light_nearness: [nearness, 'float'],
});

/** The light of an unlit material. */
function ownLight(lightPlace, lightRadiance, onScreen) {
  const toLight = lightPlace.xyz.sub((onScreen ? TSL.cameraPosition : TSL.positionWorld).mul(lightPlace.w));
  const nearness = toLight.dot(toLight).max(1e-4).inverseSqrt();
  const color = lightRadiance.mul(TSL.mix(1, nearness.mul(nearness), lightPlace.w));
  return lightInputs(toLight.mul(nearness), color, nearness.mul(lightPlace.w));
}

/** One of three's lights. Its shadow is that of the point where the light entered the body. */
function engineLight({ lightDirection, lightNode, lightColor }, builder, box) {
  const near = lightNode.light.isPointLight || lightNode.light.isSpotLight;
  const nearness = near ? lightNode.getLightVector(builder).length().max(0.01).reciprocal() : TSL.float(0);
  const L = turned(TSL.cameraWorldMatrix, lightDirection);
  let color = unshadowed(lightNode, builder) ?? lightColor;
  if (hasEntryShadow(lightNode)) color = color.mul(entryShadow(lightNode, { L, nearness, worldToBody, box }));
  return lightInputs(L, color, nearness);
}

/**
 * The four lights that stand for a rectangle of light.
 * @param {any} data three's
 * @param {import('./three.js').Description} description
 */
function areaLights({ lightPosition, halfWidth, halfHeight, lightColor }, { area, passes }, texts) {
  /** @returns {any} */
  const call = (type, part, ...args) => new CallNode(type, area?.[part], texts, args);
  const sides = [TSL.mat3(lightPosition.sub(TSL.positionView), halfWidth, halfHeight), 'mat3'];
  const spread = [TSL.float(Number(spreadOf(passes))), 'float'];
  return [0, 1, 2, 3].map((index) => {
    const way = call('vec4', 'towards', [TSL.int(index), 'int'], spread, sides).toVar();
    const light = call('float', 'light', sides, [way, 'vec4']).max(0);
    return lightInputs(turned(TSL.cameraWorldMatrix, way.xyz), lightColor.mul(light), way.w);
  });
}

/** The light's colour where it arrives, without shadow. */
function unshadowed(lightNode, builder) {
  const { colorNode, baseColorNode } = lightNode;
  if (!baseColorNode) return null;
  lightNode.colorNode = baseColorNode;
  const { lightColor } = lightNode.setupDirect(builder);
  lightNode.colorNode = colorNode;
  return lightColor;
}

/** A call of a function; its arguments are nodes with their types, and undefined for the surface. */
class CallNode extends THREE.Node {
  /** @param {THREE.Node | null} surface */
  constructor(type, name, texts, args, surface = null) {
    super(type);
    this.name = name;
    this.texts = texts;
    this.args = args.map((arg) => arg?.[0]); // three finds nodes in lists
    this.types = args.map((arg) => arg?.[1]);
    this.surface = surface;
  }

  generate(builder) {
    const gpu = builder.renderer.backend.isWebGPUBackend;
    this.texts[gpu ? 'wgsl' : 'glsl'].build(builder);
    this.surface?.build(builder);
    const args = this.args.flatMap((arg, index) => {
      if (!arg) return SURFACE;
      if (!this.types[index].startsWith('sampler')) return arg.build(builder, this.types[index]);
      return gpu ? [arg.build(builder, 'texture'), arg.build(builder, 'sampler')] : arg.build(builder, 'texture');
    });
    return `${this.name}(${args.join(', ')})`;
  }
}

/** The call that stores the surface, once per fragment. */
class SurfaceNode extends CallNode {
  generate(builder) {
    const data = builder.getDataFromNode(this);
    if (!data.stored) {
      data.stored = true;
      builder.addLineFlowCode(`${SURFACE} = ${super.generate(builder)}`, this);
    }
    return '';
  }
}

/** A member of the surface. */
class FieldNode extends THREE.Node {
  constructor(type, name, surface) {
    super(type);
    this.name = name;
    this.surface = surface;
  }

  generate(builder) {
    this.surface.build(builder, 'void');
    return `${SURFACE}.${this.name}`;
  }
}

/**
 * The members of the surface that three reads: type, property of its node material, and the property's value.
 * @type {Record<string, [string, string, ((node: any) => any)?]>}
 */
const FIELDS = {
  metallic: ['float', 'metalnessNode'],
  roughness: ['float', 'roughnessNode'],
  occlusion: ['float', 'aoNode'],
  emission: ['vec3', 'emissiveNode'],
  specular: ['float', 'specularColorNode', (specular) => TSL.materialSpecularColor.mul(specular.mul(25).max(25 / 51))], // and specularIntensityNode
  clearcoat: ['float', 'clearcoatNode', (clearcoat) => TSL.materialClearcoat.mul(clearcoat)],
  clearcoat_roughness: ['float', 'clearcoatRoughnessNode'],
  sheen_color: ['vec3', 'sheenNode', (color) => TSL.materialSheen.mul(color)],
  sheen_roughness: ['float', 'sheenRoughnessNode', (roughness) => roughness.max(1e-4)],
  normal: ['vec3', 'normalNode', ({ x, y, z }) => turned(
    TSL.cameraViewMatrix, tangent.mul(x).add(bitangent.mul(y)).mul(side).add(geometryNormal.mul(z)),
  )],
};

/**
 * The nodes of a material; WebGPURenderer takes them over as it makes a node material of a classic one.
 * @param {import('./three.js').Description} description
 * @param {{ glsl: THREE.Node, wgsl: THREE.Node }} texts nodes of the functions
 * @param {Record<string, any>} uniforms nodes by their properties
 */
export function nodesOf(description, texts, uniforms) {
  const { calls, parameters, textures, fields = [], screen } = description;
  const argumentsOf = ({ inputs, values }, given) => [
    ...inputs.map((name) => given[name]), ...values.map((name) => [uniforms[name], (parameters[name] ?? textures[name]).type]),
  ];
  const point = { ...INPUTS, time: [uniforms.time, 'float'] };
  if (calls.color) {
    const given = uniforms.lightPlace ? { ...point, ...ownLight(uniforms.lightPlace, uniforms.lightRadiance, screen) } : point;
    return { colorNode: new CallNode('vec4', calls.color.name, texts, argumentsOf(calls.color, given)) };
  }
  const surface = new SurfaceNode('void', calls.surface.name, texts, argumentsOf(calls.surface, point));
  /** @returns {any} */
  const field = (type, name, absent) => (fields.includes(name) ? new FieldNode(type, name, surface) : absent);
  const nodes = { colorNode: TSL.materialColor.mul(TSL.vec4(field('vec3', 'albedo', TSL.vec3(1)), field('float', 'alpha', 1))) };
  for (const [name, [type, property, valueOf = (node) => node]] of Object.entries(FIELDS)) {
    if (fields.includes(name)) nodes[property] = valueOf(field(type, name));
  }
  // what reflects less than 2 % from the front is no mirror from the side
  if (fields.includes('specular')) nodes.specularIntensityNode = TSL.materialSpecularIntensity.mul(field('float', 'specular').mul(51).min(1));
  if (calls.translucency) {
    nodes.setupLightingModel = function (builder) {
      /** @type {any} three's types have no parameter */
      const { setupLightingModel } = THREE.MeshPhysicalNodeMaterial.prototype;
      const model = setupLightingModel.call(this, builder);
      const { direct, directRectArea } = model;
      const comeThrough = (light, { reflectedLight }) => {
        const given = { ...point, ...light, N: [TSL.normalWorld, 'vec3'] };
        /** @type {any} */
        const through = new CallNode('vec3', calls.translucency.name, texts, argumentsOf(calls.translucency, given), surface);
        reflectedLight.directDiffuse.addAssign(through.mul(light.light_color[0]).mul(1 / Math.PI));
      };
      model.direct = function (data, builder) {
        direct.call(this, data, builder);
        comeThrough(engineLight(data, builder, uniforms), data);
      };
      model.directRectArea = function (data, builder) {
        directRectArea.call(this, data, builder);
        for (const light of areaLights(data, description, texts)) comeThrough(light, data);
      };
      return model;
    };
  }
  return nodes;
}
