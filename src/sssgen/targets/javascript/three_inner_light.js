// The light inside a body in three: the lamps and the surroundings of its scene, summed on the CPU whenever they have changed.

import * as THREE from 'three/webgpu';
import { surroundingsOf } from './inner_light.js';

/** The width of a picture of a ball in the surroundings, in texels. */
const BALL = 32;

/** The irradiance of a lamp at a place of the world, as three has it, relative to its colour. */
function fallOf(light, place) {
  const away = Math.max(light.position.distanceTo(place), 0.01), reach = light.distance;
  const edge = reach > 0 ? Math.min(Math.max(1 - (away / reach) ** 4, 0), 1) ** 2 : 1;
  const fall = edge * away ** -light.decay;
  if (!light.axis) return fall;
  const cosine = place.clone().sub(light.position).divideScalar(-away).dot(light.axis);
  return fall * THREE.MathUtils.smoothstep(cosine, light.cone, light.penumbra);
}

/** The lamps of a scene, in the space of an object. */
function lampsOf(object, scene, camera) {
  const toObject = object.matrixWorld.clone().invert(), lamps = [];
  const place = new THREE.Vector3();
  scene.traverseVisible((light) => {
    if (!light.layers.test(camera.layers)) return;
    const { isDirectionalLight, isPointLight, isSpotLight } = light;
    if (!(isDirectionalLight || isPointLight || isSpotLight)) return;
    const color = light.color.clone().multiplyScalar(light.intensity / Math.PI).toArray();
    const position = new THREE.Vector3().setFromMatrixPosition(light.matrixWorld);
    const towards = light.target && position.clone().sub(place.setFromMatrixPosition(light.target.matrixWorld)).normalize();
    if (isDirectionalLight) {
      lamps.push({ directional: true, place: towards.transformDirection(toObject).toArray(), colorAt: () => color });
      return;
    }
    const { distance, decay, angle, penumbra } = light, own = [0, 0, 0];
    const cone = isSpotLight && { axis: towards, cone: Math.cos(angle), penumbra: Math.cos(angle * (1 - penumbra)) };
    const lamp = { position, distance, decay, ...cone };
    lamps.push({
      directional: false, place: position.clone().applyMatrix4(toObject).toArray(),
      colorAt: (at) => {
        const fall = fallOf(lamp, place.fromArray(at).applyMatrix4(object.matrixWorld));
        for (let channel = 0; channel < 3; channel++) own[channel] = fall * color[channel];
        return own;
      },
    });
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

/** The volumes of the light inside of objects, in one renderer. */
export class InnerLight {
  #ball = new Ball();
  /** @type {Map<THREE.Object3D, { texture: THREE.Data3DTexture, response: any, key: string }>} */
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
    const key = JSON.stringify([lamps.map(({ place, colorAt }) => [place, ...colorAt(response.low), ...colorAt(response.high)]), around]);
    if (key !== volume.key) {
      volume.key = key;
      response.light(lamps, around, /** @type {any} */ (volume.texture.image.data));
      volume.texture.needsUpdate = true;
    }
    return volume.texture;
  }

  /** @returns {{ texture: THREE.Data3DTexture, response: any, key: string }} */
  #volumeOf(object, response) {
    const before = this.#volumes.get(object);
    if (before && before.response === response) return before;
    before?.texture.dispose();
    const { width, height, depth } = response;
    const texture = new THREE.Data3DTexture(new Uint16Array(4 * width * height * depth), width, height, depth);
    Object.assign(texture, { format: THREE.RGBAFormat, type: THREE.HalfFloatType, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter });
    const volume = { texture, response, key: '' };
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
