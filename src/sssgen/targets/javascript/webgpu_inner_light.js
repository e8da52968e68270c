// The light inside a body in a page that draws with WebGPU itself: of the lights and the ambient light that the page gives.

import { surroundingsOf } from './inner_light.js';
import { distantLamp, nearLamp } from './inner_volume.js';
import { Relight } from './webgpu_relight.js';

/** The inverse of a matrix of places, both with 16 numbers by columns. @param {number[]} matrix */
function inverseOf(matrix) {
  const column = (index) => matrix.slice(4 * index, 4 * index + 3);
  const over = (/** @type {number[]} */ [a, b, c], /** @type {number[]} */ [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
  const product = (first, second) => first.reduce((sum, part, index) => sum + part * second[index], 0);
  const [x, y, z, place] = [0, 1, 2, 3].map(column), size = product(x, over(y, z));
  const rows = [over(y, z), over(z, x), over(x, y)].map((row) => row.map((part) => part / size));
  const columns = [0, 1, 2].map((index) => [...rows.map((row) => row[index]), 0]);
  return [...columns.flat(), ...rows.map((row) => -product(row, place)), 1];
}

/** The product of two matrices. @param {number[]} first @param {number[]} second */
function timesMatrix(first, second) {
  return Array.from({ length: 16 }, (_, index) => {
    const row = index % 4, column = 4 * Math.floor(index / 4);
    return [0, 1, 2, 3].reduce((sum, part) => sum + first[4 * part + row] * second[column + part], 0);
  });
}

/** The volume of the light inside a body. */
export class InnerTexture {
  #light = '';

  /** @param {GPUDevice} device @param {import('./inner_light.js').LightResponse} response */
  constructor(device, response) {
    const { width, height, depth } = response, usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.STORAGE_BINDING;
    this.response = response;
    this.texture = device.createTexture({ label: 'inner light', size: [width, height, depth], dimension: '3d', format: 'rgba16float', usage });
    this.relight = new Relight(device, response, this.texture);
  }

  /**
   * Takes the light of now, and gives the technique's parameters by their names there.
   * @param {number[]} model
   * @param {{ position: number[], color: number[] }[]} lights
   * @param {number[]} ambient
   * @returns {Record<string, number[]>}
   */
  follow(model, lights, ambient) {
    const toObject = inverseOf(model), { parameters } = this.response;
    const lamps = lights.map(({ position: [x, y, z, near], color }) => (
      near ? nearLamp({ position: [x, y, z], color, settings: [] }, () => 1, model, toObject) : distantLamp([x, y, z], color, toObject)
    ));
    const light = JSON.stringify([lamps, ambient, model]); // all numbers, without the functions
    if (light !== this.#light) this.relight.compute(model, lamps, surroundingsOf(() => ambient));
    this.#light = light;
    const values = Object.entries(parameters).map(([name, value]) => [name, [value].flat()]);
    return { ...Object.fromEntries(values), world_to_volume: timesMatrix(parameters.world_to_volume, toObject) };
  }
  /** Frees the texture and what it is computed from. */
  destroy() {
    this.texture.destroy();
    this.relight.destroy();
  }
}
