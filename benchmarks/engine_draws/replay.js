// Draws in WebGPU what `record` recorded, with the programs that sssgen translated and the loader beside them.

import { Program, generateMipmaps, lastVertexFirst } from 'loader';

const TOPOLOGIES = ['point-list', 'line-list', 'line-strip', 'line-strip', 'triangle-list', 'triangle-strip'];
const COMPARES = { 0x200: 'never', 0x201: 'less', 0x202: 'equal', 0x203: 'less-equal', 0x204: 'greater', 0x205: 'not-equal', 0x206: 'greater-equal', 0x207: 'always' };
const FACTORS = {
  0: 'zero', 1: 'one', 0x300: 'src', 0x301: 'one-minus-src', 0x302: 'src-alpha', 0x303: 'one-minus-src-alpha', 0x304: 'dst-alpha', 0x305: 'one-minus-dst-alpha', 0x306: 'dst',
  0x307: 'one-minus-dst', 0x308: 'src-alpha-saturated', 0x8001: 'constant', 0x8002: 'one-minus-constant',
};
const OPERATIONS = { 0x8006: 'add', 0x800a: 'subtract', 0x800b: 'reverse-subtract', 0x8007: 'min', 0x8008: 'max' };
const WRAPS = { 0x2901: 'repeat', 0x812f: 'clamp-to-edge', 0x8370: 'mirror-repeat' };
const LINE_LOOP = 2;

/** The picture of the canvas, RGBA8, its bottom row first. */
export async function replay(device, { commands }, translated) {
  const programs = translated.map(({ description, vertex, fragment }) => new Program(device, description, { vertex, fragment }));
  const textures = new Map(), samplers = new Map();
  const { COPY_DST, COPY_SRC, RENDER_ATTACHMENT, TEXTURE_BINDING } = GPUTextureUsage;
  const textureOf = ({ id, format, size, levels, samples = 1, target = '2d' }) => {
    if (!textures.has(id)) {
      const usage = COPY_DST | COPY_SRC | TEXTURE_BINDING | (target === '3d' ? 0 : RENDER_ATTACHMENT);
      textures.set(id, device.createTexture({ size, format, mipLevelCount: levels, sampleCount: samples, dimension: target, usage: samples > 1 ? RENDER_ATTACHMENT | TEXTURE_BINDING : usage }));
    }
    return textures.get(id);
  };
  const viewOf = (part) => textureOf(part).createView({ dimension: '2d', baseMipLevel: part.level, mipLevelCount: 1, baseArrayLayer: part.layer, arrayLayerCount: 1 });
  const samplerOf = ({ min, mag, wrap, compare, anisotropy }) => {
    const key = JSON.stringify([min, mag, wrap, compare, anisotropy]);
    if (!samplers.has(key)) {
      const linear = min === 0x2601 || min === 0x2701 || min === 0x2703, mips = min >= 0x2700, between = min === 0x2702 || min === 0x2703 || (linear && !mips); // anisotropy wants it, also without levels
      const maxAnisotropy = linear && between && mag === 0x2601 ? anisotropy : 1;
      samplers.set(key, device.createSampler({
        minFilter: linear ? 'linear' : 'nearest', magFilter: mag === 0x2601 ? 'linear' : 'nearest', mipmapFilter: between ? 'linear' : 'nearest', ...(mips ? {} : { lodMaxClamp: 0 }), maxAnisotropy,
        addressModeU: WRAPS[wrap[0]], addressModeV: WRAPS[wrap[1]], addressModeW: WRAPS[wrap[2]], ...(compare ? { compare: COMPARES[compare] } : {}),
      }));
    }
    return samplers.get(key);
  };
  const bufferOf = (data, usage) => {
    const buffer = device.createBuffer({ size: Math.ceil(data.byteLength / 4) * 4, usage, mappedAtCreation: true });
    new data.constructor(buffer.getMappedRange()).set(data);
    buffer.unmap();
    return buffer;
  };
  const attachments = (into, { color = null, depth = null, isClearing = false, resolve = null } = {}) => ({
    colorAttachments: into.colors.map((part, index) => part && {
      view: viewOf(part), loadOp: color ? 'clear' : 'load', storeOp: 'store', ...(color ? { clearValue: color } : {}), ...(resolve ? { resolveTarget: viewOf(resolve.colors[index]) } : {}),
    }),
    ...(into.depth && !resolve ? {
      depthStencilAttachment: {
        view: viewOf(into.depth), depthLoadOp: isClearing && depth !== null ? 'clear' : 'load', depthStoreOp: 'store', depthClearValue: depth ?? 1,
        ...(into.depth.format.includes('stencil') ? { stencilLoadOp: 'load', stencilStoreOp: 'store' } : {}),
      },
    } : {}),
  });
  const pass = (descriptor, action = () => {}) => {
    const encoder = device.createCommandEncoder(), render = encoder.beginRenderPass(descriptor);
    action(render);
    render.end();
    device.queue.submit([encoder.finish()]);
  };

  const draw = (command) => {
    const program = programs[command.program], values = program.values(), sources = {}, topology = TOPOLOGIES[command.topology];
    if (!topology) throw new Error(`WebGPU has no triangle fans`);
    for (const [name, value] of Object.entries(command.uniforms)) values.set(name, value);
    for (const [name, bytes] of Object.entries(command.blocks)) values.setBlock(name, bytes);
    for (const [name, texture] of Object.entries(command.textures)) if (texture) values.setTexture(name, textureOf(texture), samplerOf(texture));
    for (const [name, columns] of Object.entries(command.attributes)) {
      if (columns[0].constant) sources[name] = { constant: columns.flatMap(({ constant }) => constant) };
      else sources[name] = attribute(columns);
    }
    const vertices = program.vertices(sources);
    let order = command.index;
    const inOrder = () => Array.from({ length: command.count }, (_, vertex) => command.first + vertex);
    if (command.topology === LINE_LOOP) order = [...(order ?? inOrder()), order?.[0] ?? command.first];
    if (program.isFlat) order = lastVertexFirst(order ?? inOrder(), topology);
    const { into, depth, blend, mask } = command, component = ([source, target, operation]) => ({ srcFactor: FACTORS[source], dstFactor: FACTORS[target], operation: OPERATIONS[operation] });
    const writeMask = mask.reduce((sum, is, bit) => sum | (is ? 1 << bit : 0), 0);
    const pipeline = program.pipeline({
      vertices, topology: program.isFlat ? topology.replace('strip', 'list') : topology, indexFormat: order ? 'uint32' : undefined, samples: (into.colors[0] ?? into.depth).samples,
      targets: into.colors.map((part) => part && { format: part.format, writeMask, ...(blend ? { blend: { color: component(blend.color), alpha: component(blend.alpha) } } : {}) }),
      depth: into.depth ? { format: into.depth.format, test: depth.test, write: depth.write, compare: COMPARES[depth.compare], bias: depth.bias[0], slopeBias: depth.bias[1] } : undefined,
      cull: { 0: 'none', 0x404: 'front', 0x405: 'back' }[command.cull], frontFace: command.front === 0x901 ? 'ccw' : 'cw',
    });
    pass(attachments(into), (render) => {
      const [x, y, width, height] = command.viewport;
      render.setViewport(x, y, width, height, ...command.depthRange);
      if (command.scissor) render.setScissorRect(...command.scissor);
      render.setBlendConstant(command.color);
      render.setPipeline(pipeline);
      vertices.bind(render);
      values.bind(render);
      if (order) {
        render.setIndexBuffer(bufferOf(new Uint32Array(order), GPUBufferUsage.INDEX), 'uint32');
        render.drawIndexed(order.length, command.instances);
      } else render.draw(command.count, command.instances, command.first);
    });
  };

  /** The columns of one attribute, one buffer with all columns of a vertex together. */
  const attribute = (columns) => {
    const key = columns[0].data, { size, divisor, isInteger } = columns[0], count = key.length / size, stride = size * columns.length;
    if (divisor > 1) throw new Error(`WebGPU advances by one instance, not by ${divisor}`);
    let data = key;
    if (columns.length > 1) {
      data = new key.constructor(count * stride);
      columns.forEach((column, number) => { for (let i = 0; i < count; i++) for (let part = 0; part < size; part++) data[i * stride + number * size + part] = column.data[i * size + part]; });
    }
    const kind = isInteger ? (data instanceof Uint32Array ? 'uint32' : 'sint32') : 'float32';
    return { buffer: bufferOf(data, GPUBufferUsage.VERTEX), format: size > 1 ? `${kind}x${size}` : kind, stride: 4 * stride, perInstance: divisor === 1 };
  };

  for (const command of commands) {
    if (command.kind === 'texels') {
      const texture = textureOf({ ...command, id: command.texture });
      for (const { level, layer, size, data } of command.texels)
        device.queue.writeTexture({ texture, mipLevel: level, origin: [0, 0, layer] }, data, { bytesPerRow: size[0] * command.bytes }, [...size, 1]);
    } else if (command.kind === 'mipmaps') generateMipmaps(device, textures.get(command.texture));
    else if (command.kind === 'clear') pass(attachments(command.into, { ...command, isClearing: true }));
    else if (command.kind === 'resolve') {
      if (!command.color) continue;
      if (command.from.colors[0].samples > 1) pass(attachments(command.from, { resolve: command.into }));
      else throw new Error('copies between framebuffers are not replayed');
    } else draw(command);
  }
  const canvas = textures.get('canvas'), { width, height } = canvas, stride = Math.ceil((width * 4) / 256) * 256;
  const encoder = device.createCommandEncoder(), buffer = device.createBuffer({ size: stride * height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
  encoder.copyTextureToBuffer({ texture: canvas }, { buffer, bytesPerRow: stride }, [width, height]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const rows = new Uint8Array(buffer.getMappedRange()), picture = new Uint8Array(width * height * 4);
  for (let row = 0; row < height; row++) picture.set(rows.subarray(row * stride, row * stride + width * 4), row * width * 4);
  return picture;
}
