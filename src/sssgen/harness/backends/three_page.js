// The page of the three.js renderers: it draws meshes with emitted modules, as plans say that come through a WebSocket.
//
// A message pair each way: a text of JSON, then bytes. In a plan, `{at, size}` stands for a piece of its bytes. When the
// connection ends, the page closes, and with it the browser.

import * as THREE from 'three';
import { WebGPURenderer, REVISION } from 'three/webgpu';

const complaints = [];
for (const level of ['error', 'warn']) {
  const print = console[level];
  console[level] = (...parts) => {
    complaints.push(parts.map(String).join(' '));
    print(...parts);
  };
}

const renderers = new Map();

async function rendererFor(kind) {
  if (!renderers.has(kind)) {
    const canvas = document.createElement('canvas');
    const renderer = kind === 'webgl' ? new THREE.WebGLRenderer({ canvas }) : new WebGPURenderer({ canvas, forceWebGL: kind === 'webgl2' });
    renderer.toneMapping = THREE.NoToneMapping;
    if (renderer.init) await renderer.init();
    if (kind === 'webgpu' && !renderer.backend.isWebGPUBackend) throw new Error('its WebGPU has no adapter');
    renderers.set(kind, renderer);
  }
  return renderers.get(kind);
}

async function draw(plan, piece) {
  complaints.length = 0;
  const renderer = await rendererFor(plan.renderer);
  const gpu = plan.renderer === 'webgpu';
  const url = URL.createObjectURL(new Blob([plan.module], { type: 'text/javascript' }));
  const { createMaterial } = await import(url);
  URL.revokeObjectURL(url);
  const textures = Object.fromEntries(Object.entries(plan.textures).map(([name, one]) => [name, textureOf(one, piece)]));
  const material = createMaterial({ ...plan.values, ...textures });
  for (const [name, value] of Object.entries(plan.properties)) {
    if (material[name]?.isColor) material[name].setScalar(value);
    else material[name] = value;
  }

  const vertices = new THREE.InterleavedBuffer(new Float32Array(piece(plan.vertices).slice().buffer), 12);
  const geometry = new THREE.BufferGeometry();
  for (const [name, size, offset] of [['position', 3, 0], ['normal', 3, 3], ['tangent', 4, 6], ['uv', 2, 10]]) {
    geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(vertices, size, offset));
  }
  if (plan.withoutTangents) geometry.deleteAttribute('tangent');
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(piece(plan.triangles).slice().buffer), 1));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.matrixAutoUpdate = false;
  mesh.matrix.fromArray(plan.model);
  mesh.castShadow = mesh.receiveShadow = true;

  const scene = new THREE.Scene();
  const lights = plan.lights.map(lightOf);
  scene.add(mesh, ...lights);
  if (material.light === null) material.light = lights[0] ?? null;
  if (plan.ambient) scene.add(new THREE.AmbientLight(new THREE.Color(...plan.ambient), Math.PI));
  const target = new THREE.RenderTarget(plan.width, plan.height, { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
  const glTarget = new THREE.WebGLRenderTarget(plan.width, plan.height, { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
  const into = plan.renderer === 'webgl' ? glTarget : target;
  renderer.setClearColor(0x000000, 0);
  renderer.setRenderTarget(into);
  renderer.clear();
  const start = performance.now();
  renderer.render(scene, cameraOf(plan, gpu));
  let pixels;
  if (plan.renderer === 'webgl') {
    pixels = new Float32Array(plan.width * plan.height * 4);
    renderer.readRenderTargetPixels(into, 0, 0, plan.width, plan.height, pixels);
  } else {
    pixels = await renderer.readRenderTargetPixelsAsync(into, 0, 0, plan.width, plan.height);
  }
  const drew = (performance.now() - start) / 1000;
  renderer.setRenderTarget(null);
  [geometry, material, target, glTarget, ...Object.values(textures)].forEach((one) => one.dispose());
  const stride = pixels.length / plan.height * 4;
  return [{ stride, drew, topFirst: gpu, complaints: [...complaints] }, pixels.buffer.slice(pixels.byteOffset, pixels.byteOffset + pixels.byteLength)];
}

function lightOf({ position, color }) {
  const [x, y, z, w] = position;
  // three's lights are irradiance, those of the other shells radiance: their ratio is pi
  const light = new (w ? THREE.PointLight : THREE.DirectionalLight)(new THREE.Color(...color), Math.PI);
  light.position.set(x, y, z);
  return light;
}

// A camera that is turned against the scene, so that world space and view space differ.
function cameraOf({ viewProjection, eye }, gpu) {
  const camera = new THREE.PerspectiveCamera();
  const view = new THREE.Matrix4().makeRotationFromEuler(new THREE.Euler(0.4, -0.7, 0.2));
  view.multiply(new THREE.Matrix4().makeTranslation(-eye[0], -eye[1], -eye[2]));
  const projection = new THREE.Matrix4().fromArray(viewProjection).multiply(view.clone().invert());
  if (gpu) projection.premultiply(new THREE.Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 1));
  camera.coordinateSystem = gpu ? THREE.WebGPUCoordinateSystem : THREE.WebGLCoordinateSystem;
  camera.matrixAutoUpdate = camera.matrixWorldAutoUpdate = false;
  camera.updateProjectionMatrix = () => {};
  camera.projectionMatrix.copy(projection);
  camera.projectionMatrixInverse.copy(projection).invert();
  camera.matrixWorldInverse.copy(view);
  camera.matrixWorld.copy(view).invert();
  camera.updateMatrixWorld = () => {};
  return camera;
}

const WRAPS = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };

function textureOf({ dim, size, levels, filter, wrap }, piece) {
  const halves = levels.map((level) => new Uint16Array(piece(level.data).slice().buffer));
  const Kind = dim === '3D' ? THREE.Data3DTexture : THREE.DataTexture;
  const texture = new Kind(halves[0], ...size);
  const mag = filter === 'nearest' ? THREE.NearestFilter : THREE.LinearFilter;
  if (levels.length > 1) {
    texture.mipmaps = levels.map((level, i) => ({ data: halves[i], width: level.size[0], height: level.size[1] }));
  }
  const min = levels.length > 1 ? THREE.LinearMipmapLinearFilter : mag;
  return Object.assign(texture, {
    format: THREE.RGBAFormat, type: THREE.HalfFloatType, magFilter: mag, minFilter: min, generateMipmaps: false,
    wrapS: WRAPS[wrap], wrapT: WRAPS[wrap], wrapR: WRAPS[wrap], unpackAlignment: 1, needsUpdate: true,
  });
}

const socket = new WebSocket(location.href.replace('http:', 'ws:'));
socket.binaryType = 'arraybuffer';
socket.onclose = () => window.close();

function say(answer, bytes = new ArrayBuffer(0)) {
  socket.send(JSON.stringify(answer));
  socket.send(bytes);
}

let plan;
socket.onmessage = async ({ data }) => {
  if (typeof data === 'string') {
    plan = JSON.parse(data);
    return;
  }
  const bytes = new Uint8Array(data);
  try {
    say(...(await draw(plan, ({ at, size }) => bytes.subarray(at, at + size))));
  } catch (error) {
    say({ error: `${error.name}: ${error.message}`, complaints: [...complaints], stack: error.stack });
  }
};
socket.onopen = () => say({ version: REVISION });
