// The passes of a material in a page that draws with WebGPU itself: pictures of the body alone, as the eye or a light sees it.
//
//   const passes = createPasses(device, reflection);   // NAME.wgsl.reflection.json of sssgen emit --target wgsl
//   const { textures, samplers, values } = passes.draw(encoder, body, eye, lights);   // by the names in the shader
//
// It executes the list of the reflection for a frame, before the render pass that draws the material. Where the device has
// the feature float32-filterable, the pictures have 32-bit floats, else 16-bit ones.

import { FAR, LAYERS, LAYER_GAP, PACKING, SIDE, emptyOf, isFiltered, isVolume, layersOf, lightsOf, showsLight, tileOf, tilesOf, viewNumbers } from './frame_passes.js';
import { Responses } from './inner_volume.js';
import { InnerTexture } from './webgpu_inner_light.js';

/**
 * A mesh, with the position at location 0 and the normal at location 1, as the material's shader has them.
 * @typedef {object} Body
 * @property {GPUVertexBufferLayout[]} layout
 * @property {GPUBuffer[]} buffers
 * @property {GPUBuffer} triangles the indices; triangles are counter-clockwise seen from outside
 * @property {GPUIndexFormat} [indexFormat] uint32 without it
 * @property {number} count of the indices
 * @property {number[]} model object space to world space, by columns
 * @property {number[][]} box the lowest and the highest corner in object space
 */

/**
 * @typedef {{ position: number[], viewProjection: number[], size: number[] }} Eye size: of the picture in which the material is
 *   drawn, in pixels
 * @typedef {{ position: number[], color: number[] }} Light position: x, y, z, 1 at a place; x, y, z, 0 is the direction to it
 * @typedef {{ textures: Record<string, GPUTexture>, samplers: Record<string, GPUSampler>, values: Record<string, number[]> }} Drawn
 * @typedef {{ clip: number[], plane: number[], end: number }} View what a camera sees: world space to clip space, the plane
 *   from which distances count, and the distance of the farthest corner
 * @typedef {{ name: string, of: string, seen_from: string, layers: string[], empty: '0' | 'far', texture: string, views: string[],
 *   size: string | null }} PassRecord
 * @typedef {{ passes: PassRecord[], uniforms: { name: string, source_name: string }[], textures: { name: string, source_name: string }[] }} Reflection
 */

/** The width of a light's view, relative to the body. */
const MARGIN = 1.1;
/** The floats of a drawing in the uniform buffer, whose offsets are multiples of 256 bytes. */
const FLOATS = 128;

const BODY = /* wgsl */ `
struct Drawing {
    to_clip: mat4x4f,
    to_world: mat4x4f,
    plane: vec4f,  // its product with a place is the distance; zeros: the distance from the eye
    eye: vec3f,
    margin: f32,  // above 0: of surfaces that lie so far behind those of front
    ambient: vec4f,
    positions: array<vec4f, 4>,
    colors: array<vec4f, 4>,
}
@group(0) @binding(0) var<uniform> drawing: Drawing;
@group(0) @binding(1) var front: texture_2d<f32>;

struct Varyings {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn corner(@location(0) position: vec3f, @location(1) normal: vec3f) -> Varyings {
    let place = drawing.to_world * vec4f(position, 1.0);
    let x = drawing.to_world[0].xyz;
    let y = drawing.to_world[1].xyz;
    let z = drawing.to_world[2].xyz;
    let turned = mat3x3f(cross(y, z), cross(z, x), cross(x, y)) * normal * sign(dot(x, cross(y, z)));
    return Varyings(drawing.to_clip * place, place.xyz, turned);
}

@fragment
fn distances(input: Varyings) -> @location(0) vec4f {
    var way = dot(drawing.plane, vec4f(input.place, 1.0));
    if (all(drawing.plane == vec4f())) {
        way = distance(drawing.eye, input.place);
    }
    if (drawing.margin > 0.0 && way < textureLoad(front, vec2i(input.clip.xy), 0).r + drawing.margin) {
        discard;
    }
    return vec4f(way);
}

@fragment
fn light(input: Varyings) -> @location(0) vec4f {
    let normal = normalize(input.normal);
    var sum = drawing.ambient.rgb;
    for (var i = 0; i < 4; i++) {
        let near = drawing.positions[i].w;
        let way = drawing.positions[i].xyz - input.place * near;
        let square = max(dot(way, way), 1e-4);
        sum += drawing.colors[i].rgb * max(dot(normal, way), 0.0) * inverseSqrt(square) * mix(1.0, 1.0 / square, near);
    }
    return vec4f(sum, dot(drawing.plane, vec4f(input.place, 1.0)));
}`;

/** Made when it is used: the file that has LAYERS follows this one where both are one file. */
const packedText = () => /* wgsl */ `
${LAYERS.map((name, index) => `@group(0) @binding(${index}) var ${name}: texture_2d<f32>;`).join('\n')}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn packed(@builtin(position) place: vec4f) -> @location(0) vec4f {
    let at = vec2i(place.xy);
    return ${PACKING.wgsl};
}`;

// Vectors, and matrices as four rows.

const dot = (a, b) => a.reduce((sum, one, index) => sum + one * b[index], 0);
/** @returns {number[]} */
const cross = (/** @type {number[]} */ [a, b, c], /** @type {number[]} */ [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const times = (a, factor) => a.map((one) => one * factor);
const minus = (a, b) => a.map((one, index) => one - b[index]);
const unit = (a) => times(a, 1 / Math.max(Math.hypot(...a), 1e-30));
const rowsOf = (matrix) => [0, 1, 2, 3].map((row) => [0, 4, 8, 12].map((at) => matrix[at + row]));
const columnsOfRows = (rows) => [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));

/** The corners of a body's box, and its middle, in world space. @param {Body} body */
function boxOf({ model, box: [low, high] }) {
  const rows = rowsOf(model).slice(0, 3);
  const place = (point) => rows.map((row) => dot(row, [...point, 1]));
  const corners = [low, high].flatMap(([x]) => [low, high].flatMap(([, y]) => [low, high].map(([, , z]) => place([x, y, z]))));
  return { corners, middle: place(low.map((one, index) => 0.5 * (one + high[index]))) };
}

/** @param {Eye} eye @returns {View} whose plane is in the middle of the body */
function eyeView({ viewProjection }, { corners, middle }) {
  const [, , , w] = rowsOf(viewProjection);
  const plane = minus(w, [0, 0, 0, dot(w, [...middle, 1])]);
  return { clip: viewProjection, plane, end: Math.max(...corners.map((corner) => dot(plane, [...corner, 1]))) };
}

/** @param {Light} light @param {boolean} distant whether it counts as one from afar @returns {View} */
function lightView({ position }, distant, { corners, middle }) {
  const place = position.slice(0, 3), parallel = distant || position[3] === 0;
  const towards = position[3] === 0 ? place : minus(place, middle), ahead = unit(times(towards, -1));
  const least = Math.min(...ahead.map(Math.abs)), axis = ahead.findIndex((one) => Math.abs(one) === least);
  const side = unit(cross(times(ahead, -1), [0, 1, 2].map((index) => Number(index === axis)))), up = cross(side, ahead);
  const from = parallel ? middle : place;
  const depths = corners.map((corner) => dot(ahead, minus(corner, from)));
  const gap = 0.01 * Math.hypot(...minus(corners[7], corners[0]));
  const near = Math.max(Math.min(...depths) - gap, parallel ? -Infinity : 0.01 * Math.hypot(...towards)), far = Math.max(...depths) + gap;
  const reach = (axis) => Math.max(...corners.map((corner, index) => Math.abs(dot(axis, minus(corner, from))) / (parallel ? 1 : Math.max(depths[index], near))));
  const half = MARGIN * Math.max(reach(side), reach(up));
  const row = (axis) => [...axis, -dot(axis, from)];
  const plane = minus(row(ahead), [0, 0, 0, near]);
  const rows = [times(row(side), 1 / half), times(row(up), 1 / half), times(plane, (parallel ? 1 : far) / (far - near)), parallel ? [0, 0, 0, 1] : row(ahead)];
  return { clip: columnsOfRows(rows), plane, end: Math.max(...depths) - near };
}

/** How bright a light is at a place. @param {number[]} middle @param {Light} light */
function strengthAt(middle, { position, color }) {
  const way = minus(position.slice(0, 3), middle);
  return Math.max(...color) / (position[3] ? Math.max(dot(way, way), 1e-6) : 1);
}

/** The drawings of one frame, each with its numbers in a buffer of this frame alone: two bodies may have one encoder. */
class Frame {
  /** @param {GPUDevice} device @param {GPUCommandEncoder} encoder @param {number} count of the drawings at most */
  constructor(device, encoder, count, lit) {
    this.encoder = encoder;
    this.lit = lit;
    this.buffer = device.createBuffer({ size: 4 * FLOATS * count, usage: GPUBufferUsage.UNIFORM, mappedAtCreation: true });
    this.numbers = new Float32Array(this.buffer.getMappedRange());
    this.end = 0;
  }

  /** Adds a drawing. @param {View} view @returns {number} the offset of its numbers */
  add({ clip, plane }, model, eye, margin) {
    const start = this.end;
    this.numbers.set([...clip, ...model, ...plane, ...eye, margin, ...this.lit], start);
    this.end += FLOATS;
    return 4 * start;
  }
}

/** The passes of a material. */
class Passes {
  /** @type {Map<string, GPURenderPipeline>} */
  #pipelines = new Map();
  /** What all bodies share: layers and depths. @type {Map<string, GPUTexture>} */
  #shared = new Map();
  /** @type {Map<Body, Map<string, GPUTexture>>} */
  #pictures = new Map();
  /** @type {Map<Body, InnerTexture>} */
  #volumes = new Map();

  /** @param {GPUDevice} device @param {Reflection} reflection @param {Record<string, any>} responses */
  constructor(device, { passes, uniforms, textures }, responses) {
    this.device = device;
    this.names = Object.fromEntries([...uniforms, ...textures].map(({ name, source_name }) => [source_name, name]));
    const own = passes.filter(({ of }) => of === 'body' || of === 'casters').map((pass) => ({ ...pass, seenFrom: pass.seen_from }));
    this.passes = own.filter((pass) => !isVolume(pass));
    this.responses = new Responses(own);
    for (const [name, response] of Object.entries(responses)) this.responses.take(name, response, () => {});
    this.format = /** @type {GPUTextureFormat} */ (device.features.has('float32-filterable') ? 'rgba32float' : 'rgba16float');
    this.group = device.createBindGroupLayout({ entries: [
      { binding: 0, visibility: GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT, buffer: { hasDynamicOffset: true, minBindingSize: 4 * FLOATS } },
      { binding: 1, visibility: GPUShaderStage.FRAGMENT, texture: { sampleType: 'unfilterable-float' } },
    ] });
    this.samplers = /** @type {const} */ (['nearest', 'linear']).map((filter) => device.createSampler({ minFilter: filter, magFilter: filter }));
    this.blank = this.#texture(new Map(), 'blank', 'r32float', [1, 1]);
  }

  /**
   * Draws the pictures of a body for a frame, before the pass that draws the material, and gives them with the views in
   * which they were drawn. A light that a picture needs and that is missing leaves zeros.
   * @param {GPUCommandEncoder} encoder
   * @param {Body} body the same object in each frame: it has pictures of its own
   * @param {Eye} eye
   * @param {Light[]} lights those that the material gets
   * @param {{ ambient?: number[], others?: Body[] }} [around] the ambient light, and other bodies that cast shadows
   * @returns {Drawn}
   */
  draw(encoder, body, eye, lights, { ambient = [0, 0, 0], others = [] } = {}) {
    /** @type {Drawn} */
    const drawn = { textures: {}, samplers: {}, values: {} };
    const casters = [body, ...others];
    for (const name of this.responses.keys()) this.#drawInside(name, body, lights, ambient, drawn);
    const count = this.passes.reduce((sum, { layers, views }) => sum + layers.length * Math.max(views.length, 1) * casters.length, 0);
    if (!count) return drawn;
    const four = (key) => [0, 1, 2, 3].flatMap((index) => [...(lights[index]?.[key] ?? []), 0, 0, 0, 0].slice(0, 4));
    const frame = new Frame(this.device, encoder, count, [...ambient, 0, ...four('position'), ...four('color')]);
    if (!this.#pictures.has(body)) this.#pictures.set(body, new Map());
    const own = /** @type {Map<string, GPUTexture>} */ (this.#pictures.get(body));
    for (const pass of this.passes) {
      const bodies = pass.of === 'body' ? [body] : casters, isEye = pass.seenFrom === 'eye';
      const boxes = bodies.map(boxOf), box = { corners: boxes.flatMap(({ corners }) => corners), middle: boxes[0].middle };
      const views = isEye ? [eyeView(eye, box)] : this.#shown(pass, lights, box).map((light) => lightView(light, pass.seenFrom === 'distant light', box));
      const tiles = tilesOf(views.length), size = isEye ? eye.size : [tiles.across * SIDE, tiles.up * SIDE];
      const picture = this.#texture(own, pass.name, this.format, size);
      this.#draw(frame, pass, bodies, views, eye, box, picture);
      const { textures, samplers, values } = drawn, name = this.names[pass.texture];
      textures[name] = picture;
      samplers[name] = this.samplers[Number(isFiltered(pass))];
      pass.views.forEach((name, index) => {
        const view = views[index];
        values[this.names[name]] = view ? viewNumbers(view.clip, view.plane.flatMap((one) => [0, 0, one, 0]), 1, 0, -1, tileOf(index), tiles) : Array(16).fill(0);
      });
      if (pass.size) values[this.names[pass.size]] = [size[0]];
    }
    frame.buffer.unmap();
    return drawn;
  }

  /** Computes the light inside a body. */
  #drawInside(name, body, lights, ambient, { textures, samplers, values }) {
    const response = this.responses.loaded(name);
    if (!response) return;
    if (!this.#volumes.has(body)) {
      const [low, high] = body.box;
      response.checkBody(low, high);
      this.#volumes.set(body, new InnerTexture(this.device, response));
    }
    const volume = /** @type {InnerTexture} */ (this.#volumes.get(body));
    const parameters = volume.follow(body.model, lights, ambient);
    textures[this.names[name]] = volume.texture;
    samplers[this.names[name]] = this.samplers[1];
    for (const [parameter, numbers] of Object.entries(parameters)) if (this.names[parameter]) values[this.names[parameter]] = numbers;
  }

  /** Frees the pictures of a body. @param {Body} body */
  forget(body) {
    this.#volumes.get(body)?.destroy();
    this.#volumes.delete(body);
    for (const picture of this.#pictures.get(body)?.values() ?? []) picture.destroy();
    this.#pictures.delete(body);
  }

  /** Frees all. */
  destroy() {
    for (const body of [...this.#pictures.keys(), ...this.#volumes.keys()]) this.forget(body);
    for (const texture of [this.blank, ...this.#shared.values()]) texture.destroy();
    this.#shared.clear();
  }

  /** The lights that a pass shows: the brightest, or of one view the first. */
  #shown(pass, lights, { middle }) {
    const strength = (light) => (pass.views.length > 1 ? strengthAt(middle, light) : 1);
    return lightsOf(lights.map((light) => ({ light, directional: light.position[3] === 0, strength: strength(light) })), pass);
  }

  /** Draws one pass into its picture. */
  #draw(frame, pass, bodies, views, eye, { corners }, picture) {
    const { width, height } = picture, tiles = tilesOf(views.length), lit = showsLight(pass);
    const layers = lit ? [{ back: false, before: -1 }] : layersOf(pass), isPacked = layers.length > 1;
    // what receives a shadow may lie far behind the bodies that cast it
    const end = pass.name === 'shadow_depth' ? FAR : emptyOf(pass, Math.max(1e-3, ...views.map((view) => view.end)));
    const clearValue = lit ? [0, 0, 0, end] : [end, end, end, end];
    const gap = LAYER_GAP * 0.5 * Math.hypot(...minus(corners[7], corners[0]));
    /** @type {GPUTexture[]} */
    const drawn = [];
    const depth = this.#texture(this.#shared, `${pass.name} depth`, 'depth32float', [width, height]);
    for (const { back, before } of layers) {
      const target = isPacked ? this.#texture(this.#shared, `${pass.name} ${drawn.length}`, 'r32float', [width, height]) : picture;
      const into = frame.encoder.beginRenderPass({
        colorAttachments: [{ view: target.createView(), clearValue, loadOp: 'clear', storeOp: 'store' }],
        depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: 'clear', depthStoreOp: 'discard' },
      });
      const front = before < 0 ? this.blank : drawn[before];
      const group = this.device.createBindGroup({ layout: this.group, entries: [
        { binding: 0, resource: { buffer: frame.buffer, size: 4 * FLOATS } }, { binding: 1, resource: front.createView() },
      ] });
      views.forEach((view, index) => {
        const { x, y } = tileOf(index), [w, h] = [width / tiles.across, height / tiles.up];
        const shown = lit || pass.seenFrom !== 'eye' ? view : { ...view, plane: [0, 0, 0, 0] };
        into.setViewport(x * w, y * h, w, h, 0, 1);
        for (const body of bodies) {
          into.setPipeline(this.#pipeline(lit ? 'light' : 'distances', body, target.format, back));
          into.setBindGroup(0, group, [frame.add(shown, body.model, eye.position, before < 0 ? 0 : gap)]);
          body.buffers.forEach((buffer, slot) => into.setVertexBuffer(slot, buffer));
          into.setIndexBuffer(body.triangles, body.indexFormat ?? 'uint32');
          into.drawIndexed(body.count);
        }
      });
      into.end();
      drawn.push(target);
    }
    if (isPacked) this.#pack(frame.encoder, drawn, picture);
  }

  /** Writes layers into one picture. */
  #pack(encoder, layers, picture) {
    const pipeline = this.#reuse('packed', () => {
      const module = this.device.createShaderModule({ code: packedText() });
      return { layout: 'auto', vertex: { module }, fragment: { module, targets: [{ format: this.format }] } };
    });
    const into = encoder.beginRenderPass({ colorAttachments: [{ view: picture.createView(), loadOp: 'clear', storeOp: 'store' }] });
    const entries = LAYERS.map((_, binding) => ({ binding, resource: layers[Math.min(binding, layers.length - 1)].createView() }));
    into.setPipeline(pipeline);
    into.setBindGroup(0, this.device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
    into.draw(3);
    into.end();
  }

  /** @param {string} entryPoint @param {Body} body @param {GPUTextureFormat} format @param {boolean} back whether its back faces are drawn */
  #pipeline(entryPoint, { layout, model }, format, back) {
    const [x, y, z] = [0, 4, 8].map((at) => model.slice(at, at + 3));
    const frontFace = dot(x, cross(y, z)) < 0 ? 'cw' : 'ccw';
    return this.#reuse(JSON.stringify([entryPoint, layout, format, back, frontFace]), () => {
      const module = this.device.createShaderModule({ code: BODY });
      return {
        layout: this.device.createPipelineLayout({ bindGroupLayouts: [this.group] }),
        vertex: { module, buffers: layout },
        fragment: { module, entryPoint, targets: [{ format }] },
        primitive: { cullMode: back ? 'front' : 'back', frontFace },
        depthStencil: { format: 'depth32float', depthWriteEnabled: true, depthCompare: 'less' },
      };
    });
  }

  /** A pipeline that is created once for each key. @param {string} key @param {() => GPURenderPipelineDescriptor} describe */
  #reuse(key, describe) {
    const pipeline = this.#pipelines.get(key) ?? this.device.createRenderPipeline(describe());
    this.#pipelines.set(key, pipeline);
    return pipeline;
  }

  /**
   * A texture, kept until its size changes.
   * @param {Map<string, GPUTexture>} kept @param {string} key @param {GPUTextureFormat} format @param {number[]} size
   */
  #texture(kept, key, format, [width, height]) {
    const old = kept.get(key);
    if (old && old.width === width && old.height === height) return old;
    old?.destroy();
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_SRC;
    const texture = this.device.createTexture({ label: key, size: [width, height], format, usage });
    kept.set(key, texture);
    return texture;
  }
}

/**
 * The passes of a material; bodies may share them.
 * @param {GPUDevice} device
 * @param {Reflection} reflection
 * @param {Record<string, string | { data: ArrayBuffer, facts: any }>} [responses] for `inner_light` the URL of a `.bin` of
 *   `sssgen bake fluence --relit`, beside which its JSON lies, or the content of both
 */
export function createPasses(device, reflection, responses = {}) {
  return new Passes(device, reflection, responses);
}
