// What Babylon.js draws before a material: pictures of the body alone, as the eye or a light sees it. A picture that the page
// sets itself is not drawn.

import { EffectRenderer, EffectWrapper } from '@babylonjs/core/Materials/effectRenderer.js';
import { ImageProcessingConfiguration } from '@babylonjs/core/Materials/imageProcessingConfiguration.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { MaterialPluginBase } from '@babylonjs/core/Materials/materialPluginBase.js';
import { ShaderMaterial } from '@babylonjs/core/Materials/shaderMaterial.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Matrix } from '@babylonjs/core/Maths/math.vector.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Viewport } from '@babylonjs/core/Maths/math.viewport.js';
import '@babylonjs/core/Shaders/depth.vertex.js';
import '@babylonjs/core/ShadersWGSL/depth.vertex.js';
import { InnerVolume } from './babylon_inner_light.js';
import { DIRECTIONAL, POINT, RECTANGLE, SPOT, lightOf, lightsOn } from './babylon_lights.js';
import { LAYERS, LAYER_GAP, PACKING, SIDE, emptyOf, isFiltered, isVolume, layersOf, lightsOf, packing, showsLight, tileOf, tilesOf, viewNumbers } from './frame_passes.js';

// The shaders, in GLSL and in WGSL. The vertices are those of Babylon's own depth maps: with bones, morph targets and instances.

/** The distance from the eye or from the light's plane, of surfaces behind those of the layer `front`. */
const DISTANCE = [/* glsl */ `
varying vec4 vViewPos;
#ifdef FROM_PLANE
uniform float start;
#endif
#ifdef PEELS
uniform float margin;
uniform highp sampler2D front;
#endif
void main(void) {
#ifdef FROM_PLANE
  float way = abs(vViewPos.z) - start;
#else
  float way = length(vViewPos.xyz);
#endif
#ifdef PEELS
  if (way < texelFetch(front, ivec2(gl_FragCoord.xy), 0).r + margin) discard;
#endif
  gl_FragColor = vec4(way, 0.0, 0.0, 1.0);
}`, /* wgsl */ `
varying vViewPos: vec4f;
#ifdef FROM_PLANE
uniform start: f32;
#endif
#ifdef PEELS
uniform margin: f32;
var front: texture_2d<f32>;
#endif
@fragment
fn main(input: FragmentInputs) -> FragmentOutputs {
#ifdef FROM_PLANE
  let way = abs(fragmentInputs.vViewPos.z) - uniforms.start;
#else
  let way = length(fragmentInputs.vViewPos.xyz);
#endif
#ifdef PEELS
  if (way < textureLoad(front, vec2i(fragmentInputs.position.xy), 0).r + uniforms.margin) { discard; }
#endif
  fragmentOutputs.color = vec4f(way, 0.0, 0.0, 1.0);
}`];

/** Layers in one picture: vertex shader and fragment shader. */
const packingShaders = (written) => [[/* glsl */ `
attribute vec2 position;
void main(void) { gl_Position = vec4(position, 0.0, 1.0); }`, written.glsl], [/* wgsl */ `
attribute position: vec2f;
@vertex
fn main(input: VertexInputs) -> FragmentInputs { vertexOutputs.position = vec4f(vertexInputs.position, 0.0, 1.0); }`, /* wgsl */ `
${LAYERS.map((name) => `var ${name}: texture_2d<f32>;`).join('\n')}
@fragment
fn main(input: FragmentInputs) -> FragmentOutputs {
  let at = vec2i(fragmentInputs.position.xy);
  fragmentOutputs.color = ${written.wgsl};
}`]];

const languageOf = (engine) => Number(engine.isWebGPU);

// The lights of a body.

/** How far vertices reach from the center of their box, by that box. @type {WeakMap<any, number>} */
const REACHES = new WeakMap();

/** The same in world space. A round body reaches much less far than its corners; of one that moves in the shader it is unknown. */
function reachOf([mesh, ...others]) {
  const box = mesh.geometry?.extend; // another object when positions change
  if (others.length || !box || mesh.hasThinInstances || mesh.skeleton || mesh.morphTargetManager || mesh.bakedVertexAnimationManager) return Infinity;
  if (!REACHES.has(box)) {
    const center = Vector3.Center(box.minimum, box.maximum).asArray(), positions = mesh.getVerticesData('position');
    let most = positions ? 0 : Infinity;
    for (let at = 0; at < positions?.length; at += 3) most = Math.max(most, Math.hypot(...center.map((middle, axis) => positions[at + axis] - middle)));
    REACHES.set(box, most);
  }
  return /** @type {number} */ (REACHES.get(box)) * Math.max(...mesh.getBoundingInfo().boundingBox.directions.map((edge) => edge.length()));
}

/** The box of a body and its instances: the corners in world space, the ball around them, and the directions of the body's edges. */
function boxOf(meshes) {
  const boxes = meshes.map((mesh) => mesh.getBoundingInfo().boundingBox);
  const corners = boxes.flatMap(({ vectorsWorld }) => vectorsWorld);
  const [least, most] = [Vector3.Minimize, Vector3.Maximize].map((bound) => corners.reduce((a, b) => bound(a, b)));
  const edges = boxes[0].directions.map((edge) => edge.normalizeToNew());
  return { corners, edges, reach: reachOf(meshes), center: Vector3.Center(least, most), radius: Vector3.Distance(least, most) / 2 };
}

/** The lights of a scene that a pass shows, as homogeneous vectors. */
function lightsAt(mesh, { center }, pass) {
  const lights = lightsOn(mesh, [POINT, DIRECTIONAL, SPOT, RECTANGLE]).map((light) => {
    const [place, radiance] = lightOf(light);
    const fall = place[3] ? Math.max(Vector3.DistanceSquared(Vector3.FromArray(place), center), 1e-6) : 1;
    const area = light.getTypeID() === RECTANGLE ? light.width * light.height : 1;
    return { light: place, directional: !place[3], strength: area * Math.max(...radiance) / fall };
  });
  return lightsOf(lights, pass);
}

/** What a light sees of a body; `distant`: as if it were far away. Upwards is an edge of the body, so that it fills the picture. */
function viewOf(light, { corners, edges, reach, center, radius }, distant, scene) {
  const engine = scene.getEngine(), hand = scene.useRightHandedSystem ? 'RH' : 'LH';
  const afar = distant || !light[3];
  const place = Vector3.FromArray(light);
  const way = (light[3] ? place.subtract(center) : place).normalize();
  const distance = afar ? Infinity : Vector3.Distance(place, center);
  const round = afar ? reach : reach < distance ? reach / Math.sqrt(distance ** 2 - reach ** 2) : Infinity;
  const fits = edges.filter((up) => Math.abs(Vector3.Dot(up, way)) < 0.99).map((up) => {
    const view = Matrix[`LookAt${hand}`](afar ? center.add(way.scale(2 * radius)) : place, center, up);
    const seen = corners.map((corner) => Vector3.TransformCoordinates(corner, view));
    const depths = seen.map(({ z }) => Math.max(Math.abs(z), 0.01 * radius));
    const [width, height] = ['x', 'y'].map((axis) => 1.02 * Math.min(round, Math.max(...seen.map((corner, index) => Math.abs(corner[axis]) / (afar ? 1 : depths[index])))));
    return { view, width, height, range: [0.99 * Math.min(...depths), 1.01 * Math.max(...depths)] };
  });
  const { view, width, height, range } = fits.reduce((a, b) => (b.width + b.height < a.width + a.height ? b : a));
  const [near, far] = engine.useReverseDepthBuffer ? range.reverse() : range;
  const projection = afar
    ? Matrix[`OrthoOffCenter${hand}`](-width, width, -height, height, near, far, engine.isNDCHalfZRange)
    : Matrix[`PerspectiveFov${hand}`](2 * Math.atan(height), width / height, near, far, engine.isNDCHalfZRange, 0, engine.useReverseDepthBuffer);
  return { view, clip: view.multiply(projection), start: Math.min(...range), end: Math.max(...range) };
}

// The pictures of a body.

/** A picture of floats of a pass. Filters blend what lights see, and light. */
class Picture extends RenderTargetTexture {
  constructor(pass, size, scene, settings) {
    const { textureFloatRender, textureFloatLinearFiltering, textureHalfFloatLinearFiltering } = scene.getEngine().getCaps();
    const full = textureFloatRender && (!isFiltered(pass) || textureFloatLinearFiltering);
    const blends = isFiltered(pass) && (full || textureHalfFloatLinearFiltering);
    const samplingMode = blends ? Texture.BILINEAR_SAMPLINGMODE : Texture.NEAREST_SAMPLINGMODE;
    super(`sssgen ${pass.name}`, size, scene, { type: full ? 1 : 2, generateMipMaps: false, samplingMode, ...settings }); // else half floats
    this.doNotSerialize = true;
  }

  /** Takes a size, if it has another one. */
  fit({ width, height }) {
    if (this.getRenderWidth() !== width || this.getRenderHeight() !== height) this.resize({ width, height });
  }
}

const RED = 6;

/** A layer of a pass: the distances of its surfaces. */
class Layer extends Picture {
  #material;
  #tile = 0;
  #tiles = tilesOf(1);
  #empty = 0;

  /** @param {import('./frame_passes.js').Pass} pass @param {boolean} back @param {Layer | undefined} front the layer that its surfaces are behind */
  constructor(pass, back, front, size, scene) {
    super(pass, size, scene, { format: RED });
    this.pass = pass;
    const engine = scene.getEngine(), shaderLanguage = languageOf(engine);
    const defines = ['STORE_CAMERASPACE_Z', pass.seenFrom === 'eye' ? '' : 'FROM_PLANE', front ? 'PEELS' : ''].filter((one) => one);
    this.#material = new ShaderMaterial(this.name, scene, { vertex: 'depth', fragmentSource: DISTANCE[shaderLanguage] }, {
      attributes: ['position'], uniforms: ['world', 'view', 'viewProjection', 'start', 'margin'], samplers: ['front'], defines, shaderLanguage, useClipPlane: false,
    });
    if (front) this.#material.setTexture('front', front);
    Object.assign(this.#material, { cullBackFaces: !back, doNotSerialize: true });
    this.onClearObservable.add(() => {
      if (!this.#tile) engine.clear(new Color4(this.#empty, this.#empty, this.#empty, 1), true, true, true);
      const { x, y } = tileOf(this.#tile), { across, up } = this.#tiles;
      engine.setViewport(new Viewport(x / across, y / up, 1 / across, 1 / up), this.getRenderWidth(), this.getRenderHeight());
    });
  }

  /** From now on draws a mesh with the material of the layer. */
  take(mesh) {
    this.setMaterialForRendering(mesh, this.#material);
  }

  leave(mesh) {
    this.setMaterialForRendering(mesh, undefined);
  }

  isReadyFor(mesh) {
    this.renderList = [mesh];
    return this.isReadyForRendering();
  }

  /** Draws meshes as each of some views shows them, a tile for each. */
  draw(meshes, views, margin) {
    this.renderList = meshes;
    this.#material.sideOrientation = meshes[0].material.sideOrientation;
    this.#material.setFloat('margin', margin);
    this.#tiles = tilesOf(views.length);
    this.#empty = emptyOf(this.pass, Math.max(...views.map(({ start, end }) => end - start), 1));
    views.forEach(({ view, clip, start }, tile) => {
      this.#material.setMatrix('view', view).setMatrix('viewProjection', clip).setFloat('start', start);
      this.#tile = tile;
      this.render();
    });
  }

  dispose() {
    this.#material.dispose();
    super.dispose();
  }
}

/** Makes a material white, without vertex colours, and its alpha the distance from the camera's plane. */
class White extends MaterialPluginBase {
  constructor(material) {
    super(material, 'SssgenWhite', 200);
    this.doNotSerialize = true;
    this._enable(true);
  }

  getClassName() {
    return 'SssgenWhite';
  }

  isCompatible() {
    return true;
  }

  getCustomCode(stage, language) {
    if (stage === 'vertex') return null;
    return language
      ? { CUSTOM_FRAGMENT_UPDATE_ALBEDO: 'surfaceAlbedo = vec3f(1.0);', CUSTOM_FRAGMENT_BEFORE_FRAGCOLOR: 'finalColor.a = abs((scene.view * vec4f(fragmentInputs.vPositionW, 1.0)).z);' }
      : { CUSTOM_FRAGMENT_UPDATE_ALBEDO: 'surfaceAlbedo = vec3(1.0);', CUSTOM_FRAGMENT_BEFORE_FRAGCOLOR: 'finalColor.a = abs((view * vec4(vPositionW, 1.0)).z);' };
  }
}

/** What a white matt body reflects in the light and the shadows of its scene. */
class LightLayer extends Picture {
  #material;

  constructor(pass, size, scene) {
    super(pass, size, scene, {});
    this.#material = new PBRMaterial(this.name, scene);
    const imageProcessingConfiguration = new ImageProcessingConfiguration();
    imageProcessingConfiguration.applyByPostProcess = true; // linear light
    Object.assign(this.#material, { metallic: 0, roughness: 1, metallicF0Factor: 0, fogEnabled: false, imageProcessingConfiguration, doNotSerialize: true });
    new White(this.#material); // the material keeps it
    this.clearColor = new Color4(0, 0, 0, emptyOf(pass));
  }

  take(mesh) {
    this.setMaterialForRendering(mesh, this.#material);
  }

  leave(mesh) {
    this.setMaterialForRendering(mesh, undefined);
  }

  isReadyFor(mesh) {
    this.#follow(mesh);
    this.renderList = [mesh];
    return this.isReadyForRendering();
  }

  /** Draws meshes as the camera sees them. */
  draw(meshes) {
    this.#follow(meshes[0]);
    this.renderList = meshes;
    this.render();
  }

  /** Takes what the body's own material has of the light. */
  #follow({ material }) {
    for (const name of ['sideOrientation', 'maxSimultaneousLights', 'environmentIntensity', 'directIntensity', 'ambientColor']) {
      this.#material[name] = material[name];
    }
  }

  dispose() {
    this.#material.dispose();
    super.dispose();
  }
}

/** What writes the layers of a pass into one picture. */
class Packing {
  #layers = [];

  constructor(engine, written) {
    const shaderLanguage = languageOf(engine), [vertexShader, fragmentShader] = packingShaders(written)[shaderLanguage];
    this.renderer = new EffectRenderer(engine);
    this.shader = new EffectWrapper({ engine, name: 'sssgen layers', vertexShader, fragmentShader, samplerNames: LAYERS, shaderLanguage });
    this.shader.onApplyObservable.add(() => {
      LAYERS.forEach((name, channel) => this.shader.effect.setTexture(name, this.#layers[channel] ?? this.#layers[0]));
    });
  }

  draw(layers, picture) {
    this.#layers = layers;
    this.renderer.render(this.shader, picture);
  }

  dispose() {
    this.shader.dispose();
    this.renderer.dispose();
  }
}

/**
 * The passes of a material. To Babylon it is a render target of the material: each camera renders it before what it sees, when
 * it is known which meshes these are.
 */
export class Passes extends RenderTargetTexture {
  /** @type {any} */
  #scene;
  #material;
  #passes;
  #isGiven;
  #responses;
  /** For each pass, by its name. @type {Record<string, Packing>} */
  #packings = {};
  /** The layers of a pass, by its name: all bodies share them. @type {Record<string, (Layer | LightLayer)[]>} */
  #layers = {};
  /** For each mesh: its pictures by the names of passes, and the values of properties. */
  #bodies = new Map();

  /**
   * @param {import('@babylonjs/core/Materials/material.js').Material} material
   * @param {import('./frame_passes.js').Pass[]} passes
   * @param {(property: string) => boolean} isGiven whether the page has set a picture
   * @param {import('./inner_volume.js').Responses} responses what it has set for volumes
   */
  constructor(material, passes, isGiven, responses) {
    super(`${material.name} passes`, 1, material.getScene());
    this.doNotSerialize = true;
    this.#scene = material.getScene();
    this.#material = material;
    this.#passes = passes;
    this.#isGiven = isGiven;
    this.#responses = responses;
    for (const pass of passes) if (!isVolume(pass)) this.#packings[pass.name] = new Packing(this.#scene.getEngine(), showsLight(pass) ? packing(['rgba']) : PACKING);
  }

  /** The passes that it draws. */
  get #drawn() {
    return this.#passes.filter((pass) => !this.#isGiven(pass.texture));
  }

  /** The properties that it sets. */
  get properties() {
    return this.#drawn.flatMap((pass) => [pass.texture, ...pass.views]);
  }

  /** Their values for a mesh. */
  valuesOf(mesh) {
    return this.#bodies.get(mesh)?.values ?? {};
  }

  #has(mesh) {
    return !mesh.isAnInstance && mesh.subMeshes?.some((part) => part.getMaterial() === this.#material);
  }

  isReadyForRendering() {
    const meshes = this.#scene.meshes.filter((mesh) => this.#has(mesh));
    const drawn = this.#drawn.filter((pass) => !isVolume(pass));
    const ready = meshes.flatMap((mesh) => drawn.flatMap((pass) => this.#partsOf(mesh, pass).layers.map((layer) => layer.isReadyFor(mesh))));
    return [...ready, ...Object.values(this.#packings).map(({ shader }) => shader.isReady())].every(Boolean);
  }

  render() {
    const { data, length } = this.#scene.getActiveMeshes();
    const meshes = new Set(data.slice(0, length).map((mesh) => mesh.sourceMesh ?? mesh));
    for (const mesh of meshes) {
      if (!this.#has(mesh)) continue;
      for (const pass of this.#drawn) {
        if (isVolume(pass)) this.#computePass(pass, mesh);
        else this.#drawPass(pass, mesh);
      }
    }
    this.#scene.getEngine().setViewport(this.#scene.activeCamera.viewport);
  }

  /** Computes the volume of a mesh. */
  #computePass(pass, mesh) {
    const response = this.#responses.loaded(pass.texture), { values, pictures } = this.#bodyOf(mesh);
    if (pictures[pass.name]?.response !== response) {
      pictures[pass.name]?.dispose();
      const { minimum, maximum } = mesh.getRawBoundingInfo();
      response?.checkBody(minimum.asArray(), maximum.asArray());
      pictures[pass.name] = response && new InnerVolume(response, this.#scene);
    }
    pictures[pass.name]?.follow(mesh, this.#material);
    values[pass.texture] = pictures[pass.name] ?? undefined; // the material's own
  }

  #drawPass(pass, mesh) {
    const scene = this.#scene;
    const meshes = [mesh, ...mesh.instances].filter((one) => one.isEnabled() && one.isVisible);
    const box = boxOf(meshes);
    const views = pass.seenFrom === 'eye'
      ? [{ view: scene.getViewMatrix(), clip: scene.getTransformMatrix(), start: 0, end: 1 }]
      : lightsAt(mesh, box, pass).map((light) => viewOf(light, box, pass.seenFrom === 'distant light', scene));
    const tiles = tilesOf(views.length), tile = pass.seenFrom === 'eye' ? sizeOf(scene) : { width: SIDE, height: SIDE };
    const { layers, picture, values } = this.#partsOf(mesh, pass);
    for (const one of [...layers, picture]) one.fit({ width: tile.width * tiles.across, height: tile.height * tiles.up });
    for (const layer of layers) layer.draw(meshes, views, LAYER_GAP * box.radius);
    this.#packings[pass.name].draw(layers, picture);
    values[pass.texture] = picture;
    pass.views.forEach((property, index) => {
      const { clip, view, start } = views[index] ?? { clip: Matrix.Zero(), view: Matrix.Zero(), start: 0 }; // it shows nothing
      values[property] = Matrix.FromArray(viewNumbers(clip.m, view.m, scene.useRightHandedSystem ? -1 : 1, start, 1, tileOf(index), tiles));
    });
  }

  #bodyOf(mesh) {
    if (!this.#bodies.has(mesh)) {
      this.#bodies.set(mesh, { values: {}, pictures: {} });
      for (const end of [mesh.onDisposeObservable, mesh.onMaterialChangedObservable]) end.addOnce(() => this.#forget(mesh));
    }
    return this.#bodies.get(mesh);
  }

  /** The layers of a pass; the picture of a mesh, and the values of its properties. */
  #partsOf(mesh, pass) {
    const size = { width: SIDE, height: SIDE };
    const layers = (this.#layers[pass.name] ??= this.#newLayers(pass, size));
    const { values, pictures } = this.#bodyOf(mesh);
    if (!pictures[pass.name]) {
      pictures[pass.name] = new Picture(pass, size, this.#scene, { generateDepthBuffer: false });
      layers.forEach((layer) => layer.take(mesh));
    }
    return { layers, picture: pictures[pass.name], values };
  }

  #newLayers(pass, size) {
    if (showsLight(pass)) return [new LightLayer(pass, size, this.#scene)];
    const layers = [];
    for (const { back, before } of layersOf(pass)) layers.push(new Layer(pass, back, layers[before], size, this.#scene));
    return layers;
  }

  #forget(mesh) {
    for (const [name, picture] of Object.entries(this.#bodies.get(mesh)?.pictures ?? {})) {
      picture?.dispose();
      this.#layers[name]?.forEach((layer) => layer.leave(mesh));
    }
    this.#bodies.delete(mesh);
  }

  dispose() {
    for (const mesh of [...this.#bodies.keys()]) this.#forget(mesh);
    Object.values(this.#layers).flat().forEach((layer) => layer.dispose());
    Object.values(this.#packings).forEach((each) => each.dispose());
    super.dispose();
  }
}

/** The size of what the camera draws into. */
function sizeOf(scene) {
  const engine = scene.getEngine(), target = scene.activeCamera.outputRenderTarget;
  return { width: target?.getRenderWidth() ?? engine.getRenderWidth(true), height: target?.getRenderHeight() ?? engine.getRenderHeight(true) };
}
