// The static parts of pictures: bodies and texels, as docs/site/playground/ of the repository packs them.

import { unpacked } from './packed.js';

const [POSITION, NORMAL, UV] = [2 ** 14 - 1, 2 ** 11 - 1, 2 ** 14 - 1];

/** Whole numbers with signs: first all their low bytes, then the next ones.
 * @param {Uint8Array} bytes @param {number} start @param {number} count @param {number} size  of a number, in bytes */
function planes(bytes, start, count, size) {
  const numbers = new Int32Array(count);
  for (let place = 0; place < size; place++) {
    for (let index = 0; index < count; index++) numbers[index] |= bytes[start + place * count + index] << (8 * place);
  }
  for (let index = 0; index < count; index++) numbers[index] = (numbers[index] >>> 1) ^ -(numbers[index] & 1);
  return numbers;
}

/** The sums of differences.
 * @param {Uint8Array} bytes @param {number} start @param {number} count */
function column(bytes, start, count) {
  const numbers = planes(bytes, start, count, 2);
  for (let index = 1; index < count; index++) numbers[index] += numbers[index - 1];
  return numbers;
}

/** The triangles of a packed body: position, normal and uv of each corner as 8 float32.
 * @param {ArrayBuffer} buffer */
export function bodyOf(buffer) {
  const header = new DataView(buffer);
  const [corners, triangles] = [header.getUint32(0, true), header.getUint32(4, true)];
  const range = Array.from({ length: 10 }, (_, index) => header.getFloat32(8 + 4 * index, true));
  const bytes = new Uint8Array(buffer, 48);
  const [x, y, z, a, b, u, v] = Array.from({ length: 7 }, (_, index) => column(bytes, 2 * corners * index, corners));
  const back = planes(bytes, 14 * corners, 3 * triangles, 3);
  const shared = new Float32Array(8 * corners);
  for (let index = 0; index < corners; index++) {
    let [nx, ny] = [2 * a[index] / NORMAL - 1, 2 * b[index] / NORMAL - 1];
    const nz = 1 - Math.abs(nx) - Math.abs(ny);
    if (nz < 0) [nx, ny] = [(1 - Math.abs(ny)) * (nx < 0 ? -1 : 1), (1 - Math.abs(nx)) * (ny < 0 ? -1 : 1)];
    const length = Math.hypot(nx, ny, nz);
    shared.set([
      range[0] + range[3] * x[index] / POSITION, range[1] + range[4] * y[index] / POSITION, range[2] + range[5] * z[index] / POSITION,
      nx / length, ny / length, nz / length,
      range[6] + range[8] * u[index] / UV, range[7] + range[9] * v[index] / UV,
    ], 8 * index);
  }
  const result = new Float32Array(24 * triangles);
  let next = 0;  // the next corner that is not yet used
  for (let corner = 0; corner < 3 * triangles; corner++) {
    const index = next - back[corner];
    if (index === next) next++;
    result.set(shared.subarray(8 * index, 8 * index + 8), 8 * corner);
  }
  return result.buffer;
}

/** What the stage asks pieces of; a body is unpacked once. */
export class Pieces {
  constructor() {
    /** @type {Map<string, Promise<ArrayBuffer>>} */
    this.fetched = new Map();
    /** @type {Set<string>} */
    this.bodies = new Set();
  }

  /** The piece of a name, as the preview's stage takes it.
   * @type {import('../../../../src/sssgen/preview/page_messages.js').PieceOf} */
  get = (name) => {
    const packed = this.fetched.get(name) ?? unpacked(`pieces/${name}`);
    const piece = !this.fetched.has(name) && this.bodies.has(name) ? packed.then(bodyOf) : packed;
    this.fetched.set(name, piece);
    return piece;
  };

  /** Says that a piece is a body, and begins to fetch it.
   * @param {string} name */
  body(name) { this.bodies.add(name); return this.get(name); }
}
