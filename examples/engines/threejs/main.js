// A sheet of ice with the sun behind it. ?renderer=webgl, webgpu (default, where the browser has it) or webgl2 chooses
// the renderer; the material is the same object for all of them.

import * as THREE from 'three';
import { WebGPURenderer } from 'three/webgpu';
import { createMaterial } from './ice.js';

const kind = new URLSearchParams(location.search).get('renderer') ?? 'webgpu';
const renderer = kind === 'webgl'
  ? new THREE.WebGLRenderer({ antialias: true })
  : new WebGPURenderer({ antialias: true, forceWebGL: kind === 'webgl2' });
renderer.shadowMap.enabled = true;
renderer.toneMapping = THREE.ACESFilmicToneMapping;
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
// WebGPURenderer tone-maps fog and background, WebGLRenderer does not: both colours are #1b2838 on the screen.
const air = new THREE.Color(kind === 'webgl' ? 0x1b2838 : 0x2c3845);
scene.fog = new THREE.Fog(air, 6, 14);
scene.background = air;
scene.environment = sky();

const material = createMaterial({ erosion: 0.05, cellCount: 6, uvPerUnit: [0.45, 0.45], relief: 0.03, tint: [0.1, 0.16, 0.2, 1], ambient: 0.05 });
const ice = new THREE.Mesh(new THREE.BoxGeometry(2.2, 2.2, 0.15), material);
ice.position.y = 1.25;
ice.castShadow = ice.receiveShadow = true;
const floor = new THREE.Mesh(new THREE.CircleGeometry(12, 64).rotateX(-Math.PI / 2), new THREE.MeshStandardMaterial({ color: 0x3a4450 }));
floor.receiveShadow = true;
scene.add(ice, floor);

const sun = new THREE.DirectionalLight(0xffe2b8, 5);
sun.position.set(-2, 2.2, -4);
sun.castShadow = true;
Object.assign(sun.shadow.camera, { left: -4, right: 4, top: 4, bottom: -4 });
const lamp = new THREE.PointLight(0xffffff, 20);
lamp.position.set(2, 3, 3);
scene.add(sun, lamp);

const camera = new THREE.PerspectiveCamera(35, innerWidth / innerHeight, 0.1, 50);
camera.position.set(1.5, 1.8, 5);
camera.lookAt(0, 1.1, 0);

renderer.setAnimationLoop((milliseconds) => {
  ice.rotation.y = 0.4 * Math.sin(milliseconds / 2000);
  renderer.render(scene, camera);
});

addEventListener('resize', () => {
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  renderer.setSize(innerWidth, innerHeight);
});

/** A sky from dark to bright as the environment. */
function sky() {
  const rows = 64;
  const data = new Float32Array(rows * 4);
  for (let row = 0; row < rows; row++) data.set([0.05 + 0.1 * row / rows, 0.06 + 0.15 * row / rows, 0.08 + 0.25 * row / rows, 1], 4 * row);
  const texture = new THREE.DataTexture(data, 1, rows, THREE.RGBAFormat, THREE.FloatType);
  texture.mapping = THREE.EquirectangularReflectionMapping;
  texture.needsUpdate = true;
  return texture;
}
