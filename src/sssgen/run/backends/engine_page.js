// What the pages of all engines share: plans come through a WebSocket, and pictures go back. The engine's own script
// imports this one, and calls `serve`.
//
// A message pair each way: a text of JSON, then bytes. In a plan, `{at, size}` stands for a piece of its bytes. When the
// connection ends, the page closes, and with it the browser.

/** @typedef {{ at: number, size: number }} Piece */
/** @typedef {{ dim: '2D' | '3D', size: number[], filter: 'linear' | 'nearest', wrap: 'repeat' | 'clamp' | 'mirror',
 *   levels: { size: number[], data: Piece }[] }} Texels  Half floats with four channels. */
/** @typedef {{ position: number[], color: number[] }} Light */
/** @typedef {{ modules: Record<string, string>, renderer: string, width: number, height: number, vertices: Piece, vertexSize: number,
 *   attributes: Record<string, [number, number]>, triangles: Piece, view: number[], projection: number[], eye: number[], model: number[],
 *   lights: Light[], ambient: number[], values: object, properties: Record<string, any>, textures: Record<string, Texels>,
 *   withoutTangents: boolean }} Plan  Matrices are by columns; an attribute has its first float in a vertex, and its size. */
/** @typedef {{ shadows?: boolean, cascades?: boolean, spot?: number, walls?: number[][], copies?: { size: number, model: number[] }[],
 *   instances?: number[][], leftHanded?: boolean, first?: string, around?: string, area?: Area,
 *   above?: number[], below?: number[], later?: boolean, before?: number[][], bones?: Bones }} Stage
 *   What stands around the mesh, in the property `stage`: whether lights have shadows, of cascades or of one map; the angle of lights
 *   with a position that are spots and shine at the origin; matrices of walls, which are boxes of size 1; copies of the mesh with
 *   the same material, whose vertices have another size; matrices of instances that the mesh is drawn as, in one call; whether z of
 *   the engine's world is mirrored, in Babylon.js; another renderer of three.js that draws the scene first, in another size;
 *   what shines from above, environment, hemisphere or probe; its light on a white matte surface that faces up and down; a light with an area;
 *   whether the picture is of a frame after texels of the environment have been read, in PlayCanvas; where the lights were in
 *   a frame before, in three.js; the bones of the mesh. */
/** @typedef {{ weights: number[], matrices: number[][] }} Bones  For each vertex the weight of the second of two bones; what each
 *   does, in object space; in three.js after a frame in which they do nothing. */
/** @typedef {{ model: number[], size: number[], radiance: number, shape?: string, shadows?: boolean }} Area  It shines along the -z
 *   of its matrix, with sides along x and y; `shape` is PlayCanvas's. */
/** @typedef {(place: Piece) => Uint8Array} PieceOf */
/** @typedef {(plan: any, piece: PieceOf) => Promise<Float32Array | Uint32Array>} Draw  Of a Plan, or what the engine's script takes. */

/** @type {string[]} */
const complaints = [];
for (const level of /** @type {const} */ (['error', 'warn'])) {
  const print = console[level];
  console[level] = (...parts) => {
    complaints.push(parts.map(String).join(' '));
    print(...parts);
  };
}

addEventListener('unhandledrejection', ({ reason }) => complaints.push(`${reason?.stack ?? reason}`));

// Without a GPU, Chromium loses the device when a canvas with WebGPU is shown: a texture stands in for it.
if (globalThis.GPUCanvasContext) {
  /** @type {WeakMap<GPUCanvasContext, GPUCanvasConfiguration>} */
  const configurations = new WeakMap();
  /** @type {WeakMap<GPUCanvasContext, GPUTexture>} */
  const textures = new WeakMap();
  GPUCanvasContext.prototype.configure = function (/** @type {GPUCanvasConfiguration} */ configuration) {
    configurations.set(this, configuration);
    return undefined;
  };
  GPUCanvasContext.prototype.getCurrentTexture = function () {
    const configuration = configurations.get(this);
    if (!configuration) throw new Error('the canvas is not configured');
    const { device, format, usage = GPUTextureUsage.RENDER_ATTACHMENT } = configuration;
    const texture = textures.get(this) ?? device.createTexture({ size: [this.canvas.width, this.canvas.height], format, usage });
    textures.set(this, texture);
    return texture;
  };
}

/** The picture of a plan: its rows are `stride` bytes apart.
 * @param {Draw} draw @param {{ height: number }} plan @param {PieceOf} piece @returns {Promise<[object, ArrayBuffer]>} */
async function drawn(draw, plan, piece) {
  complaints.length = 0;
  const start = performance.now();
  const pixels = await draw(plan, piece);
  const drew = (performance.now() - start) / 1000;
  return [{ stride: pixels.byteLength / plan.height, drew, complaints: [...complaints] }, /** @type {ArrayBuffer} */ (pixels.slice().buffer)];
}

const urlOf = (/** @type {string} */ text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
/** @type {Map<string, string>} */
const runtimes = new Map(); // text → URL: all materials import the same one

/** The first of some modules (file name → text), which imports the others.
 * @param {Record<string, string>} modules */
async function imported(modules) {
  let [text] = Object.values(modules);
  for (const [name, runtime] of Object.entries(modules).slice(1)) {
    if (!runtimes.has(runtime)) runtimes.set(runtime, urlOf(runtime));
    text = text.replace(`'./${name}'`, `'${runtimes.get(runtime)}'`);
  }
  const url = urlOf(text);
  const module = await import(url);
  URL.revokeObjectURL(url);
  return module;
}

const floats = (/** @type {Uint8Array} */ bytes) => new Float32Array(bytes.slice().buffer);
const indices = (/** @type {Uint8Array} */ bytes) => new Uint32Array(bytes.slice().buffer);
const halves = (/** @type {Uint8Array} */ bytes) => new Uint16Array(bytes.slice().buffer);

/** A property's value: bytes that came as text as the file that a user would load.
 * @param {any} value */
const fileOf = (value) => (value?.response ? { data: Uint8Array.from(atob(value.response), (letter) => letter.charCodeAt(0)).buffer, facts: value.facts } : value);

/** @type {Set<Promise<unknown>>} */
const reading = new Set();
const readAll = Response.prototype.arrayBuffer;
Response.prototype.arrayBuffer = function () {
  const bytes = readAll.call(this);
  reading.add(bytes);
  return bytes;
};

/** Waits until materials have read the files of their properties. */
async function filesRead() {
  await Promise.all(reading);
  reading.clear();
  await new Promise((resume) => setTimeout(resume)); // what follows in the same task
}

/** Answers the plans that come, with `draw` of the engine in that version.
 * @param {string} version @param {Draw} draw */
function serve(version, draw) {
  const socket = new WebSocket(location.href.replace('http:', 'ws:'));
  socket.binaryType = 'arraybuffer';
  socket.onclose = () => window.close();
  const say = (/** @type {object} */ answer, bytes = new ArrayBuffer(0)) => {
    socket.send(JSON.stringify(answer));
    socket.send(bytes);
  };
  /** @type {{ height: number }} */
  let plan;
  socket.onmessage = async ({ data }) => {
    if (typeof data === 'string') {
      plan = JSON.parse(data);
      return;
    }
    const bytes = new Uint8Array(data);
    try {
      say(...(await drawn(draw, plan, ({ at, size }) => bytes.subarray(at, at + size))));
    } catch (error) {
      say({ error: `${error.name}: ${error.message}`, complaints: [...complaints], stack: error.stack });
    }
  };
  socket.onopen = () => say({ version });
}

export { fileOf, filesRead, floats, halves, imported, indices, serve };
