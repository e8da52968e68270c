// {{ title }} on {{ mesh }}: drag turns the view, the sliders turn the lamp and set the light.
// In your own page, all that matters is the import of createMaterial and the line that gives the material to the mesh.

import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { createMaterial } from './{{ name }}.js';

const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
renderer.shadowMap.enabled = true;
renderer.toneMapping = THREE.NeutralToneMapping;
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
scene.background = new THREE.Color(0x141518);
scene.environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;

const material = createMaterial({% if baked %}{ innerLight: '{{ response }}' }{% endif %});
const { scene: model } = await new GLTFLoader().loadAsync('body.glb');
model.traverse((mesh) => { if (mesh.isMesh) Object.assign(mesh, { material, castShadow: true, receiveShadow: true }); });
scene.add(model);

const box = new THREE.Box3().setFromObject(model);
const { center, radius } = box.getBoundingSphere(new THREE.Sphere());
const at = (x, y, z) => new THREE.Vector3(x, y, z).multiplyScalar(radius).add(center);

const ground = new THREE.Mesh(new THREE.CircleGeometry(12 * radius, 96).rotateX(-Math.PI / 2), new THREE.MeshStandardMaterial({ color: 0x2a2826, roughness: 0.9 }));
ground.position.set(center.x, box.min.y, center.z);
ground.receiveShadow = true;
scene.fog = new THREE.Fog(scene.background, 6 * radius, 12 * radius);
scene.add(ground);

// the lamp that shines through the body, and a weak light in front
const lamp = new THREE.SpotLight(0xfff0dc, 1, 0, 0.5, 0.6);
lamp.target.position.copy(center);
const front = new THREE.DirectionalLight(0xcfe0ff, 0.2);
front.position.copy(at(2, 3, 4));
front.target.position.copy(center);
for (const light of [lamp, front]) {
  light.castShadow = true;
  light.shadow.mapSize.set(2048, 2048);
  light.shadow.radius = 3;
  light.shadow.normalBias = 0.01 * radius;
  scene.add(light, light.target);
}
Object.assign(lamp.shadow.camera, { near: radius, far: 9 * radius });
Object.assign(front.shadow.camera, { left: -2 * radius, right: 2 * radius, top: 2 * radius, bottom: -2 * radius, near: 0.1 * radius, far: 12 * radius });

const camera = new THREE.PerspectiveCamera(30, 1, radius / 50, 50 * radius);
camera.position.copy(at(1.3, 0.75, 3.7));
const controls = new OrbitControls(camera, renderer.domElement);
controls.target.copy(center);
controls.enableDamping = true;
controls.maxPolarAngle = 0.52 * Math.PI;

const slider = (name) => Number(document.querySelector(`#${name}`).value);
function light() {
  const turn = THREE.MathUtils.degToRad(slider('turn'));
  lamp.position.copy(at(3.4 * Math.sin(turn), 1.5, 3.4 * Math.cos(turn)));
  lamp.intensity = {{ lamp }} * slider('lamp') * radius ** 2;
  scene.environmentIntensity = slider('room');
}
document.querySelector('#panel').addEventListener('input', light);
light();

function resize() {
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  renderer.setSize(innerWidth, innerHeight);
}
addEventListener('resize', resize);
resize();

renderer.setAnimationLoop(() => {
  controls.update();
  renderer.render(scene, camera);
});
