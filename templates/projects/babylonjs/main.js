// {{ title }} on {{ mesh }}: drag turns the view, the sliders turn the lamp and set the light.
// In your own scene, all that matters is the import of createMaterial and the line that gives the material to the mesh.

import { ArcRotateCamera } from '@babylonjs/core/Cameras/arcRotateCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { SpotLight } from '@babylonjs/core/Lights/spotLight.js';
import { ShadowGenerator } from '@babylonjs/core/Lights/Shadows/shadowGenerator.js';
import '@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js';
import '@babylonjs/core/Loading/loadingScreen.js';
import { AppendSceneAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { ImageProcessingConfiguration } from '@babylonjs/core/Materials/imageProcessingConfiguration.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { CreateDisc } from '@babylonjs/core/Meshes/Builders/discBuilder.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/glTF/2.0/glTFLoader.js';
import { createMaterial } from './{{ name }}.babylon.js';

const center = new Vector3({{ center_xyz | join(", ") }});
const radius = {{ radius }};
const at = (x, y, z) => new Vector3(x, y, z).scale(radius).add(center);

const [canvas] = document.getElementsByTagName('canvas');
const engine = new Engine(canvas, true);
const scene = new Scene(engine);
scene.useRightHandedSystem = true; // as glTF: the body is not mirrored
const air = Color3.FromHexString('#141518').toLinearSpace();
scene.clearColor = Color4.FromColor3(air, 1);
scene.fogMode = Scene.FOGMODE_LINEAR;
scene.fogColor = air;
scene.fogStart = 6 * radius;
scene.fogEnd = 12 * radius;
Object.assign(scene.imageProcessingConfiguration, { toneMappingEnabled: true, toneMappingType: ImageProcessingConfiguration.TONEMAPPING_KHR_PBR_NEUTRAL });

const camera = new ArcRotateCamera('camera', 1.23, 1.38, 4 * radius, center);
camera.fov = 0.52;
camera.minZ = radius / 50;
camera.maxZ = 50 * radius;
camera.wheelDeltaPercentage = 0.01;
camera.attachControl();

// the lamp that shines through the body, and a weak light in front
const lamp = new SpotLight('lamp', center, Vector3.Down(), 1, 2);
lamp.diffuse = Color3.FromHexString('#fff0dc').toLinearSpace();
const front = new SpotLight('front', at(2, 3, 4), new Vector3(-2, -3, -4), 0.8, 2);
front.diffuse = Color3.FromHexString('#cfe0ff').toLinearSpace();
front.intensity = 6 * radius ** 2;
const sky = new HemisphericLight('sky', Vector3.Up(), scene);
sky.groundColor = new Color3(0.3, 0.28, 0.26);

const material = createMaterial({% if baked %}{ innerLight: '{{ response }}' }{% endif %});
await AppendSceneAsync('{{ body }}', scene);
for (const light of [lamp, front]) {
  light.shadowMinZ = 0.1 * radius;
  light.shadowMaxZ = 9 * radius;
  const shadows = new ShadowGenerator(1024, light);
  shadows.usePercentageCloserFiltering = true;
  for (const mesh of scene.meshes) if (mesh.getTotalVertices()) shadows.addShadowCaster(mesh);
}
for (const mesh of scene.meshes) if (mesh.getTotalVertices()) Object.assign(mesh, { material, receiveShadows: true });

const ground = CreateDisc('ground', { radius: 12 * radius, tessellation: 96, sideOrientation: 2 });
ground.rotation.x = Math.PI / 2;
ground.position.set(center.x, {{ low_y }}, center.z);
ground.material = Object.assign(new PBRMaterial('ground'), { albedoColor: Color3.FromHexString('#2a2826').toLinearSpace(), metallic: 0, roughness: 0.9 });
ground.receiveShadows = true;

const slider = (name) => Number(document.querySelector(`#${name}`).value);
function light() {
  const turn = slider('turn') * Math.PI / 180;
  lamp.position = at(3.4 * Math.sin(turn), 1.5, 3.4 * Math.cos(turn));
  lamp.setDirectionToTarget(center);
  lamp.intensity = {{ lamp }} * slider('lamp') * radius ** 2;
  sky.intensity = 2 * slider('room');
}
document.querySelector('#panel').addEventListener('input', light);
light();

engine.runRenderLoop(() => scene.render());
addEventListener('resize', () => engine.resize());
