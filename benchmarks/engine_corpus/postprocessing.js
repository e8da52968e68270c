// The package `postprocessing` for three.js: each effect alone, and the passes.

import * as THREE from 'three';
import * as all from 'postprocessing';
import { canvas, run } from './pages_common.js';

const renderer = new THREE.WebGLRenderer({ canvas: canvas(), antialias: false });
const camera = new THREE.PerspectiveCamera(50, 1, 0.1, 20);
camera.position.z = 3;
const scene = new THREE.Scene().add(new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial()));
const texture = () => Object.assign(new THREE.DataTexture(new Uint8Array(64).fill(128), 4, 4), { needsUpdate: true });

const VALUES = {
  ASCIIEffect: () => [], BloomEffect: () => [{ mipmapBlur: true }], BokehEffect: () => [], DepthOfFieldEffect: () => [camera],
  GodRaysEffect: () => [camera, scene.children[0]], LUT3DEffect: () => [all.LookupTexture.createNeutral(4)], LUT1DEffect: () => [texture()],
  OutlineEffect: () => [scene, camera], SelectiveBloomEffect: () => [scene, camera], ShockWaveEffect: () => [camera],
  SSAOEffect: () => [camera, texture(), { depthAwareUpsampling: false }], TextureEffect: () => [{ texture: texture() }], GlitchEffect: () => [{}], RealisticBokehEffect: () => [],
};
const draw = (...passes) => {
  const composer = new all.EffectComposer(renderer, { frameBufferType: THREE.HalfFloatType });
  composer.addPass(new all.RenderPass(scene, camera));
  passes.forEach((pass) => composer.addPass(pass));
  composer.render(0.1);
  composer.render(0.1);
};

const steps = [];
for (const name of Object.keys(all).filter((one) => one.endsWith('Effect') && one !== 'Effect')) {
  steps.push([name, () => draw(new all.EffectPass(camera, new all[name](...(VALUES[name]?.() ?? []))))]);
}
for (const [name, value] of Object.entries(all.BlendFunction)) {
  steps.push([`blend ${name}`, () => draw(new all.EffectPass(camera, new all.NoiseEffect({ blendFunction: value })))]);
}
for (const [name, mode] of Object.entries(all.ToneMappingMode)) {
  steps.push([`tone mapping ${name}`, () => draw(new all.EffectPass(camera, new all.ToneMappingEffect({ mode })))]);
}
for (const [name, preset] of Object.entries(all.SMAAPreset)) {
  steps.push([`SMAA ${name}`, () => draw(new all.EffectPass(camera, new all.SMAAEffect({ preset })))]);
}
for (const name of ['KawaseBlurPass', 'GaussianBlurPass', 'MipmapBlurPass', 'LuminancePass', 'TiltShiftBlurPass', 'BoxBlurPass']) {
  steps.push([name, () => {
    const target = new THREE.WebGLRenderTarget(16, 16);
    const pass = new all[name]();
    pass.initialize?.(renderer, false, THREE.HalfFloatType);
    pass.setSize?.(16, 16);
    pass.render(renderer, new THREE.WebGLRenderTarget(16, 16), target, 0.1);
  }]);
}
steps.push(['NormalPass, DepthDownsamplingPass', () => {
  const normals = new all.NormalPass(scene, camera);
  draw(normals, new all.DepthDownsamplingPass({ normalBuffer: normals.texture }), new all.EffectPass(camera, new all.SSAOEffect(camera, normals.texture)));
}]);

run(steps);
