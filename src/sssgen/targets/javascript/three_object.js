// Values that a shader reads of the object that is drawn: the box of its body, and parameters that move with it. A material may
// belong to several objects, so that each renderer sets them for each object.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';

/**
 * How much larger the box is on all sides, in parts of its diagonal: a texel of a shadow map on a face of the box may be the
 * body's own, and the filter of the shadow reads its neighbours.
 */
const MARGIN = 0.02;

const box = new THREE.Box3(), size = new THREE.Vector3(), matrix = new THREE.Matrix4();

/** A box around an object's body, in its space; of many instances, the box of each. */
function boxOf(object) {
  const owner = object.isSkinnedMesh ? object : object.geometry;
  if (!owner.boundingBox) owner.computeBoundingBox();
  const diagonal = box.copy(owner.boundingBox).getSize(size).length();
  return box.expandByScalar(MARGIN * diagonal);
}

/** A value in the space of an object, for the world: a matrix takes positions of the world, a length is one there. */
export function placedValue(value, { matrixWorld }) {
  if (value.isMatrix4) return matrix.copy(matrixWorld).invert().premultiply(value);
  return value * Math.cbrt(Math.abs(matrixWorld.determinant()));
}

/** Uniforms whose values come from the object. */
export class ObjectUniforms {
  /** @type {{ node: any, valueOf: (object: any) => any }[]} */
  #uniforms = [];

  /** A uniform with that value of the object; `start` is a first one. */
  uniform(start, valueOf) {
    const node = TSL.uniform(start).onObjectUpdate(({ object }, self) => {
      const value = valueOf(object);
      if (typeof value === 'number') return value;
      self.value.copy(value);
      return self.value;
    });
    this.#uniforms.push({ node, valueOf });
    return node;
  }

  /** The uniforms of the box around the body. */
  box() {
    return {
      bodyMin: this.uniform(new THREE.Vector3(), (object) => boxOf(object).min),
      bodyMax: this.uniform(new THREE.Vector3(), (object) => boxOf(object).max),
    };
  }

  /** Sets all in WebGLRenderer, which otherwise uploads a material's uniforms once for successive objects. */
  place(object, renderer) {
    let changed = false;
    for (const { node, valueOf } of this.#uniforms) {
      const value = valueOf(object), isNumber = typeof value === 'number';
      if (isNumber ? node.value === value : node.value.equals(value)) continue;
      changed = true;
      if (isNumber) node.value = value;
      else node.value.copy(value);
    }
    if (changed) renderer.state.useProgram(null);
  }
}
