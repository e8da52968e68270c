// An emitted material in WebGPU. What differs from one material to the next is read from the reflection.
// The shell's own blocks are the same for all (docs/templates.md): camera and lights in group 0, the object in group 2.

const TEXELS = { white: [255, 255, 255, 255], black: [0, 0, 0, 255], gray: [128, 128, 128, 255], bump: [128, 128, 255, 255] };
const dimensionOf = (type) => type.slice('sampler'.length).toLowerCase();
const BYTES = { camera: 144, lights: 144, object: 128 };
/** Of a mesh: position 3, normal 3, tangent 3 and its handedness, uv 2. */
export const LAYOUT = [{
  arrayStride: 48,
  attributes: [['float32x3', 0], ['float32x3', 12], ['float32x4', 24], ['float32x2', 40]].map(([format, offset], shaderLocation) => ({ format, offset, shaderLocation })),
}];

/** What `sssgen emit NAME --target wgsl -o FOLDER` wrote: the text, the reflection, and what draws the passes of a material that has some. */
export async function load(folder, name) {
  const get = async (file) => {
    const answer = await fetch(`${folder}/${file}`);
    if (!answer.ok) throw new Error(`${file}: ${answer.status}. Run: sssgen emit ${name} --target wgsl -o out`);
    return answer.text();
  };
  const wgsl = await get(`${name}.wgsl`), reflection = JSON.parse(await get(`${name}.wgsl.reflection.json`));
  const drawn = reflection.passes.some(({ of }) => of !== 'surroundings');
  const runtime = drawn ? await import(new URL(`${folder}/sssgen-webgpu.js`, location.href).href) : undefined;
  return { wgsl, reflection, createPasses: runtime?.createPasses };
}

export class Material {
  /** `format` is that of the view it draws into: an -srgb one, where `reflection.color` is linear. `count`: its samples. */
  constructor(device, { wgsl, reflection }, format, count = 1) {
    this.device = device;
    this.reflection = reflection;
    this.screen = reflection.raymarched; // one triangle over the screen, no mesh
    this.buffers = Object.fromEntries(Object.entries(BYTES).map(([name, size]) => [name, this.#uniforms(size)]));
    this.buffers.material = this.#uniforms(Math.max(16, reflection.uniform_block_size ?? 0));
    this.textures = {};
    for (const uniform of reflection.uniforms) this.set(uniform.name, uniform.default);
    for (const texture of reflection.textures) this.#texel(texture);

    const { VERTEX, FRAGMENT } = GPUShaderStage;
    const block = (binding) => ({ binding, visibility: VERTEX | FRAGMENT, buffer: {} });
    const pairs = reflection.textures.flatMap(({ type, binding }) => [
      { binding: binding.texture, visibility: FRAGMENT, texture: { viewDimension: dimensionOf(type) } },
      { binding: binding.sampler, visibility: FRAGMENT, sampler: {} },
    ]);
    this.layouts = [[block(0), block(1)], [...(reflection.uniforms.length ? [block(0)] : []), ...pairs], [block(0)]]
      .map((entries) => device.createBindGroupLayout({ entries }));
    const module = device.createShaderModule({ code: wgsl });
    const { vertex, fragment } = reflection.files[0].stages;
    this.pipeline = device.createRenderPipeline({
      layout: device.createPipelineLayout({ bindGroupLayouts: this.layouts }),
      vertex: { module, entryPoint: vertex, buffers: this.screen ? [] : LAYOUT },
      fragment: { module, entryPoint: fragment, targets: [{ format }] },
      primitive: { topology: 'triangle-list', cullMode: 'none' },
      depthStencil: { format: 'depth24plus', depthWriteEnabled: true, depthCompare: this.screen ? 'always' : 'less' },
      multisample: { count },
    });
  }

  #uniforms(size) {
    return this.device.createBuffer({ size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  }

  #texel({ name, type, default: texel }) {
    const dimension = type === 'sampler3D' ? '3d' : '2d';
    const size = [1, 1, type === 'samplerCube' ? 6 : 1];
    const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
    const texture = this.device.createTexture({ size, dimension, format: 'rgba8unorm', usage });
    const data = new Uint8Array(Array(size[2]).fill(TEXELS[texel]).flat());
    this.device.queue.writeTexture({ texture }, data, { bytesPerRow: 4, rowsPerImage: 1 }, size);
    this.texture(name, texture);
  }

  /** Sets a parameter: a list of its components. A matrix is given by its columns. */
  set(name, value) {
    const { type, offset } = this.reflection.uniforms.find((uniform) => uniform.name === name);
    const kind = /^(u|b|i)/.exec(type)?.[1];
    const List = kind === 'u' ? Uint32Array : kind ? Int32Array : Float32Array;
    const column = /^mat(\d)/.exec(type) ? Number(type[3]) : value.length;
    for (let at = 0, place = offset; at < value.length; at += column, place += 16)
      this.device.queue.writeBuffer(this.buffers.material, place, new List(value.slice(at, at + column)));
  }

  /** Sets a texture to a picture: a canvas or an ImageBitmap, its lower edge at v = 0. */
  picture(name, source) {
    const format = this.reflection.textures.find((one) => one.name === name).color_space === 'sRGB' ? 'rgba8unorm-srgb' : 'rgba8unorm';
    const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST | GPUTextureUsage.RENDER_ATTACHMENT;
    const texture = this.device.createTexture({ size: [source.width, source.height], format, usage });
    this.device.queue.copyExternalImageToTexture({ source, flipY: true }, { texture }, [source.width, source.height]);
    this.texture(name, texture);
  }

  /** Sets a texture; without a sampler, it is read as its technique declares. */
  texture(name, texture, sampler = this.#sampler(name)) {
    if (this.textures[name]?.texture !== texture) this.groups = undefined;
    this.textures[name] = { texture, sampler };
  }

  #sampler(name) {
    const { wrap } = this.reflection.textures.find((one) => one.name === name).import;
    const mode = wrap === 'clamp' ? 'clamp-to-edge' : 'repeat';
    return this.device.createSampler({ addressModeU: mode, addressModeV: mode, addressModeW: mode, minFilter: 'linear', magFilter: 'linear' });
  }

  /** Sets what the passes have drawn, as far as the material reads it. */
  show({ textures, samplers, values }) {
    const has = (list, name) => list.some((declared) => declared.name === name);
    for (const name in textures) if (has(this.reflection.textures, name)) this.texture(name, textures[name], samplers[name]);
    for (const name in values) if (has(this.reflection.uniforms, name)) this.set(name, values[name]);
  }

  /** Writes the shell's blocks. Matrices are 16 numbers, column by column; a light is { position: [x, y, z, w], color }. */
  view({ viewProjection, inverseViewProjection, position, time, ambient, lights, model, inverseModel }) {
    const write = (name, numbers) => this.device.queue.writeBuffer(this.buffers[name], 0, new Float32Array(numbers));
    write('camera', [...viewProjection, ...inverseViewProjection, ...position, time]);
    const four = (list) => [...list.flat(), ...Array(16).fill(0)].slice(0, 16);
    write('lights', [...ambient, 0, ...four(lights.map((light) => light.position)), ...four(lights.map((light) => [...light.color, 0]))]);
    this.device.queue.writeBuffer(this.buffers.lights, 12, new Int32Array([lights.length]));
    write('object', [...model, ...inverseModel]);
  }

  draw(pass, mesh) {
    this.groups ??= this.#groups();
    pass.setPipeline(this.pipeline);
    this.groups.forEach((group, index) => pass.setBindGroup(index, group));
    if (this.screen) return pass.draw(3);
    pass.setVertexBuffer(0, mesh.buffers[0]);
    pass.setIndexBuffer(mesh.triangles, 'uint32');
    pass.drawIndexed(mesh.count);
  }

  #groups() {
    const block = (binding, name) => ({ binding, resource: { buffer: this.buffers[name] } });
    const material = this.reflection.uniforms.length ? [block(0, 'material')] : [];
    for (const { name, type, binding } of this.reflection.textures) {
      const { texture, sampler } = this.textures[name];
      const view = texture.createView({ dimension: dimensionOf(type) });
      material.push({ binding: binding.texture, resource: view }, { binding: binding.sampler, resource: sampler });
    }
    return [[block(0, 'camera'), block(1, 'lights')], material, [block(0, 'object')]]
      .map((entries, index) => this.device.createBindGroup({ layout: this.layouts[index], entries }));
  }
}
