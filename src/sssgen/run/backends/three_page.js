// three.js in a page: draws meshes with emitted modules, as plans say (engine_page.js).

import * as THREE from 'three';
import { WebGPURenderer, REVISION, RectAreaLightNode } from 'three/webgpu';
import { fileOf, filesRead, floats, halves, imported, indices, serve } from './engine_page.js';

/** @typedef {import('./engine_page.js').Plan} Plan */
/** @typedef {import('./engine_page.js').PieceOf} PieceOf */

/** @type {Map<string, THREE.WebGLRenderer | WebGPURenderer>} */
const renderers = new Map();

/** @param {string} kind */
async function rendererFor(kind) {
  const started = renderers.get(kind);
  if (started) return started;
  const canvas = document.createElement('canvas');
  const renderer = kind === 'webgl' ? new THREE.WebGLRenderer({ canvas }) : new WebGPURenderer({ canvas, forceWebGL: kind === 'webgl2' });
  renderer.toneMapping = THREE.NoToneMapping;
  if (renderer instanceof WebGPURenderer) {
    await renderer.init();
    if (kind === 'webgpu' && !('device' in renderer.backend)) throw new Error('its WebGPU has no adapter');
  }
  renderers.set(kind, renderer);
  return renderer;
}

/** @param {Plan} plan @param {PieceOf} piece */
async function draw(plan, piece) {
  const renderer = await rendererFor(plan.renderer);
  const gpu = plan.renderer === 'webgpu';
  const { createMaterial, textures: declared } = await imported(plan.modules);
  const textures = Object.fromEntries(Object.entries(plan.textures).map(([name, one]) => [name, textureOf(one, piece)]));
  const material = createMaterial({ ...plan.values, ...textures });
  const { stage = {}, ...properties } = plan.properties;
  for (const [path, value] of Object.entries(properties)) {
    const names = path.split('.'), last = names[names.length - 1];
    const one = names.slice(0, -1).reduce((object, name) => object[name], material);
    if (one[last]?.isColor) one[last].setScalar(value);
    else one[last] = fileOf(value);
  }
  await filesRead();

  const vertices = new THREE.InterleavedBuffer(floats(piece(plan.vertices)), plan.vertexSize);
  const geometry = new THREE.BufferGeometry();
  for (const [ours, [offset, size]] of Object.entries(plan.attributes)) {
    const name = ours === 'uv2' ? 'uv1' : ours;
    geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(vertices, size, offset));
  }
  if (plan.withoutTangents) geometry.deleteAttribute('tangent');
  geometry.setIndex(new THREE.BufferAttribute(indices(piece(plan.triangles)), 1));
  const placed = (/** @type {number[]} */ model, size = 1) => {
    const own = size === 1 ? geometry : geometry.clone().scale(size, size, size);
    const mesh = new (stage.bones ? THREE.SkinnedMesh : THREE.Mesh)(own, material);
    mesh.frustumCulled = false;
    mesh.matrixAutoUpdate = false;
    mesh.matrix.fromArray(model);
    if (stage.bones && mesh instanceof THREE.SkinnedMesh) bind(mesh, stage.bones);
    mesh.castShadow = mesh.receiveShadow = true;
    return mesh;
  };

  const scene = new THREE.Scene();
  const lights = plan.lights.map((light) => lightOf(light, stage));
  renderer.shadowMap.enabled = Boolean(stage.shadows);
  const meshes = [placed(plan.model), ...(stage.copies ?? []).map(({ model, size }) => placed(model, size))];
  scene.add(...meshes, ...(stage.walls ?? []).map(wallOf), ...lights);
  if (material.light === null) material.light = lights[0] ?? null;
  if (stage.around === 'environment') scene.environment = sky();
  else if (stage.around) scene.add(SURROUNDINGS[stage.around](stage));
  if (stage.area) scene.add(areaLightOf(stage.area));
  if (plan.ambient.length) scene.add(new THREE.AmbientLight(new THREE.Color().fromArray(plan.ambient), Math.PI));
  const pictures = () => Object.keys(declared).map((name) => material[name]).filter((texture) => texture.isRenderTargetTexture);
  if (stage.first) render(await rendererFor(stage.first), scene, cameraOf(plan, stage.first === 'webgpu'), 5, 4).dispose();
  const foreign = pictures();
  if (stage.before) {
    const places = lights.map(({ position }) => position.clone());
    lights.forEach(({ position }, number) => position.fromArray(stage.before[number]));
    render(renderer, scene, cameraOf(plan, gpu), plan.width, plan.height).dispose();
    lights.forEach(({ position }, number) => position.copy(places[number]));
  }
  if (stage.bones) {
    render(renderer, scene, cameraOf(plan, gpu), plan.width, plan.height).dispose();
    await new Promise(requestAnimationFrame); // WebGPURenderer reads bones once in a frame
    meshes.forEach(({ children }) => children.forEach(({ matrix }, number) => matrix.fromArray(stage.bones.matrices[number])));
  }
  const target = render(renderer, scene, cameraOf(plan, gpu), plan.width, plan.height);
  if (pictures().some((texture) => foreign.includes(texture))) throw new Error('two renderers draw into one picture');
  let pixels;
  if (renderer instanceof THREE.WebGLRenderer) {
    pixels = new Float32Array(plan.width * plan.height * 4);
    renderer.readRenderTargetPixels(target, 0, 0, plan.width, plan.height, pixels);
  } else {
    pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, plan.width, plan.height);
  }
  renderer.setRenderTarget(null);
  [...meshes.map(({ geometry }) => geometry), material, target, ...Object.values(textures)].forEach((one) => one.dispose());
  return pixels;
}

/** Gives a mesh bones at rest. @param {THREE.SkinnedMesh} mesh @param {import('./engine_page.js').Bones} bones */
function bind(mesh, { weights, matrices }) {
  const bones = matrices.map(() => Object.assign(new THREE.Bone(), { matrixAutoUpdate: false }));
  mesh.geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(weights.flatMap(() => [0, 1, 0, 0]), 4));
  mesh.geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(weights.flatMap((weight) => [1 - weight, weight, 0, 0]), 4));
  mesh.add(...bones);
  mesh.bind(new THREE.Skeleton(bones));
}

/** @type {Record<string, (stage: import('./engine_page.js').Stage) => THREE.Light>} (1 + y) / 2 on a white matte surface, or the colours of the stage. */
const SURROUNDINGS = {
  hemisphere: ({ above = [1, 1, 1], below = [0, 0, 0] }) => new THREE.HemisphereLight(new THREE.Color(...above), new THREE.Color(...below), Math.PI),
  probe() {
    const light = new THREE.LightProbe(undefined, 0.5 * Math.PI);
    light.sh.coefficients[0].setScalar(1 / 0.886227);
    light.sh.coefficients[1].setScalar(0.5 / 0.511664);
    return light;
  },
};

/** Its upper half is white. */
function sky() {
  const texels = new Uint16Array(64 * 32 * 4).fill(THREE.DataUtils.toHalfFloat(1), 64 * 16 * 4);
  const texture = new THREE.DataTexture(texels, 64, 32, THREE.RGBAFormat, THREE.HalfFloatType, THREE.EquirectangularReflectionMapping);
  texture.needsUpdate = true;
  return texture;
}

/** @param {THREE.WebGLRenderer | WebGPURenderer} renderer @param {THREE.Scene} scene @param {THREE.Camera} camera @param {number} width @param {number} height */
function render(renderer, scene, camera, width, height) {
  // WebGLRenderer draws into no other target, and WebGPURenderer takes it, too
  const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
  renderer.setClearColor(0x000000, 0);
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  return target;
}

/** A wall that casts a shadow. @param {number[]} model */
function wallOf(model) {
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial({ color: 0x000000 }));
  mesh.matrixAutoUpdate = false;
  mesh.matrix.fromArray(model);
  mesh.castShadow = true;
  return mesh;
}

/** @param {import('./engine_page.js').Light} light @param {import('./engine_page.js').Stage} stage */
function lightOf({ position, color }, { shadows = false }) {
  const [x, y, z, w] = position;
  // three's lights are irradiance, those of the other shells radiance: their ratio is pi
  const light = new (w ? THREE.PointLight : THREE.DirectionalLight)(new THREE.Color().fromArray(color), Math.PI);
  light.position.set(x, y, z);
  light.castShadow = shadows;
  if (light instanceof THREE.DirectionalLight && shadows) {
    light.position.multiplyScalar(5); // before what it lights
    Object.assign(light.shadow.camera, { left: -2, right: 2, bottom: -2, top: 2 });
  }
  return light;
}

/** Its tables are of what a surface with highlights reflects, which no plan with such a light draws.
 * @param {import('./engine_page.js').Area} area */
function areaLightOf({ model, size, radiance }) {
  const texel = new THREE.DataTexture(new Uint16Array(4), 1, 1, THREE.RGBAFormat, THREE.HalfFloatType);
  texel.needsUpdate = true;
  const tables = { LTC_HALF_1: texel, LTC_HALF_2: texel, LTC_FLOAT_1: texel, LTC_FLOAT_2: texel };
  Object.assign(THREE.UniformsLib, tables);
  RectAreaLightNode.setLTC(tables);
  const light = new THREE.RectAreaLight(0xffffff, radiance, ...size);
  light.applyMatrix4(new THREE.Matrix4().fromArray(model));
  return light;
}

/** @param {Plan} plan @param {boolean} gpu */
function cameraOf(plan, gpu) {
  const camera = new THREE.PerspectiveCamera();
  camera.coordinateSystem = gpu ? THREE.WebGPUCoordinateSystem : THREE.WebGLCoordinateSystem;
  camera.matrixAutoUpdate = camera.matrixWorldAutoUpdate = false;
  camera.updateProjectionMatrix = () => {};
  camera.projectionMatrix.fromArray(plan.projection);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  camera.matrixWorldInverse.fromArray(plan.view);
  camera.matrixWorld.copy(camera.matrixWorldInverse).invert();
  camera.updateMatrixWorld = () => {};
  return camera;
}

const WRAPS = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };

/** @param {import('./engine_page.js').Texels} texels @param {PieceOf} piece */
function textureOf({ dim, size, levels, filter, wrap }, piece) {
  const texels = levels.map((level) => halves(piece(level.data)));
  const Kind = dim === '3D' ? THREE.Data3DTexture : THREE.DataTexture;
  const texture = new Kind(texels[0], ...size);
  const mag = filter === 'nearest' ? THREE.NearestFilter : THREE.LinearFilter;
  if (levels.length > 1) {
    texture.mipmaps = levels.map((level, i) => ({ data: texels[i], width: level.size[0], height: level.size[1] }));
  }
  const min = levels.length > 1 ? THREE.LinearMipmapLinearFilter : mag;
  return Object.assign(texture, {
    format: THREE.RGBAFormat, type: THREE.HalfFloatType, magFilter: mag, minFilter: min, generateMipmaps: false,
    wrapS: WRAPS[wrap], wrapT: WRAPS[wrap], wrapR: WRAPS[wrap], unpackAlignment: 1, needsUpdate: true,
  });
}

serve(REVISION, draw);
