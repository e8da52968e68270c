// Draws in WebGPU with a program of WebGL that `sssgen transpile --stages A.vert B.frag --target wgsl -o FOLDER` wrote.
// It reads NAME.program.json, and makes of it the layouts, the pipelines, and what sets uniforms and textures by name.
//
//   const program = await loadProgram(device, 'web/water.program.json');
//   const vertices = program.vertices({ position: { buffer, format: 'float32x3', stride: 12 } });
//   const pipeline = program.pipeline({ vertices, targets: ['rgba8unorm'], depth: { format: 'depth24plus' } });
//   const values = program.values();   // one for each object that is drawn
//   values.set('time', 0.5); values.setTexture('map', texture, sampler); values.setBuffer('Bones', storageBuffer);
//   pass.setPipeline(pipeline); vertices.bind(pass); values.bind(pass); pass.draw(count);
//
// With `rows` "bottom-first" a picture has the rows of WebGL: the first row is its bottom. So gl_FragCoord, dFdy and the
// coordinates of textures that were drawn before mean what they mean in WebGL. Draw into a texture, and show it with
// `show(device, texture, view, format)`, which turns it.

/** @typedef {{ name: string, stages: string[], type: string, lengths: number[], offset: number, size: number,
 *   array_stride: number, matrix_stride: number, block?: BlockPlace }} Uniform */
/** @typedef {{ name: string, offset: number, strides: number[], matrix_stride: number, row_major: boolean }} BlockPlace
 *   Where a uniform is in a uniform buffer of WebGL. */
/** @typedef {{ uniform: string, type: string, count: number, offset: number, array_stride: number, matrix_stride: number,
 *   block?: BlockPlace & { stride: number } }} Place  Where the numbers of a name are; `uniform` is the whole that it belongs to. */
/** @typedef {{ name: string, stages: string[], dimension: GPUTextureViewDimension, sample_type: GPUTextureSampleType,
 *   filterable: boolean, sampler: GPUSamplerBindingType | '', multisampled: boolean, binding: { group: number, texture: number, sampler: number } }} Texture */
/** @typedef {{ name: string, stages: string[], access: string, binding: { binding: number } }} Memory */
/** @typedef {{ name: string, type: string, location: number, locations: number, format: GPUVertexFormat }} Attribute */
/** @typedef {{ format: number, program: string, rows: string, stages: Record<string, { file: string, entry: string }>,
 *   attributes: Attribute[], varyings: { name: string, interpolation: string }[], uniform_block: { size: number, group: number, binding: number } | null,
 *   uniforms: Uniform[], textures: Texture[], storage_buffers?: (Memory & { block: string })[],
 *   storage_images?: (Memory & { type: string, format: string })[] }} Description */
/** @typedef {{ buffer?: GPUBuffer, format?: GPUVertexFormat, stride?: number, offset?: number, perInstance?: boolean,
 *   constant?: number[] }} Source  Where an attribute comes from: a buffer, or one constant for all vertices. */
/** @typedef {{ format: GPUTextureFormat, test?: boolean, write?: boolean, compare?: GPUCompareFunction,
 *   bias?: number, slopeBias?: number, stencil?: object }} Depth  `bias` and `slopeBias` are the units and the factor
 *   of WebGL's polygonOffset. */
/** @typedef {{ vertices: Vertices, targets: (GPUTextureFormat | GPUColorTargetState)[], depth?: Depth,
 *   topology?: GPUPrimitiveTopology, indexFormat?: GPUIndexFormat, cull?: GPUCullMode, frontFace?: GPUFrontFace,
 *   samples?: number }} Options  As in WebGL, nothing is culled and front faces turn counterclockwise by default. */

/** The program that NAME.program.json describes; its shaders are read from the same folder.
 * @param {GPUDevice} device @param {string} url @param {Record<string, GPUTextureSampleType>} [sampleTypes]
 * @returns {Promise<Program>} */
export async function loadProgram(device, url, sampleTypes = {}) {
  const get = async (place) => {
    const answer = await fetch(place);
    if (!answer.ok) throw new Error(`${place}: ${answer.status}`);
    return answer;
  };
  const base = new URL(url, globalThis.location?.href);
  const description = await (await get(base)).json();
  const texts = await Promise.all(
    ['vertex', 'fragment'].map(async (stage) => (await get(new URL(description.stages[stage].file, base))).text()),
  );
  return new Program(device, description, { vertex: texts[0], fragment: texts[1] }, sampleTypes);
}

export class Program {
  /** @param {GPUDevice} device @param {Description} description @param {{ vertex: string, fragment: string }} texts
   * @param {Record<string, GPUTextureSampleType>} sampleTypes  'unfilterable-float' for a texture whose format cannot
   *   be filtered on this device, such as rgba32float, by its name in the shader */
  constructor(device, description, texts, sampleTypes = {}) {
    if (description.format !== 1) throw new Error(`this loader does not read format ${description.format}`);
    this.device = device;
    this.description = description;
    const { vertex, fragment } = description.stages;
    this.stages = {
      vertex: { module: device.createShaderModule({ code: texts.vertex, label: vertex.file }), entryPoint: vertex.entry },
      fragment: { module: device.createShaderModule({ code: texts.fragment, label: fragment.file }), entryPoint: fragment.entry },
    };
    for (const stage of ['vertex', 'fragment']) {
      const count = description.textures.filter(({ stages }) => stages.includes(stage)).length;
      const most = device.limits.maxSampledTexturesPerShaderStage;
      if (count > most) throw new Error(`${description.program}: ${count} textures in the ${stage} shader, but the device grants ${most}: request more, or let the engine use fewer`);
    }
    const visible = (/** @type {string[]} */ stages) => (stages.includes('vertex') ? 1 : 0) | (stages.includes('fragment') ? 2 : 0);
    const block = description.uniform_block;
    /** @type {GPUBindGroupLayoutEntry[]} */
    const entries = block ? [{ binding: block.binding, visibility: 3, buffer: {} }] : [];
    for (const texture of description.textures) {
      const { binding, dimension, sampler, multisampled } = texture, visibility = visible(texture.stages);
      const sampleType = sampleTypes[texture.name] ?? (texture.filterable || texture.sample_type !== 'float' ? texture.sample_type : 'unfilterable-float');
      entries.push({ binding: binding.texture, visibility, texture: { sampleType, viewDimension: dimension, multisampled } });
      const type = sampler === 'filtering' && sampleType !== 'float' ? 'non-filtering' : sampler;
      if (type) entries.push({ binding: binding.sampler, visibility, sampler: { type } });
    }
    for (const { binding, stages, access } of description.storage_buffers ?? [])
      entries.push({ ...binding, visibility: visible(stages), buffer: { type: access === 'readonly' ? 'read-only-storage' : 'storage' } });
    for (const { binding, stages, access, type, format } of description.storage_images ?? []) {
      const way = { readonly: 'read-only', writeonly: 'write-only' }[access] ?? 'read-write';
      entries.push({ ...binding, visibility: visible(stages), storageTexture: { access: way, format: formatOf(format), viewDimension: dimensionOf(type) } });
    }
    this.group = device.createBindGroupLayout({ entries, label: description.program });
    this.layout = device.createPipelineLayout({ bindGroupLayouts: [this.group] });
    /** @type {Map<string, Place>} */
    this.places = new Map();
    for (const uniform of description.uniforms) for (const [name, place] of placesOf(uniform)) this.places.set(name, place);
    /** @type {Map<string, GPURenderPipeline>} */
    this.pipelines = new Map();
    /** Whether a value is not interpolated: WebGL takes that of a triangle's last vertex, WebGPU that of its first. Then
     * give the indices to `lastVertexFirst`. */
    this.isFlat = description.varyings.some(({ interpolation }) => interpolation === 'flat');
  }

  /** Where the attributes come from; one that is left out has the constant of WebGL, (0, 0, 0, 1).
   * @param {Record<string, Source>} sources */
  vertices(sources) {
    return new Vertices(this, sources);
  }

  /** Uniforms and textures, all 0 and black at first. */
  values() {
    return new Values(this);
  }

  /** @param {Options} options @returns {GPURenderPipeline} */
  pipeline({ vertices, targets, depth, topology = 'triangle-list', indexFormat, cull = 'none', frontFace = 'ccw', samples = 1 }) {
    const isTurned = this.description.rows === 'bottom-first'; // then triangles turn the other way, too
    const strip = topology.endsWith('strip') && indexFormat ? { stripIndexFormat: indexFormat } : {};
    const colors = targets.map((target) => (typeof target === 'string' ? { format: target } : target));
    /** @type {GPURenderPipelineDescriptor} */
    const descriptor = {
      layout: this.layout,
      vertex: { ...this.stages.vertex, buffers: vertices.layouts },
      fragment: { ...this.stages.fragment, targets: colors },
      primitive: { topology, cullMode: cull, frontFace: (frontFace === 'ccw') === isTurned ? 'cw' : 'ccw', ...strip },
      multisample: { count: samples },
    };
    if (depth) {
      const { format, test = true, write = true, compare = 'less', bias = 0, slopeBias = 0, stencil = {} } = depth;
      const triangles = topology.startsWith('triangle');
      descriptor.depthStencil = {
        format, depthWriteEnabled: test && write, depthCompare: test ? compare : 'always', ...stencil,
        ...(triangles ? { depthBias: bias, depthBiasSlopeScale: slopeBias } : {}),
      };
    }
    const { layout, vertex, fragment, ...rest } = descriptor;
    const key = JSON.stringify([vertices.layouts, colors, rest]);
    const pipeline = this.pipelines.get(key) ?? this.device.createRenderPipeline(descriptor);
    this.pipelines.set(key, pipeline);
    return pipeline;
  }
}

export class Vertices {
  /** @param {Program} program @param {Record<string, Source>} sources */
  constructor(program, sources) {
    const { device, description } = program;
    /** @type {GPUVertexBufferLayout[]} */
    this.layouts = [];
    /** @type {{ buffer: GPUBuffer, offset: number }[]} */
    this.buffers = [];
    const slots = new Map(); // interleaved attributes share one
    const slotOf = (buffer, base, arrayStride, stepMode) => {
      const key = slots.get(buffer) ?? slots.set(buffer, {}).get(buffer), name = `${base} ${arrayStride} ${stepMode}`;
      if (!(name in key)) {
        key[name] = this.layouts.push({ arrayStride, stepMode, attributes: [] }) - 1;
        this.buffers.push({ buffer, offset: base });
      }
      return this.layouts[key[name]];
    };
    for (const { name, location, locations, format } of description.attributes) {
      const source = sources[name] ?? {};
      let { buffer, offset = 0, stride, perInstance = false } = source;
      const own = source.format ?? format, column = bytesOf(own);
      if (!buffer) {
        buffer = constantBuffer(device, own, locations, source.constant ?? [0, 0, 0, 1]);
        stride = 0;
      }
      stride ??= column * locations;
      if (stride % 4) throw new Error(`the attribute '${name}' has a stride of ${stride} bytes: WebGPU takes multiples of 4`);
      const base = stride ? Math.floor(offset / stride) * stride : 0;
      const slot = slotOf(buffer, base, stride, perInstance ? 'instance' : 'vertex');
      for (let index = 0; index < locations; index++)
        slot.attributes.push({ format: own, offset: offset - base + index * column, shaderLocation: location + index });
    }
    const most = device.limits.maxVertexBuffers;
    if (this.layouts.length > most) throw new Error(`${this.layouts.length} vertex buffers, but the device has ${most}: interleave attributes`);
  }

  /** @param {GPURenderPassEncoder} pass */
  bind(pass) {
    this.buffers.forEach(({ buffer, offset }, slot) => pass.setVertexBuffer(slot, buffer, offset));
  }
}

export class Values {
  /** @param {Program} program */
  constructor(program) {
    const { device, description } = program;
    this.program = program;
    this.data = new ArrayBuffer(description.uniform_block?.size ?? 0);
    this.floats = new Float32Array(this.data);
    this.integers = new Int32Array(this.data);
    this.buffer = description.uniform_block ? device.createBuffer({ size: this.data.byteLength, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST }) : undefined;
    /** @type {Map<string, { view: GPUTextureView, sampler?: GPUSampler }>} */
    this.resources = new Map();
    /** @type {Map<number, GPUBindingResource>} */
    this.memory = new Map();
    this.given = new Set();
    this.isChanged = true;
    this.bindGroup = null;
  }

  /** Sets a uniform: a number, a bool, or their components in an array, those of a matrix column by column. The name is
   * that of WebGL: `lights[1].color`, `weights`, `weights[2]`.
   * @param {string} name @param {number | boolean | ArrayLike<any>} value
   * @returns {boolean} whether the program has this uniform; it has none that its shaders do not read */
  set(name, value) {
    const place = find(this.program.places, name);
    if (!place) return false;
    const { type, count, offset, array_stride, matrix_stride } = place, { kind, columns, rows } = shapeOf(type);
    const numbers = typeof value === 'object' ? Array.from(value).flat(Infinity) : [value], one = columns * rows;
    if (numbers.length > count * one || numbers.length % one)
      throw new Error(`${name}: ${numbers.length} numbers for ${count > 1 ? `${count} of ` : ''}${type}`);
    const words = kind === 'float' ? this.floats : this.integers;
    for (let index = 0; index < numbers.length; index++) {
      const column = Math.floor((index % one) / rows), element = Math.floor(index / one);
      words[(offset + element * array_stride + column * matrix_stride) / 4 + (index % rows)] = Number(numbers[index]);
    }
    this.isChanged = true;
    this.given.add(place.uniform);
    return true;
  }

  /** The uniforms and textures that the program reads and that were never set: they are 0 and black.
   * @returns {string[]} */
  missing() {
    const { uniforms, textures } = this.program.description;
    const left = uniforms.filter(({ name }) => !this.given.has(name)), black = textures.filter(({ name }) => !this.resources.has(name));
    return [...left, ...black].map(({ name }) => name);
  }

  /** Sets the uniforms of a block from the bytes of WebGL's uniform buffer, in the layout std140.
   * @param {string} name  of the block, not of its instance @param {ArrayBuffer | ArrayBufferView} data
   * @returns {boolean} whether the program reads a member of it */
  setBlock(name, data) {
    const places = [...this.program.places.values()].filter(({ block }) => block?.name === name), view = ArrayBuffer.isView(data) ? data : new Uint8Array(data);
    const bytes = new DataView(view.buffer, view.byteOffset, view.byteLength), words = [];
    for (const { type, count, offset, array_stride, matrix_stride, block } of places) {
      if (!block) continue;
      const { columns, rows } = shapeOf(type);
      for (let index = 0; index < count * columns * rows; index++) {
        const element = Math.floor(index / (columns * rows)), column = Math.floor(index / rows) % columns, row = index % rows;
        const [line, place] = block.row_major ? [row, column] : [column, row];
        const from = block.offset + element * block.stride + line * block.matrix_stride + 4 * place;
        words.push([(offset + element * array_stride + column * matrix_stride) / 4 + row, from]);
      }
    }
    const needed = Math.max(0, ...words.map(([, from]) => from + 4));
    if (bytes.byteLength < needed) throw new Error(`${name}: ${bytes.byteLength} bytes, but its members need ${needed}`);
    for (const [to, from] of words) this.integers[to] = bytes.getInt32(from, true);
    for (const { uniform } of places) this.given.add(uniform);
    this.isChanged ||= places.length > 0;
    return places.length > 0;
  }

  /** Sets a texture and how it is read.
   * @param {string} name @param {GPUTexture | GPUTextureView} texture @param {GPUSampler} [sampler]
   * @returns {boolean} whether the program reads it */
  setTexture(name, texture, sampler) {
    const described = this.program.description.textures.find((each) => each.name === name);
    if (!described) return false;
    const isTexture = 'createView' in texture, isDepth = isTexture && texture.format.includes('depth');
    const view = isTexture ? texture.createView({ dimension: described.dimension, ...(isDepth ? { aspect: 'depth-only' } : {}) }) : texture;
    this.resources.set(name, { view, sampler });
    this.bindGroup = null;
    return true;
  }

  /** Sets a storage buffer. It has no counterpart in WebGL, and needs a value before it is drawn with.
   * @param {string} name  of the block, not of its instance @param {GPUBuffer} buffer
   * @returns {boolean} whether the program uses it */
  setBuffer(name, buffer) {
    return this.#setMemory(this.program.description.storage_buffers?.find(({ block }) => block === name), { buffer });
  }

  /** Sets an image, whose texels a shader loads and stores; as a storage buffer.
   * @param {string} name @param {GPUTexture} texture @param {number} [level]
   * @returns {boolean} whether the program uses it */
  setImage(name, texture, level = 0) {
    const described = this.program.description.storage_images?.find((each) => each.name === name);
    const view = described && texture.createView({ dimension: dimensionOf(described.type), baseMipLevel: level, mipLevelCount: 1 });
    return this.#setMemory(described, view);
  }

  /** @param {Memory | undefined} described @param {GPUBindingResource | undefined} resource */
  #setMemory(described, resource) {
    if (!described || !resource) return false;
    this.memory.set(described.binding.binding, resource);
    this.bindGroup = null;
    return true;
  }

  /** Sends what changed to the GPU, and binds it. The GPU sees the last values before `queue.submit`.
   * @param {GPURenderPassEncoder} pass */
  bind(pass) {
    const { device, description, group } = this.program, block = description.uniform_block, buffer = this.buffer;
    if (this.isChanged && buffer) device.queue.writeBuffer(buffer, 0, this.data);
    this.isChanged = false;
    if (!this.bindGroup) {
      /** @type {GPUBindGroupEntry[]} */
      const entries = block && buffer ? [{ binding: block.binding, resource: { buffer } }] : [];
      for (const { name, dimension, sample_type, sampler, multisampled, binding } of description.textures) {
        const given = this.resources.get(name);
        if (multisampled && !given) throw new Error(`${description.program}: '${name}' has no value: call setTexture with a texture of several samples`);
        entries.push({ binding: binding.texture, resource: given?.view ?? blackTexture(device, sample_type, dimension === '3d' ? '3d' : '2d').createView({ dimension }) });
        const own = sampler === 'non-filtering' ? null : given?.sampler; // its texels are read one by one
        if (sampler) entries.push({ binding: binding.sampler, resource: own ?? device.createSampler(sampler === 'comparison' ? { compare: 'less-equal' } : {}) });
      }
      for (const { name, binding } of [...(description.storage_buffers ?? []), ...(description.storage_images ?? [])]) {
        const resource = this.memory.get(binding.binding);
        if (!resource) throw new Error(`${description.program}: '${name}' has no value: call setBuffer or setImage`);
        entries.push({ ...binding, resource });
      }
      this.bindGroup = device.createBindGroup({ layout: group, entries });
    }
    pass.setBindGroup(0, this.bindGroup);
  }
}

/** Each name of a uniform, with its place: `lights[].color` with 2 lights has two.
 * @param {Uniform} uniform @returns {[string, Place][]} */
function placesOf({ name, type, lengths, offset, array_stride, matrix_stride, block }) {
  const parts = name.split('[]'), outer = parts.length - 1, count = lengths.slice(outer).reduce((a, b) => a * b, 1);
  /** @type {[string, number][]} */
  let places = [[parts[0], block?.offset ?? 0]];
  for (const [index, part] of parts.slice(1).entries())
    places = places.flatMap(([head, start]) =>
      Array.from({ length: lengths[index] }, (_, element) => [`${head}[${element}]${part}`, start + element * (block?.strides[index] ?? 0)]));
  return places.map(([each, start], index) => [each, {
    uniform: name, type, count, offset: offset + index * count * array_stride, array_stride, matrix_stride,
    ...(block ? { block: { ...block, offset: start, stride: block.strides.at(-1) ?? 0 } } : {}),
  }]);
}

/** @param {Map<string, Place>} places @param {string} name @returns {Place | undefined} */
function find(places, name) {
  const place = places.get(name), [, array, index] = /^(.*)\[(\d+)\]$/.exec(name) ?? [];
  if (place || array === undefined) return place;
  const whole = places.get(array), element = Number(index);
  if (!whole || element >= whole.count) return undefined;
  return { ...whole, count: whole.count - element, offset: whole.offset + element * whole.array_stride };
}

/** The kind of a type's numbers, its columns, and the rows of each.
 * @param {string} type */
function shapeOf(type) {
  const matrix = /^mat(\d)(?:x(\d))?$/.exec(type), vector = /^([biu]?)vec(\d)$/.exec(type);
  if (matrix) return { kind: 'float', columns: Number(matrix[1]), rows: Number(matrix[2] ?? matrix[1]) };
  const kind = vector ? { '': 'float', b: 'bool', i: 'int', u: 'uint' }[vector[1]] : type;
  return { kind, columns: 1, rows: vector ? Number(vector[2]) : 1 };
}

/** The view of an image of GLSL: `image2DArray`.
 * @param {string} type @returns {GPUTextureViewDimension} */
function dimensionOf(type) {
  return type.endsWith('3D') ? '3d' : type.endsWith('Array') ? '2d-array' : '2d';
}

/** The name of a format of GLSL in WebGPU: `rgba8` is `rgba8unorm`.
 * @param {string} format @returns {GPUTextureFormat} */
function formatOf(format) {
  const [, channels, end] = /^([a-z]+\d+)(.*)$/.exec(format) ?? [];
  return /** @type {GPUTextureFormat} */ (channels + { '': 'unorm', _snorm: 'snorm', f: 'float', i: 'sint', ui: 'uint' }[end]);
}

/** The bytes of a vertex format.
 * @param {string} format */
function bytesOf(format) {
  if (/10-10-10-2|unorm8x4-bgra/.test(format)) return 4;
  const [, bits, count = '1'] = /^[a-z]+(\d+)(?:x(\d))?$/.exec(format) ?? [];
  return (Number(bits) / 8) * Number(count);
}

/** @param {GPUDevice} device @param {GPUVertexFormat} format @param {number} locations @param {number[]} numbers */
function constantBuffer(device, format, locations, numbers) {
  const count = bytesOf(format) / 4, list = Array.from({ length: count * locations }, (_, index) => numbers[index] ?? (index % count === 3 ? 1 : 0));
  const data = format.startsWith('float') ? new Float32Array(list) : new Int32Array(list);
  const buffer = device.createBuffer({ size: data.byteLength, usage: GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(buffer, 0, data);
  return buffer;
}

const black = new WeakMap();

/** What WebGL reads of a texture that is not set: black and opaque. It has 6 layers, so that any view fits.
 * @param {GPUDevice} device @param {GPUTextureSampleType} sampleType @param {GPUTextureDimension} dimension */
function blackTexture(device, sampleType, dimension = '2d') {
  const textures = black.get(device) ?? black.set(device, {}).get(device), key = `${sampleType} ${dimension}`;
  if (textures[key]) return textures[key];
  const format = { float: 'rgba8unorm', depth: 'depth16unorm', sint: 'rgba32sint', uint: 'rgba32uint' }[sampleType];
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
  const texture = device.createTexture({ size: [1, 1, dimension === '3d' ? 1 : 6], format, usage, dimension });
  if (sampleType === 'float')
    for (let layer = 0; layer < texture.depthOrArrayLayers; layer++)
      device.queue.writeTexture({ texture, origin: [0, 0, layer] }, new Uint8Array([0, 0, 0, 255]), { bytesPerRow: 4 }, [1, 1, 1]);
  return (textures[key] = texture);
}

/** The indices of the same triangles or lines, each with its last vertex first; triangles turn as before. Strips become
 * lists, whose topology is then `triangle-list` or `line-list`.
 * @param {ArrayLike<number>} indices @param {GPUPrimitiveTopology} topology @returns {number[]} */
export function lastVertexFirst(indices, topology) {
  const size = topology.startsWith('triangle') ? 3 : topology.startsWith('line') ? 2 : 1, isStrip = topology.endsWith('strip'), order = [];
  for (let first = 0; first + size <= indices.length; first += isStrip ? 1 : size) {
    const corners = Array.from({ length: size }, (_, corner) => indices[first + corner]);
    if (isStrip && size === 3 && first % 2) [corners[0], corners[1]] = [corners[1], corners[0]];
    order.push(corners[size - 1], ...corners.slice(0, -1));
  }
  return order;
}

const COPY = /* wgsl */ `
@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var source_sampler: sampler;
struct Corner { @builtin(position) position: vec4f, @location(0) uv: vec2f }
@vertex fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let uv = vec2f(vec2u((index << 1u) & 2u, index & 2u));
    return Corner(vec4f(uv * 2.0 - 1.0, 0.0, 1.0), vec2f(uv.x, select(1.0 - uv.y, uv.y, TURNED)));
}
@fragment fn copied(corner: Corner) -> @location(0) vec4f { return textureSample(source, source_sampler, corner.uv); }
override TURNED: bool;
`;
const copies = new WeakMap();

/** Draws one texture into another.
 * @param {GPUDevice} device @param {GPUCommandEncoder} encoder @param {GPUTextureView} from @param {GPUTextureView} to
 * @param {GPUTextureFormat} format @param {boolean} isTurned @param {GPUFilterMode} filter */
function copy(device, encoder, from, to, format, isTurned, filter) {
  const made = copies.get(device) ?? copies.set(device, {}).get(device), key = `${format} ${isTurned}`;
  if (!made[key]) {
    const module = device.createShaderModule({ code: COPY });
    made[key] = device.createRenderPipeline({
      layout: 'auto',
      vertex: { module, constants: { TURNED: Number(isTurned) } },
      fragment: { module, targets: [{ format }] },
    });
  }
  const sampler = device.createSampler({ minFilter: filter, magFilter: filter });
  const entries = [{ binding: 0, resource: from }, { binding: 1, resource: sampler }];
  const pass = encoder.beginRenderPass({ colorAttachments: [{ view: to, loadOp: 'clear', storeOp: 'store' }] });
  pass.setPipeline(made[key]);
  pass.setBindGroup(0, device.createBindGroup({ layout: made[key].getBindGroupLayout(0), entries }));
  pass.draw(3);
  pass.end();
}

/** Shows a picture whose first row is its bottom, such as in `context.getCurrentTexture().createView()`.
 * @param {GPUDevice} device @param {GPUTexture} texture @param {GPUTextureView} view @param {GPUTextureFormat} format */
export function show(device, texture, view, format) {
  const encoder = device.createCommandEncoder();
  copy(device, encoder, texture.createView(), view, format, true, 'nearest');
  device.queue.submit([encoder.finish()]);
}

/** WebGL's generateMipmap, for all layers: each level is the mean of four texels of the one before.
 * @param {GPUDevice} device @param {GPUTexture} texture */
export function generateMipmaps(device, texture) {
  const encoder = device.createCommandEncoder();
  for (let layer = 0; layer < texture.depthOrArrayLayers; layer++)
    for (let level = 1; level < texture.mipLevelCount; level++) {
      const [from, to] = [level - 1, level].map((baseMipLevel) =>
        texture.createView({ dimension: '2d', baseMipLevel, mipLevelCount: 1, baseArrayLayer: layer, arrayLayerCount: 1 }));
      copy(device, encoder, from, to, texture.format, false, 'linear');
    }
  device.queue.submit([encoder.finish()]);
}
