// A sheet of ice with the sun behind it. ?device=webgl2 or webgpu (default, where the browser has it) chooses the device.

import * as pc from 'playcanvas';
import { createMaterial } from './ice.mjs';

const [canvas] = document.getElementsByTagName('canvas');
const kind = new URLSearchParams(location.search).get('device') ?? 'webgpu';
const device = await pc.createGraphicsDevice(canvas, { deviceTypes: [kind, pc.DEVICETYPE_WEBGL2], antialias: true });
const options = new pc.AppOptions();
options.graphicsDevice = device;
options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem, pc.LightComponentSystem];
const app = new pc.AppBase(canvas);
app.init(options);
app.setCanvasFillMode(pc.FILLMODE_FILL_WINDOW);
app.setCanvasResolution(pc.RESOLUTION_AUTO);
app.scene.ambientLight = new pc.Color(0.25, 0.28, 0.35);
// PlayCanvas tone-maps the fog and not the clear colour: both colours are #1b2838 on the screen.
const [fogColor, clearColor] = ['#26323d', '#1b2838'].map((text) => new pc.Color().fromString(text));
Object.assign(app.scene.fog, { type: pc.FOG_LINEAR, color: fogColor, start: 6, end: 16 });

function add(name, components, [x, y, z] = [0, 0, 0], [pitch, yaw, roll] = [0, 0, 0]) {
  const entity = new pc.Entity(name);
  for (const [component, values] of Object.entries(components)) entity.addComponent(component, values);
  entity.setPosition(x, y, z);
  entity.setEulerAngles(pitch, yaw, roll);
  app.root.addChild(entity);
  return entity;
}

const stone = new pc.StandardMaterial();
stone.diffuse = new pc.Color(0.23, 0.27, 0.31);
stone.update();
add('floor', { render: { type: 'plane', material: stone } }).setLocalScale(30, 1, 30);

const material = createMaterial(device, {
  erosion: 0.05, cellCount: 6, uvPerUnit: [0.45, 0.45], relief: 0.03, tint: [0.1, 0.16, 0.2, 1], sssAmbient: 0.05,
});
const ice = add('ice', { render: { type: 'box', material } }, [0, 1.25, 0]);
ice.setLocalScale(2.2, 2.2, 0.15);

const sun = { type: 'directional', color: new pc.Color(1, 0.89, 0.72), intensity: 1.6, castShadows: true, shadowDistance: 20, shadowBias: 0.3, normalOffsetBias: 0.05 };
add('sun', { light: sun }, [0, 0, 0], [-58, 27, 0]);
add('lamp', { light: { type: 'omni', intensity: 1.2, range: 12 } }, [2, 3, 3]);
const camera = add('camera', { camera: { fov: 35, clearColor, toneMapping: pc.TONEMAP_ACES } }, [1.5, 1.8, 5]);
camera.lookAt(0, 1.1, 0);

let seconds = 0;
app.on('update', (dt) => {
  seconds += dt;
  ice.setEulerAngles(0, 23 * Math.sin(seconds / 2), 0);
});
app.start();
addEventListener('resize', () => app.resizeCanvas());
