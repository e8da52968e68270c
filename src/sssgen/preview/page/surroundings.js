// The light from all around a body: a studio, a sky, or a panorama from a file.

import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { CubeRenderTarget, WebGPURenderer } from 'three/webgpu';
import { suffixOf } from './chosen_files.js';

export const PANORAMAS = ['.hdr', '.exr'];
const SIDE = 256;  // of the studio's cube, in texels
const STUDIO_LEVEL = 0.3;  // three's room is brighter than the lamps of a scene

/** @typedef {{ kind: string, panorama: THREE.DataTexture | null, strength: number, turn: number, background: boolean, blur: number }} Light
 *   `kind`: `none` (what the scene has), `studio`, `sky` or `file`; `turn` in degrees; `blur` 0 to 1. */

/** The light around the scene of a stage. */
export class Surroundings {
  /** @param {import('./stage.js').Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {CubeRenderTarget | THREE.WebGLCubeRenderTarget | null} */
    this.studio = null;
  }

  /** @param {Light} light */
  show({ kind, panorama, strength, turn, background, blur }) {
    const { scene } = this.stage;
    const texture = { none: () => this.stage.sceneLight, studio: () => this.studioTexture(), sky: skyTexture, file: () => panorama }[kind]?.() ?? null;
    const angle = THREE.MathUtils.degToRad(turn);
    const level = strength * (kind === 'studio' ? STUDIO_LEVEL : 1);
    scene.environment = texture;
    scene.environmentIntensity = level;
    scene.environmentRotation.set(0, angle, 0);
    scene.background = background ? texture : null;
    scene.backgroundIntensity = level;
    scene.backgroundBlurriness = blur;
    scene.backgroundRotation.set(0, angle, 0);
  }

  /** A cube with what three's room looks like from its middle. */
  studioTexture() {
    if (!this.studio) {
      /** @type {any} three's types know one renderer */
      const renderer = this.stage.renderer;
      const Target = renderer instanceof WebGPURenderer ? CubeRenderTarget : THREE.WebGLCubeRenderTarget;
      const studio = new Target(SIDE, { type: THREE.HalfFloatType });
      const room = new RoomEnvironment();
      new THREE.CubeCamera(0.1, 100, /** @type {any} */ (studio)).update(renderer, room);
      this.studio = studio;
      room.dispose();
    }
    return this.studio.texture;
  }

  dispose() { this.studio?.dispose(); }
}

/** The panorama of a .hdr or .exr file. Throws for a file that is none.
 * @param {File} file @param {number} widest  in texels */
export async function panoramaOf(file, widest) {
  const exr = suffixOf(file) === '.exr';
  const { width = 0, height = 0, data, format, type } = (exr ? new EXRLoader() : new HDRLoader()).parse(await file.arrayBuffer());
  if ((format ?? THREE.RGBAFormat) !== THREE.RGBAFormat) throw new Error('the picture has no colours');
  if (!width || !height || Math.max(width, height) > widest) throw new Error(`${width} × ${height} texels are too many here: at most ${widest} × ${widest}`);
  // the rows of .hdr count downwards
  return panorama(/** @type {any} */ (data), width, height, type, !exr);
}

/** An equirectangular texture of linear colours.
 * @param {Uint16Array<ArrayBuffer> | Float32Array<ArrayBuffer>} data @param {number} width @param {number} height @param {any} type @param {boolean} [downwards] */
function panorama(data, width, height, type, downwards = false) {
  const texture = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, type);
  return Object.assign(texture, {
    mapping: THREE.EquirectangularReflectionMapping, magFilter: THREE.LinearFilter, minFilter: THREE.LinearFilter,
    wrapS: THREE.RepeatWrapping, flipY: downwards, needsUpdate: true,
  });
}

/** @type {THREE.DataTexture | null} */
let sky = null;

/** A clear sky with a sun in the left front, above a meadow: the luminance is that of Perez, Seals and Michalsky 1993, All-weather model
 * for sky luminance distribution, with the coefficients of a clear sky. */
function skyTexture() {
  if (sky) return sky;
  const [width, height] = [512, 256];
  const data = new Float32Array(4 * width * height);
  const sun = new THREE.Vector3().setFromSphericalCoords(1, 0.95, -0.7);
  const direction = new THREE.Vector3();
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const [azimuth, elevation] = [(x + 0.5) / width * 2 * Math.PI, ((y + 0.5) / height - 0.5) * Math.PI];
      direction.set(Math.cos(elevation) * Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.sin(azimuth));
      data.set([...skyColor(direction, sun), 1], 4 * (y * width + x));
    }
  }
  sky = panorama(data, width, height, THREE.FloatType);
  return sky;
}

/** @param {THREE.Vector3} direction @param {THREE.Vector3} sun  unit */
function skyColor(direction, sun) {
  const up = direction.y;
  const nearSun = Math.min(Math.max(direction.dot(sun), -1), 1);
  const angle = Math.acos(nearSun);
  const perez = (1 - Math.exp(-0.32 / Math.max(up, 0.02))) * (1 + 10 * Math.exp(-3 * angle) + 0.45 * nearSun * nearSun);
  const level = 0.42 * perez;
  const high = Math.sqrt(Math.max(up, 0));
  const clear = [[0.86, 0.30], [0.94, 0.56], [1.02, 1.05]].map(([low, top]) => level * (low + (top - low) * high));
  const disc = 160 * THREE.MathUtils.smoothstep(nearSun, Math.cos(0.075), Math.cos(0.055));
  const above = [disc + clear[0], 0.93 * disc + clear[1], 0.8 * disc + clear[2]];
  const share = THREE.MathUtils.smoothstep(up, -0.03, 0.005);  // of the sky at the horizon
  return [0.13, 0.125, 0.1].map((meadow, index) => meadow + (above[index] - meadow) * share);
}
