// A sheet of ice with the sun behind it. ?engine=webgl or webgpu (default) chooses the engine; a browser without WebGPU gets WebGL.
// The material is the same object for both.

import { ArcRotateCamera } from '@babylonjs/core/Cameras/arcRotateCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { WebGPUEngine } from '@babylonjs/core/Engines/webgpuEngine.js';
import { DirectionalLight } from '@babylonjs/core/Lights/directionalLight.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { PointLight } from '@babylonjs/core/Lights/pointLight.js';
import { ShadowGenerator } from '@babylonjs/core/Lights/Shadows/shadowGenerator.js';
import '@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { CreateBox } from '@babylonjs/core/Meshes/Builders/boxBuilder.js';
import { CreateGround } from '@babylonjs/core/Meshes/Builders/groundBuilder.js';
import { Scene } from '@babylonjs/core/scene.js';
import { createMaterial } from './ice.babylon.js';

const [canvas] = document.getElementsByTagName('canvas');
const kind = new URLSearchParams(location.search).get('engine') ?? 'webgpu';
const hasWebGPU = kind === 'webgpu' && await WebGPUEngine.IsSupportedAsync;
const engine = hasWebGPU ? await WebGPUEngine.CreateAsync(canvas, { antialias: true }) : new Engine(canvas, true);

const scene = new Scene(engine);
scene.clearColor = Color4.FromHexString('#1b2838ff');
scene.fogMode = Scene.FOGMODE_LINEAR;
scene.fogColor = Color3.FromHexString('#1b2838');
scene.fogStart = 6;
scene.fogEnd = 14;
scene.imageProcessingConfiguration.toneMappingEnabled = true;

const ice = CreateBox('ice', { width: 2.2, height: 2.2, depth: 0.15 });
ice.position.y = 1.25;
ice.material = createMaterial({ erosion: 0.05, cellCount: 6, uvPerUnit: [0.45, 0.45], relief: 0.03, tint: [0.1, 0.16, 0.2, 1], ambient: 0.05 });
const floor = CreateGround('floor', { width: 24, height: 24 });
const stone = new PBRMaterial('stone');
stone.albedoColor = Color3.FromHexString('#3a4450').toLinearSpace();
stone.metallic = 0;
floor.material = stone;
floor.receiveShadows = ice.receiveShadows = true;

const sun = new DirectionalLight('sun', new Vector3(2, -2.2, -4));
sun.position = new Vector3(-4, 4.4, 8);
sun.diffuse = Color3.FromHexString('#ffe2b8').toLinearSpace();
sun.intensity = 5;
const lamp = new PointLight('lamp', new Vector3(2, 3, -3));
lamp.intensity = 20;
const sky = new HemisphericLight('sky', Vector3.Up());
sky.intensity = 0.3;
const shadows = new ShadowGenerator(1024, sun);
shadows.addShadowCaster(ice);

const camera = new ArcRotateCamera('camera', -1.28, 1.43, 5.4, new Vector3(0, 1.1, 0));
camera.fov = 0.61;
camera.minZ = 0.1;
camera.attachControl();

scene.onBeforeRenderObservable.add(() => {
  ice.rotation.y = 0.4 * Math.sin(performance.now() / 2000);
});
engine.runRenderLoop(() => scene.render());
addEventListener('resize', () => engine.resize());
