// The light inside a body from the file of `sssgen bake fluence --relit`: the sum for some lights and surroundings.

const TYPES = { uint8: Uint8Array, int8: Int8Array, uint16: Uint16Array, uint32: Uint32Array, float16: Uint16Array };
/** The root of light that has not been scattered, relative to its irradiance. */
const UNSCATTERED = 0.25;

/** The share of a channel whose stored root is `root`. A share above 1 is light that a curved surface focuses: the same for all channels.
 * @param {number} root @param {number} power */
function arrivingShare(root, power) {
  const share = Math.max(root, 3e-5) ** 2;
  return share < 1 ? share ** power : share;
}

/** A number in half a float. */
export function fromHalf(bits) {
  const exponent = (bits >> 10) & 31, fraction = bits & 1023, sign = bits & 32768 ? -1 : 1;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

const whole = new Float32Array(1), bitsOf = new Uint32Array(whole.buffer);

/** A number that is not negative as half a float, rounded; larger ones are the largest. */
export function toHalf(value) {
  whole[0] = Math.min(value, 65504);
  const bits = bitsOf[0];
  if (bits < 0x38800000) return Math.round(whole[0] * 2 ** 24); // subnormal
  return (bits - 0x38000000 + 0x1000) >>> 13;
}

/** The real spherical harmonics up to order 2 in a unit direction. @param {number[]} way */
export const harmonics = ([x = 0, y = 0, z = 0]) => [
  0.28209479, 0.48860251 * y, 0.48860251 * z, 0.48860251 * x, 1.09254843 * x * y, 1.09254843 * y * z,
  0.31539157 * (3 * z * z - 1), 1.09254843 * x * z, 0.54627422 * (x * x - y * y),
];

/**
 * A pose of a skinned body, by its voxels: InnerPose of inner_pose.js.
 * @typedef {object} Pose
 * @property {Uint16Array} bones four of each voxel
 * @property {Float32Array} weights of these
 * @property {((way: number[]) => number[])[]} turns a direction of the rest pose behind the rotation of each bone
 * @property {(voxel: number, result: number[]) => void} place where a voxel is
 * @property {(voxel: number, way: Float64Array) => void} turnBack a direction there, for the rest pose
 */

/**
 * How a body responds to light, as a `.bin` and the JSON beside it have it: its numbers are explained where they are made, in
 * sssgen's light_response.py.
 */
export class LightResponse {
  /** @param {ArrayBuffer} data the decompressed file @param {any} facts the content of its JSON */
  constructor(data, facts) {
    if (!facts?.arrays?.arriving || !facts.object_to_volume) throw new TypeError('this is no response of a body: sssgen bake fluence --relit makes one');
    const read = (name) => {
      const { type, shape, start } = facts.arrays[name];
      return new TYPES[type](data, start, shape.reduce((product, count) => product * count, 1));
    };
    /** The corners of the box, in object space. */
    this.low = facts.box_min;
    this.high = facts.box_max;
    this.size = facts.box_max.map((value, axis) => value - this.low[axis]);
    this.body = facts.body;
    const [depth, height, width] = facts.arrays.nearest.shape;
    /** The texels of the volume. */
    this.width = width;
    this.height = height;
    this.depth = depth;
    this.cells = read('cells');
    this.nearest = read('nearest');
    this.latents = read('latents');
    this.table = Float32Array.from(read('table'), fromHalf);
    this.arriving = read('arriving');
    this.around = read('surroundings');
    /** The distance of each texel from the surface, in half floats: 0 to 1. */
    this.distance = Uint16Array.from(read('distance'), (stored) => toHalf(stored / 255));
    this.largest = facts.largest;
    this.count = this.cells.length;
    this.rank = this.latents.length / this.count;
    /** The directions along the sides of the maps: of the table, and of light that has not been scattered. */
    this.side = Math.round(Math.sqrt(this.table.length / (3 * (1 + this.rank))));
    this.arrivingSide = Math.round(Math.sqrt(this.arriving.length / this.count));
    /** For each stored root the light of each channel that has not been scattered. */
    this.shares = facts.powers.map((power) => (
      Float32Array.from({ length: 256 }, (_, root) => UNSCATTERED * arrivingShare((root * facts.highest) / 255, power))
    ));
    /** The parameters of the technique, by their names there. */
    this.parameters = facts.parameters;
    /** The light of each channel in the voxels that count. */
    this.sum = [0, 1, 2].map(() => new Float32Array(this.count));
    this.halves = new Uint16Array(this.count);
    this.row = new Float32Array(3 * (1 + this.rank));
    this.mix = { way: new Float64Array(3), texels: new Int32Array(4), weights: new Float64Array(4) };
  }

  /**
   * Warns of a mesh that is not the one of the bake: the light inside is then wrong.
   * @param {ArrayLike<number>} low the corners of its box, in object space @param {ArrayLike<number>} high
   */
  checkBody(low, high) {
    if (!this.body?.box_min) return;
    const { name, box_min: from, box_max: to } = this.body, longest = Math.max(...to.map((value, axis) => value - from[axis]));
    const isOther = from.some((value, axis) => Math.max(Math.abs(low[axis] - value), Math.abs(high[axis] - to[axis])) > 0.01 * longest);
    const text = (corner) => `(${Array.from(corner, (value) => Number(value.toPrecision(3))).join(', ')})`;
    if (isOther) console.warn(`the light inside is baked for another body: ${name} is from ${text(from)} to ${text(to)}, this mesh from ${text(low)} to ${text(high)}; bake it for this mesh`);
  }

  /** The parameters of the technique, by the properties of materials: where an engine has the name itself, it begins with `sss`. */
  ownParameters() {
    return Object.entries(this.parameters).flatMap(([name, value]) => (
      [name, `sss_${name}`].map((own) => [own.replace(/_(\w)/g, (_, letter) => letter.toUpperCase()), value])
    ));
  }

  /** The centre of a voxel that counts, in object space, into `result`. */
  place(voxel, result) {
    const cell = this.cells[voxel], { width, height, depth, low, size } = this, rest = Math.floor(cell / width);
    result[0] = low[0] + (((cell % width) + 0.5) / width) * size[0];
    result[1] = low[1] + (((rest % height) + 0.5) / height) * size[1];
    result[2] = low[2] + ((Math.floor(rest / height) + 0.5) / depth) * size[2];
  }

  /**
   * Computes the light in all texels.
   * @param {{ directional: boolean, place: number[], colorAt: (place: number[]) => number[] }[]} lights in object space: the
   *   direction towards a directional light, or the place of another; the irradiance on a plane that faces it, where 1 makes
   *   a white matt surface white
   * @param {number[][] | null} surroundings for each harmonic the integrals of the light of three channels
   * @param {Uint16Array} texels gets four half floats a texel
   * @param {Pose | null} pose of a skinned body: its lights are in the space of the bent body, its texels are those of the rest pose
   */
  light(lights, surroundings, texels, pose = null) {
    for (const channel of this.sum) channel.fill(0);
    for (const light of lights) (light.directional && !pose ? this.#addDistant(light) : this.#addNear(light, pose));
    if (surroundings && pose) this.#addTurned(surroundings, pose);
    else if (surroundings) this.#addSurroundings(surroundings);
    const { nearest, halves, distance } = this;
    this.sum.forEach((values, channel) => {
      for (let voxel = 0; voxel < values.length; voxel++) halves[voxel] = toHalf(Math.max(values[voxel], 0));
      for (let texel = 0; texel < nearest.length; texel++) texels[4 * texel + channel] = halves[nearest[texel]];
    });
    for (let texel = 0; texel < distance.length; texel++) texels[4 * texel + 3] = distance[texel];
  }

  /** The row of the table for the direction of `mix` into `row`. */
  #look() {
    const { side, table, row, mix } = this, length = row.length;
    mixOf(mix, side);
    const [a, b, c, d] = mix.weights, [first, second, third, fourth] = mix.texels.map((texel) => texel * length);
    for (let index = 0; index < length; index++) {
      row[index] = a * table[first + index] + b * table[second + index] + c * table[third + index] + d * table[fourth + index];
    }
  }

  /** Adds a distant light: row by row of the stored numbers, as they lie in memory. */
  #addDistant({ place, colorAt }) {
    const { mix, row, latents, count, rank, arriving, shares, sum } = this, color = colorAt(this.low);
    mix.way.set(place);
    this.#look();
    mixOf(mix, this.arrivingSide);
    const [first, second, third, fourth] = mix.texels, [a, b, c, d] = mix.weights, texels = this.arrivingSide ** 2;
    for (let channel = 0; channel < 3; channel++) {
      const ofChannel = sum[channel], strength = color[channel], start = strength * row[channel];
      if (arriving.length) {
        const share = shares[channel];
        for (let voxel = 0, at = 0; voxel < count; voxel++, at += texels) {
          const root = a * arriving[at + first] + b * arriving[at + second] + c * arriving[at + third] + d * arriving[at + fourth];
          ofChannel[voxel] += start + strength * share[(root + 0.5) | 0];
        }
      } else for (let voxel = 0; voxel < count; voxel++) ofChannel[voxel] += start;
      for (let number = 0; number < rank; number++) {
        const weight = (strength * row[3 * (number + 1) + channel]) / 255, at = number * count;
        for (let voxel = 0; voxel < count; voxel++) ofChannel[voxel] += weight * latents[at + voxel];
      }
    }
  }

  /** Adds a light whose direction or strength differs between voxels. */
  #addNear({ directional, place, colorAt }, pose) {
    const { mix, row, latents, count, rank, arriving, shares, sum } = this, own = [0, 0, 0];
    for (let voxel = 0; voxel < count; voxel++) {
      if (pose) pose.place(voxel, own);
      else this.place(voxel, own);
      for (let axis = 0; axis < 3; axis++) mix.way[axis] = directional ? place[axis] : place[axis] - own[axis];
      pose?.turnBack(voxel, mix.way);
      this.#look();
      const color = colorAt(own), { texels, weights } = mix;
      let root = 0.5;
      mixOf(mix, this.arrivingSide);
      const at = voxel * this.arrivingSide ** 2;
      if (arriving.length) for (let corner = 0; corner < 4; corner++) root += weights[corner] * arriving[at + texels[corner]];
      for (let channel = 0; channel < 3; channel++) {
        let light = arriving.length ? shares[channel][root | 0] : 0;
        for (let number = 0; number < rank; number++) light += row[3 * (number + 1) + channel] * (latents[number * count + voxel] / 255);
        sum[channel][voxel] += color[channel] * (row[channel] + light);
      }
    }
  }

  #addSurroundings(light) {
    const { around, count, largest, sum } = this;
    for (let harmonic = 0; harmonic < 9; harmonic++) {
      for (let channel = 0; channel < 3; channel++) {
        const weight = (light[harmonic][channel] * largest[harmonic][channel]) / 127;
        const first = (3 * harmonic + channel) * count;
        const ofChannel = sum[channel];
        for (let voxel = 0; voxel < count; voxel++) ofChannel[voxel] += weight * around[first + voxel];
      }
    }
  }

  /** Adds surroundings to a skinned body: each voxel has a mean of what its bones turn back. */
  #addTurned(light, { bones, weights, turns }) {
    const { around, count, largest, sum } = this, ofBones = new Map();
    for (const bone of new Set(bones)) {
      ofBones.set(bone, turnedSurroundings(light, turns[bone]).flatMap((color, harmonic) => (
        color.map((value, channel) => (value * largest[harmonic][channel]) / 127)
      )));
    }
    for (let at = 0; at < bones.length; at++) {
      const voxel = Math.floor(at / 4), ofBone = ofBones.get(bones[at]);
      for (let number = 0; weights[at] && number < 27; number++) {
        sum[number % 3][voxel] += weights[at] * ofBone[number] * around[number * count + voxel];
      }
    }
  }
}

/**
 * The four texels of an octahedral map that are nearest to a direction `way` of any length, and their weights. Beyond an edge
 * lies the same edge, reversed.
 * @param {{ way: Float64Array, texels: Int32Array, weights: Float64Array }} mix
 */
export function mixOf({ way, texels, weights }, side) {
  const x = way[0], y = way[1], whole = Math.max(Math.abs(x) + Math.abs(y) + Math.abs(way[2]), 1e-20);
  let across = x / whole, up = y / whole;
  if (way[2] < 0) {
    const flat = across;
    across = (1 - Math.abs(up)) * (x < 0 ? -1 : 1);
    up = (1 - Math.abs(flat)) * (y < 0 ? -1 : 1);
  }
  const column = (0.5 * across + 0.5) * side - 0.5, row = (0.5 * up + 0.5) * side - 0.5;
  const left = Math.floor(column), low = Math.floor(row), right = column - left, high = row - low;
  for (let corner = 0; corner < 4; corner++) {
    const i = corner & 1, j = corner >> 1;
    texels[corner] = texelOf(left + i, low + j, side);
    weights[corner] = (i ? right : 1 - right) * (j ? high : 1 - high);
  }
}

function texelOf(column, row, side) {
  const beside = column < 0 || column >= side, above = row < 0 || row >= side;
  const x = above && !beside ? side - 1 - column : column, y = beside && !above ? side - 1 - row : row;
  return Math.min(Math.max(y, 0), side - 1) * side + Math.min(Math.max(x, 0), side - 1);
}

/** Directions that are spread evenly over the sphere (Fibonacci), with their harmonics. */
const AROUND = Array.from({ length: 128 }, (_, index) => {
  const y = 1 - (2 * index + 1) / 128, angle = index * Math.PI * (3 - Math.sqrt(5)), across = Math.sqrt(1 - y * y);
  const way = [across * Math.cos(angle), y, across * Math.sin(angle)];
  return { way, values: harmonics(way) };
});
/** What a cosine leaves of the harmonics of each order: Ramamoorthi and Hanrahan 2001. */
const COSINE = [Math.PI, (2 * Math.PI) / 3, Math.PI / 4];
const ORDER = [0, 1, 1, 1, 2, 2, 2, 2, 2];

/**
 * The integrals of surroundings times the harmonics, from what a white matt surface shows that faces each direction.
 * @param {(way: number[]) => number[]} shown the colour for a direction in object space
 */
export function surroundingsOf(shown) {
  const sums = ORDER.map(() => [0, 0, 0]);
  for (const { way, values } of AROUND) {
    const color = shown(way);
    values.forEach((value, harmonic) => {
      for (let channel = 0; channel < 3; channel++) sums[harmonic][channel] += value * color[channel];
    });
  }
  const solidAngle = (4 * Math.PI) / AROUND.length;
  return sums.map((sum, harmonic) => sum.map((value) => (value * solidAngle) / COSINE[ORDER[harmonic]]));
}

/**
 * Surroundings for a body that is turned: each direction in its own space has the light of the direction behind `turn`.
 * @param {number[][]} light the integrals times the harmonics
 * @param {(way: number[]) => number[]} turn
 */
function turnedSurroundings(light, turn) {
  const axes = [turn([1, 0, 0]), turn([0, 1, 0]), turn([0, 0, 1])], height = 0.31539157, square = 0.54627422; // as in `harmonics`
  const channels = [0, 1, 2].map((channel) => {
    const [same = 0, y = 0, z = 0, x = 0, xy = 0, yz = 0, zz = 0, xz = 0, xx = 0] = light.map((color) => color[channel]);
    // harmonics of order 2 are a symmetric matrix: its product with a direction, from both sides
    const rows = [
      [square * xx - height * zz, square * xy, square * xz], [square * xy, -square * xx - height * zz, square * yz],
      [square * xz, square * yz, 2 * height * zz],
    ];
    const along = axes.map((axis) => axis[0] * x + axis[1] * y + axis[2] * z);
    const behind = axes.map((axis) => rows.map((row) => row[0] * axis[0] + row[1] * axis[1] + row[2] * axis[2]));
    const at = (/** @type {number} */ i, /** @type {number} */ j) => axes[i][0] * behind[j][0] + axes[i][1] * behind[j][1] + axes[i][2] * behind[j][2];
    return [
      same, along[1], along[2], along[0], at(0, 1) / square, at(1, 2) / square, at(2, 2) / (2 * height), at(0, 2) / square,
      (at(0, 0) - at(1, 1)) / (2 * square),
    ];
  });
  return ORDER.map((_, harmonic) => channels.map((values) => values[harmonic]));
}

/**
 * The response of a body from the bytes of a file and the content of its JSON.
 * @param {BufferSource} data
 * @param {any} facts
 */
async function responseFrom(data, facts) {
  const view = ArrayBuffer.isView(data) ? new DataView(data.buffer, data.byteOffset, data.byteLength) : new DataView(data);
  const { bytes, adler32 } = facts.file; // the checksum of what is compressed ends the file
  if (view.byteLength !== bytes || (adler32 !== undefined && view.getUint32(bytes - 4) !== adler32)) {
    throw new Error(`${facts.file.name}.json is the JSON of another bake: copy both files of a bake together`);
  }
  return new LightResponse(await decompressed(data), facts);
}

/** What was compressed. @param {BufferSource} data */
function decompressed(data) {
  return new Response(new Blob([data]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
}

/**
 * The response of a body: from the URL of a `.bin` of `sssgen bake fluence --relit`, beside which its JSON lies, or from the
 * content of both.
 * @param {string | { data: BufferSource, facts: any }} source
 */
export async function responseOf(source) {
  if (typeof source !== 'string') return responseFrom(source.data, source.facts);
  const load = async (/** @type {string} */ url) => {
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`cannot load ${url}: ${answer.status}`);
    return answer;
  };
  const [data, facts] = await Promise.all([load(source), load(`${source}.json`)]);
  return responseFrom(await data.arrayBuffer(), await facts.json());
}
