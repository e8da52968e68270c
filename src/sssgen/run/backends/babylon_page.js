// Babylon.js in a page: draws meshes with emitted modules, as plans say (engine_page.js).

import { Bone } from '@babylonjs/core/Bones/bone.js';
import { Skeleton } from '@babylonjs/core/Bones/skeleton.js';
import { Camera } from '@babylonjs/core/Cameras/camera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { WebGPUEngine } from '@babylonjs/core/Engines/webgpuEngine.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { DirectionalLight } from '@babylonjs/core/Lights/directionalLight.js';
import { PointLight } from '@babylonjs/core/Lights/pointLight.js';
import { CascadedShadowGenerator } from '@babylonjs/core/Lights/Shadows/cascadedShadowGenerator.js';
import { ShadowGenerator } from '@babylonjs/core/Lights/Shadows/shadowGenerator.js';
import '@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js';
import { RectAreaLight } from '@babylonjs/core/Lights/rectAreaLight.js';
import { SpotLight } from '@babylonjs/core/Lights/spotLight.js';
import { RawCubeTexture } from '@babylonjs/core/Materials/Textures/rawCubeTexture.js';
import { RawTexture } from '@babylonjs/core/Materials/Textures/rawTexture.js';
import { RawTexture3D } from '@babylonjs/core/Materials/Textures/rawTexture3D.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Matrix, Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { CubeMapToSphericalPolynomialTools } from '@babylonjs/core/Misc/HighDynamicRange/cubemapToSphericalPolynomial.js';
import { Mesh } from '@babylonjs/core/Meshes/mesh.js';
import { CreateBoxVertexData } from '@babylonjs/core/Meshes/Builders/boxBuilder.js';
import { TransformNode } from '@babylonjs/core/Meshes/transformNode.js';
import { VertexData } from '@babylonjs/core/Meshes/mesh.vertexData.js';
import '@babylonjs/core/Meshes/thinInstanceMesh.js';
import { Scene } from '@babylonjs/core/scene.js';
import { fileOf, filesRead, floats, halves, imported, indices, serve } from './engine_page.js';

/** @typedef {import('./engine_page.js').Plan} Plan */
/** @typedef {import('./engine_page.js').PieceOf} PieceOf */
/** @typedef {import('./engine_page.js').Stage} Stage */

const RGBA = 5, FLOAT = 1, HALF_FLOAT = 2, CLOCKWISE = 0, COUNTER_CLOCKWISE = 1;
const WRAPS = { clamp: 0, repeat: 1, mirror: 2 };
/** @type {Engine | WebGPUEngine} */
let engine;

/** @param {string} kind */
async function engineFor(kind) {
  const canvas = document.createElement('canvas');
  if (kind === 'webgl') return new Engine(canvas, false);
  const made = new WebGPUEngine(canvas);
  await made.initAsync();
  return made;
}

/** The matrix from the plan's world, which is right-handed, to that of a scene. @param {Scene} scene */
const handOf = (scene) => Matrix.Scaling(1, 1, scene.useRightHandedSystem ? 1 : -1);

class GivenCamera extends Camera {
  /** @param {Plan} plan @param {Scene} scene */
  constructor(plan, scene) {
    super('given', Vector3.Zero(), scene);
    const hand = handOf(scene);
    const whole = hand.multiply(Matrix.FromArray(plan.view)).multiply(Matrix.FromArray(plan.projection));
    const [x, y, z] = plan.eye;
    // cascades are chosen by the depth in view space, so that it must not be turned
    this.view = plan.properties.stage?.cascades ? Matrix.Translation(-x, -y, -z) : hand.multiply(Matrix.FromArray(plan.view)).multiply(hand);
    this.freezeProjectionMatrix(Matrix.Invert(this.view).multiply(whole));
  }

  _getViewMatrix() {
    return this.view;
  }
}

/** @param {Plan} plan @param {PieceOf} piece */
async function draw(plan, piece) {
  engine ??= await engineFor(plan.renderer);
  const device = engine instanceof WebGPUEngine ? engine._device : null;
  device?.pushErrorScope('validation');
  const scene = new Scene(engine);
  const { stage = {}, ...properties } = plan.properties;
  scene.useRightHandedSystem = !stage.leftHanded;
  scene.clearColor = new Color4(0, 0, 0, 0);
  scene.ambientColor = Color3.FromArray(plan.ambient.length ? plan.ambient : [0, 0, 0]);
  scene.imageProcessingConfiguration.applyByPostProcess = true; // linear light
  const camera = new GivenCamera(plan, scene);
  const lights = plan.lights.map((light) => lightOf(light, stage, scene));
  if (stage.area) areaLightOf(stage.area, scene);
  if (stage.around === 'hemisphere') {
    const { above = [1, 1, 1], below = [0, 0, 0] } = stage;
    Object.assign(new HemisphericLight('above', new Vector3(0, 1, 0), scene), { diffuse: Color3.FromArray(above), groundColor: Color3.FromArray(below) });
  }
  if (stage.around === 'environment') scene.environmentTexture = skyOf(scene);
  const { createMaterial } = await imported(plan.modules);
  const textures = Object.fromEntries(Object.entries(plan.textures).map(([name, one]) => [name, textureOf(one, piece, scene)]));
  const material = createMaterial({ ambientColor: Color3.White(), ...plan.values, ...textures }, scene);
  for (const [path, value] of Object.entries(properties)) {
    const names = path.split('.');
    const last = names[names.length - 1];
    const one = names.slice(0, -1).reduce((object, name) => object[name], material);
    one[last] = one[last] instanceof Color3 ? new Color3(value, value, value) : fileOf(value);
  }
  await filesRead();
  if (material.light === null) material.light = scene.lights[0] ?? null;

  const placed = (/** @type {VertexData} */ data, /** @type {number[]} */ model) => {
    const mesh = new Mesh('drawn', scene);
    data.applyToMesh(mesh);
    mesh.material = material;
    mesh.sideOrientation = stage.leftHanded ? CLOCKWISE : COUNTER_CLOCKWISE; // its matrix mirrors it
    mesh.alwaysSelectAsActiveMesh = true;
    mesh.receiveShadows = true;
    mesh.freezeWorldMatrix(Matrix.FromArray(model).multiply(handOf(scene)));
    mesh._updateNonUniformScalingState(true); // Babylon derives it from mesh.scaling
    return mesh;
  };
  const meshes = [placed(vertexDataOf(plan, piece), plan.model)];
  if (stage.bones) bind(meshes[0], stage.bones, scene);
  for (const model of stage.instances ?? []) meshes[0].thinInstanceAdd(Matrix.FromArray(model));
  for (const { size, model } of stage.copies ?? []) meshes.push(placed(vertexDataOf(plan, piece, size), model));
  const walls = (stage.walls ?? []).map((model) => placed(CreateBoxVertexData({}), model));
  const generators = stage.shadows ? lights.map((light) => shadowOf(light, stage, [...meshes, ...walls], camera)) : [];

  const size = { width: plan.width, height: plan.height };
  const target = new RenderTargetTexture('target', size, scene, { type: FLOAT, samplingMode: Texture.NEAREST_SAMPLINGMODE, generateMipMaps: false });
  target.clearColor = scene.clearColor;
  camera.outputRenderTarget = target;
  scene.activeCamera = camera;
  const ready = (/** @type {Mesh} */ mesh) => mesh.isReady(true) && generators.every((one) => one.isReady(mesh.subMeshes[0], mesh.hasThinInstances, false));
  while (![...meshes, ...walls].every(ready) || !scene.isReady(true)) {
    const wrong = meshes[0].subMeshes[0].effect?.getCompilationError();
    if (wrong) throw new Error(wrong);
    await new Promise((resume) => setTimeout(resume, 1));
  }
  for (const generator of generators) {
    const map = generator.getShadowMap();
    if (map) scene.customRenderTargets.push(map); // before what reads it
  }
  engine.beginFrame();
  scene.render();
  engine.endFrame();
  const pixels = await target.readPixels();
  const refused = await device?.popErrorScope();
  if (refused) throw new Error(refused.message);
  scene.dispose();
  if (!pixels) throw new Error('Babylon.js reads no pixels');
  return new Float32Array(pixels.buffer, pixels.byteOffset, plan.width * plan.height * 4);
}

/** @param {Plan} plan @param {PieceOf} piece @param {number} [size] */
function vertexDataOf(plan, piece, size = 1) {
  const vertices = floats(piece(plan.vertices));
  const part = (/** @type {string} */ name) => {
    const [offset, size] = plan.attributes[name];
    const count = vertices.length / plan.vertexSize;
    return Float32Array.from({ length: count * size }, (_, i) => vertices[Math.floor(i / size) * plan.vertexSize + offset + (i % size)]);
  };
  return Object.assign(new VertexData(), {
    positions: part('position').map((one) => one * size), normals: part('normal'), tangents: plan.withoutTangents ? null : part('tangent'), uvs: part('uv'),
    uvs2: part('uv2'), colors: part('color'), indices: indices(piece(plan.triangles)),
  });
}

/** Gives a mesh bones, which bend it. @param {Mesh} mesh @param {import('./engine_page.js').Bones} bones @param {Scene} scene */
function bind(mesh, { weights, matrices }, scene) {
  mesh.setVerticesData('matricesIndices', weights.flatMap(() => [0, 1, 0, 0]));
  mesh.setVerticesData('matricesWeights', weights.flatMap((weight) => [1 - weight, weight, 0, 0]));
  mesh.skeleton = new Skeleton('bones', 'bones', scene);
  for (const matrix of matrices) {
    const bone = new Bone('bone', mesh.skeleton, null, Matrix.Identity());
    bone.getLocalMatrix().copyFrom(Matrix.FromArray(matrix));
    bone.markAsDirty();
  }
}

/** A cube whose upper half is white. @param {Scene} scene */
function skyOf(scene) {
  const size = 32, full = () => new Float32Array(size * size * 4).fill(1);
  const half = () => full().fill(0, size * size * 2); // its first row is up
  const [right, left, up, down, front, back] = [half(), half(), full(), full().fill(0), half(), half()];
  const faces = [right, left, up, down, front, back];
  const sky = new RawCubeTexture(scene, faces, size, RGBA, FLOAT, true);
  sky.sphericalPolynomial = CubeMapToSphericalPolynomialTools.ConvertCubeMapToSphericalPolynomial({
    size, right, left, up, down, front, back, format: RGBA, type: FLOAT, gammaSpace: false,
  });
  return sky;
}

/** @param {import('./engine_page.js').Light} light @param {Stage} stage @param {Scene} scene */
function lightOf({ position, color }, { spot }, scene) {
  const [x, y, z, w] = position;
  const place = Vector3.TransformCoordinates(new Vector3(x, y, z), handOf(scene));
  const towards = place.scale(-1).normalize();
  const light = !w ? new DirectionalLight('direction', towards, scene)
    : spot ? new SpotLight('spot', place, towards, spot, 1, scene) : new PointLight('point', place, scene);
  light.diffuse = light.specular = Color3.FromArray(color);
  light.intensity = Math.PI; // Babylon's lights are irradiance, those of the other shells radiance
  return light;
}

/** Its tables, which Babylon would load from the network, are of what a surface with highlights reflects: no plan with such a
 * light draws one.
 * @param {import('./engine_page.js').Area} area @param {Scene} scene */
function areaLightOf({ model, size, radiance }, scene) {
  const texel = () => RawTexture.CreateRGBATexture(new Uint16Array(4), 1, 1, scene, false, false, 2, HALF_FLOAT);
  scene._ltcTextures = { LTC1: texel(), LTC2: texel() };
  const light = new RectAreaLight('area', Vector3.Zero(), size[0], size[1], scene);
  light.intensity = radiance;
  const placed = new TransformNode('placed', scene);
  // it shines along its -z in mirrored worlds, too
  const sides = Matrix.Scaling(scene.useRightHandedSystem ? 1 : -1, 1, 1);
  placed.freezeWorldMatrix(sides.multiply(Matrix.FromArray(model)).multiply(handOf(scene)));
  light.parent = placed;
}

/** @param {DirectionalLight | PointLight | SpotLight} light @param {Stage} stage @param {Mesh[]} casters @param {Camera} camera */
function shadowOf(light, { cascades }, casters, camera) {
  const directional = light instanceof DirectionalLight;
  if (directional) light.autoCalcShadowZBounds = true;
  else Object.assign(light, { shadowMinZ: 0.1, shadowMaxZ: 20 });
  Object.assign(camera, { minZ: 0.5, maxZ: 20 }); // where cascades begin and end
  const generator = directional && cascades ? new CascadedShadowGenerator(1024, light, false, camera) : new ShadowGenerator(512, light);
  generator.usePercentageCloserFiltering = !(light instanceof PointLight);
  casters.forEach((one) => generator.addShadowCaster(one));
  return generator;
}

/** @param {import('./engine_page.js').Texels} texels @param {PieceOf} piece @param {Scene} scene */
function textureOf({ dim, size, levels, filter, wrap }, piece, scene) {
  const texels = halves(piece(levels[0].data));
  const mode = filter === 'nearest' ? Texture.NEAREST_SAMPLINGMODE : levels.length > 1 ? Texture.TRILINEAR_SAMPLINGMODE : Texture.BILINEAR_SAMPLINGMODE;
  const mipmaps = levels.length > 1;
  const texture = dim === '3D'
    ? new RawTexture3D(texels, size[0], size[1], size[2], RGBA, scene, false, false, mode, HALF_FLOAT)
    : new RawTexture(texels, size[0], size[1], RGBA, scene, mipmaps, false, mode, HALF_FLOAT);
  return Object.assign(texture, { wrapU: WRAPS[wrap], wrapV: WRAPS[wrap], wrapR: WRAPS[wrap], anisotropicFilteringLevel: 1 });
}

serve(Engine.Version, draw);
