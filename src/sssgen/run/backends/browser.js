// The page of the `browser` back end: it carries out plans (webgpu_plan.py) that come through a WebSocket.
//
// A message pair each way: a text of JSON, then bytes. In a plan, `{at, size}` stands for a piece of its bytes. When the
// connection ends, the page closes, and with it the browser.

/** @typedef {{ at: number, size: number }} Piece */
/** @typedef {(place: Piece) => Uint8Array} PieceOf */
/** @typedef {<T extends { destroy(): void }>(resource: T) => T} Keep  Destroys it after the picture. */
/** @typedef {{ group: number, binding: number, sampler: number, view: GPUTextureViewDimension, filter: GPUFilterMode,
 *   between: GPUMipmapFilterMode, wrap: GPUAddressMode, compare: GPUCompareFunction | '', format: GPUTextureFormat, dimension: GPUTextureDimension, bytes_per_texel: number,
 *   levels: { size: number[], data: Piece }[] }} Texture */
/** @typedef {{ code: string, vertex_code: string, vertex: string, fragment: string, format: GPUTextureFormat, groups: GPUBindGroupLayoutEntry[][],
 *   attributes: GPUVertexAttribute[], stride: number, width: number, height: number, vertices: Piece, triangles: Piece,
 *   blocks: { group: number, binding: number, data: Piece }[], textures: Texture[] }} Plan  As webgpu_plan.py describes it. */
/** @typedef {{ pipeline: GPURenderPipeline, layouts: GPUBindGroupLayout[] }} Pipeline */

const KEPT = 64;
const ROW = 256; // bytesPerRow of a copy into a buffer is a multiple of this
/** @type {GPUErrorFilter[]} */
const SCOPES = ["validation", "out-of-memory", "internal"];
/** @type {(keyof GPUSupportedLimits)[]} */
const LIMITS = ["maxTextureDimension2D", "maxTextureDimension3D", "maxBufferSize", "maxUniformBufferBindingSize"];

/** @type {GPUDevice} */
let device;
/** @type {string | undefined} */
let lost; // why the device is gone
/** @type {Map<string, Pipeline>} */
const pipelines = new Map(); // the oldest first

async function start() {
  const adapter = await navigator.gpu?.requestAdapter({ powerPreference: "high-performance" });
  if (!adapter) return { error: "its WebGPU has no adapter" };
  const requiredLimits = Object.fromEntries(LIMITS.map((name) => [name, adapter.limits[name]]));
  device = await adapter.requestDevice({ requiredLimits });
  device.lost.then((info) => { lost = info.message || info.reason; });
  const version = await browserVersion();
  const { description, device: chip, architecture } = adapter.info;
  return { version, adapter: description || chip || architecture };
}

async function browserVersion() {
  /** @type {any} */
  const { userAgentData } = navigator; // Chromium's
  const detail = await userAgentData?.getHighEntropyValues(["fullVersionList"]);
  const chromium = detail?.fullVersionList.find(({ brand }) => brand === "Chromium");
  return chromium?.version ?? navigator.userAgent.match(/Firefox\/(\S+)/)?.[1] ?? "";
}

/** What a plan gives: `{stride}` and the picture, its rows `stride` bytes apart; `{messages}` where the text is refused;
 * `{error}` where a step is; `{lost}` where the device is gone.
 * @param {Plan} plan @param {Uint8Array} bytes @returns {Promise<[any, ArrayBuffer?]>} */
async function carryOut(plan, bytes) {
  /** @type {{ destroy(): void }[]} */
  const made = [];
  /** @type {Keep} */
  const keep = (one) => {
    made.push(one);
    return one;
  };
  SCOPES.forEach((scope) => device.pushErrorScope(scope));
  let answer;
  try {
    answer = await draw(plan, ({ at, size }) => bytes.subarray(at, at + size), keep);
  } catch (error) {
    answer = [{ error: `${error.name}: ${error.message}` }];
  }
  const errors = await Promise.all(SCOPES.map(() => device.popErrorScope().catch(() => null)));
  made.forEach((one) => one.destroy());
  if (lost !== undefined) return [{ lost }];
  const error = errors.find((one) => one);
  return error && !answer[0].messages ? [{ error: error.message }] : answer;
}

/** @param {Plan} plan @param {PieceOf} piece @param {Keep} keep @returns {Promise<[any, ArrayBuffer?]>} */
async function draw(plan, piece, keep) {
  const known = await pipelineFor(plan);
  if (!known.pipeline) return [{ messages: known.messages }];
  const { pipeline, layouts } = known;
  const size = [plan.width, plan.height];
  const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
  const target = keep(device.createTexture({ size, format: plan.format, usage }));
  const encoder = device.createCommandEncoder();
  /** @type {GPURenderPassColorAttachment} */
  const attachment = { view: target.createView(), loadOp: "clear", storeOp: "store" };
  const pass = encoder.beginRenderPass({ colorAttachments: [attachment] });
  pass.setPipeline(pipeline);
  const groups = layouts.map(() => []);
  bindBlocks(plan, groups, piece, keep);
  bindTextures(plan, groups, piece, keep);
  groups.forEach((entries, i) => pass.setBindGroup(i, device.createBindGroup({ layout: layouts[i], entries })));
  if (plan.triangles.size) {
    pass.setVertexBuffer(0, keep(filled(piece(plan.vertices), GPUBufferUsage.VERTEX)));
    pass.setIndexBuffer(keep(filled(piece(plan.triangles), GPUBufferUsage.INDEX)), "uint32");
    pass.drawIndexed(plan.triangles.size / 4);
  } else {
    pass.draw(3);
  }
  pass.end();
  const stride = Math.ceil((plan.width * 16) / ROW) * ROW;
  const copied = { size: stride * plan.height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ };
  const buffer = keep(device.createBuffer(copied));
  encoder.copyTextureToBuffer({ texture: target }, { buffer, bytesPerRow: stride }, size);
  const start = performance.now();
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const drew = (performance.now() - start) / 1000;
  return [{ stride, drew }, buffer.getMappedRange().slice()];
}

/** The pipeline and the layouts of its groups, from the page's own if they are known; or what Tint says against it.
 * @param {Plan} plan
 * @returns {Promise<Pipeline | { messages: any[], pipeline?: undefined }>} */
async function pipelineFor(plan) {
  const { code, vertex_code, vertex, fragment, format, groups, attributes, stride } = plan;
  const drawn = plan.triangles.size > 0;
  const key = JSON.stringify([code, vertex_code, vertex, fragment, format, drawn && attributes, groups]);
  let found = pipelines.get(key);
  if (!found) {
    const module = device.createShaderModule({ code });
    const vertexModule = vertex_code ? device.createShaderModule({ code: vertex_code }) : module;
    const lists = await Promise.all([module, vertexModule].map(async (each) => (await each.getCompilationInfo()).messages));
    const errors = lists.flat().filter(({ type }) => type === "error");
    if (errors.length) return { messages: errors.map((one) => [one.lineNum, one.linePos, one.message]) };
    const layouts = groups.map((entries) => device.createBindGroupLayout({ entries }));
    /** @type {GPUVertexBufferLayout[]} */
    const buffers = drawn ? [{ arrayStride: stride, stepMode: "vertex", attributes }] : [];
    const pipeline = await device.createRenderPipelineAsync({
      layout: device.createPipelineLayout({ bindGroupLayouts: layouts }),
      vertex: { module: vertexModule, entryPoint: vertex, buffers },
      fragment: { module, entryPoint: fragment, targets: [{ format }] },
      primitive: { topology: "triangle-list", cullMode: "none" },
    });
    found = { pipeline, layouts };
  }
  pipelines.delete(key);
  pipelines.set(key, found);
  for (const oldest of pipelines.keys()) if (pipelines.size > KEPT) pipelines.delete(oldest);
  return found;
}

/** @param {Plan} plan @param {GPUBindGroupEntry[][]} groups @param {PieceOf} piece @param {Keep} keep */
function bindBlocks(plan, groups, piece, keep) {
  for (const { group, binding, data } of plan.blocks) {
    groups[group].push({ binding, resource: { buffer: keep(filled(piece(data), GPUBufferUsage.UNIFORM)) } });
  }
}

/** @param {Plan} plan @param {GPUBindGroupEntry[][]} groups @param {PieceOf} piece @param {Keep} keep */
function bindTextures(plan, groups, piece, keep) {
  for (const texture of plan.textures) {
    const { group, binding, sampler, view, filter, between, wrap, compare } = texture;
    groups[group].push({ binding, resource: keep(uploaded(texture, piece)).createView({ dimension: view }) });
    if (sampler < 0) continue;
    const wraps = { addressModeU: wrap, addressModeV: wrap, addressModeW: wrap };
    /** @type {GPUSamplerDescriptor} */
    const filters = { magFilter: filter, minFilter: filter, mipmapFilter: between };
    const compares = compare ? { compare } : {};
    groups[group].push({ binding: sampler, resource: device.createSampler({ ...wraps, ...filters, ...compares }) });
  }
}

/** @param {Texture} texture @param {PieceOf} piece */
function uploaded({ format, dimension, levels, bytes_per_texel: texel }, piece) {
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
  const texture = device.createTexture({ size: levels[0].size, format, dimension, usage, mipLevelCount: levels.length });
  levels.forEach(({ size, data }, mipLevel) => {
    const layout = { bytesPerRow: size[0] * texel, rowsPerImage: size[1] };
    device.queue.writeTexture({ texture, mipLevel }, piece(data), layout, size);
  });
  return texture;
}

/** @param {Uint8Array} data @param {number} usage */
function filled(data, usage) {
  const size = Math.ceil(data.length / 4) * 4;
  const buffer = device.createBuffer({ size, usage, mappedAtCreation: true });
  new Uint8Array(buffer.getMappedRange()).set(data);
  buffer.unmap();
  return buffer;
}

const socket = new WebSocket(location.href.replace("http:", "ws:"));
socket.binaryType = "arraybuffer";
socket.onclose = () => window.close();

/** @param {object} answer */
function say(answer, bytes = new ArrayBuffer(0)) {
  socket.send(JSON.stringify(answer));
  socket.send(bytes);
}

/** @type {Plan} */
let plan;
socket.onmessage = async ({ data }) => {
  if (typeof data === "string") plan = JSON.parse(data);
  else say(...(await carryOut(plan, new Uint8Array(data))));
};
socket.onopen = async () => say(await start().catch((error) => ({ error: `${error.name}: ${error.message}` })));
