// A body of fewer triangles, for drafts: corners in one cell of a grid become one, their mean.

import * as THREE from 'three';

/** @typedef {THREE.BufferGeometry<Record<'position' | 'normal' | 'uv', THREE.InterleavedBufferAttribute>>
 *   & { boundingBox: THREE.Box3, boundingSphere: THREE.Sphere }} Body */

const CELLS = 128;
const FLOATS = 8;

/** Attributes of corners, each with position, normal and uv.
 * @param {Float32Array} numbers @returns {Body} */
export function geometryOf(numbers) {
  const corners = new THREE.InterleavedBuffer(numbers, FLOATS);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(corners, 3, 0));
  geometry.setAttribute('normal', new THREE.InterleavedBufferAttribute(corners, 3, 3));
  geometry.setAttribute('uv', new THREE.InterleavedBufferAttribute(corners, 2, 6));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return /** @type {Body} */ (geometry);
}

/** The sphere around a body in world space.
 * @param {THREE.Mesh<Body>} mesh */
export function ballOf(mesh) {
  return mesh.geometry.boundingSphere.clone().applyMatrix4(mesh.matrixWorld);
}

/** The same body with coarser triangles; the body itself where that saves little.
 * @param {Body} geometry */
export function coarseOf(geometry) {
  const { array, count } = /** @type {{ array: Float32Array, count: number }} */ (geometry.attributes.position.data);
  const { min, max } = geometry.boundingBox;
  const cell = Math.max(max.x - min.x, max.y - min.y, max.z - min.z) / CELLS || 1;
  const across = CELLS + 1;
  const numbers = new Int32Array(across ** 3).fill(-1);  // of the cells that have corners; a Map takes ten times as long
  const standing = new Uint32Array(count);
  let cells = 0;
  for (let corner = 0; corner < count; corner++) {
    const at = FLOATS * corner;
    const place = (Math.floor((array[at + 2] - min.z) / cell) * across + Math.floor((array[at + 1] - min.y) / cell)) * across + Math.floor((array[at] - min.x) / cell);
    if (numbers[place] < 0) numbers[place] = cells++;
    standing[corner] = numbers[place];
  }
  const means = meansOf(array, standing, cells);
  const kept = [];
  for (let corner = 0; corner < count; corner += 3) {
    const [a, b, c] = [standing[corner], standing[corner + 1], standing[corner + 2]];
    if (a !== b && b !== c && c !== a) kept.push(corner);
  }
  if (2 * kept.length > count / 3) return geometry;
  const coarse = new Float32Array(3 * FLOATS * kept.length);
  kept.forEach((corner, index) => {
    coarse.set(array.subarray(FLOATS * corner, FLOATS * (corner + 3)), 3 * FLOATS * index);
    for (let side = 0; side < 3; side++) {
      const from = 6 * standing[corner + side];
      coarse.set(means.subarray(from, from + 6), FLOATS * (3 * index + side));
    }
  });
  return geometryOf(coarse);
}

/** The mean position and the unit mean normal of the corners in each cell.
 * @param {Float32Array} array @param {Uint32Array} standing @param {number} cells */
function meansOf(array, standing, cells) {
  const means = new Float32Array(6 * cells);
  const counts = new Uint32Array(cells);
  standing.forEach((cell, corner) => {
    for (let axis = 0; axis < 6; axis++) means[6 * cell + axis] += array[FLOATS * corner + axis];
    counts[cell] += 1;
  });
  for (let cell = 0; cell < cells; cell++) {
    const at = 6 * cell;
    const length = Math.hypot(means[at + 3], means[at + 4], means[at + 5]) || 1;
    for (let axis = 0; axis < 3; axis++) {
      means[at + axis] /= counts[cell];
      means[at + 3 + axis] /= length;
    }
  }
  return means;
}
