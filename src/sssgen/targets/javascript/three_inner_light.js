// The light inside a body in three: the lamps and the surroundings of its scene, summed on the CPU whenever they have changed.

import * as THREE from 'three/webgpu';
import { surroundingsOf } from './inner_light.js';
import { InnerPose } from './inner_pose.js';
import { InnerTexels, distantLamp, nearLamp } from './inner_volume.js';

/** The width of a picture of a ball in the surroundings, in texels. */
const BALL = 32;

/** The irradiance of a lamp as three has it, relative to its colour. */
function fallOf(distance, cosine, [reach, decay, cone, penumbra]) {
  const edge = reach > 0 ? Math.min(Math.max(1 - (distance / reach) ** 4, 0), 1) ** 2 : 1;
  const fall = edge * Math.max(distance, 0.01) ** -decay;
  return cone === undefined ? fall : fall * THREE.MathUtils.smoothstep(cosine, cone, penumbra);
}

/** The lamps of a scene, in the space of an object. */
function lampsOf(object, scene, camera) {
  const world = object.matrixWorld.elements, toObject = object.matrixWorld.clone().invert().elements, lamps = [];
  scene.traverseVisible((light) => {
    if (!light.layers.test(camera.layers)) return;
    const { isDirectionalLight, isPointLight, isSpotLight } = light;
    if (!(isDirectionalLight || isPointLight || isSpotLight)) return;
    const color = light.color.clone().multiplyScalar(light.intensity / Math.PI).toArray();
    const position = new THREE.Vector3().setFromMatrixPosition(light.matrixWorld);
    const towards = light.target && position.clone().sub(new THREE.Vector3().setFromMatrixPosition(light.target.matrixWorld)).normalize().toArray();
    if (isDirectionalLight) {
      lamps.push(distantLamp(towards, color, toObject));
      return;
    }
    const { distance, decay, angle, penumbra } = light;
    const settings = [distance, decay, ...(isSpotLight ? [Math.cos(angle), Math.cos(angle * (1 - penumbra))] : [])];
    lamps.push(nearLamp({ position: position.toArray(), axis: towards, color, settings }, fallOf, world, toObject));
  });
  return lamps;
}

/** What a white matt surface of a scene reflects of its ambient light, by its direction: functions that add to a colour. */
function ambientOf(scene, camera) {
  const parts = [], shown = new THREE.Color(), up = new THREE.Vector3(), normal = new THREE.Vector3();
  scene.traverseVisible((light) => {
    if (!light.layers.test(camera.layers)) return;
    const strength = light.intensity / Math.PI;
    if (light.isAmbientLight) parts.push((way, sum) => sum.add(shown.copy(light.color).multiplyScalar(strength)));
    if (light.isHemisphereLight) {
      parts.push((way, sum) => {
        up.setFromMatrixPosition(light.matrixWorld).normalize();
        sum.add(shown.copy(light.groundColor).lerp(light.color, 0.5 * up.dot(way) + 0.5).multiplyScalar(strength));
      });
    }
    if (light.isLightProbe) {
      parts.push((way, sum) => {
        light.sh.getIrradianceAt(way, normal);
        sum.add(shown.setRGB(normal.x, normal.y, normal.z).multiplyScalar(strength));
      });
    }
  });
  return parts;
}

/** Pictures of a white matt ball in the environment of a scene, from the front and from behind. */
class Ball {
  constructor() {
    const material = new THREE.MeshPhysicalMaterial({ roughness: 1, specularIntensity: 0 });
    this.mesh = new THREE.Mesh(new THREE.SphereGeometry(1, 64, 32), material);
    this.scene = new THREE.Scene().add(this.mesh);
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 4);
    const settings = { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
    this.targets = [1, -1].map(() => new THREE.WebGLRenderTarget(BALL, BALL, settings));
    /** What was drawn last. */
    this.drawn = '';
    /** The direction of rows upwards in them. */
    this.up = 1;
    /** The pixels of both sides. */
    this.pixels = null;
  }

  /** Draws both sides if the environment has changed. WebGPURenderer gives the pixels one frame later. */
  draw(renderer, scene, material) {
    const environment = material.envMap ?? scene.environment;
    const rotation = material.envMap ? material.envMapRotation : scene.environmentRotation;
    const intensity = material.envMap ? material.envMapIntensity : scene.environmentIntensity;
    const key = environment ? [environment.uuid, environment.version, intensity, ...rotation.toArray()].join(' ') : '';
    if (key === this.drawn) return;
    this.drawn = key;
    if (!environment) {
      this.pixels = null;
      return;
    }
    Object.assign(this.scene, { environment, environmentIntensity: intensity });
    this.scene.environmentRotation.copy(rotation);
    const sides = this.targets.map((target, behind) => {
      this.camera.position.set(0, 0, behind ? -2 : 2);
      this.camera.lookAt(0, 0, 0);
      renderer.setRenderTarget(target);
      renderer.setClearColor(new THREE.Color(0, 0, 0), 0);
      renderer.clear();
      renderer.render(this.scene, this.camera);
      if (renderer.isWebGPURenderer) return renderer.readRenderTargetPixelsAsync(target, 0, 0, BALL, BALL);
      const pixels = new Float32Array(4 * BALL * BALL);
      renderer.readRenderTargetPixels(target, 0, 0, BALL, BALL, pixels);
      return pixels;
    });
    this.up = renderer.isWebGPURenderer && renderer.backend.isWebGPUBackend ? -1 : 1;
    if (renderer.isWebGPURenderer) Promise.all(sides).then((pixels) => (this.pixels = pixels));
    else this.pixels = sides;
  }

  /** Adds what the ball shows in a direction. */
  add(way, sum) {
    if (!this.pixels) return;
    const behind = way.z < 0, x = behind ? -way.x : way.x, scale = 0.97; // not at the edge of the ball, where pixels show two
    const texel = (value) => Math.min(Math.floor((0.5 + 0.5 * scale * value) * BALL), BALL - 1);
    const at = 4 * (texel(this.up * way.y) * BALL + texel(x)), pixels = /** @type {any} */ (this.pixels)[Number(behind)];
    sum.r += pixels[at];
    sum.g += pixels[at + 1];
    sum.b += pixels[at + 2];
  }

  dispose() {
    for (const target of this.targets) target.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** The pose of a skinned object, for its response. */
function poseOf({ geometry }, response) {
  const numbersOf = ({ itemSize, count }, attribute) => (
    Float32Array.from({ length: count * itemSize }, (_, at) => attribute.getComponent(Math.floor(at / itemSize), at % itemSize))
  );
  const [places, bones, weights] = ['position', 'skinIndex', 'skinWeight'].map((name) => {
    const attribute = geometry.getAttribute(name);
    return numbersOf(attribute, attribute);
  });
  return new InnerPose(response, places, bones, weights);
}

/**
 * What each bone does to points in the space of a skinned object: matrices, by columns. WebGPURenderer updates those of the skeleton
 * later, and keeps the last ones for velocities.
 */
function bonesOf({ skeleton: { bones, boneInverses }, bindMatrix, bindMatrixInverse }) {
  const matrix = new THREE.Matrix4();
  return bones.map(({ matrixWorld }, index) => (
    matrix.multiplyMatrices(matrixWorld, boneInverses[index]).multiply(bindMatrix).premultiply(bindMatrixInverse).toArray()
  ));
}

/** The volumes of the light inside of objects, in one renderer. */
export class InnerLight {
  #ball = new Ball();
  /** @type {Map<THREE.Object3D, { texture: THREE.Data3DTexture, texels: InnerTexels, pose: InnerPose | null }>} */
  #volumes = new Map();

  /** The volume of an object with a `response`, for the light of now. */
  draw({ renderer, scene, camera, object }, response) {
    const volume = this.#volumeOf(object, response);
    this.#ball.draw(renderer, scene, object.material);
    const lamps = lampsOf(object, scene, camera), parts = ambientOf(scene, camera);
    const turn = new THREE.Matrix3().setFromMatrix4(object.matrixWorld), way = new THREE.Vector3(), sum = new THREE.Color();
    const around = surroundingsOf((direction) => {
      way.fromArray(direction).applyMatrix3(turn).normalize();
      sum.setRGB(0, 0, 0);
      for (const add of parts) add(way, sum);
      this.#ball.add(way, sum);
      return [sum.r, sum.g, sum.b];
    });
    volume.pose?.bend(bonesOf(object));
    if (volume.texels.follow(lamps, around, volume.pose)) volume.texture.needsUpdate = true;
    return volume.texture;
  }

  /** @returns {{ texture: THREE.Data3DTexture, texels: InnerTexels, pose: InnerPose | null }} */
  #volumeOf(object, response) {
    const before = this.#volumes.get(object);
    if (before && before.texels.response === response) return before;
    before?.texture.dispose();
    if (!object.geometry.boundingBox) object.geometry.computeBoundingBox();
    response.checkBody(...[object.geometry.boundingBox.min, object.geometry.boundingBox.max].map((corner) => corner.toArray()));
    const texels = new InnerTexels(response);
    const texture = new THREE.Data3DTexture(texels.data, response.width, response.height, response.depth);
    Object.assign(texture, { format: THREE.RGBAFormat, type: THREE.HalfFloatType, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter });
    const volume = { texture, texels, pose: object.isSkinnedMesh ? poseOf(object, response) : null };
    this.#volumes.set(object, volume);
    return volume;
  }

  /** Frees the volume of an object. */
  forget(object) {
    this.#volumes.get(object)?.texture.dispose();
    this.#volumes.delete(object);
  }

  dispose() {
    for (const object of [...this.#volumes.keys()]) this.forget(object);
    this.#ball.dispose();
  }
}
