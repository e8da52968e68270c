// The light inside a body in Babylon.js: the lights and the surroundings of its scene, summed on the CPU whenever they have changed.

import { RawTexture3D } from '@babylonjs/core/Materials/Textures/rawTexture3D.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Matrix } from '@babylonjs/core/Maths/math.vector.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { DIRECTIONAL, POINT, SPOT, axisOf, lightOf, lightsOn } from './babylon_lights.js';
import { shownAround } from './babylon_surroundings.js';
import { surroundingsOf } from './inner_light.js';
import { InnerPose } from './inner_pose.js';
import { InnerTexels, directionBehind, distantLamp, nearLamp } from './inner_volume.js';

/** The kinds of fall-off, as Babylon's lights number them. */
const PHYSICAL = 1, GLTF = 2, STANDARD = 3;
const saturated = (value) => Math.min(Math.max(value, 0), 1);

/** The kind of a light's fall-off at a material. */
function kindOf({ falloffType }, { usePhysicalLightFalloff, useGLTFLightFalloff }) {
  return falloffType || (usePhysicalLightFalloff ? PHYSICAL : useGLTFLightFalloff ? GLTF : STANDARD);
}

/** What is left of a light's colour, as Babylon's shaders have it. */
function fallOf(distance, cosine, [kind, range, edge, inner, exponent]) {
  const square = Math.max(distance * distance, 1e-7);
  const inRange = kind === GLTF ? saturated(1 - (square / (range * range)) ** 2) ** 2 : 1;
  const fall = kind === STANDARD ? Math.max(1 - distance / range, 0) : inRange / square;
  if (edge === undefined) return fall;
  if (kind === STANDARD) return cosine >= edge ? fall * Math.max(cosine, 1e-7) ** exponent : 0;
  if (kind === GLTF) return fall * saturated((cosine - edge) / Math.max(inner - edge, 0.001)) ** 2;
  return fall * 100 ** ((cosine - 1) / (1 - edge)); // a hundredth at the edge of the cone
}

/** The lights on a mesh with a material, in the space of the mesh. */
function lampsOf(mesh, material) {
  const world = mesh.getWorldMatrix(), toObject = Matrix.Invert(world).m;
  return lightsOn(mesh, [POINT, DIRECTIONAL, SPOT]).map((light) => {
    const [place, radiance] = lightOf(light), color = radiance.map((value) => value * material.directIntensity);
    const position = place.slice(0, 3);
    if (!place[3]) return distantLamp(position, color, toObject);
    const settings = [kindOf(light, material), light.range];
    if (light.getTypeID() === POINT) return nearLamp({ position, color, settings }, fallOf, world.m, toObject);
    settings.push(...[light.angle, light.innerAngle].map((angle) => Math.cos(0.5 * angle)), light.exponent);
    return nearLamp({ position, color, axis: axisOf(light).asArray(), settings }, fallOf, world.m, toObject);
  });
}

/** The pose of a mesh whose bones its shader reads; null for another one. */
function poseOf(mesh, response) {
  if (!mesh.useBones || !mesh.computeBonesUsingShaders || !mesh.skeleton) return null;
  const [places, bones, weights] = ['position', 'matricesIndices', 'matricesWeights'].map((kind) => mesh.getVerticesData(kind));
  return new InnerPose(response, places, bones, weights);
}

/** What each bone does to points in the space of the mesh: matrices, by columns. */
function bonesOf(mesh) {
  const numbers = mesh.skeleton.getTransformMatrices(mesh);
  return mesh.skeleton.bones.map((_, bone) => Array.from(numbers.subarray(16 * bone, 16 * bone + 16)));
}

/** The volume of the light inside a mesh. */
export class InnerVolume extends RawTexture3D {
  #texels;
  /** @type {InnerPose | null | undefined} */
  #pose;

  /** @param {import('./inner_light.js').LightResponse} response */
  constructor(response, scene) {
    const texels = new InnerTexels(response), clamp = Texture.CLAMP_ADDRESSMODE;
    super(texels.data, response.width, response.height, response.depth, 5, scene, false, false, Texture.BILINEAR_SAMPLINGMODE, 2); // RGBA, half floats
    Object.assign(this, { wrapU: clamp, wrapV: clamp, wrapR: clamp, doNotSerialize: true });
    this.#texels = texels;
  }

  get response() {
    return this.#texels.response;
  }

  /** Takes the light of now. */
  follow(mesh, material) {
    const shown = shownAround(mesh, material), world = mesh.getWorldMatrix().m;
    const around = surroundingsOf((way) => shown(Vector3.FromArray(directionBehind(world, way))));
    this.#pose ??= poseOf(mesh, this.response);
    this.#pose?.bend(bonesOf(mesh));
    if (this.#texels.follow(lampsOf(mesh, material), around, this.#pose)) this.update(this.#texels.data);
  }
}
