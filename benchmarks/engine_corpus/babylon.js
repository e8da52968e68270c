// Babylon.js: its materials in variants, node materials, its material library, post processes, pipelines, layers, particles.

import * as B from '@babylonjs/core';
import * as library from '@babylonjs/materials';
import { canvas, picture, run, wait } from './pages_common.js';

const engine = new B.Engine(canvas(), false, { disableWebGL2Support: false });
const texture = () => B.RawTexture.CreateRGBATexture(new Uint8Array(64).fill(128), 4, 4, scene, false);
const faces = () => new B.RawCubeTexture(scene, Array.from({ length: 6 }, () => new Uint8Array(64).fill(128)), 4);
let scene;
let camera;

const LIGHTS = {
  directional: () => new B.DirectionalLight('l', new B.Vector3(0, -1, 1), scene),
  point: () => new B.PointLight('l', new B.Vector3(0, 3, 0), scene),
  spot: () => new B.SpotLight('l', new B.Vector3(0, 3, 0), new B.Vector3(0, -1, 0), 1, 2, scene),
  hemispheric: () => new B.HemisphericLight('l', new B.Vector3(0, 1, 0), scene),
  area: () => new B.RectAreaLight('l', new B.Vector3(0, 1, 0), 1, 1, scene),
};

function begin(lights = ['hemispheric', 'directional'], shadows = '') {
  scene?.dispose();
  scene = new B.Scene(engine);
  camera = new B.ArcRotateCamera('c', 1, 1, 4, B.Vector3.Zero(), scene);
  const mesh = B.MeshBuilder.CreateTorusKnot('m', { radius: 0.6, tube: 0.2, radialSegments: 12, tubularSegments: 5 }, scene);
  for (const name of lights) {
    const light = LIGHTS[name]();
    if (shadows && light.getShadowGenerator && name !== 'hemispheric' && name !== 'area') {
      const generator = shadows === 'cascaded' && name === 'directional' ? new B.CascadedShadowGenerator(16, light) : new B.ShadowGenerator(16, light);
      if (shadows in generator) generator[shadows] = true;
      generator.addShadowCaster(mesh);
      mesh.receiveShadows = true;
    }
  }
  return mesh;
}

// Babylon compiles when a mesh is ready to be drawn: several frames.
async function draw() {
  const end = performance.now() + 6000;
  do {
    scene.render();
    await wait(10);
  } while (!scene.isReady() && performance.now() < end);
  scene.render();
}

const steps = [];
const step = (name, make, { lights, shadows, after } = {}) => steps.push([name, async () => {
  const mesh = begin(lights, shadows);
  mesh.material = make(mesh);
  await after?.(mesh);
  await draw();
}]);
const assign = (object, values) => {
  for (const [path, value] of Object.entries(values)) {
    const parts = path.split('.');
    const last = parts.pop();
    parts.reduce((parent, part) => parent[part], object)[last] = typeof value === 'function' ? value() : value;
  }
  return object;
};
const standard = (values = {}) => () => assign(new B.StandardMaterial('standard', scene), values);
const pbr = (values = {}) => () => assign(new B.PBRMaterial('pbr', scene), { metallic: 0.2, roughness: 0.5, ...values });
const cube = () => faces();
const parallel = () => Object.assign(texture(), { coordinatesMode: B.Texture.PLANAR_MODE });

const SHAPES = {
  fog: (mesh) => { scene.fogMode = B.Scene.FOGMODE_EXP2; mesh.applyFog = true; },
  instances: (mesh) => { mesh.createInstance('i'); mesh.registerInstancedBuffer('color', 4); mesh.instancedBuffers.color = new B.Color4(1, 0, 0, 1); },
  'thin instances': (mesh) => mesh.thinInstanceAdd([B.Matrix.Identity(), B.Matrix.Translation(1, 0, 0)]),
  colors: (mesh) => mesh.setVerticesData(B.VertexBuffer.ColorKind, new Float32Array(4 * mesh.getTotalVertices()).fill(1)),
  skeleton: (mesh) => {
    const skeleton = new B.Skeleton('s', 's', scene);
    new B.Bone('b', skeleton);
    const count = 4 * mesh.getTotalVertices();
    mesh.setVerticesData(B.VertexBuffer.MatricesIndicesKind, new Float32Array(count));
    mesh.setVerticesData(B.VertexBuffer.MatricesWeightsKind, new Float32Array(count).fill(0.25));
    mesh.skeleton = skeleton;
  },
  morph: (mesh) => {
    mesh.morphTargetManager = new B.MorphTargetManager(scene);
    mesh.morphTargetManager.addTarget(B.MorphTarget.FromMesh(mesh.clone(), 'a', 0.5));
  },
  clipping: () => { scene.clipPlane = new B.Plane(0, 1, 0, 0); scene.clipPlane2 = new B.Plane(1, 0, 0, 0); },
  'log depth': (mesh) => { mesh.material.useLogarithmicDepth = true; },
  'image processing': () => assign(scene.imageProcessingConfiguration, { toneMappingEnabled: true, vignetteEnabled: true, colorCurvesEnabled: true, colorCurves: () => new B.ColorCurves(), ditheringEnabled: true }),
};
const STANDARD = {
  plain: {}, maps: { diffuseTexture: texture, specularTexture: texture, emissiveTexture: texture, ambientTexture: texture, opacityTexture: texture },
  bump: { bumpTexture: texture }, parallax: { bumpTexture: texture, useParallax: true, useParallaxOcclusion: true }, lightmap: { lightmapTexture: texture, useLightmapAsShadowmap: true },
  reflection: { reflectionTexture: cube }, 'planar reflection': { reflectionTexture: parallel }, refraction: { refractionTexture: cube },
  fresnel: { diffuseFresnelParameters: () => new B.FresnelParameters(), emissiveFresnelParameters: () => new B.FresnelParameters(), reflectionTexture: cube, reflectionFresnelParameters: () => new B.FresnelParameters() },
  'alpha test': { diffuseTexture: texture, useAlphaFromDiffuseTexture: true, transparencyMode: 1 }, 'two sided': { backFaceCulling: false, twoSidedLighting: true },
  unlit: { disableLighting: true, emissiveColor: () => B.Color3.White() }, wireframe: { wireframe: true }, points: { pointsCloud: true }, 'detail map': { 'detailMap.isEnabled': true, 'detailMap.texture': texture },
};
const PBR = {
  plain: {}, maps: { albedoTexture: texture, metallicTexture: texture, bumpTexture: texture, ambientTexture: texture, emissiveTexture: texture, opacityTexture: texture, lightmapTexture: texture },
  environment: { reflectionTexture: cube }, 'spherical harmonics': { reflectionTexture: cube, useRadianceOverAlpha: false, realTimeFiltering: true, realTimeFilteringQuality: 8 },
  clearcoat: { 'clearCoat.isEnabled': true, 'clearCoat.texture': texture, 'clearCoat.bumpTexture': texture, 'clearCoat.isTintEnabled': true, reflectionTexture: cube },
  sheen: { 'sheen.isEnabled': true, 'sheen.texture': texture, reflectionTexture: cube }, iridescence: { 'iridescence.isEnabled': true, reflectionTexture: cube },
  anisotropy: { 'anisotropy.isEnabled': true, 'anisotropy.texture': texture, bumpTexture: texture, reflectionTexture: cube },
  translucency: { 'subSurface.isTranslucencyEnabled': true, 'subSurface.thicknessTexture': texture }, refraction: { 'subSurface.isRefractionEnabled': true, 'subSurface.refractionTexture': cube, 'subSurface.isDispersionEnabled': true },
  scattering: { 'subSurface.isScatteringEnabled': true }, parallax: { bumpTexture: texture, useParallax: true, useParallaxOcclusion: true },
  'specular glossiness': { reflectivityTexture: texture, useMicroSurfaceFromReflectivityMapAlpha: true, metallic: null, roughness: null }, unlit: { unlit: true }, 'alpha blend': { alpha: 0.5, transparencyMode: 2, useRadianceOverAlpha: true },
  'two sided': { backFaceCulling: false, twoSidedLighting: true, forceIrradianceInFragment: true, reflectionTexture: cube }, 'detail map': { 'detailMap.isEnabled': true, 'detailMap.texture': texture }, decal: { 'decalMap.isEnabled': true },
  'all layers': { 'clearCoat.isEnabled': true, 'sheen.isEnabled': true, 'iridescence.isEnabled': true, 'anisotropy.isEnabled': true, 'subSurface.isRefractionEnabled': true, 'subSurface.isTranslucencyEnabled': true, reflectionTexture: cube, bumpTexture: texture },
};
const SHADOWS = ['useBlurExponentialShadowMap', 'usePoissonSampling', 'usePercentageCloserFiltering', 'useContactHardeningShadow', 'useCloseExponentialShadowMap', 'cascaded', 'plain'];

for (const [kind, variants, make] of [['standard', STANDARD, standard], ['pbr', PBR, pbr]]) {
  for (const [name, values] of Object.entries(variants)) step(`${kind} ${name}`, make(values));
  for (const [name, after] of Object.entries(SHAPES)) step(`${kind} ${name}`, make(), { after });
  for (const name of Object.keys(LIGHTS)) step(`${kind} ${name}`, make(), { lights: [name] });
  for (const shadows of SHADOWS) step(`${kind} shadows ${shadows}`, make(), { lights: ['directional', 'point', 'spot'], shadows });
}
for (const [name, make] of Object.entries({
  'node material': () => new B.NodeMaterial('n', scene).setToDefault(),
  'OpenPBR': () => B.OpenPBRMaterial && new B.OpenPBRMaterial('o', scene),
  background: () => new B.BackgroundMaterial('b', scene), 'background with textures': () => assign(new B.BackgroundMaterial('b', scene), { diffuseTexture: texture, reflectionTexture: cube, opacityFresnel: true }),
  'grid, default': () => new library.GridMaterial('g', scene),
})) {
  step(name, () => {
    const made = make();
    return made;
  });
}
steps.push(['node material', async () => {
  const mesh = begin();
  const material = new B.NodeMaterial('n', scene);
  material.setToDefault();
  material.build();
  mesh.material = material;
  await draw();
}]);
for (const name of ['setToDefaultPostProcess', 'setToDefaultProceduralTexture', 'setToDefaultParticle']) {
  steps.push([`node material ${name}`, async () => {
    begin();
    const material = new B.NodeMaterial('n', scene);
    material[name]();
    material.build();
    if (name.endsWith('PostProcess')) material.createPostProcess(camera);
    if (name.endsWith('Texture')) material.createProceduralTexture(16, scene);
    if (name.endsWith('Particle')) {
      const particles = assign(new B.ParticleSystem('p', 10, scene), { particleTexture: texture });
      material.createEffectForParticles(particles);
      particles.start();
    }
    await draw();
  }]);
}
for (const name of ['CellMaterial', 'FireMaterial', 'FurMaterial', 'GradientMaterial', 'GridMaterial', 'LavaMaterial', 'MixMaterial', 'NormalMaterial', 'ShadowOnlyMaterial', 'SimpleMaterial', 'SkyMaterial', 'TerrainMaterial', 'TriPlanarMaterial', 'WaterMaterial']) {
  for (const shadows of ['', 'usePercentageCloserFiltering']) {
    step(`${name} ${shadows}`, () => assign(new library[name](name, scene), {
      ...(['CellMaterial', 'FireMaterial', 'FurMaterial', 'LavaMaterial', 'SimpleMaterial', 'NormalMaterial'].includes(name) ? { diffuseTexture: texture } : {}),
      ...(name === 'FireMaterial' ? { distortionTexture: texture, opacityTexture: texture } : {}), ...(name === 'LavaMaterial' ? { noiseTexture: texture } : {}),
      ...(name === 'WaterMaterial' ? { bumpTexture: texture } : {}), ...(name === 'TerrainMaterial' ? { mixTexture: texture, diffuseTexture1: texture, diffuseTexture2: texture, diffuseTexture3: texture, bumpTexture1: texture } : {}),
      ...(name === 'TriPlanarMaterial' ? { diffuseTextureX: texture, diffuseTextureY: texture, diffuseTextureZ: texture } : {}), ...(name === 'MixMaterial' ? { mixTexture1: texture, diffuseTexture1: texture, diffuseTexture2: texture, diffuseTexture3: texture, diffuseTexture4: texture } : {}),
    }), { lights: ['directional', 'point', 'hemispheric'], shadows });
  }
}

const POST = {
  AnaglyphPostProcess: () => [1, [camera, camera]], BlackAndWhitePostProcess: () => [1, camera], BlurPostProcess: () => [new B.Vector2(1, 0), 32, 1, camera],
  ChromaticAberrationPostProcess: () => [32, 32, 1, camera], ColorCorrectionPostProcess: () => [picture, 1, camera], ConvolutionPostProcess: () => [B.ConvolutionPostProcess.EmbossKernel, 1, camera],
  DisplayPassPostProcess: () => [1, camera], ExtractHighlightsPostProcess: () => [1, camera], FilterPostProcess: () => [B.Matrix.Identity(), 1, camera], FxaaPostProcess: () => [1, camera],
  GrainPostProcess: () => [1, camera], HighlightsPostProcess: () => [1, camera], ImageProcessingPostProcess: () => [1, camera], PassPostProcess: () => [1, camera],
  RefractionPostProcess: () => [picture, B.Color3.White(), 0.5, 0.5, 1, camera], SharpenPostProcess: () => [1, camera], TonemapPostProcess: () => [B.TonemappingOperator.Hable, 1, camera],
  ScreenSpaceCurvaturePostProcess: () => [scene, 1, camera], MotionBlurPostProcess: () => [scene, 1, camera], ScreenSpaceReflectionPostProcess: () => [scene, 1, camera],
  StereoscopicInterlacePostProcessI: () => [[camera, camera], true, true], VolumetricLightScatteringPostProcess: () => [1, camera, undefined, 20],
};
for (const [name, values] of Object.entries(POST)) {
  step(`post ${name}`, standard(), { after: () => { new B[name](name, ...values()); } });
}
for (const operator of [1, 2, 3]) step(`tone mapping ${operator}`, standard(), { after: () => { new B.TonemapPostProcess('t', operator, 1, camera); } });
const PIPELINES = {
  DefaultRenderingPipeline: () => assign(new B.DefaultRenderingPipeline('p', true, scene, [camera]), { bloomEnabled: true, depthOfFieldEnabled: true, chromaticAberrationEnabled: true, grainEnabled: true, sharpenEnabled: true, fxaaEnabled: true, glowLayerEnabled: true }),
  SSAORenderingPipeline: () => new B.SSAORenderingPipeline('p', scene, 1, [camera]), SSAO2RenderingPipeline: () => new B.SSAO2RenderingPipeline('p', scene, 1, [camera], true),
  SSRRenderingPipeline: () => new B.SSRRenderingPipeline('p', scene, [camera], true), LensRenderingPipeline: () => new B.LensRenderingPipeline('p', { edge_blur: 1, chromatic_aberration: 1, distortion: 1, dof_focus_distance: 1, dof_aperture: 1, grain_amount: 1, dof_pentagon: true, dof_gain: 1, dof_threshold: 1, blur_noise: true }, scene, 1, [camera]),
  StandardRenderingPipeline: () => assign(new B.StandardRenderingPipeline('p', scene, 1, null, [camera]), { BloomEnabled: true, DepthOfFieldEnabled: true, LensFlareEnabled: true, HDREnabled: true, VLSEnabled: false, MotionBlurEnabled: true }),
  TAARenderingPipeline: () => assign(new B.TAARenderingPipeline('p', scene, [camera]), { isEnabled: true }), FSR1RenderingPipeline: () => new B.FSR1RenderingPipeline('p', scene, [camera]),
};
for (const [name, make] of Object.entries(PIPELINES)) step(`pipeline ${name}`, pbr(), { after: () => { make(); } });
const OTHERS = {
  'glow layer': () => new B.GlowLayer('g', scene), 'highlight layer': (mesh) => new B.HighlightLayer('h', scene).addMesh(mesh, B.Color3.White()), outline: (mesh) => { mesh.renderOutline = mesh.renderOverlay = true; },
  edges: (mesh) => mesh.enableEdgesRendering(), depth: () => scene.enableDepthRenderer(), 'geometry buffer': () => scene.enableGeometryBufferRenderer(), 'depth peeling': (mesh) => { scene.useOrderIndependentTransparency = true; mesh.visibility = 0.5; },
  particles: () => assign(new B.ParticleSystem('p', 10, scene), { particleTexture: texture }).start(), 'GPU particles': () => assign(new B.GPUParticleSystem('p', { capacity: 10 }, scene), { particleTexture: texture }).start(),
  'animated GPU particles': () => { const one = assign(new B.GPUParticleSystem('p', { capacity: 10 }, scene), { particleTexture: texture, isAnimationSheetEnabled: true, isLocal: true, noiseTexture: texture, isBillboardBased: false }); one.addColorGradient(0, new B.Color4(1, 0, 0, 1)); one.addColorGradient(1, new B.Color4(1, 1, 0, 1)); one.addSizeGradient(0, 1); one.addSizeGradient(1, 2); one.addVelocityGradient?.(0, 1); one.start(); },
  sprites: () => { new B.Sprite('s', new B.SpriteManager('s', picture, 4, 8, scene)); }, 'lens flares': () => { const system = new B.LensFlareSystem('l', B.MeshBuilder.CreateBox('x', {}, scene), scene); new B.LensFlare(0.2, 0, B.Color3.White(), picture, system); },
  skybox: () => scene.createDefaultSkybox(faces(), true), environment: () => { scene.environmentTexture = faces(); scene.createDefaultEnvironment({ createSkybox: true, createGround: true, environmentTexture: faces() }); }, layer: () => { new B.Layer('l', picture, scene); }, trail: (mesh) => { new B.TrailMesh('t', mesh, scene); },
  lines: () => B.MeshBuilder.CreateLines('l', { points: [B.Vector3.Zero(), B.Vector3.One()], colors: [new B.Color4(1, 0, 0, 1), new B.Color4(1, 1, 0, 1)] }, scene), dashes: () => B.MeshBuilder.CreateDashedLines('l', { points: [B.Vector3.Zero(), B.Vector3.One()] }, scene), 'greased line': () => B.CreateGreasedLine('g', { points: [0, 0, 0, 1, 1, 1] }, {}, scene),
  splats: () => { const splat = new B.GaussianSplattingMesh('s', null, scene); splat.updateData(new ArrayBuffer(32 * 16)); }, 'noise texture': (mesh) => { mesh.material.diffuseTexture = new B.NoiseProceduralTexture('n', 16, scene); },
  'reflective shadow map': () => { const map = new B.ReflectiveShadowMap(scene, scene.lights[1], { width: 16, height: 16 }); map.addMesh(); }, 'IBL shadows': () => { new B.IblShadowsRenderPipeline('i', scene, {}, [camera]); }, 'bounding box': (mesh) => { mesh.showBoundingBox = true; },
  probe: (mesh) => { const probe = new B.ReflectionProbe('p', 16, scene); probe.renderList.push(mesh); }, mirror: (mesh) => { const mirror = new B.MirrorTexture('m', 16, scene); mirror.mirrorPlane = new B.Plane(0, -1, 0, 0); mirror.blurKernel = 8; mirror.renderList = [mesh]; mesh.material.reflectionTexture = mirror; },
  'baked animation': (mesh) => { const manager = new B.BakedVertexAnimationManager(scene); manager.texture = texture(); mesh.bakedVertexAnimationManager = manager; SHAPES.skeleton(mesh); }, 'prefiltered environment': async () => { await new B.HDRFiltering(engine).prefilter(faces()); },
};
for (const [name, after] of Object.entries(OTHERS)) step(name, standard(), { after });

run(steps);
