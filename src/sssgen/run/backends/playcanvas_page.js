// PlayCanvas in a page: draws meshes with emitted modules, as plans say (engine_page.js).

import * as pc from 'playcanvas';
import { fileOf, filesRead, floats, halves, imported, indices, serve } from './engine_page.js';

/** @typedef {import('./engine_page.js').Plan} Plan */
/** @typedef {import('./engine_page.js').PieceOf} PieceOf */
/** @typedef {import('./engine_page.js').Stage} Stage */

/** @type {Map<string, pc.AppBase>} */
const apps = new Map();

/** An object with what PlayCanvas's types keep to the engine.
 * @param {object} object @returns {any} */
const internalsOf = (object) => object;

/** PlayCanvas cannot turn its clustered lighting on again: with and without it are two apps.
 * @param {string} renderer @param {boolean} clustered */
async function appFor(renderer, clustered) {
  const kind = `${renderer} ${clustered}`;
  const started = apps.get(kind);
  if (started) return started;
  const canvas = document.createElement('canvas');
  canvas.id = kind; // by which a material finds its app
  const gpu = renderer === 'webgpu';
  const device = await pc.createGraphicsDevice(canvas, { deviceTypes: [gpu ? pc.DEVICETYPE_WEBGPU : pc.DEVICETYPE_WEBGL2], antialias: false });
  if (device.isWebGPU !== gpu) throw new Error(`PlayCanvas chose another device: ${device.deviceType}`);
  if (gpu) {
    const internals = internalsOf(device);
    internals.wgpu.addEventListener('uncapturederror', ({ error }) => console.error(error.message));
    // without a GPU, Chromium loses the device where a canvas is shown: the frame goes into a texture
    internals.gpuContext = null;
    internals.externalBackbuffer = new pc.Texture(device, { width: 4, height: 4, format: device.backBufferFormat, mipmaps: false });
  }
  const options = new pc.AppOptions();
  options.graphicsDevice = device;
  options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem, pc.LightComponentSystem];
  const app = new pc.AppBase(canvas);
  app.init(options);
  app.scene.clusteredLightingEnabled = clustered;
  invertedSquares(device);
  // Tables for area lights: no plan with one has highlights; a disk has the cosine of its direction, as where all of it is
  // above the horizon.
  const cosines = Array.from({ length: 64 * 64 * 4 }, (_, at) => (at % 4 === 3 ? Math.max((2 * (Math.floor(at / 4) % 64)) / 63 - 1, 0) : 0));
  app.setAreaLightLuts(cosines.map(() => 0), cosines);
  apps.set(kind, app);
  return app;
}

/** PlayCanvas's light at the distance d is 16 / (d * d + 1) within a range. For numbers that can be compared with those of
 * other targets it is 1 / (d * d) here.
 * @param {pc.GraphicsDevice} device */
function invertedSquares(device) {
  pc.ShaderChunks.get(device, pc.SHADERLANGUAGE_GLSL).set('falloffInvSquaredPS', `
float getFalloffWindow(float radius, vec3 d) { return 1.0; }
float getFalloffInvSquared(float radius, vec3 d) { return 1.0 / max(dot(d, d), 1e-4); }
`);
  pc.ShaderChunks.get(device, pc.SHADERLANGUAGE_WGSL).set('falloffInvSquaredPS', `
fn getFalloffWindow(radius: f32, d: vec3f) -> f32 { return 1.0; }
fn getFalloffInvSquared(radius: f32, d: vec3f) -> f32 { return 1.0 / max(dot(d, d), 1e-4); }
`);
}

/** @param {Plan} plan @param {PieceOf} piece */
async function draw(plan, piece) {
  const { clustered = true, stage = {}, ...properties } = plan.properties;
  const app = await appFor(plan.renderer, clustered);
  const { scene, graphicsDevice: device } = app;
  const { createMaterial } = await imported(plan.modules);
  const textures = Object.fromEntries(Object.entries(plan.textures).map(([name, one]) => [name, textureOf(device, one, piece)]));
  const material = createMaterial(device, { ...plan.values, ...textures });
  for (const [name, value] of Object.entries(properties)) {
    if (material[name] instanceof pc.Color) material[name].set(value, value, value);
    else material[name] = fileOf(value);
  }
  await filesRead();
  scene.ambientLight = colorOf(plan.ambient.length ? plan.ambient : [0, 0, 0]);

  const sky = stage.around ? skyOf(device, stage) : null;
  scene.envAtlas = sky;

  const placed = (/** @type {pc.Mesh} */ mesh, /** @type {number[]} */ model) => {
    const entity = new pc.Entity('', app);
    const instance = new pc.MeshInstance(mesh, material, entity);
    instance.cull = false;
    entity.addComponent('render', { meshInstances: [instance], castShadows: stage.shadows, receiveShadows: stage.shadows });
    setMatrix(entity, model);
    return entity;
  };
  const bodies = [placed(meshOf(device, plan, piece, 1, stage.bones), plan.model)];
  if (stage.bones) bind(bodies[0], stage.bones, app);
  if (stage.instances) instancesOf(bodies[0], device, stage.instances);
  for (const { size, model } of stage.copies ?? []) bodies.push(placed(meshOf(device, plan, piece, size), model));
  for (const model of stage.walls ?? []) bodies.push(placed(pc.Mesh.fromGeometry(device, new pc.BoxGeometry()), model));
  const lights = plan.lights.map((light) => lightOf(app, light, stage));
  scene.lighting.areaLightsEnabled = Boolean(stage.area);
  if (stage.area) lights.push(areaLightOf(app, stage.area));
  if (material.light === null && lights.length) material.light = lights[0].light;
  material.update();

  const colorBuffer = new pc.Texture(device, {
    width: plan.width, height: plan.height, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false,
    minFilter: pc.FILTER_NEAREST, magFilter: pc.FILTER_NEAREST,
  });
  const renderTarget = new pc.RenderTarget({ colorBuffer, depth: true, samples: 1 });
  const camera = cameraOf(app, plan, renderTarget);
  const all = [...bodies, camera, ...lights];
  all.forEach((one) => app.root.addChild(one));
  app.render();
  if (stage.later) {
    await sky?.read(0, 0, 1, 1, { immediate: true });
    await new Promise((resume) => setTimeout(resume, 100)); // until others see theirs, too
    app.render();
  }
  const pixels = /** @type {Float32Array} */ (await colorBuffer.read(0, 0, plan.width, plan.height, { renderTarget, immediate: true }));
  await internalsOf(device).wgpu?.queue.onSubmittedWorkDone();
  all.forEach((one) => one.destroy());
  renderTarget.destroy();
  scene.envAtlas = null;
  sky?.destroy();
  [colorBuffer, material, ...Object.values(textures)].forEach((one) => one.destroy());
  return pixels;
}

/** The light of a cube whose upper half is white, or whose light is linear in the height, so that a white matte surface has the
 * colours of the stage.
 * @param {pc.GraphicsDevice} device @param {Stage} stage */
function skyOf(device, { around, above = [1, 1, 1], below = [0, 0, 0] }) {
  const size = 32;
  /** @param {number} y */
  const seen = (y) => above.map((up, i) => {
    const middle = (up + below[i]) / 2;
    return around === 'hemisphere' ? middle + 1.5 * (up - middle) * y : y > 0 ? up : below[i];
  });
  const face = (/** @type {(s: number, t: number) => number} */ heightOf) => {
    const texels = Array.from({ length: size * size }, (_, i) => {
      const s = (2 * (i % size) + 1) / size - 1, t = 1 - (2 * Math.floor(i / size) + 1) / size; // its first row is up
      return [...seen(heightOf(s, t) / Math.hypot(1, s, t)), 1].map(pc.FloatPacking.float2Half);
    });
    return /** @type {any} the types have no halves */ (new Uint16Array(texels.flat()));
  };
  const side = () => face((s, t) => t);
  const cube = new pc.Texture(device, {
    cubemap: true, width: size, height: size, format: pc.PIXELFORMAT_RGBA16F, mipmaps: false,
    levels: [[side(), side(), face(() => 1), face(() => -1), side(), side()]],
  });
  const lit = pc.EnvLighting.generateLightingSource(cube, { size });
  const atlas = pc.EnvLighting.generateAtlas(lit);
  [cube, lit].forEach((one) => one.destroy());
  return atlas;
}

/** @type {Record<string, string>} */
const SEMANTICS = {
  position: pc.SEMANTIC_POSITION, normal: pc.SEMANTIC_NORMAL, tangent: pc.SEMANTIC_TANGENT,
  uv: pc.SEMANTIC_TEXCOORD0, uv2: pc.SEMANTIC_TEXCOORD1, color: pc.SEMANTIC_COLOR,
};

/** @param {pc.GraphicsDevice} device @param {Plan} plan @param {PieceOf} piece @param {number} [scale] of positions
 * @param {import('./engine_page.js').Bones} [bones] */
function meshOf(device, plan, piece, scale = 1, bones) {
  const rows = floats(piece(plan.vertices));
  const count = rows.length / plan.vertexSize;
  const mesh = new pc.Mesh(device);
  for (const [name, [first, size]] of Object.entries(plan.attributes)) {
    if (name === 'tangent' && plan.withoutTangents) continue;
    const part = Float32Array.from({ length: count * size }, (_, i) => rows[Math.floor(i / size) * plan.vertexSize + first + i % size]);
    mesh.setVertexStream(SEMANTICS[name], name === 'position' ? part.map((one) => one * scale) : part, size);
  }
  if (bones) {
    mesh.setVertexStream(pc.SEMANTIC_BLENDINDICES, bones.weights.flatMap(() => [0, 1, 0, 0]), 4, count, pc.TYPE_UINT8);
    mesh.setVertexStream(pc.SEMANTIC_BLENDWEIGHT, bones.weights.flatMap((weight) => [1 - weight, weight, 0, 0]), 4);
  }
  mesh.setIndices(indices(piece(plan.triangles)));
  mesh.update();
  return mesh;
}

// PlayCanvas keeps colours encoded.
const colorOf = (/** @type {number[]} */ values) => new pc.Color(values.map((value) => value ** (1 / 2.2)));

/** @param {pc.AppBase} app @param {import('./engine_page.js').Light} light @param {Stage} stage */
function lightOf(app, { position, color }, { shadows, cascades, spot }) {
  const [x, y, z, w] = position;
  const entity = new pc.Entity('', app);
  const angle = ((spot ?? 0) * 90) / Math.PI; // from the axis, in degrees
  entity.addComponent('light', {
    type: !w ? 'directional' : spot ? 'spot' : 'omni', color: colorOf(color), intensity: 1, range: 50, innerConeAngle: angle, outerConeAngle: angle,
    falloffMode: pc.LIGHTFALLOFF_INVERSESQUARED, castShadows: shadows, shadowResolution: 1024, shadowDistance: 10, numCascades: cascades ? 4 : 1,
  });
  if (w) entity.setPosition(x, y, z);
  // a light shines down its own y
  if (!w || spot) entity.setRotation(new pc.Quat().setFromDirections(pc.Vec3.UP, new pc.Vec3(x, y, z).normalize()));
  return entity;
}

/** @type {Record<string, number>} */
const SHAPES = { rectangle: pc.LIGHTSHAPE_RECT, disk: pc.LIGHTSHAPE_DISK, sphere: pc.LIGHTSHAPE_SPHERE };

/** PlayCanvas's light of 16 is the radiance 1. @param {pc.AppBase} app @param {import('./engine_page.js').Area} area */
function areaLightOf(app, { model, size, radiance, shape = 'rectangle', shadows = false }) {
  const entity = new pc.Entity('', app), matrix = new pc.Mat4().set(model);
  const color = colorOf(Array(3).fill(radiance / 16));
  entity.addComponent('light', { type: 'omni', shape: SHAPES[shape], color, range: 50, castShadows: shadows, shadowResolution: 1024 });
  entity.setPosition(matrix.getTranslation());
  // it shines down its own y, and its sides are along x and z
  entity.setRotation(new pc.Quat().setFromMat4(matrix).mul(new pc.Quat().setFromEulerAngles(90, 0, 0)));
  entity.setLocalScale(size[0], 1, size[1]);
  return entity;
}

/** Gives an entity's mesh bones, which bend it.
 * @param {pc.Entity} entity @param {import('./engine_page.js').Bones} bones @param {pc.AppBase} app */
function bind(entity, { matrices }, app) {
  const instance = /** @type {pc.MeshInstance} */ (entity.render?.meshInstances[0]);
  const skin = new pc.Skin(app.graphicsDevice, matrices.map(() => new pc.Mat4()), matrices.map((_, number) => `bone ${number}`));
  Object.assign(instance.mesh ?? {}, { skin });
  instance.skinInstance = new pc.SkinInstance(skin);
  instance.skinInstance.bones = matrices.map((matrix) => {
    const bone = new pc.Entity('', app);
    entity.addChild(bone);
    setMatrix(bone, matrix);
    return bone;
  });
}

/** Draws an entity's mesh with these matrices.
 * @param {pc.Entity} entity @param {pc.GraphicsDevice} device @param {number[][]} matrices */
function instancesOf(entity, device, matrices) {
  const data = new Float32Array(matrices.flat()).buffer;
  const format = pc.VertexFormat.getDefaultInstancingFormat(device);
  entity.render?.meshInstances[0].setInstancing(new pc.VertexBuffer(device, format, matrices.length, { data }));
}

/** Gives an entity a matrix that may stretch and mirror along any axes: not one of position, rotation and scale.
 * @param {pc.Entity} entity @param {number[]} matrix */
function setMatrix(entity, matrix) {
  entity.getLocalTransform();
  internalsOf(entity).localTransform.set(matrix);
}

/** @param {pc.AppBase} app @param {Plan} plan @param {pc.RenderTarget} renderTarget */
function cameraOf(app, plan, renderTarget) {
  const entity = new pc.Entity('', app);
  entity.addComponent('camera', { renderTarget, clearColor: new pc.Color(0, 0, 0, 0), toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_NONE, frustumCulling: false });
  const world = new pc.Mat4().set(plan.view).invert();
  entity.setPosition(new pc.Vec3(plan.eye));
  const projection = new pc.Mat4().set(plan.projection);
  // PlayCanvas takes depths from -1 to 1 on both devices
  if (plan.renderer === 'webgpu') projection.mul2(new pc.Mat4().set([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 0, -1, 1]), projection.clone());
  if (!entity.camera) throw new Error('the entity has no camera');
  entity.camera.calculateProjection = (result) => result.copy(projection);
  entity.camera.calculateTransform = (result) => result.copy(world);
  return entity;
}

const WRAPS = { repeat: pc.ADDRESS_REPEAT, clamp: pc.ADDRESS_CLAMP_TO_EDGE, mirror: pc.ADDRESS_MIRRORED_REPEAT };

/** @param {pc.GraphicsDevice} device @param {import('./engine_page.js').Texels} texels @param {PieceOf} piece */
function textureOf(device, { dim, size, levels, filter, wrap }, piece) {
  const nearest = filter === 'nearest';
  return new pc.Texture(device, {
    width: size[0], height: size[1], depth: size[2] ?? 1, volume: dim === '3D', format: pc.PIXELFORMAT_RGBA16F, mipmaps: levels.length > 1,
    numLevels: levels.length, levels: levels.map((level) => halves(piece(level.data))),
    minFilter: nearest ? pc.FILTER_NEAREST : levels.length > 1 ? pc.FILTER_LINEAR_MIPMAP_LINEAR : pc.FILTER_LINEAR,
    magFilter: nearest ? pc.FILTER_NEAREST : pc.FILTER_LINEAR, addressU: WRAPS[wrap], addressV: WRAPS[wrap], addressW: WRAPS[wrap],
  });
}

serve(pc.version, draw);
