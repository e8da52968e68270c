// A ground below the body: the shadows of the lamps fall on it, and it is darker where the body hides the surroundings.

import * as THREE from 'three';

const REACH = 9;  // of the ground, in radii of the body
const NEAR = 2.4;  // of the contact shadow
const CELLS = 88;  // of the contact shadow, across
const RINGS = 6;  // of rays
const SPOKES = 14;
const STEPS = 36;
const TOUCHING = 0.04;  // in radii of the body

/** The ground of a stage. */
export class Ground {
  /** @param {import('./stage.js').Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {THREE.Mesh<THREE.CircleGeometry, THREE.MeshStandardMaterial> | null} */
    this.mesh = null;
  }

  /** @param {boolean} on */
  show(on) {
    if (on && !this.mesh) this.mesh = this.made();
    if (this.mesh) this.mesh.visible = on;
    if (on) this.place();
  }

  made() {
    const geometry = new THREE.CircleGeometry(1, 96).rotateX(-Math.PI / 2);
    const material = new THREE.MeshStandardMaterial({ color: 0x8c8a86, roughness: 0.95, transparent: true, alphaMap: fadeTexture() });
    material.polygonOffset = true;  // a body may have a flat bottom
    material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
    const mesh = new THREE.Mesh(geometry, material);
    mesh.receiveShadow = true;
    mesh.renderOrder = -1;
    this.stage.scene.add(mesh);
    return mesh;
  }

  /** Below the body that is shown. */
  place() {
    const { mesh, stage } = this;
    if (!mesh?.visible || !stage.mesh) return;
    const key = `${stage.mesh.userData.body} ${stage.model.elements.join()}`;
    if (key !== this.key) {
      this.key = key;
      const heights = heightsOf(stage.bodies[0], stage.model, stage.ball);
      mesh.position.set(stage.ball.center.x, heights.bottom, stage.ball.center.z);
      mesh.scale.setScalar(REACH * stage.ball.radius);
      mesh.material.aoMap?.dispose();
      mesh.material.aoMap = contactTexture(heights);
    }
    mesh.rotation.y = stage.angle;
  }

  dispose() {
    this.mesh?.geometry.dispose();
    this.mesh?.material.aoMap?.dispose();
    this.mesh?.material.alphaMap?.dispose();
    this.mesh?.material.dispose();
  }
}

/** White in the middle, black at the edge. */
function fadeTexture() {
  const side = 128;
  const data = new Uint8Array(4 * side * side);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const away = Math.hypot((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5) * 2;
      const share = 255 * (1 - THREE.MathUtils.smoothstep(away, 0.25, 0.98));
      data.set([share, share, share, 255], 4 * (y * side + x));
    }
  }
  return textureOf(data, side);
}

/** @param {Uint8Array<ArrayBuffer>} data @param {number} side */
function textureOf(data, side) {
  const texture = new THREE.DataTexture(data, side, side);
  return Object.assign(texture, { magFilter: THREE.LinearFilter, minFilter: THREE.LinearFilter, needsUpdate: true });
}

/** The body above each cell of the ground, in radii of the body: from `low` to `high`; `low` is endless where there is none.
 * @param {import('./coarse_body.js').Body} body @param {THREE.Matrix4} model @param {THREE.Sphere} ball */
function heightsOf(body, model, { center, radius }) {
  const { position } = body.attributes;
  const low = new Float32Array(CELLS * CELLS).fill(Infinity);
  const high = new Float32Array(CELLS * CELLS).fill(-Infinity);
  const corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
  const point = new THREE.Vector3();
  let bottom = Infinity;
  for (let index = 0; index < position.count; index += 3) {
    corners.forEach((corner, side) => corner.fromBufferAttribute(position, index + side).applyMatrix4(model).sub(center).divideScalar(radius));
    const [a, b, c] = corners;
    bottom = Math.min(bottom, a.y, b.y, c.y);
    // points of the triangle, no farther apart than a cell
    const parts = Math.min(CELLS, Math.ceil(Math.max(a.distanceTo(b), a.distanceTo(c), b.distanceTo(c)) * CELLS / (2 * NEAR)) || 1);
    for (let i = 0; i <= parts; i++) {
      for (let j = 0; j <= parts - i; j++) {
        point.copy(a).multiplyScalar(parts - i - j).addScaledVector(b, i).addScaledVector(c, j).divideScalar(parts);
        const cell = cellOf(point.x, point.z);
        low[cell] = Math.min(low[cell], point.y);
        high[cell] = Math.max(high[cell], point.y);
      }
    }
  }
  for (let cell = 0; cell < low.length; cell++) { low[cell] -= bottom; high[cell] -= bottom; }
  return { low, high, bottom: center.y + radius * bottom };
}

const indexOf = (/** @type {number} */ place) => Math.floor((place / NEAR + 1) * 0.5 * CELLS);
const cellOf = (/** @type {number} */ x, /** @type {number} */ z) => indexOf(z) * CELLS + indexOf(x);

/** A picture of the share of the sky that each place of the ground sees.
 * @param {{ low: Float32Array, high: Float32Array }} heights */
function contactTexture({ low, high }) {
  const top = high.reduce((one, other) => Math.max(one, other), 0);
  const placeOf = (/** @type {number} */ index) => ((index + 0.5) / CELLS * 2 - 1) * NEAR;
  const seen = Float32Array.from(low, (height, cell) => (
    height < TOUCHING ? NaN : skySeen(placeOf(cell % CELLS), placeOf(Math.floor(cell / CELLS)), low, high, top)));
  // where the body touches the ground, that of the places around: a filter would spread the black there beyond the body
  const smooth = blurred(blurred(blurred(seen)));
  const data = new Uint8Array(4 * CELLS * CELLS).fill(255);
  smooth.forEach((share, cell) => {
    const [column, row] = [cell % CELLS, Math.floor(cell / CELLS)];
    const edge = THREE.MathUtils.smoothstep(Math.max(Math.abs(placeOf(column)), Math.abs(placeOf(row))) / NEAR, 0.75, 0.98);
    const texel = 4 * ((CELLS - 1 - row) * CELLS + column);  // row 0 of a texture is at the front, where z is largest
    data.fill(255 * (Number.isNaN(share) ? 0 : share + (1 - share) * edge), texel, texel + 3);
  });
  const texture = textureOf(data, CELLS);
  texture.repeat.setScalar(REACH / NEAR);
  texture.offset.setScalar(0.5 - 0.5 * REACH / NEAR);
  return texture;
}

/** The means over the cells around, of those that have a value.
 * @param {Float32Array} shares */
function blurred(shares) {
  return shares.map((_, cell) => {
    let [sum, count] = [0, 0];
    for (const row of [-CELLS, 0, CELLS]) {
      for (const column of [-1, 0, 1]) {
        const share = shares[cell + row + column];
        if (share >= 0) { sum += share; count += 1; }
      }
    }
    return count ? sum / count : NaN;
  });
}

/** The share of the sky that a place sees, weighted with the cosine: rays through the body's heights.
 * @param {number} x @param {number} z @param {Float32Array} low @param {Float32Array} high @param {number} top */
function skySeen(x, z, low, high, top) {
  let hidden = 0;
  for (let ring = 0; ring < RINGS; ring++) {
    const sine = Math.sqrt((ring + 0.5) / RINGS);  // equal shares of the cosine
    const cosine = Math.sqrt(1 - sine * sine);
    for (let spoke = 0; spoke < SPOKES; spoke++) {
      const angle = (spoke + ring / RINGS) / SPOKES * 2 * Math.PI;
      const [dx, dz] = [sine * Math.cos(angle), sine * Math.sin(angle)];
      const way = Math.min(top / cosine, 2.2);
      for (let step = 1; step <= STEPS; step++) {
        const along = way * (step - 0.5) / STEPS;
        const [px, pz, height] = [x + along * dx, z + along * dz, along * cosine];
        if (Math.abs(px) >= NEAR || Math.abs(pz) >= NEAR) break;
        const cell = cellOf(px, pz);
        if (low[cell] <= height + 0.01 && height <= high[cell]) { hidden += 1; break; }
      }
    }
  }
  return 1 - hidden / (RINGS * SPOKES);
}
