// Scenes of translucent bodies, walls and lamps for test_threejs_shadows.py, in three.js. A body is lit from behind; all
// that a picture shows is the light that came through.

import * as THREE from 'three';
import { WebGPURenderer, REVISION } from 'three/webgpu';
import { SunLight } from './SunLight.js';
import { imported, serve } from './engine_page.js';

let renderer;
const materials = new Map();
const black = new THREE.MeshBasicMaterial({ color: 0 });
const ball = new THREE.SphereGeometry(0.5, 24, 16), pea = new THREE.SphereGeometry(0.2, 24, 16);
const sheet = new THREE.BoxGeometry(0.9, 0.9, 0.04), slab = new THREE.BoxGeometry(1, 1, 0.05);
const target = new THREE.WebGLRenderTarget(64, 32, { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
const camera = new THREE.PerspectiveCamera(40, 2, 0.1, 20);
camera.position.z = 4;

async function start(kind) {
  const canvas = document.createElement('canvas');
  renderer = kind === 'webgl' ? new THREE.WebGLRenderer({ canvas }) : new WebGPURenderer({ canvas, forceWebGL: kind === 'webgl2' });
  if (kind !== 'webgl') await renderer.init();
  renderer.toneMapping = THREE.NoToneMapping;
  renderer.setClearColor(0x000000, 0);
}

async function materialOf({ material, modules, side = 'FrontSide', missing }, number = 0) {
  const key = `${material} ${side} ${number} ${missing}`;
  if (!materials.has(key)) {
    const { createMaterial } = await imported(modules);
    materials.set(key, createMaterial({ color: 0, specularIntensity: 0, side: THREE[side] }));
  }
  return materials.get(key);
}

/** A lamp behind the bodies, without falloff: all that it lights has the radiance 1. */
const LAMPS = {
  directional: () => new THREE.DirectionalLight(0xffffff, Math.PI),
  point: () => new THREE.PointLight(0xffffff, Math.PI, 0, 0),
  spot: () => new THREE.SpotLight(0xffffff, Math.PI, 0, 0.7, 0, 0),
  sun: () => new SunLight(0xffffff, Math.PI),
};

function lampOf({ kind, position = [0.3, 0.4, -3] }, shadows) {
  const light = LAMPS[kind]();
  light.position.set(...position);
  light.castShadow = shadows;
  light.shadow.mapSize.set(256, 256);
  if (light.isDirectionalLight) Object.assign(light.shadow.camera, { left: -2, right: 2, top: 2, bottom: -2 });
  return light;
}

const placed = ({ position = [0, 0, 0], scale = [1, 1, 1], turn = 0 }) => new THREE.Matrix4().compose(
  new THREE.Vector3(...position), new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0.6, 0.8, 0), turn), new THREE.Vector3(...scale),
);

const GEOMETRIES = { ball, pea, sheet };

async function bodiesOf(plan) {
  const { bodies, drawn } = plan, material = await materialOf(plan), matrices = bodies.map(placed), [{ shape }] = bodies;
  if (drawn === 'instanced') {
    const mesh = new THREE.InstancedMesh(GEOMETRIES[shape], material, bodies.length);
    matrices.forEach((matrix, number) => mesh.setMatrixAt(number, matrix));
    return [mesh];
  }
  if (drawn === 'batched') {
    const { position, index } = { ...GEOMETRIES[shape].attributes, index: GEOMETRIES[shape].index };
    const mesh = new THREE.BatchedMesh(bodies.length, position.count, index.count, material);
    const geometry = mesh.addGeometry(GEOMETRIES[shape]);
    for (const matrix of matrices) mesh.setMatrixAt(mesh.addInstance(geometry), matrix);
    return [mesh];
  }
  return Promise.all(bodies.map(async (body, number) => {
    const own = drawn === 'apart' ? await materialOf(plan, number) : material;
    const mesh = drawn === 'skinned' ? skinned(body, own) : new THREE.Mesh(GEOMETRIES[body.shape], own);
    mesh.applyMatrix4(matrices[number]);
    mesh.renderOrder = number;
    return mesh;
  }));
}

/** A body whose only bone moves it by the place of the body: its mesh stays where it is. */
function skinned({ shape, position }, material) {
  const geometry = GEOMETRIES[shape].clone(), { count } = geometry.attributes.position;
  geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(new Uint16Array(4 * count), 4));
  geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(new Float32Array(4 * count).map((_, i) => (i % 4 ? 0 : 1)), 4));
  const mesh = new THREE.SkinnedMesh(geometry, material), bone = new THREE.Bone();
  mesh.add(bone);
  mesh.bind(new THREE.Skeleton([bone]));
  bone.position.set(...position.map((x) => -2 * x)); // the mesh's own matrix moves it back
  mesh.frustumCulled = false;
  return mesh;
}

async function draw(plan) {
  if (!renderer) await start(plan.renderer);
  for (const [chunk, text] of Object.entries(THREE.ShaderChunk)) {
    if (plan.missing) THREE.ShaderChunk[chunk] = text.replaceAll(plan.missing, 'renamed');
  }
  const scene = new THREE.Scene(), lights = plan.lamps.map((lamp) => lampOf(lamp, plan.shadows));
  scene.add(...lights, ...await bodiesOf(plan));
  for (const mesh of scene.children.filter(({ isMesh }) => isMesh)) {
    mesh.castShadow = true;
    mesh.receiveShadow = !plan.unreceived;
  }
  for (const wall of plan.walls) {
    const mesh = new THREE.Mesh(slab, wall.color === undefined ? black : new THREE.MeshBasicMaterial({ color: wall.color }));
    mesh.applyMatrix4(placed(wall));
    mesh.castShadow = true;
    scene.add(mesh);
  }
  renderer.shadowMap.enabled = plan.shadows;
  renderer.shadowMap.type = THREE[plan.shadowType ?? 'PCFShadowMap'];
  camera.coordinateSystem = plan.renderer === 'webgpu' ? THREE.WebGPUCoordinateSystem : THREE.WebGLCoordinateSystem;
  camera.updateProjectionMatrix();
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  let pixels = new Float32Array(64 * 32 * 4);
  if (renderer.isWebGLRenderer) renderer.readRenderTargetPixels(target, 0, 0, 64, 32, pixels);
  else pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, 64, 32);
  renderer.setRenderTarget(null);
  lights.forEach((light) => light.dispose());
  return pixels;
}

serve(REVISION, draw);
