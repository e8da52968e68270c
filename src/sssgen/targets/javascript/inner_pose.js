// The pose of a skinned body for the light inside of it, whose bake knows the rest pose alone: where bones move its voxels, and how they
// turn them. A voxel moves with the vertex that is nearest to it. Spaces are the object's, matrices have 16 numbers, by columns.

/** The rotation of a matrix, by columns: its first direction stays, and its second one the plane with it. */
function rotationOf(matrix) {
  const [a, b, c, , d, e, f] = matrix;
  const long = Math.hypot(a, b, c) || 1, x = [a / long, b / long, c / long];
  const across = [x[1] * f - x[2] * e, x[2] * d - x[0] * f, x[0] * e - x[1] * d], area = Math.hypot(...across) || 1;
  const z = across.map((part) => part / area);
  return [...x, z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0], ...z];
}

/**
 * For each of some places the number of the nearest of others: it looks along the axis on which they are spread most.
 * @param {number[][]} places @param {Float32Array} others three numbers each @returns {number[]}
 */
export function nearestOf(places, others) {
  const numbers = Array.from({ length: others.length / 3 }, (_, index) => index);
  const spread = [0, 1, 2].map((axis) => {
    const along = numbers.map((index) => others[3 * index + axis]);
    return along.reduce((most, value) => Math.max(most, value), -Infinity) - along.reduce((least, value) => Math.min(least, value), Infinity);
  });
  const axis = spread.indexOf(Math.max(...spread));
  numbers.sort((one, other) => others[3 * one + axis] - others[3 * other + axis]);
  return places.map((place) => {
    let low = 0, high = numbers.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (others[3 * numbers[middle] + axis] < place[axis]) low = middle + 1;
      else high = middle;
    }
    let nearest = 0, least = Infinity;
    const look = (/** @type {number} */ at) => {
      const index = numbers[at], x = others[3 * index] - place[0], y = others[3 * index + 1] - place[1], z = others[3 * index + 2] - place[2];
      const square = x * x + y * y + z * z;
      if (square < least) [nearest, least] = [index, square];
    };
    const isNear = (/** @type {number} */ at) => (others[3 * numbers[at] + axis] - place[axis]) ** 2 < least;
    for (let at = low; at < numbers.length && isNear(at); at++) look(at);
    for (let at = low - 1; at >= 0 && isNear(at); at--) look(at);
    return nearest;
  });
}

/** How bones have moved the voxels of a body that count. */
export class InnerPose {
  /**
   * @param {import('./inner_light.js').LightResponse} response
   * @param {Float32Array} vertices their places in the rest pose
   * @param {Float32Array} bones four of each vertex
   * @param {Float32Array} weights of these
   */
  constructor(response, vertices, bones, weights) {
    this.rest = Array.from({ length: response.count }, (_, voxel) => {
      const place = [0, 0, 0];
      response.place(voxel, place);
      return place;
    });
    const nearest = nearestOf(this.rest, vertices), four = [0, 1, 2, 3];
    this.bones = Uint16Array.from(nearest.flatMap((vertex) => four.map((part) => bones[4 * vertex + part])));
    this.weights = Float32Array.from(nearest.flatMap((vertex) => four.map((part) => weights[4 * vertex + part])));
    this.places = new Float32Array(3 * response.count);
    this.rotations = new Float32Array(9 * response.count);
    /** What the bones do. @type {number[][]} */
    this.matrices = [];
    /** @type {((way: number[]) => number[])[]} */
    this.turns = [];
  }

  /** Takes what each bone does to a point of the rest pose. @param {number[][]} matrices */
  bend(matrices) {
    if (matrices.length === this.matrices.length && matrices.every((matrix, bone) => matrix.every((part, at) => part === this.matrices[bone][at]))) return;
    this.matrices = matrices;
    this.turns = matrices.map((matrix) => {
      const turn = rotationOf(matrix);
      return ([x, y, z]) => [0, 1, 2].map((row) => turn[row] * x + turn[3 + row] * y + turn[6 + row] * z);
    });
    const blended = new Array(16);
    this.rest.forEach(([x, y, z], voxel) => {
      blended.fill(0);
      for (let at = 4 * voxel; at < 4 * voxel + 4; at++) {
        const weight = this.weights[at];
        for (let part = 0; weight && part < 16; part++) blended[part] += weight * matrices[this.bones[at]][part];
      }
      for (let row = 0; row < 3; row++) this.places[3 * voxel + row] = blended[row] * x + blended[4 + row] * y + blended[8 + row] * z + blended[12 + row];
      this.rotations.set(rotationOf(blended), 9 * voxel);
    });
  }

  /** Where a voxel is, into `result`. */
  place(voxel, result) {
    for (let axis = 0; axis < 3; axis++) result[axis] = this.places[3 * voxel + axis];
  }

  /** Turns a direction at a voxel back to the rest pose. */
  turnBack(voxel, way) {
    const [x, y, z] = way, { rotations } = this;
    for (let axis = 0, at = 9 * voxel; axis < 3; axis++, at += 3) way[axis] = rotations[at] * x + rotations[at + 1] * y + rotations[at + 2] * z;
  }
}
