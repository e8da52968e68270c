// {{ title }} on {{ mesh }}: drag turns the view, the sliders turn the lamp and set the light.
// In your own scene, all that matters is the import of createMaterial and the line that gives the material to the mesh.

import * as pc from 'playcanvas';
import { createMaterial } from './{{ name }}.mjs';

const center = new pc.Vec3({{ center_xyz | join(", ") }});
const radius = {{ radius }};
const at = (x, y, z) => new pc.Vec3(x, y, z).mulScalar(radius).add(center);

const [canvas] = document.getElementsByTagName('canvas');
const device = await pc.createGraphicsDevice(canvas, { deviceTypes: [pc.DEVICETYPE_WEBGL2], antialias: true });
const options = new pc.AppOptions();
options.graphicsDevice = device;
options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem, pc.LightComponentSystem];
options.resourceHandlers = [pc.ContainerHandler, pc.TextureHandler];
const app = new pc.AppBase(canvas);
app.init(options);
app.setCanvasFillMode(pc.FILLMODE_FILL_WINDOW);
app.setCanvasResolution(pc.RESOLUTION_AUTO);

function add(name, component, values) {
  const entity = new pc.Entity(name);
  entity.addComponent(component, values);
  app.root.addChild(entity);
  return entity;
}

const material = createMaterial(device{% if baked %}, { innerLight: '{{ response }}' }{% endif %});
const model = new pc.Asset('body', 'container', { url: '{{ body }}' });
await new Promise((resolve, reject) => {
  model.once('load', resolve);
  model.once('error', reject);
  app.assets.add(model);
  app.assets.load(model);
});
const body = model.resource.instantiateRenderEntity({ castShadows: true, receiveShadows: true });
for (const { meshInstances } of body.findComponents('render')) for (const instance of meshInstances) instance.material = material;
app.root.addChild(body);

const stone = new pc.StandardMaterial();
stone.diffuse = new pc.Color().fromString('#2a2826');
stone.gloss = 0.1;
stone.update();
const ground = add('ground', 'render', { type: 'plane', material: stone, castShadows: false });
ground.setPosition(center.x, {{ low_y }}, center.z);
ground.setLocalScale(24 * radius, 1, 24 * radius);

// the lamp that shines through the body, and a weak light in front
const shadows = { castShadows: true, shadowResolution: 1024, shadowBias: 0.2, normalOffsetBias: 0.05, range: 14 * radius, falloffMode: pc.LIGHTFALLOFF_INVERSESQUARED };
const lamp = add('lamp', 'light', { type: 'spot', color: new pc.Color().fromString('#fff0dc'), innerConeAngle: 15, outerConeAngle: 28, ...shadows });
const front = add('front', 'light', { type: 'spot', color: new pc.Color().fromString('#cfe0ff'), innerConeAngle: 15, outerConeAngle: 28, ...shadows });

/** Places a light so that it shines on the body: PlayCanvas' lights shine along their -y. */
function aim(light, place) {
  light.setPosition(place);
  light.lookAt(center);
  light.rotateLocal(90, 0, 0);
}
aim(front, at(2, 3, 4));

/** The intensity for a brightness at a squared distance: PlayCanvas' falloff is 16 / (1 + square). */
const intensity = (brightness, square) => brightness * (1 + square) / 16;
front.light.intensity = intensity(0.06, 29 * radius ** 2);

const slider = (name) => Number(document.querySelector(`#${name}`).value);
function light() {
  const turn = slider('turn') * Math.PI / 180;
  aim(lamp, at(3.4 * Math.sin(turn), 1.5, 3.4 * Math.cos(turn)));
  lamp.light.intensity = intensity({{ lamp_brightness }} * slider('lamp'), 13.8 * radius ** 2);
  app.scene.ambientLight = new pc.Color(1, 0.97, 0.93).mulScalar(slider('room'));
}
document.querySelector('#panel').addEventListener('input', light);
light();

const camera = add('camera', 'camera', { fov: 30, nearClip: radius / 50, farClip: 50 * radius, clearColor: new pc.Color().fromString('#141518'), toneMapping: pc.TONEMAP_NEUTRAL });
const view = { turn: 0.34, lift: 0.19, distance: 4 };
function look() {
  const { turn, lift, distance } = view;
  camera.setPosition(at(distance * Math.sin(turn) * Math.cos(lift), distance * Math.sin(lift), distance * Math.cos(turn) * Math.cos(lift)));
  camera.lookAt(center);
}
canvas.addEventListener('pointermove', ({ buttons, movementX, movementY }) => {
  if (!buttons) return;
  view.turn -= 0.008 * movementX;
  view.lift = Math.min(Math.max(view.lift + 0.008 * movementY, -0.1), 1.4);
  look();
});
canvas.addEventListener('wheel', ({ deltaY }) => {
  view.distance = Math.min(Math.max(view.distance * Math.exp(0.001 * deltaY), 1.5), 12);
  look();
}, { passive: true });
look();

app.start();
addEventListener('resize', () => app.resizeCanvas());
