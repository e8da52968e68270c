// three.js in a page: runs the functions of an emitted module of TSL on arrays of arguments (engine_page.js).
//
// Each pixel of the picture is one lane of one call. The arguments are texels of `data`, four 32-bit components each, in blocks
// of `rows` rows; the results are the components of the picture, likewise. A lane's row is counted from the bottom.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { floats, imported, indices, serve } from './engine_page.js';

/** @typedef {{ dim: string, kind: 'float' | 'int' | 'uint', layers: number, compare: string, levels: { size: number[], data: Piece }[],
 *   filter: string, wrap: 'repeat' | 'clamp' | 'mirror', size: number[] }} Texels */
/** @typedef {{ texture: string, type: string, size: number, kind: string, rows: number[] }} Argument  A row for each column. */
/** @typedef {{ modules: Record<string, string>, renderer: string, width: number, height: number, rows: number, data: Piece,
 *   textures: Record<string, Texels>,
 *   calls: { function: string, slot: number, columns: number, size: number, kind: string, args: Argument[] }[] }} Plan */
/** @typedef {import('./engine_page.js').Piece} Piece */
/** @typedef {import('./engine_page.js').PieceOf} PieceOf */

const { If, bitcast, int, ivec2, positionGeometry, texture, uint, uvec4, vec4 } = TSL;
/** @type {THREE.WebGPURenderer} */
let renderer;

/** @param {string} kind */
async function started(kind) {
  if (!renderer) {
    renderer = new THREE.WebGPURenderer({ canvas: document.createElement('canvas'), forceWebGL: kind === 'webgl2' });
    await renderer.init();
    if (kind === 'webgpu' && !('device' in renderer.backend)) throw new Error('its WebGPU has no adapter');
  }
  return renderer;
}

/** @param {Plan} plan @param {PieceOf} piece */
async function draw(plan, piece) {
  await started(plan.renderer);
  const module = await imported(plan.modules);
  const words = new Uint32Array(piece(plan.data).slice().buffer);
  const data = new THREE.DataTexture(words, plan.width, words.length / plan.width / 4, THREE.RGBAIntegerFormat, THREE.UnsignedIntType);
  data.needsUpdate = true;
  const textures = Object.fromEntries(Object.entries(plan.textures).map(([name, one]) => [name, textureOf(one, piece)]));
  const nodes = Object.fromEntries(Object.entries(textures).map(([name, one]) => [name, nodeOf(one)]));

  const source = texture(data, ivec2(0, 0)); // with a place, so that three transforms no coordinate
  const material = new THREE.NodeMaterial();
  material.fragmentNode = TSL.Fn(() => {
    // a triangle that covers the picture: its position is that of the pixel, from -1 to 1
    const place = TSL.ivec2(TSL.floor(positionGeometry.xy.mul(0.5).add(0.5).mul(TSL.vec2(plan.width, plan.height)))).toConst();
    const slot = place.y.div(int(plan.rows)).toConst();
    const lane = ivec2(place.x, place.y.mod(int(plan.rows))).toConst();
    const read = (row, size) => source.load(ivec2(lane.x, lane.y.add(int(row))))['xyzw'.slice(0, size)];
    const argument = ({ texture: name, type, size, kind, rows }) => {
      if (name) return nodes[name];
      const columns = rows.map((row) => ofWords(read(row, size), kind, size));
      return columns.length > 1 ? TSL[type](...columns) : columns[0];
    };
    const result = uvec4(0, 0, 0, 0).toVar();
    for (const call of plan.calls) {
      If(slot.greaterThanEqual(int(call.slot)).and(slot.lessThan(int(call.slot + call.columns))), () => {
        const value = module[call.function](...call.args.map(argument)).toVar();
        for (let column = 0; column < call.columns; column++) {
          const part = call.columns > 1 ? value.element(int(column)) : value;
          If(slot.equal(int(call.slot + column)), () => {
            result.assign(toWords(part, call.kind, call.size));
          });
        }
      });
    }
    return result;
  })();

  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
  material.vertexNode = vec4(positionGeometry, 1);
  material.depthTest = material.depthWrite = material.toneMapped = material.fog = false;
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  const target = new THREE.RenderTarget(plan.width, plan.height, {
    format: THREE.RGBAIntegerFormat, type: THREE.UnsignedIntType, depthBuffer: false,
    minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, generateMipmaps: false,
  });
  renderer.autoClear = false;
  renderer.setRenderTarget(target);
  renderer.render(mesh, new THREE.OrthographicCamera());
  const pixels = /** @type {Uint32Array} */ (await renderer.readRenderTargetPixelsAsync(target, 0, 0, plan.width, plan.height));
  renderer.setRenderTarget(null);
  [geometry, material, target, data, ...Object.values(textures)].forEach((one) => one.dispose());
  return pixels;
}

/** The value whose bits are `words`: a uint or a vector of them.
 * @param {any} words @param {string} kind @param {number} size */
function ofWords(words, kind, size) {
  if (kind === 'uint') return words;
  if (kind === 'bool') return size > 1 ? words.notEqual(TSL['uvec' + size](...Array(size).fill(0))) : words.notEqual(uint(0));
  const prefix = { float: 'vec', int: 'ivec' }[kind];
  return bitcast(words, size > 1 ? prefix + size : kind);
}

/** Its bits as four words.
 * @param {any} value @param {string} kind @param {number} size */
function toWords(value, kind, size) {
  const prefix = size > 1 ? 'uvec' + size : 'uint';
  const words = kind === 'uint' ? value : kind === 'bool' ? TSL[prefix](value) : bitcast(value, prefix);
  const zeros = Array(4 - size).fill(uint(0));
  return zeros.length ? uvec4(words, ...zeros) : words;
}

/** @param {any} one  a texture of three */
function nodeOf(one) {
  if (one.isCubeTexture) return TSL.cubeTexture(one);
  return one.isData3DTexture ? TSL.texture3D(one) : texture(one);
}

const WRAPS = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };

/** @param {Texels} texels @param {PieceOf} piece */
function textureOf({ dim, kind, layers, compare, levels, filter, wrap, size }, piece) {
  const array = { float: floats, int: (bytes) => new Int32Array(bytes.slice().buffer), uint: indices }[kind];
  const texels = levels.map((level) => array(piece(level.data)));
  const [width, height, depth] = size;
  let one;
  if (compare) throw new Error(`no ${dim} texture that compares`);
  if (dim === 'Cube') {
    // three reads a cube at -x: the faces +x and -x change places, and every row of texels is turned round
    const count = width * width * 4;
    const faces = [1, 0, 2, 3, 4, 5].map((face) => {
      const own = texels[0].slice(face * count, (face + 1) * count);
      const turned = own.map((_, at) => own[at - (at % (4 * width)) + 4 * (width - 1 - Math.floor((at % (4 * width)) / 4)) + (at % 4)]);
      return Object.assign(new THREE.DataTexture(turned, width, width, THREE.RGBAFormat, THREE.FloatType), { needsUpdate: true });
    });
    one = new THREE.CubeTexture(faces);
  } else if (layers) {
    one = new THREE.DataArrayTexture(texels[0], width, height, layers);
  } else if (dim === '3D') {
    one = new THREE.Data3DTexture(texels[0], width, height, depth);
  } else {
    one = new THREE.DataTexture(texels[0], width, height);
    if (levels.length > 1) {
      one.mipmaps = levels.map((level, i) => ({ data: texels[i], width: level.size[0], height: level.size[1] }));
    }
  }
  const mag = filter === 'nearest' ? THREE.NearestFilter : THREE.LinearFilter;
  return Object.assign(one, {
    format: kind === 'float' ? THREE.RGBAFormat : THREE.RGBAIntegerFormat,
    type: { float: THREE.FloatType, int: THREE.IntType, uint: THREE.UnsignedIntType }[kind],
    magFilter: mag, minFilter: levels.length > 1 ? THREE.LinearMipmapLinearFilter : mag, generateMipmaps: false,
    wrapS: WRAPS[wrap], wrapT: WRAPS[wrap], wrapR: WRAPS[wrap], unpackAlignment: 1, needsUpdate: true,
  });
}

serve(THREE.REVISION, draw);
