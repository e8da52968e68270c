// What the web's engines share of the light inside a body: lamps in the space of the body, the texels of its volume, and the files
// that a page sets. Matrices have 16 numbers, by columns.

import { isVolume } from './frame_passes.js';
import { LightResponse, responseOf } from './inner_light.js';

/** A place (`w` 1) or a direction (0) behind a matrix, into `result`. */
function behind(matrix, place, w, result = [0, 0, 0]) {
  for (let row = 0; row < 3; row++) {
    result[row] = matrix[row] * place[0] + matrix[4 + row] * place[1] + matrix[8 + row] * place[2] + matrix[12 + row] * w;
  }
  return result;
}

/** A direction behind a matrix, of length 1. */
export function directionBehind(matrix, way) {
  const result = behind(matrix, way, 0), length = Math.hypot(...result) || 1;
  return result.map((part) => part / length);
}

/**
 * A lamp that is far away, as `LightResponse.light` takes it.
 * @param {number[]} towards the direction towards it, in world space
 * @param {number[]} color what a white matt surface shows that faces it
 * @param {ArrayLike<number>} toObject from world to object space
 */
export const distantLamp = (towards, color, toObject) => ({ directional: true, place: directionBehind(toObject, towards), color, colorAt: () => color });

/**
 * A lamp with a position, as `LightResponse.light` takes it.
 * @param {{ position: number[], color: number[], axis?: number[], settings: any[] }} lamp in world space; `axis`: against the
 *   direction in which it shines
 * @param {(distance: number, cosine: number, settings: any) => number} fall what is left of its colour at a distance, where
 *   the way towards it has a cosine with the axis
 * @param {ArrayLike<number>} world from object to world space
 * @param {ArrayLike<number>} toObject the reverse
 */
export function nearLamp(lamp, fall, world, toObject) {
  const { position, color, axis = [0, 0, 0], settings } = lamp, way = [0, 0, 0], own = [0, 0, 0];
  return {
    ...lamp, world: Array.from(world), directional: false, place: behind(toObject, position, 1),
    colorAt: (at) => {
      behind(world, at, 1, way);
      for (let part = 0; part < 3; part++) way[part] = position[part] - way[part];
      const distance = Math.hypot(way[0], way[1], way[2]);
      const cosine = (way[0] * axis[0] + way[1] * axis[1] + way[2] * axis[2]) / Math.max(distance, 1e-9);
      const share = fall(distance, cosine, settings);
      for (let channel = 0; channel < 3; channel++) own[channel] = share * color[channel];
      return own;
    },
  };
}

/** The texels of the volume of one body. */
export class InnerTexels {
  #light = '';

  /** @param {LightResponse} response */
  constructor(response) {
    this.response = response;
    this.data = new Uint16Array(4 * response.width * response.height * response.depth);
  }

  /**
   * Computes them where the light has changed, and says whether it has.
   * @param {any[]} lamps
   * @param {number[][]} surroundings
   * @param {import('./inner_pose.js').InnerPose | null} pose of a skinned body
   */
  follow(lamps, surroundings, pose = null) {
    const light = JSON.stringify([lamps, surroundings, pose?.matrices]); // all numbers, without the functions
    if (light === this.#light) return false;
    this.#light = light;
    this.response.light(lamps, surroundings, this.data, pose);
    return true;
  }
}

/** The files of `sssgen bake fluence --relit` that a page has set, by their properties; while one is loading, where it is. */
export class Responses extends Map {
  #properties;

  /** @param {import('./frame_passes.js').Pass[]} passes */
  constructor(passes) {
    super();
    this.#properties = passes.filter(isVolume).map(({ texture }) => texture);
  }

  /**
   * Takes what a page has set, if a volume is computed of it, and says whether it is so.
   * @param {string} property
   * @param {any} value the URL of a file, or `{ data, facts }`
   * @param {(property: string, value: any) => void} setParameter gets what the file says of the technique's parameters
   */
  take(property, value, setParameter) {
    this.delete(property);
    const isLoaded = value instanceof LightResponse, isFile = typeof value === 'string' || value?.facts || isLoaded;
    if (!isFile || !this.#properties.includes(property)) return false;
    this.set(property, value);
    const use = (/** @type {LightResponse} */ response) => {
      if (this.get(property) !== value) return; // another was set, or none, while this one was loading
      this.set(property, response);
      for (const [name, numbers] of response.ownParameters()) setParameter(name, numbers);
    };
    if (isLoaded) use(value);
    else responseOf(value).then(use, (error) => console.error(`'${property}': ${error.message}`));
    return true;
  }

  /** The response of a property, as soon as it is there. @returns {LightResponse | null} */
  loaded(property) {
    const response = this.get(property);
    return response instanceof LightResponse ? response : null;
  }
}
