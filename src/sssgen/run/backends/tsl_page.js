// three.js in a page: runs the functions of an emitted module of TSL on arrays of arguments (engine_page.js).
//
// Each pixel of the picture is one lane of one call. The arguments are texels of `data`, four 32-bit components each, in blocks
// of `rows` rows; the results are the components of the picture, likewise. A lane's row is counted from the bottom.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { floats, imported, indices, serve } from './engine_page.js';

/** @typedef {{ dim: string, kind: 'float' | 'int' | 'uint', layers: number, compare: string, levels: { size: number[], data: Piece }[],
 *   filter: string, wrap: 'repeat' | 'clamp' | 'mirror' }} Texels */
/** @typedef {{ width: number, height: number, depth: number, data: any }} Image  A level of a texture; six faces have the depth 6. */
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
function textureOf({ dim, kind, layers, compare, levels, filter, wrap }, piece) {
  const array = { float: floats, int: (bytes) => new Int32Array(bytes.slice().buffer), uint: indices }[kind];
  const images = levels.map((level) => {
    const [width, height, depth = layers || (dim === 'Cube' ? 6 : 1)] = level.size;
    const texels = array(piece(level.data));
    return { width, height, depth, data: dim === 'Cube' ? turned(texels, width) : texels };
  });
  const { width, height, depth, data } = images[0];
  let one;
  if (compare) throw new Error(`no ${dim} texture that compares`);
  if (dim === 'Cube') {
    one = new THREE.CubeTexture(facesOf(images[0]));
    one.mipmaps = images.slice(1).map((image) => ({ images: facesOf(image) }));
  } else {
    one = layers ? new THREE.DataArrayTexture(data, width, height, depth)
      : dim === '3D' ? new THREE.Data3DTexture(data, width, height, depth) : new THREE.DataTexture(data, width, height);
    if (images.length > 1) one.mipmaps = images;
  }
  const mag = filter === 'nearest' ? THREE.NearestFilter : THREE.LinearFilter;
  Object.assign(one, {
    format: kind === 'float' ? THREE.RGBAFormat : THREE.RGBAIntegerFormat,
    type: { float: THREE.FloatType, int: THREE.IntType, uint: THREE.UnsignedIntType }[kind],
    magFilter: mag, minFilter: levels.length > 1 ? THREE.LinearMipmapLinearFilter : mag, generateMipmaps: false,
    wrapS: WRAPS[wrap], wrapT: WRAPS[wrap], wrapR: WRAPS[wrap], unpackAlignment: 1, needsUpdate: true,
  });
  if (!one.isDataTexture && images.length > 1) writeLevels(one, images);
  return one;
}

/** three reads a cube at -x: the faces +x and -x change places, and every row of texels is turned round.
 * @param {any} texels  of six faces @param {number} width */
function turned(texels, width) {
  const row = 4 * width, count = row * width;
  return texels.map((_, at) => {
    const face = [1, 0, 2, 3, 4, 5][Math.floor(at / count)], inside = at % count, column = Math.floor((inside % row) / 4);
    return texels[face * count + inside - (inside % row) + 4 * (width - 1 - column) + (inside % 4)];
  });
}

/** @param {Image} image */
function facesOf({ width, data }) {
  const count = 4 * width * width;
  return [0, 1, 2, 3, 4, 5].map((face) => {
    const own = data.slice(face * count, (face + 1) * count);
    return Object.assign(new THREE.DataTexture(own, width, width, THREE.RGBAFormat, THREE.FloatType), { needsUpdate: true });
  });
}

/** Writes the levels of a texture after the first, which three writes for a plain texture alone.
 * @param {any} one @param {Image[]} images */
function writeLevels(one, images) {
  renderer.initTexture(one);
  const backend = /** @type {any} */ (renderer.backend);
  const { texture: gpu, textureGPU, glTextureType, glFormat, glType } = backend.get(one);
  images.forEach(({ width, height, depth, data }, level) => {
    if (level === 0) return;
    if (gpu) {
      const layout = { bytesPerRow: 4 * data.BYTES_PER_ELEMENT * width, rowsPerImage: height };
      backend.device.queue.writeTexture({ texture: gpu, mipLevel: level }, data, layout, [width, height, depth]);
      return;
    }
    const gl = backend.gl;
    backend.state.bindTexture(glTextureType, textureGPU);
    if (one.isCubeTexture) {
      facesOf({ width, height, depth, data }).forEach((face, index) => {
        const target = gl.TEXTURE_CUBE_MAP_POSITIVE_X + index;
        gl.texSubImage2D(target, level, 0, 0, width, width, glFormat, glType, face.image.data);
      });
    } else gl.texSubImage3D(glTextureType, level, 0, 0, 0, width, height, depth, glFormat, glType, data);
  });
}

serve(THREE.REVISION, draw);
