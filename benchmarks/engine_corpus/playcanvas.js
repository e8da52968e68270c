// PlayCanvas: its standard material in variants, lights and shadows of each kind, sprites, particles, text, camera frames.

import * as pc from 'playcanvas';
import { canvas, run, wait } from './pages_common.js';

let app;
const texture = (more = {}) => new pc.Texture(app.graphicsDevice, { width: 4, height: 4, mipmaps: false, levels: [new Uint8Array(64).fill(128)], ...more });
const faces = () => new pc.Texture(app.graphicsDevice, { width: 4, height: 4, cubemap: true, mipmaps: false, levels: [Array.from({ length: 6 }, () => new Uint8Array(64).fill(128))] });

async function start(clustered) {
  app?.destroy();
  const element = canvas();
  const device = await pc.createGraphicsDevice(element, { deviceTypes: [pc.DEVICETYPE_WEBGL2], antialias: false });
  const options = new pc.AppOptions();
  options.graphicsDevice = device;
  options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem, pc.LightComponentSystem, pc.ParticleSystemComponentSystem, pc.SpriteComponentSystem, pc.ElementComponentSystem, pc.ScreenComponentSystem, pc.GSplatComponentSystem].filter(Boolean);
  options.resourceHandlers = [pc.TextureHandler];
  options.lightmapper = pc.Lightmapper;
  options.batchManager = pc.BatchManager;
  app = new pc.AppBase(element);
  app.init(options);
  app.scene.clusteredLightingEnabled = clustered;
  app.start();
}

const made = [];
function entity(type, values, at = [0, 0, 0]) {
  const one = new pc.Entity('', app);
  app.root.addChild(one);
  if (type) one.addComponent(type, values);
  one.setPosition(...at);
  made.push(one);
  return one;
}

function clear() {
  for (const one of made.splice(0)) one.destroy();
  app.scene.fog.type = pc.FOG_NONE;
  app.scene.envAtlas = app.scene.skybox = null;
}

async function frames(count = 3) {
  for (let index = 0; index < count; index++) {
    app.tick?.();
    app.render();
    await wait(5);
  }
}

const LIGHT = { directional: { type: 'directional' }, omni: { type: 'omni' }, spot: { type: 'spot' } };

async function draw(material, { lights = [{ type: 'directional' }], camera = {}, after } = {}) {
  clear();
  const eye = entity('camera', { clearColor: new pc.Color(0, 0, 0), ...camera }, [0, 0, 3]);
  for (const light of lights) entity('light', { shadowResolution: 16, ...light }, [1, 2, 3]);
  const mesh = entity('render', { type: 'torus', castShadows: true, receiveShadows: true });
  mesh.render.meshInstances.forEach((instance) => { instance.material = material; });
  await after?.(mesh, eye);
  await frames();
}

const standard = (values = {}) => {
  const material = Object.assign(new pc.StandardMaterial(), Object.fromEntries(Object.entries(values).map(([name, value]) => [name, typeof value === 'function' ? value() : value])));
  material.update();
  return material;
};
const VARIANTS = {
  plain: {}, metalness: { useMetalness: true, metalness: 0.5, gloss: 0.5 }, 'specular colours': { useMetalness: true, useMetalnessSpecularColor: true }, lambert: { useLighting: true, specular: () => new pc.Color(0, 0, 0) },
  maps: { diffuseMap: texture, normalMap: texture, glossMap: texture, specularMap: texture, emissiveMap: texture, aoMap: texture, opacityMap: texture, blendType: pc.BLEND_NORMAL },
  'maps of metal': { useMetalness: true, metalnessMap: texture, diffuseMap: texture, normalMap: texture, glossMap: texture, lightMap: texture },
  'second coordinates': { diffuseMap: texture, diffuseMapUv: 1, diffuseMapTiling: () => new pc.Vec2(2, 2) }, 'vertex colours': { diffuseVertexColor: true, emissiveVertexColor: true }, 'detail maps': { diffuseMap: texture, diffuseDetailMap: texture, normalMap: texture, normalDetailMap: texture },
  parallax: { heightMap: texture, normalMap: texture }, 'cube map': { cubeMap: faces }, 'sphere map': { sphereMap: texture }, 'box projection': { cubeMap: faces, cubeMapProjection: pc.CUBEPROJ_BOX, cubeMapProjectionBox: () => new pc.BoundingBox() },
  clearcoat: { clearCoat: 1, clearCoatGloss: 0.8, clearCoatNormalMap: texture, clearCoatMap: texture }, sheen: { useSheen: true, sheen: () => new pc.Color(1, 1, 1), sheenGlossMap: texture }, iridescence: { useIridescence: true, iridescence: 1, iridescenceMap: texture },
  refraction: { refraction: 1, useDynamicRefraction: true, thickness: 1, thicknessMap: texture, useMetalness: true }, dispersion: { refraction: 1, useDynamicRefraction: true, dispersion: 0.2, thickness: 1 }, 'static refraction': { refraction: 0.5, refractionIndex: 0.8, cubeMap: faces },
  anisotropy: { enableGGXSpecular: true, anisotropyIntensity: 0.5, anisotropyMap: texture }, 'alpha test': { opacityMap: texture, alphaTest: 0.5 }, dither: { opacityMap: texture, opacityDither: pc.DITHER_BAYER8 }, 'blue noise': { opacityMap: texture, opacityDither: pc.DITHER_BLUENOISE, opacityShadowDither: pc.DITHER_BAYER8 }, 'alpha to coverage': { alphaToCoverage: true, opacityMap: texture, alphaTest: 0.5 },
  'two sided': { cull: pc.CULLFACE_NONE, twoSidedLighting: true }, unlit: { useLighting: false, emissiveMap: texture }, 'shadow catcher': { shadowCatcher: true }, 'pixel snap': { pixelSnap: true }, 'occludes specular': { aoMap: texture, occludeSpecular: pc.SPECOCC_GLOSSDEPENDENT }, 'no energy conservation': { conserveEnergy: false },
  all: { useMetalness: true, clearCoat: 1, useSheen: true, useIridescence: true, refraction: 0.5, useDynamicRefraction: true, thickness: 1, anisotropyIntensity: 0.5, enableGGXSpecular: true, normalMap: texture, diffuseMap: texture },
};
const SHADOWS = ['SHADOW_PCF1_32F', 'SHADOW_PCF3_32F', 'SHADOW_PCF5_32F', 'SHADOW_VSM_16F', 'SHADOW_VSM_32F', 'SHADOW_PCSS_32F'];

const steps = [];
for (const clustered of [false, true]) {
  const mode = clustered ? 'clustered' : 'classic';
  steps.push([mode, () => start(clustered)]);
  for (const [name, values] of Object.entries(VARIANTS)) steps.push([`${mode} ${name}`, () => draw(standard(values))]);
  for (const [name, light] of Object.entries(LIGHT)) {
    steps.push([`${mode} ${name}`, () => draw(standard(), { lights: [light] })]);
    for (const shadow of SHADOWS) steps.push([`${mode} ${name} ${shadow}`, () => draw(standard(), { lights: [{ ...light, castShadows: true, shadowType: pc[shadow] }] })]);
    steps.push([`${mode} ${name} cookie`, () => draw(standard(), { lights: [{ ...light, cookie: name === 'omni' ? faces() : texture() }] })]);
    for (const shape of [pc.LIGHTSHAPE_RECT, pc.LIGHTSHAPE_DISK, pc.LIGHTSHAPE_SPHERE]) {
      steps.push([`${mode} ${name} shape ${shape}`, async () => {
        await draw(standard({ clearCoat: shape === pc.LIGHTSHAPE_DISK ? 1 : 0 }), { lights: [{ ...light, shape }] });
      }]);
    }
    steps.push([`${mode} ${name} linear falloff`, () => draw(standard(), { lights: [{ ...light, falloffMode: pc.LIGHTFALLOFF_LINEAR }, { type: 'omni' }, { type: 'spot', castShadows: true }] })]);
  }
  for (const fog of [pc.FOG_LINEAR, pc.FOG_EXP, pc.FOG_EXP2]) steps.push([`${mode} fog ${fog}`, () => draw(standard(), { after: () => { app.scene.fog.type = fog; } })]);
  for (const [name, tone] of Object.entries(pc).filter(([key]) => key.startsWith('TONEMAP_'))) steps.push([`${mode} ${name}`, () => draw(standard(), { camera: { toneMapping: tone } })]);
  steps.push([`${mode} cascades`, () => draw(standard(), { lights: [{ type: 'directional', castShadows: true, numCascades: 4, cascadeBlend: 0.1 }] })]);
  steps.push([`${mode} environment`, () => draw(standard({ useMetalness: true }), { after: () => { app.scene.envAtlas = texture(); app.scene.skybox = faces(); } })]);
  steps.push([`${mode} prefiltered environment`, () => draw(standard({ useMetalness: true }), { after: () => { const lighting = pc.EnvLighting.generateLightingSource(faces()); app.scene.envAtlas = pc.EnvLighting.generateAtlas(lighting); app.scene.skybox = pc.EnvLighting.generateSkyboxCubemap(faces()); } })]);
  steps.push([`${mode} dome`, () => draw(standard(), { after: () => { app.scene.skybox = faces(); app.scene.sky.type = pc.SKYTYPE_DOME; } })]);
  steps.push([`${mode} instances`, () => draw(standard(), { after: (mesh) => { const format = pc.VertexFormat.getDefaultInstancingFormat(app.graphicsDevice); mesh.render.meshInstances[0].setInstancing(new pc.VertexBuffer(app.graphicsDevice, format, 2, { data: new Float32Array(32) })); } })]);
  steps.push([`${mode} skin`, () => draw(standard(), { after: (mesh) => { const [instance] = mesh.render.meshInstances; const bone = new pc.GraphNode('b'); const skin = new pc.Skin(app.graphicsDevice, [new pc.Mat4()], ['b']); const one = new pc.SkinInstance(skin); one.bones = [bone]; instance.skinInstance = one; } })]);
  steps.push([`${mode} morph`, () => draw(standard(), { after: (mesh) => { const [instance] = mesh.render.meshInstances; const count = instance.mesh.vertexBuffer.numVertices; const target = new pc.MorphTarget({ deltaPositions: new Float32Array(3 * count), deltaNormals: new Float32Array(3 * count) }); const morph = new pc.Morph([target], app.graphicsDevice); instance.mesh.morph = morph; instance.morphInstance = new pc.MorphInstance(morph); instance.morphInstance.setWeight(0, 0.5); } })]);
}
steps.push(['sprite', () => draw(standard(), { after: () => { const atlas = new pc.TextureAtlas(); atlas.texture = texture(); atlas.frames = { a: { rect: new pc.Vec4(0, 0, 4, 4), pivot: new pc.Vec2(), border: new pc.Vec4(1, 1, 1, 1) } }; for (const renderMode of [pc.SPRITE_RENDERMODE_SIMPLE, pc.SPRITE_RENDERMODE_SLICED, pc.SPRITE_RENDERMODE_TILED]) { entity('sprite', { type: 'simple' }).sprite.sprite = new pc.Sprite(app.graphicsDevice, { atlas, frameKeys: ['a'], renderMode }); } } })]);
for (const values of [{}, { lighting: true, normalMap: () => texture() }, { depthSoftening: 0.5 }, { stretch: 0.5, alignToMotion: true }, { sort: 1, loop: true }, { orientation: 1 }, { mesh: true }, { animTilesX: 2, animTilesY: 2, animNumFrames: 4 }, { localSpace: true, wrap: true, wrapBounds: new pc.Vec3(1, 1, 1) }, { emitterShape: 1 }]) {
  steps.push([`particles ${JSON.stringify(values)}`, () => draw(standard(), { after: () => { const component = entity('particlesystem', { numParticles: 8, lifetime: 1, rate: 0.01, colorMap: texture(), ...Object.fromEntries(Object.entries(values).map(([name, value]) => [name, name === 'mesh' ? pc.Mesh.fromGeometry(app.graphicsDevice, new pc.BoxGeometry()) : typeof value === 'function' ? value() : value])) }); component.particlesystem.play(); } })]);
}
for (const [name, values] of Object.entries({ bloom: (f) => { f.bloom.intensity = 0.1; }, ssao: (f) => { f.ssao.type = 'lighting'; }, 'ssao combined': (f) => { f.ssao.type = 'combine'; f.ssao.blurEnabled = true; }, taa: (f) => { f.taa.enabled = true; }, dof: (f) => { f.dof.enabled = true; f.dof.nearBlur = true; }, grading: (f) => { f.grading.enabled = true; f.vignette.intensity = 0.5; f.fringing.intensity = 5; f.colorEnhance && (f.colorEnhance.enabled = true); }, lut: (f) => { f.colorLUT.texture = texture({ width: 256, height: 16, levels: [new Uint8Array(256 * 64)] }); }, sharpness: (f) => { f.rendering.sharpness = 0.5; f.rendering.sceneColorMap = true; f.rendering.sceneDepthMap = true; } })) {
  steps.push([`camera frame ${name}`, () => draw(standard(), { after: (mesh, eye) => { const frame = new pc.CameraFrame(app, eye.camera); values(frame); frame.update(); } })]);
}
steps.push(['outline, picker, lines', () => draw(standard(), { after: (mesh, eye) => { app.drawLine(new pc.Vec3(), new pc.Vec3(1, 1, 1)); const picker = new pc.Picker(app, 8, 8, true); picker.prepare(eye.camera, app.scene); } })]);
steps.push(['lightmapper', () => draw(standard(), { lights: [{ type: 'directional', bake: true, castShadows: true, affectLightmapped: true, bakeDir: true }], after: (mesh) => { mesh.render.lightmapped = true; app.scene.ambientBake = true; app.scene.lightmapMode = pc.BAKE_COLORDIR; app.scene.lightmapFilterEnabled = true; app.lightmapper.bake([mesh], pc.BAKE_COLORDIR); } })]);
steps.push(['environment conversions', () => { for (const distribution of ['ggx', 'lambert', 'phong', 'none']) pc.reprojectTexture?.(faces(), texture({ width: 16, height: 16, levels: [new Uint8Array(1024)] }), { distribution, numSamples: 64 }); pc.EnvLighting.generatePrefilteredAtlas?.([faces(), faces(), faces(), faces(), faces(), faces()]); }]);

run(steps);
