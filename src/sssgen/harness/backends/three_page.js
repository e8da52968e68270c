// three.js in a page: draws meshes with emitted modules, as plans say (engine_page.js).

import * as THREE from 'three';
import { WebGPURenderer, REVISION } from 'three/webgpu';

const VERSION = REVISION;
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
  const renderer = await rendererFor(plan.renderer);
  const gpu = plan.renderer === 'webgpu';
  const { createMaterial } = await imported(plan.modules);
  const textures = Object.fromEntries(Object.entries(plan.textures).map(([name, one]) => [name, textureOf(one, piece)]));
  const material = createMaterial({ ...plan.values, ...textures });
  for (const [name, value] of Object.entries(plan.properties)) {
    if (material[name]?.isColor) material[name].setScalar(value);
    else material[name] = value;
  }

  const vertices = new THREE.InterleavedBuffer(floats(piece(plan.vertices)), plan.vertexSize);
  const geometry = new THREE.BufferGeometry();
  for (const [ours, [offset, size]] of Object.entries(plan.attributes)) {
    const name = ours === 'uv2' ? 'uv1' : ours;
    geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(vertices, size, offset));
  }
  if (plan.withoutTangents) geometry.deleteAttribute('tangent');
  geometry.setIndex(new THREE.BufferAttribute(indices(piece(plan.triangles)), 1));
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
  renderer.render(scene, cameraOf(plan, gpu));
  let pixels;
  if (plan.renderer === 'webgl') {
    pixels = new Float32Array(plan.width * plan.height * 4);
    renderer.readRenderTargetPixels(into, 0, 0, plan.width, plan.height, pixels);
  } else {
    pixels = await renderer.readRenderTargetPixelsAsync(into, 0, 0, plan.width, plan.height);
  }
  renderer.setRenderTarget(null);
  [geometry, material, target, glTarget, ...Object.values(textures)].forEach((one) => one.dispose());
  return pixels;
}

function lightOf({ position, color }) {
  const [x, y, z, w] = position;
  // three's lights are irradiance, those of the other shells radiance: their ratio is pi
  const light = new (w ? THREE.PointLight : THREE.DirectionalLight)(new THREE.Color(...color), Math.PI);
  light.position.set(x, y, z);
  return light;
}

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
