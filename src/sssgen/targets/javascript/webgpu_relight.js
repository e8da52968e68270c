// The sum of inner_light.js on a GPU with WebGPU: one invocation sums the light of a voxel that counts, another one writes a texel.

import { fromHalf } from './inner_light.js';

const WORKGROUP = 64;

/** The compute shader. Bytes come in groups of four, of a voxel's numbers or of its directions. */
export const RELIGHT = /* wgsl */ `
struct Light {
  place: vec4f,  // in object space: where it is, with w = 1, or the direction towards it
  color: vec4f,  // the irradiance on a plane that faces it, of a near light at the distance 1
}
struct Frame {
  model: mat4x4f,
  low: vec4f,
  step: vec4f,  // the size of a voxel
  size: vec4u,  // the texels, and the count of lights
  counts: vec4u,  // voxels, groups of numbers, directions along the side of a map, 1 if one is of light that is not scattered
  surroundings: array<vec4f, 9>,  // the integrals of the light times the harmonics
  lights: array<Light>,
}
struct Corners { texels: vec4u, weights: vec4f }

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> latents: array<u32>;
@group(0) @binding(3) var<storage, read> table: array<vec4f>;
@group(0) @binding(4) var<storage, read> arriving: array<u32>;
@group(0) @binding(5) var<storage, read> around: array<vec4f>;
@group(0) @binding(6) var<storage, read> shares: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> sums: array<vec4f>;
@group(0) @binding(8) var<storage, read> nearest: array<u32>;
@group(0) @binding(9) var<storage, read> light: array<vec4f>;
@group(0) @binding(10) var volume: texture_storage_3d<rgba16float, write>;

// Beyond an edge of an octahedral map lies the same edge, reversed.
fn texel_of(column: i32, row: i32, side: i32) -> u32 {
  let beside = column < 0 || column >= side;
  let above = row < 0 || row >= side;
  let x = select(column, side - 1 - column, above && !beside);
  let y = select(row, side - 1 - row, beside && !above);
  return u32(clamp(y, 0, side - 1) * side + clamp(x, 0, side - 1));
}

// The four texels around a direction of any length.
fn corners_of(way: vec3f, side: i32) -> Corners {
  let whole = max(abs(way.x) + abs(way.y) + abs(way.z), 1e-20);
  var at = way.xy / whole;
  if (way.z < 0.0) {
    at = (1.0 - abs(at.yx)) * select(vec2f(1.0), vec2f(-1.0), way.xy < vec2f(0.0));
  }
  let place = (0.5 * at + 0.5) * f32(side) - 0.5;
  let low = floor(place);
  let part = place - low;
  let x = i32(low.x);
  let y = i32(low.y);
  return Corners(
    vec4u(texel_of(x, y, side), texel_of(x + 1, y, side), texel_of(x, y + 1, side), texel_of(x + 1, y + 1, side)),
    vec4f((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y),
  );
}

// A row of the table for a direction.
fn row_of(corners: Corners, number: u32) -> vec3f {
  let first = corners.texels * (4u * frame.counts.y + 1u) + number;
  return corners.weights.x * table[first.x].xyz + corners.weights.y * table[first.y].xyz
    + corners.weights.z * table[first.z].xyz + corners.weights.w * table[first.w].xyz;
}

fn root_of(index: u32) -> f32 {
  return f32((arriving[index / 4u] >> (8u * (index % 4u))) & 255u);
}

@compute @workgroup_size(${WORKGROUP})
fn light_up(@builtin(global_invocation_id) id: vec3u) {
  let voxel = id.x;
  if (voxel >= frame.counts.x) {
    return;
  }
  let cell = cells[voxel];
  let place = vec3u(cell % frame.size.x, cell / frame.size.x % frame.size.y, cell / (frame.size.x * frame.size.y));
  let at = frame.low.xyz + (vec3f(place) + 0.5) * frame.step.xyz;
  var total = vec3f(0.0);
  for (var harmonic = 0u; harmonic < 9u; harmonic++) {
    total += frame.surroundings[harmonic].xyz * around[harmonic * frame.counts.x + voxel].xyz;
  }
  for (var number = 0u; number < frame.size.w; number++) {
    let lamp = frame.lights[number];
    let way = lamp.place.xyz - lamp.place.w * at;
    let away = max(length((frame.model * vec4f(way, 0.0)).xyz), 0.01);
    let corners = corners_of(way, i32(frame.counts.z));
    var scattered = row_of(corners, 0u);
    for (var group = 0u; group < frame.counts.y; group++) {
      let weights = unpack4x8unorm(latents[group * frame.counts.x + voxel]);
      let row = 4u * group + 1u;
      scattered += weights.x * row_of(corners, row) + weights.y * row_of(corners, row + 1u)
        + weights.z * row_of(corners, row + 2u) + weights.w * row_of(corners, row + 3u);
    }
    if (frame.counts.w > 0u) {
      let first = voxel * frame.counts.z * frame.counts.z + corners.texels;
      let roots = vec4f(root_of(first.x), root_of(first.y), root_of(first.z), root_of(first.w));
      scattered += shares[u32(dot(corners.weights, roots) + 0.5)].xyz;
    }
    total += lamp.color.xyz * select(1.0, 1.0 / (away * away), lamp.place.w > 0.0) * scattered;
  }
  sums[voxel] = vec4f(clamp(total, vec3f(0.0), vec3f(65504.0)), 0.0);
}

// The distance from the surface is in the eight high bits.
@compute @workgroup_size(${WORKGROUP})
fn show(@builtin(global_invocation_id) id: vec3u) {
  let size = textureDimensions(volume);
  let texel = id.x;
  if (texel >= size.x * size.y * size.z) {
    return;
  }
  let place = vec3u(texel % size.x, texel / size.x % size.y, texel / (size.x * size.y));
  let stored = nearest[texel];
  textureStore(volume, place, vec4f(light[stored & 0xffffffu].xyz, f32(stored >> 24u) / 255.0));
}
`;

/** Numbers of three channels in groups of four, for vec4f. @param {ArrayLike<number>} numbers @param {number} count of the groups */
const padded = (numbers, count) => Float32Array.from({ length: 4 * count }, (_, at) => (at % 4 < 3 ? numbers[3 * (at >> 2) + (at % 4)] : 0));

/** What does not change with the light, by binding: the data of a response. @param {import('./inner_light.js').LightResponse} response */
function dataOf(response) {
  const { count, rank, cells, latents, table, arriving, around, largest, shares, side } = response, groups = Math.ceil(rank / 4);
  const bytes = new Uint8Array(4 * groups * count);
  for (let number = 0; number < rank; number++) {
    for (let voxel = 0; voxel < count; voxel++) bytes[4 * ((number >> 2) * count + voxel) + (number % 4)] = latents[number * count + voxel];
  }
  const rows = new Float32Array(4 * side * side * (4 * groups + 1));
  for (let direction = 0; direction < side * side; direction++) {
    for (let row = 0; row <= rank; row++) {
      for (let channel = 0; channel < 3; channel++) {
        rows[4 * (direction * (4 * groups + 1) + row) + channel] = table[3 * (direction * (rank + 1) + row) + channel];
      }
    }
  }
  const roots = new Uint8Array(4 * Math.max(Math.ceil(arriving.length / 4), 1));
  roots.set(arriving);
  const weights = new Float32Array(4 * 9 * count);
  for (let harmonic = 0; harmonic < 9; harmonic++) {
    for (let channel = 0; channel < 3; channel++) {
      for (let voxel = 0; voxel < count; voxel++) {
        weights[4 * (harmonic * count + voxel) + channel] = (around[(3 * harmonic + channel) * count + voxel] * largest[harmonic][channel]) / 127;
      }
    }
  }
  const light = padded(Array.from({ length: 768 }, (_, at) => shares[at % 3][Math.floor(at / 3)]), 256);
  return [Uint32Array.from(cells), bytes, rows, roots, weights, light];
}

/** Sums the light inside a body into a texture. */
export class Relight {
  /** @param {GPUDevice} device @param {import('./inner_light.js').LightResponse} response @param {GPUTexture} texture */
  constructor(device, response, texture) {
    if (response.arriving.length && response.arrivingSide !== response.side) throw new TypeError('this bake has maps of two sizes: bake it again');
    this.device = device;
    this.response = response;
    const module = device.createShaderModule({ label: 'inner light', code: RELIGHT });
    const pipelineOf = (entryPoint) => device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint } });
    this.lightUp = pipelineOf('light_up');
    this.show = pipelineOf('show');
    const bufferOf = (/** @type {ArrayBufferView} */ data) => {
      const buffer = device.createBuffer({ size: data.byteLength, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
      device.queue.writeBuffer(buffer, 0, data.buffer, data.byteOffset, data.byteLength);
      return buffer;
    };
    const distance = response.distance.map((half) => Math.round(255 * fromHalf(half)));
    const nearest = Uint32Array.from(response.nearest, (voxel, texel) => (voxel | (distance[texel] << 24)) >>> 0);
    const sums = device.createBuffer({ size: 16 * response.count, usage: GPUBufferUsage.STORAGE });
    this.buffers = [...dataOf(response).map(bufferOf), sums];
    this.frame = device.createBuffer({ size: 16, usage: GPUBufferUsage.STORAGE });
    this.texels = bufferOf(nearest);
    const resources = [this.texels, sums].map((buffer) => ({ buffer }));
    this.written = device.createBindGroup({
      layout: this.show.getBindGroupLayout(0),
      entries: [...resources, texture.createView()].map((resource, number) => ({ binding: 8 + number, resource })),
    });
  }

  /**
   * @param {number[]} model
   * @param {{ directional: boolean, place: number[], color: number[] }[]} lamps in object space; near ones fall off by the square
   * @param {number[][]} surroundings for each harmonic the integrals of the light
   */
  compute(model, lamps, surroundings) {
    const { response, device } = this, { count, rank, side, arriving, low, size, width, height, depth } = response;
    const floats = new Float32Array(32 + 36 + 8 * Math.max(lamps.length, 1)), whole = new Uint32Array(floats.buffer);
    floats.set([...model, ...low, 0, size[0] / width, size[1] / height, size[2] / depth, 0]);
    whole.set([width, height, depth, lamps.length, count, Math.ceil(rank / 4), side, Number(arriving.length > 0)], 24);
    surroundings.forEach((color, harmonic) => floats.set(color, 32 + 4 * harmonic));
    lamps.forEach(({ directional, place, color }, number) => floats.set([...place, Number(!directional), ...color, 0], 68 + 8 * number));
    if (this.frame.size < floats.byteLength) {
      this.frame.destroy();
      this.frame = device.createBuffer({ size: floats.byteLength, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
    }
    device.queue.writeBuffer(this.frame, 0, floats);
    const group = device.createBindGroup({
      layout: this.lightUp.getBindGroupLayout(0), entries: [this.frame, ...this.buffers].map((buffer, binding) => ({ binding, resource: { buffer } })),
    });
    const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
    pass.setPipeline(this.lightUp);
    pass.setBindGroup(0, group);
    pass.dispatchWorkgroups(Math.ceil(count / WORKGROUP));
    pass.setPipeline(this.show);
    pass.setBindGroup(0, this.written);
    pass.dispatchWorkgroups(Math.ceil((width * height * depth) / WORKGROUP));
    pass.end();
    device.queue.submit([encoder.finish()]);
  }
  /** Frees the buffers. */
  destroy() {
    [...this.buffers, this.texels, this.frame].forEach((buffer) => buffer.destroy());
  }
}
