// What Babylon.js draws before a material: pictures of the body alone, as the eye or a light sees it. A picture that the page
// sets itself is not drawn.

import { EffectRenderer, EffectWrapper } from '@babylonjs/core/Materials/effectRenderer.js';
import { ShaderMaterial } from '@babylonjs/core/Materials/shaderMaterial.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Matrix, Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Viewport } from '@babylonjs/core/Maths/math.viewport.js';
import '@babylonjs/core/Shaders/depth.vertex.js';
import '@babylonjs/core/ShadersWGSL/depth.vertex.js';
import { LAYER_GAP, SIDE, columnsOf, emptyOf, layersOf, lightsOf, viewNumbers } from './frame_passes.js';

// The shaders, in GLSL and in WGSL. The vertices are those of Babylon's own depth maps: with bones, morph targets and instances.

/** The distance from the eye or from the light's plane, of surfaces behind those of the layer `front`. */
const DISTANCE = [/* glsl */ `
varying vec4 vViewPos;
#ifdef PEELS
uniform float margin;
uniform highp sampler2D front;
#endif
void main(void) {
#ifdef FROM_PLANE
  float way = abs(vViewPos.z);
#else
  float way = length(vViewPos.xyz);
#endif
#ifdef PEELS
  if (way < texelFetch(front, ivec2(gl_FragCoord.xy), 0).r + margin) discard;
#endif
  gl_FragColor = vec4(way, 0.0, 0.0, 1.0);
}`, /* wgsl */ `
varying vViewPos: vec4f;
#ifdef PEELS
uniform margin: f32;
var front: texture_2d<f32>;
#endif
@fragment
fn main(input: FragmentInputs) -> FragmentOutputs {
#ifdef FROM_PLANE
  let way = abs(fragmentInputs.vViewPos.z);
#else
  let way = length(fragmentInputs.vViewPos.xyz);
#endif
#ifdef PEELS
  if (way < textureLoad(front, vec2i(fragmentInputs.position.xy), 0).r + uniforms.margin) { discard; }
#endif
  fragmentOutputs.color = vec4f(way, 0.0, 0.0, 1.0);
}`];

const CHANNELS = ['layer0', 'layer1', 'layer2', 'layer3'];

/** Four layers in one picture: vertex shader and fragment shader. */
const PACKING = [[/* glsl */ `
attribute vec2 position;
void main(void) { gl_Position = vec4(position, 0.0, 1.0); }`, /* glsl */ `
${CHANNELS.map((name) => `uniform highp sampler2D ${name};`).join('\n')}
void main(void) {
  ivec2 at = ivec2(gl_FragCoord.xy);
  gl_FragColor = vec4(${CHANNELS.map((name) => `texelFetch(${name}, at, 0).r`).join(', ')});
}`], [/* wgsl */ `
attribute position: vec2f;
@vertex
fn main(input: VertexInputs) -> FragmentInputs { vertexOutputs.position = vec4f(vertexInputs.position, 0.0, 1.0); }`, /* wgsl */ `
${CHANNELS.map((name) => `var ${name}: texture_2d<f32>;`).join('\n')}
@fragment
fn main(input: FragmentInputs) -> FragmentOutputs {
  let at = vec2i(fragmentInputs.position.xy);
  fragmentOutputs.color = vec4f(${CHANNELS.map((name) => `textureLoad(${name}, at, 0).r`).join(', ')});
}`]];

const languageOf = (engine) => Number(engine.isWebGPU);

// The lights of a body.

/** The position of a light, or the direction towards it, as a homogeneous vector; and its radiance. */
export function lightOf(light) {
  if (!light) return [[0, 1, 0, 0], [0, 0, 0]];
  const directional = light.getTypeID() === 1;
  const place = directional
    ? (light.computeTransformedInformation() ? light.transformedDirection : light.direction).scale(-1)
    : light.getAbsolutePosition();
  return [[...place.asArray(), directional ? 0 : 1], light.diffuse.scale(light.getScaledIntensity() / Math.PI).asArray()];
}

/** The box of a body and its instances: the corners in world space, and the ball around them. */
function boxOf(meshes) {
  const corners = meshes.flatMap((mesh) => mesh.getBoundingInfo().boundingBox.vectorsWorld);
  const [least, most] = [Vector3.Minimize, Vector3.Maximize].map((bound) => corners.reduce((a, b) => bound(a, b)));
  return { corners, center: Vector3.Center(least, most), radius: Vector3.Distance(least, most) / 2 };
}

const POINT = 0, DIRECTIONAL = 1, SPOT = 2;

/** The lights of a scene that a pass shows, as homogeneous vectors. */
function lightsAt(mesh, { center }, pass) {
  const shining = mesh.getScene().lights.filter((light) => [POINT, DIRECTIONAL, SPOT].includes(light.getTypeID()) && light.isEnabled() && light.canAffectMesh(mesh));
  const lights = shining.map((light) => {
    const [place, radiance] = lightOf(light);
    const fall = place[3] ? Math.max(Vector3.DistanceSquared(Vector3.FromArray(place), center), 1e-6) : 1;
    return { light: place, directional: !place[3], strength: Math.max(...radiance) / fall };
  });
  return lightsOf(lights, pass);
}

/** What a light sees of a body; `distant`: as if it were far away. */
function viewOf(light, { corners, center, radius }, distant, scene) {
  const engine = scene.getEngine(), hand = scene.useRightHandedSystem ? 'RH' : 'LH';
  const afar = distant || !light[3];
  const place = Vector3.FromArray(light);
  const way = (light[3] ? place.subtract(center) : place).normalize();
  const up = Math.abs(way.y) > 0.99 ? new Vector3(0, 0, 1) : Vector3.Up();
  const view = Matrix[`LookAt${hand}`](afar ? center.add(way.scale(2 * radius)) : place, center, up);
  const seen = corners.map((corner) => Vector3.TransformCoordinates(corner, view));
  const depths = seen.map(({ z }) => Math.max(Math.abs(z), 0.01 * radius));
  const half = 1.02 * Math.max(...seen.map(({ x, y }, index) => Math.max(Math.abs(x), Math.abs(y)) / (afar ? 1 : depths[index])));
  const range = [0.99 * Math.min(...depths), 1.01 * Math.max(...depths)];
  if (engine.useReverseDepthBuffer) range.reverse();
  const projection = afar
    ? Matrix[`OrthoOffCenter${hand}`](-half, half, -half, half, ...range, engine.isNDCHalfZRange)
    : Matrix[`PerspectiveFov${hand}`](2 * Math.atan(half), 1, ...range, engine.isNDCHalfZRange, 0, engine.useReverseDepthBuffer);
  return { view, clip: view.multiply(projection) };
}

// The pictures of a body.

/** A picture of floats, without filters. */
function settingsOf(scene, generateDepthBuffer) {
  const type = scene.getEngine().getCaps().textureFloatRender ? 1 : 2; // else half floats
  return { type, generateDepthBuffer, generateMipMaps: false, samplingMode: Texture.NEAREST_SAMPLINGMODE };
}

/** A layer of a pass: the distances of its surfaces in the first channel. */
class Layer extends RenderTargetTexture {
  #mesh;
  #material;
  #columns;
  #tile = 0;

  /** @param {import('./frame_passes.js').Pass} pass @param {Layer} [front] the layer that its surfaces are behind */
  constructor(mesh, pass, back, front, size) {
    const scene = mesh.getScene(), engine = scene.getEngine();
    super(`${mesh.name} ${pass.name}`, size, scene, settingsOf(scene, true));
    const defines = ['STORE_CAMERASPACE_Z', pass.seenFrom !== 'eye' && 'FROM_PLANE', front && 'PEELS'].filter(Boolean);
    const language = languageOf(engine);
    this.#mesh = mesh;
    this.#columns = columnsOf(pass);
    this.#material = new ShaderMaterial(this.name, scene, { vertex: 'depth', fragmentSource: DISTANCE[language] }, {
      attributes: ['position'], uniforms: ['world', 'view', 'viewProjection', 'margin'], samplers: ['front'], defines, shaderLanguage: language, useClipPlane: false,
    });
    if (front) this.#material.setTexture('front', front);
    this.#material.cullBackFaces = !back;
    this.#material.doNotSerialize = this.doNotSerialize = true;
    this.renderList = [mesh];
    this.setMaterialForRendering(mesh, this.#material);
    const empty = emptyOf(pass), color = new Color4(empty, empty, empty, 1);
    this.onClearObservable.add(() => {
      if (!this.#tile) engine.clear(color, true, true, true);
      const width = 1 / this.#columns;
      const corner = [this.#tile % this.#columns, Math.floor(this.#tile / this.#columns)].map((place) => place * width);
      engine.setViewport(new Viewport(corner[0], corner[1], width, width), this.getRenderWidth(), this.getRenderHeight());
    });
  }

  /** Draws meshes as each of some views shows them, a tile for each. */
  draw(meshes, views, margin) {
    this.renderList = meshes;
    this.#material.sideOrientation = this.#mesh.material.sideOrientation;
    this.#material.setFloat('margin', margin);
    views.forEach(({ view, clip }, tile) => {
      this.#material.setMatrix('view', view).setMatrix('viewProjection', clip);
      this.#tile = tile;
      this.render();
    });
  }

  dispose() {
    this.setMaterialForRendering(this.#mesh, undefined);
    this.#material.dispose();
    super.dispose();
  }
}

/** What writes layers into one picture. */
class Packing {
  #layers = [];

  constructor(engine) {
    const shaderLanguage = languageOf(engine), [vertexShader, fragmentShader] = PACKING[shaderLanguage];
    this.renderer = new EffectRenderer(engine);
    this.shader = new EffectWrapper({ engine, name: 'sssgen layers', vertexShader, fragmentShader, samplerNames: CHANNELS, shaderLanguage });
    this.shader.onApplyObservable.add(() => {
      CHANNELS.forEach((name, channel) => this.shader.effect.setTexture(name, this.#layers[channel] ?? this.#layers[0]));
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
  #material;
  #passes;
  #isGiven;
  /** @type {Packing | undefined} */
  #packing;
  /** @type {Map<any, { values: Record<string, any>, pictures: Record<string, { layers: Layer[], packed: RenderTargetTexture }> }>} */
  #bodies = new Map();

  /**
   * @param {import('@babylonjs/core/Materials/material.js').Material} material
   * @param {import('./frame_passes.js').Pass[]} passes
   * @param {(property: string) => boolean} isGiven whether the page has set a picture
   */
  constructor(material, passes, isGiven) {
    super(`${material.name} passes`, 1, material.getScene());
    this.doNotSerialize = true;
    this.#material = material;
    this.#passes = passes;
    this.#isGiven = isGiven;
    if (passes.some(({ layers }) => layers.length > 1)) this.#packing = new Packing(material.getScene().getEngine());
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
    const meshes = this.getScene().meshes.filter((mesh) => this.#has(mesh));
    const layers = meshes.flatMap((mesh) => this.#drawn.flatMap((pass) => this.#picturesOf(mesh, pass).layers));
    return layers.map((layer) => layer.isReadyForRendering()).every(Boolean) && (this.#packing?.shader.isReady() ?? true);
  }

  render() {
    const scene = this.getScene(), { data, length } = scene.getActiveMeshes();
    const meshes = new Set(data.slice(0, length).map((mesh) => /** @type {any} */ (mesh).sourceMesh ?? mesh));
    for (const mesh of meshes) {
      if (this.#has(mesh)) for (const pass of this.#drawn) this.#drawPass(pass, mesh);
    }
    scene.getEngine().setViewport(scene.activeCamera.viewport);
  }

  #drawPass(pass, mesh) {
    const scene = this.getScene(), eye = pass.seenFrom === 'eye', distant = pass.seenFrom === 'distant light';
    const meshes = [mesh, ...mesh.instances].filter((one) => one.isEnabled() && one.isVisible);
    const box = boxOf(meshes);
    const views = eye
      ? [{ view: scene.getViewMatrix(), clip: scene.getTransformMatrix() }]
      : lightsAt(mesh, box, pass).map((light) => viewOf(light, box, distant, scene));
    const { layers, packed } = this.#picturesOf(mesh, pass), { values } = this.#bodies.get(mesh);
    for (const layer of layers) layer.draw(meshes, views, LAYER_GAP * box.radius);
    if (packed !== layers[0]) this.#packing.draw(layers, packed);
    const columns = columnsOf(pass), forwards = scene.useRightHandedSystem ? -1 : 1;
    values[pass.texture] = packed;
    pass.views.forEach((property, index) => {
      const tile = { x: index % columns, y: Math.floor(index / columns) };
      // a view of zeros shows nothing
      values[property] = views[index] ? Matrix.FromArray(viewNumbers(views[index].clip.m, views[index].view.m, forwards, 1, tile, columns)) : Matrix.Zero();
    });
  }

  #picturesOf(mesh, pass) {
    if (!this.#bodies.has(mesh)) {
      this.#bodies.set(mesh, { values: {}, pictures: {} });
      for (const end of [mesh.onDisposeObservable, mesh.onMaterialChangedObservable]) end.addOnce(() => this.#forget(mesh));
    }
    const { pictures } = this.#bodies.get(mesh);
    const size = pass.seenFrom === 'eye' ? sizeOf(this.getScene()) : { width: SIDE * columnsOf(pass), height: SIDE * columnsOf(pass) };
    const own = (pictures[pass.name] ??= this.#newPictures(mesh, pass, size));
    for (const picture of [...own.layers, own.packed]) {
      if (picture.getRenderWidth() !== size.width || picture.getRenderHeight() !== size.height) picture.resize(size);
    }
    return own;
  }

  #newPictures(mesh, pass, size) {
    const layers = [];
    for (const { back, before } of layersOf(pass)) layers.push(new Layer(mesh, pass, back, layers[before], size));
    if (layers.length === 1) return { layers, packed: layers[0] };
    const packed = new RenderTargetTexture(`${mesh.name} ${pass.name}`, size, this.getScene(), settingsOf(this.getScene(), false));
    packed.doNotSerialize = true;
    return { layers, packed };
  }

  #forget(mesh) {
    for (const { layers, packed } of Object.values(this.#bodies.get(mesh)?.pictures ?? {})) new Set([...layers, packed]).forEach((picture) => picture.dispose());
    this.#bodies.delete(mesh);
  }

  dispose() {
    for (const mesh of [...this.#bodies.keys()]) this.#forget(mesh);
    this.#packing?.dispose();
    super.dispose();
  }
}

/** The size of what the camera draws into. */
function sizeOf(scene) {
  const engine = scene.getEngine(), target = scene.activeCamera.outputRenderTarget;
  return { width: target?.getRenderWidth() ?? engine.getRenderWidth(true), height: target?.getRenderHeight() ?? engine.getRenderHeight(true) };
}
