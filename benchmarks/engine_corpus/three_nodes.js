// three.js with WebGPURenderer's fallback to WebGL 2: its node materials print GLSL ES 3.00 with uniform blocks.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { canvas, run } from './pages_common.js';

const renderer = new THREE.WebGPURenderer({ canvas: canvas(), forceWebGL: true });
const camera = new THREE.PerspectiveCamera(50, 1, 0.1, 20);
camera.position.z = 3;
const texture = () => Object.assign(new THREE.DataTexture(new Uint8Array(64).fill(128), 4, 4), { needsUpdate: true });

async function draw(material, { lights = [new THREE.DirectionalLight()], shadows, fog, geometry = new THREE.TorusKnotGeometry(0.6, 0.2, 12, 5), tone = THREE.NoToneMapping, instances } = {}) {
  const scene = new THREE.Scene();
  const mesh = instances ? new THREE.InstancedMesh(geometry, material, 2) : new THREE.Mesh(geometry, material);
  mesh.castShadow = mesh.receiveShadow = !!shadows;
  scene.add(mesh, ...lights);
  for (const light of lights) if (light.shadow && shadows) light.castShadow = true;
  if (fog) scene.fog = new THREE.Fog(0x888888, 1, 9);
  renderer.shadowMap.enabled = !!shadows;
  renderer.toneMapping = tone;
  await renderer.renderAsync(scene, camera);
}

const KINDS = ['Basic', 'Lambert', 'Phong', 'Toon', 'Standard', 'Physical', 'Normal', 'Matcap', 'SSS'].map((name) => `Mesh${name}NodeMaterial`);
const steps = [['start', () => renderer.init()]];
for (const kind of KINDS) {
  const make = (more = {}) => Object.assign(new THREE[kind](), more);
  steps.push([kind, () => draw(make())]);
  steps.push([`${kind} map, lights`, () => draw(make({ map: texture(), normalMap: texture() }), { lights: [new THREE.PointLight(), new THREE.SpotLight(), new THREE.HemisphereLight()], fog: true })]);
  steps.push([`${kind} shadows`, () => draw(make(), { shadows: true, lights: [new THREE.DirectionalLight(), new THREE.SpotLight(), new THREE.PointLight()] })]);
  steps.push([`${kind} instances`, () => draw(make({ alphaTest: 0.5, map: texture() }), { instances: true, tone: THREE.AgXToneMapping })]);
}
const physical = { clearcoat: 1, sheen: 1, transmission: 1, thickness: 1, iridescence: 1, anisotropy: 0.5, dispersion: 0.1 };
for (const [name, value] of Object.entries(physical)) steps.push([`physical ${name}`, () => draw(Object.assign(new THREE.MeshPhysicalNodeMaterial(), { [name]: value }))]);
steps.push(['physical all', () => draw(Object.assign(new THREE.MeshPhysicalNodeMaterial(), physical))]);

const NOISES = ['mx_noise_float', 'mx_noise_vec3', 'mx_worley_noise_float', 'mx_worley_noise_vec3', 'mx_cell_noise_float', 'mx_fractal_noise_float', 'mx_fractal_noise_vec3'];
for (const name of NOISES) {
  steps.push([`node ${name}`, () => {
    const { uv, vec3, float, positionLocal } = TSL;
    const node = name.startsWith('mx_cell') ? TSL[name](positionLocal)
      : /hue|sat/.test(name) ? TSL[name](positionLocal, 0.5)
      : /UV/.test(name) ? vec3(TSL[name](uv(), float(0.5), uv()), 0) : TSL[name](positionLocal.mul(3));
    const material = new THREE.MeshBasicNodeMaterial();
    material.colorNode = node;
    return draw(material);
  }]);
}
const BLENDS = ['blendBurn', 'blendDodge', 'blendScreen', 'blendOverlay', 'blendColor'];
for (const name of BLENDS) {
  steps.push([`node ${name}`, () => draw(Object.assign(new THREE.MeshBasicNodeMaterial(), { colorNode: TSL[name](TSL.vec4(TSL.positionLocal, 1), TSL.vec4(TSL.normalLocal, 1)) }))]);
}
steps.push(['loops and conditions', () => {
  const { Fn, Loop, If, float, positionLocal, Break } = TSL;
  const sum = Fn(() => {
    const total = float(0).toVar();
    Loop(8, ({ i }) => {
      total.addAssign(positionLocal.x.mul(float(i)).sin());
      If(total.greaterThan(3), () => { Break(); });
    });
    return total;
  });
  return draw(Object.assign(new THREE.MeshStandardNodeMaterial(), { colorNode: sum().mul(TSL.vec3(1)) }));
}]);

run(steps);
