// A body of fewer triangles, for drafts: corners in one cell of a grid become one.

import * as THREE from 'three';

const CELLS = 64;
const FLOATS = 8;

/** Attributes of corners, each with position, normal and uv. */
export function geometryOf(numbers) {
  const corners = new THREE.InterleavedBuffer(numbers, FLOATS);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(corners, 3, 0));
  geometry.setAttribute('normal', new THREE.InterleavedBufferAttribute(corners, 3, 3));
  geometry.setAttribute('uv', new THREE.InterleavedBufferAttribute(corners, 2, 6));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

/** The same body with coarser triangles; the body itself where that saves little. */
export function coarseOf(geometry) {
  const { array, count } = geometry.attributes.position.data;
  const { min, max } = geometry.boundingBox;
  const cell = Math.max(max.x - min.x, max.y - min.y, max.z - min.z) / CELLS || 1;
  const first = new Map();  // cell → the first corner in it
  const standing = new Uint32Array(count);
  for (let corner = 0; corner < count; corner++) {
    const [x, y, z] = [0, 1, 2].map((axis) => Math.floor((array[FLOATS * corner + axis] - min.getComponent(axis)) / cell));
    const key = (z * 2 * CELLS + y) * 2 * CELLS + x;
    if (!first.has(key)) first.set(key, corner);
    standing[corner] = first.get(key);
  }
  const kept = [];
  for (let corner = 0; corner < count; corner += 3) {
    const [a, b, c] = [standing[corner], standing[corner + 1], standing[corner + 2]];
    if (a !== b && b !== c && c !== a) kept.push(corner);
  }
  if (2 * kept.length > count / 3) return geometry;
  const numbers = new Float32Array(3 * FLOATS * kept.length);
  kept.forEach((corner, index) => {
    numbers.set(array.subarray(FLOATS * corner, FLOATS * (corner + 3)), 3 * FLOATS * index);
    for (let side = 0; side < 3; side++) {
      const from = FLOATS * standing[corner + side];
      numbers.set(array.subarray(from, from + 3), FLOATS * (3 * index + side));
    }
  });
  return geometryOf(numbers);
}
