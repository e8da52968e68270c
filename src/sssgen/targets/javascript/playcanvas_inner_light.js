// The light inside a body in PlayCanvas: the lights and the surroundings of its scene, summed on the CPU whenever they have changed.

import * as pc from 'playcanvas';
import { fromHalf, surroundingsOf } from './inner_light.js';
import { InnerPose } from './inner_pose.js';
import { InnerTexels, directionBehind, distantLamp, nearLamp } from './inner_volume.js';
import { refill, volumeOf } from './playcanvas_volume.js';

/** What is left of a light's colour, as PlayCanvas's shaders have it. */
function fallOf(distance, cosine, [linear, range, outer, inner]) {
  const square = distance * distance;
  const inRange = Math.min(Math.max(1 - (square / (range * range)) ** 2, 0), 1) ** 2;
  const fall = linear ? Math.max(1 - distance / range, 0) : (16 * inRange) / (square + 1);
  return outer === undefined ? fall : fall * pc.math.smoothstep(outer, inner, cosine);
}

/** Some lights in the space of a mesh instance. */
function lampsOf(instance, lights) {
  const world = instance.node.getWorldTransform(), toObject = world.clone().invert().data;
  return [...lights].filter(({ enabled }) => enabled).map((light) => {
    const { _node: node, _colorLinear: linear, type, falloffMode, attenuationEnd } = light;
    const color = Array.from(linear), axis = node.up.toArray(), position = node.getPosition().toArray();
    if (type === pc.LIGHTTYPE_DIRECTIONAL) return distantLamp(axis, color, toObject);
    const settings = [falloffMode === pc.LIGHTFALLOFF_LINEAR, attenuationEnd];
    if (type === pc.LIGHTTYPE_SPOT) settings.push(light._outerConeAngleCos, light._innerConeAngleCos);
    return nearLamp({ position, color, axis, settings }, fallOf, world.data, toObject);
  });
}

/** From a texel to a channel's light, by the encoding. */
const DECODED = {
  linear: (value) => value, srgb: (value) => value ** 2.2, rgbm: (value, alpha) => (8 * alpha * value) ** 2,
  rgbp: (value, alpha) => ((8 - 7 * alpha) * value) ** 2, rgbe: (value, alpha) => value * 2 ** (255 * alpha - 128),
};

/** Where an atlas of 512 texels has what white matt surfaces show, with an edge of one texel around it. */
const MATT = { x: 128, y: 384, width: 64, height: 32 };

/** What white matt surfaces show of the environment of a scene. PlayCanvas gives the texels some frames later. */
export class Surroundings {
  #scene;
  /** @type {any} */
  #atlas;
  /** @type {any} */
  #texels;

  /** @param {any} scene */
  constructor(scene) {
    this.#scene = scene;
  }

  /** Before a frame: reads an environment that is new. */
  follow() {
    const atlas = this.#scene.envAtlas;
    if (atlas === this.#atlas) return;
    this.#atlas = atlas;
    this.#texels = null;
    if (!atlas) return;
    const [x, y, width, height] = Object.values(MATT).map((value) => (value * atlas.width) / 512);
    atlas.read(x, y, width, height).then((texels) => { if (atlas === this.#atlas) this.#texels = texels; });
  }

  /** What a surface shows that faces a direction of the world. @param {number[]} way */
  shown([x, y, z]) {
    const scene = this.#scene, atlas = this.#atlas;
    if (!atlas) {
      const { r, g, b } = new pc.Color().linear(scene.ambientLight), strength = scene.physicalUnits ? scene.ambientLuminance : 1;
      return [r * strength, g * strength, b * strength];
    }
    if (!this.#texels) return [0, 0, 0];
    const turn = scene._skyboxRotationMat3.data;
    const [right, up, back] = [0, 3, 6].map((at) => turn[at] * x + turn[at + 1] * y + turn[at + 2] * z);
    const unit = atlas.width / 512, strength = scene.physicalUnits ? scene.skyboxLuminance : scene.skyboxIntensity;
    const across = Math.atan2(-right, back) / (2 * Math.PI) + 0.5, down = 0.5 - Math.asin(Math.min(Math.max(up, -1), 1)) / Math.PI;
    const [column, row] = [[across, MATT.width], [down, MATT.height]].map(([share, size]) => Math.floor(unit * (1 + share * (size - 2))));
    const at = 4 * (row * unit * MATT.width + column), texels = this.#texels;
    const value = (channel) => {
      const stored = texels[at + channel];
      return texels instanceof Uint16Array ? fromHalf(stored) : texels instanceof Float32Array ? stored : stored / 255;
    };
    return [0, 1, 2].map((channel) => strength * DECODED[atlas.encoding](value(channel), value(3)));
  }
}

/** The pose of a skinned mesh instance; null for another one. */
function poseOf({ mesh, skinInstance }, response) {
  if (!skinInstance) return null;
  const [places, bones, weights] = [pc.SEMANTIC_POSITION, pc.SEMANTIC_BLENDINDICES, pc.SEMANTIC_BLENDWEIGHT].map((semantic) => {
    /** @type {number[]} */
    const numbers = [];
    mesh.getVertexStream(semantic, numbers);
    return Float32Array.from(numbers);
  });
  return new InnerPose(response, places, bones, weights);
}

/** What each bone does to points in the space of the mesh: matrices, by columns. PlayCanvas computes its own later in the frame. */
function bonesOf({ node, skinInstance: { bones, skin } }) {
  const toObject = node.getWorldTransform().clone().invert();
  return bones.map((bone, number) => (
    Array.from(new pc.Mat4().mul2(toObject, bone.getWorldTransform()).mul(skin.inverseBindPose[number]).data)
  ));
}

/** The volume of the light inside a mesh instance. */
export class InnerVolume {
  /** @type {InnerPose | null | undefined} */
  #pose;

  /** @param {import('./inner_light.js').LightResponse} response */
  constructor(device, name, response) {
    this.texels = new InnerTexels(response);
    this.texture = volumeOf(device, name, this.texels.data, response);
  }

  /** Takes the light of now. @param {Surroundings} surroundings */
  follow(instance, lights, surroundings) {
    const world = instance.node.getWorldTransform().data;
    const around = surroundingsOf((way) => surroundings.shown(directionBehind(world, way)));
    this.#pose ??= poseOf(instance, this.texels.response);
    this.#pose?.bend(bonesOf(instance));
    if (this.texels.follow(lampsOf(instance, lights), around, this.#pose)) refill(this.texture);
  }
}
