// What PlayCanvas draws before a material: pictures of a body alone, as the eye or a light sees it. A picture that the page
// sets itself is not drawn.

import * as pc from 'playcanvas';
import { LAYERS, LAYER_GAP, SIDE, emptyOf, isFiltered, isVolume, layersOf, lightsOf, showsLight, tileOf, tilesOf, viewNumbers } from './frame_passes.js';
import { InnerVolume, Surroundings } from './playcanvas_inner_light.js';
import { distanceMaterial, mattMaterial, packingPass } from './playcanvas_pass_shaders.js';

/**
 * An object with what PlayCanvas's types keep to the engine.
 * @param {object} object
 * @returns {any}
 */
const internalsOf = (object) => object;

// The lights of a body.

/** The distance of a mesh's farthest vertex from the middle of its box. @type {WeakMap<pc.Mesh, { version: number, radius: number }>} */
const radii = new WeakMap();

/** That distance in object space; a ball around the box would make texels larger. */
function radiusOf(mesh) {
  const known = radii.get(mesh);
  if (known && known.version === mesh._aabbVer) return known.radius;
  const { center, halfExtents } = mesh.aabb;
  const floats = mesh.vertexBuffer.format.elements.some(({ name, dataType }) => name === pc.SEMANTIC_POSITION && dataType === pc.TYPE_FLOAT32);
  /** @type {number[]} */
  const places = [];
  if (floats) mesh.getPositions(places);
  let radius = places.length ? 0 : halfExtents.length();
  for (let at = 0; at < places.length; at += 3) {
    radius = Math.max(radius, Math.hypot(places[at] - center.x, places[at + 1] - center.y, places[at + 2] - center.z));
  }
  radii.set(mesh, { version: mesh._aabbVer, radius });
  return radius;
}

/** The ball around a mesh instance, in world space. */
function ballOf(instance) {
  const { mesh, node, skinInstance, morphInstance, _customAabb, aabb } = internalsOf(instance);
  if (skinInstance || morphInstance || _customAabb) return { center: aabb.center, radius: aabb.halfExtents.length() };
  const world = node.getWorldTransform();
  const { x, y, z } = world.getScale();
  return { center: world.transformPoint(mesh.aabb.center), radius: radiusOf(mesh) * Math.max(x, y, z) };
}

/** Those of some lights that a pass shows of a ball. */
function lightsAt(ball, lights, pass) {
  const shining = [...lights].filter(({ enabled }) => enabled).map((light) => ({
    light, directional: light.type === pc.LIGHTTYPE_DIRECTIONAL, strength: Math.max(...light._colorLinear) * nearness(light, ball),
  }));
  return lightsOf(shining, pass);
}

/** The share of a light that arrives at a ball. */
function nearness(light, { center, radius }) {
  if (light.type === pc.LIGHTTYPE_DIRECTIONAL) return 1;
  const range = light.attenuationEnd;
  const distance = Math.max(light._node.getPosition().distance(center) - radius, 0);
  if (distance >= range) return 0;
  return light.falloffMode === pc.LIGHTFALLOFF_LINEAR ? 1 - distance / range : 16 / (distance * distance + 1);
}

/** A camera that sees all of a ball from a light. */
function lampCamera(device) {
  const camera = new pc.Camera(device);
  camera.node = new pc.GraphNode();
  camera.aspectRatioMode = pc.ASPECT_MANUAL;
  camera.aspectRatio = 1;
  return camera;
}

/** Places such a camera; `distant`: as if the light were far away. */
function aim(camera, light, { center, radius: tight }, distant) {
  const radius = 1.02 * tight;
  const directional = light.type === pc.LIGHTTYPE_DIRECTIONAL;
  const way = directional ? light._node.up.clone() : light._node.getPosition().clone().sub(center);
  const afar = distant || directional;
  const distance = afar ? 2 * radius : Math.max(way.length(), 1e-6);
  const half = Math.min(Math.asin(Math.min(radius / distance, 1)), 1.5);
  way.normalize();
  camera.projection = afar ? pc.PROJECTION_ORTHOGRAPHIC : pc.PROJECTION_PERSPECTIVE;
  camera.orthoHeight = radius;
  camera.fov = (half * 360) / Math.PI;
  camera.nearClip = Math.max(distance - radius, 0.001 * distance);
  camera.farClip = distance + radius;
  camera.node.setPosition(center.clone().add(way.clone().mulScalar(distance)));
  camera.node.lookAt(center, Math.abs(way.y) > 0.99 ? pc.Vec3.BACK : pc.Vec3.UP);
  return camera;
}

/** World space to (u w, v w, distance from the camera's plane, w), in a tile of the picture; `down`: its rows count downwards. */
function viewOf(camera, tile, tiles, down) {
  const view = camera.node.getWorldTransform().clone(), projection = camera.projectionMatrix.clone();
  camera.calculateTransform?.(view, pc.VIEW_CENTER);
  camera.calculateProjection?.(projection, pc.VIEW_CENTER);
  view.invert();
  const clip = new pc.Mat4().mul2(projection, view);
  const { x, y } = tileOf(tile);
  return viewNumbers(clip.data, view.data, -1, camera.nearClip, down ? -1 : 1, { x, y: down ? tiles.up - 1 - y : y }, tiles);
}

/** Draws mesh instances into tiles of a picture, each tile as a camera sees them. */
class TilePass extends pc.RenderPass {
  /** @type {any[]} */
  cameras = [];
  /** @type {pc.MeshInstance[]} */
  meshInstances = [];
  /** What lights them. @type {{ lightList?: any, lightClusters?: any }} */
  light = {};

  constructor(device, renderer) {
    super(device);
    this.renderer = renderer;
  }

  execute() {
    const { renderer, renderTarget, meshInstances, light } = this;
    const { across, up } = tilesOf(this.cameras.length);
    this.cameras.forEach((camera, tile) => {
      const { x, y } = tileOf(tile);
      const rect = new pc.Vec4(x / across, y / up, 1 / across, 1 / up);
      const kept = { rect: camera.rect.clone(), scissorRect: camera.scissorRect.clone(), cullFaces: camera.cullFaces };
      Object.assign(camera, { rect, scissorRect: rect, cullFaces: true });
      renderer.renderForwardLayer(camera, renderTarget, null, undefined, pc.SHADER_FORWARD, { meshInstances, ...light });
      Object.assign(camera, kept);
    });
  }
}

/** A render target; `depth`: that something is drawn into. Filters blend what lights see, and light. */
function pictureOf(device, pass, { channels = 1, depth = false }, { width, height, origin }) {
  // half floats where WebGPU does not filter others: PlayCanvas declares a sampler for each texture of a material
  const full = device.textureFloatRenderable && (!(device.isWebGPU || showsLight(pass)) || device.textureFloatFilterable);
  const blends = isFiltered(pass) && (!full || device.textureFloatFilterable);
  const filter = blends ? pc.FILTER_LINEAR : pc.FILTER_NEAREST;
  const format = channels === 1 ? (full ? pc.PIXELFORMAT_R32F : pc.PIXELFORMAT_R16F) : full ? pc.PIXELFORMAT_RGBA32F : pc.PIXELFORMAT_RGBA16F;
  const colorBuffer = new pc.Texture(device, {
    name: pass.name, width, height, format, mipmaps: false, minFilter: filter, magFilter: filter,
    addressU: pc.ADDRESS_CLAMP_TO_EDGE, addressV: pc.ADDRESS_CLAMP_TO_EDGE,
  });
  return new pc.RenderTarget({ name: pass.name, colorBuffer, depth, samples: 1, origin });
}

/** A mesh instance that has the material: its copies with the materials of passes, and its pictures. */
class Body {
  /** @type {Map<pc.Material, any>} */
  #copies = new Map();
  /** @type {{ pass: import('./frame_passes.js').Pass, camera: any, origin: any, layers: pc.RenderTarget[], packed: pc.RenderTarget, version: number }[]} */
  #pictures = [];
  /** The volumes, by the names of passes. @type {Map<string, InnerVolume>} */
  #volumes = new Map();

  /** @param {pc.MeshInstance} instance */
  constructor(instance) {
    this.instance = instance;
  }

  /** The mesh instance with another material: with its bones, morph targets and instances. */
  copy(material) {
    const { node, mesh, mask, flipFacesFactor, _skinInstance, _morphInstance, instancingData, drawCommands, _shaderDefs } = internalsOf(this.instance);
    if (!this.#copies.has(material)) this.#copies.set(material, new pc.MeshInstance(mesh, material, node));
    const copy = this.#copies.get(material);
    Object.assign(copy, { node, mesh, mask, flipFacesFactor, _skinInstance, _morphInstance, instancingData, drawCommands });
    copy._updateShaderDefs(_shaderDefs);
    return copy;
  }

  /** The pictures of a pass; `camera`: that which they are for, or null for all. */
  picturesOf(pass, camera, device, size) {
    let pictures = this.#pictures.find((one) => one.pass === pass && one.camera === camera && one.origin === size.origin);
    if (!pictures) {
      const layers = showsLight(pass)
        ? [pictureOf(device, pass, { channels: 4, depth: true }, size)]
        : pass.layers.map(() => pictureOf(device, pass, { depth: true }, size));
      const packed = layers.length > 1 ? pictureOf(device, pass, { channels: 4 }, size) : layers[0];
      this.#pictures.push((pictures = { pass, camera, origin: size.origin, layers, packed, version: -1 }));
    }
    for (const target of [...pictures.layers, pictures.packed]) {
      if (target.width !== size.width || target.height !== size.height) target.resize(size.width, size.height);
    }
    return pictures;
  }

  /** The volume of a pass. */
  volumeOf(pass, response, device) {
    const before = this.#volumes.get(pass.name);
    if (before?.texels.response === response) return before;
    before?.texture.destroy();
    const { aabb } = internalsOf(this.instance).mesh;
    response.checkBody(aabb.getMin().toArray(), aabb.getMax().toArray());
    const volume = new InnerVolume(device, pass.name, response);
    this.#volumes.set(pass.name, volume);
    return volume;
  }

  /** Destroys the pictures for cameras that are not among these. */
  keep(cameras) {
    this.#destroy(({ camera }) => camera && !cameras.includes(camera));
  }

  #destroy(isGone) {
    const gone = this.#pictures.filter(isGone);
    this.#pictures = this.#pictures.filter((one) => !gone.includes(one));
    for (const target of new Set(gone.flatMap(({ layers, packed }) => [...layers, packed]))) {
      target.destroyTextureBuffers();
      target.destroy();
    }
  }

  dispose() {
    this.#destroy(() => true);
    for (const { texture } of this.#volumes.values()) texture.destroy();
    for (const copy of this.#copies.values()) {
      // those of the mesh instance stay
      Object.assign(copy, { _skinInstance: null, _morphInstance: null, instancingData: null, drawCommands: null });
      copy.destroy();
    }
    this.#copies.clear();
  }
}

/** The passes of a material. PlayCanvas runs them before each camera that sees a mesh instance with the material. */
export class Passes {
  /** The app that draws. @type {any} */
  #app;
  /** @type {Map<pc.MeshInstance, Body>} */
  #bodies = new Map();
  /** For each camera what PlayCanvas runs before it. @type {Map<any, pc.FramePass>} */
  #before = new Map();
  /** @type {Map<string, pc.ShaderMaterial>} */
  #materials = new Map();
  /** @type {any[]} */
  #lamps;
  #tiles;
  #packing;
  /** @type {pc.StandardMaterial | undefined} */
  #matt;
  /** @type {Surroundings | undefined} */
  #surroundings;
  #responses;

  /**
   * @param {any} device
   * @param {{ passes?: import('./frame_passes.js').Pass[], textures: Record<string, { name: string }>, parameters: Record<string, { name: string }> }} description
   * @param {Set<pc.MeshInstance>} instances those that have the material
   * @param {(property: string) => boolean} given whether the page has set a texture
   * @param {import('./inner_volume.js').Responses} responses what it has set for volumes
   */
  constructor(device, { passes = [], textures, parameters }, instances, given, responses) {
    this.device = device;
    this.#responses = responses;
    this.passes = passes;
    this.instances = instances;
    this.given = given;
    this.#lamps = passes.length ? Array.from({ length: 4 }, () => lampCamera(device)) : [];
    /** The name of a property in the shader. */
    this.nameOf = (property) => (textures[property] ?? parameters[property]).name;
    this.follow();
  }

  /** Follows the app of the device, as soon as there is one. */
  follow() {
    if (this.#app || !this.passes.length) return;
    const apps = [pc.AppBase.getApplication(this.device.canvas.id), pc.AppBase.getApplication()];
    this.#app = apps.find((app) => app?.graphicsDevice === this.device);
    this.#app?.on('prerender', this.#prepare, this);
    if (this.#app && this.passes.some(isVolume)) this.#surroundings = new Surroundings(this.#app.scene);
  }

  /** Before a frame: adds cameras that are new, and forgets what is gone. */
  #prepare() {
    this.#surroundings?.follow();
    const { cameras } = this.#app.systems.camera;
    for (const camera of cameras) {
      if (this.#before.has(camera)) continue;
      const before = new pc.FramePass(this.device);
      before.execute = () => this.#draw(camera);
      camera.camera.beforePasses.push(before);
      this.#before.set(camera, before);
    }
    for (const camera of this.#before.keys()) if (!cameras.includes(camera)) this.#leave(camera);
    for (const [instance, body] of this.#bodies) {
      if (this.instances.has(instance)) body.keep(cameras);
      else this.#forget(body);
    }
  }

  #leave(camera) {
    const { beforePasses } = camera.camera;
    const index = beforePasses.indexOf(this.#before.get(camera));
    if (index >= 0) beforePasses.splice(index, 1);
    this.#before.delete(camera);
  }

  #forget(body) {
    for (const pass of this.passes) this.#clear(body, pass);
    body.dispose();
    this.#bodies.delete(body.instance);
  }

  /** Takes a pass's picture away from a mesh instance. */
  #clear({ instance }, pass) {
    for (const property of [pass.texture, ...pass.views]) instance.deleteParameter(this.nameOf(property));
  }

  /** Draws the passes for a camera. */
  #draw(camera) {
    for (const [instance, { lights, layer }] of this.#seenBy(camera)) {
      const body = this.#bodies.get(instance) ?? new Body(instance);
      this.#bodies.set(instance, body);
      for (const pass of this.passes) {
        const manyEyes = pass.seenFrom === 'eye' && camera.camera.xrActive;
        if (manyEyes || this.given(pass.texture)) this.#clear(body, pass);
        else if (isVolume(pass)) this.#computePass(pass, body, lights);
        else this.#drawPass(pass, body, camera, lights, layer);
      }
    }
  }

  /** The mesh instances that a camera sees, their lights, and a layer that they are in. */
  #seenBy(camera) {
    const seen = new Map();
    for (const id of camera.layers) {
      const layer = this.#app.scene.layers.getLayerById(id);
      const { opaque = [], transparent = [] } = layer?.enabled ? layer.getCulledInstances(camera.camera) : {};
      for (const instance of [...opaque, ...transparent]) {
        if (!this.instances.has(instance)) continue;
        const lights = layer._lights.filter(({ mask }) => mask & instance.mask);
        seen.set(instance, { layer, lights: new Set([...(seen.get(instance)?.lights ?? []), ...lights]) });
      }
    }
    return seen;
  }

  /** Computes a volume. */
  #computePass(pass, body, lights) {
    const response = this.#responses.loaded(pass.texture);
    if (!response) {
      this.#clear(body, pass);
      return;
    }
    const volume = body.volumeOf(pass, response, this.device);
    volume.follow(body.instance, lights, this.#surroundings);
    body.instance.setParameter(this.nameOf(pass.texture), volume.texture);
  }

  #drawPass(pass, body, camera, lights, layer) {
    const { device } = this;
    const eye = pass.seenFrom === 'eye';
    const ball = ballOf(body.instance);
    const shown = eye ? [] : lightsAt(ball, lights, pass), tiles = tilesOf(shown.length);
    const pictures = body.picturesOf(pass, eye ? camera : null, device, eye ? sizeOf(camera, device) : { width: SIDE * tiles.across, height: SIDE * tiles.up });
    body.instance.setParameter(this.nameOf(pass.texture), pictures.packed.colorBuffer);
    if (!eye && pictures.version === device.renderVersion) return; // they are the same for all cameras of a frame
    pictures.version = device.renderVersion;
    const distant = pass.seenFrom === 'distant light';
    const cameras = eye ? [camera.camera] : shown.map((light, index) => aim(this.#lamps[index], light, ball, distant));
    pass.views.forEach((view, index) => {
      // a view of zeros shows nothing
      const matrix = cameras[index] ? viewOf(cameras[index], index, tiles, device.isWebGPU) : Array(16).fill(0);
      body.instance.setParameter(this.nameOf(view), matrix);
    });
    if (showsLight(pass)) this.#drawLight(pass, body, pictures.packed, cameras, layer);
    else this.#drawLayers(pass, body, pictures, cameras, LAYER_GAP * ball.radius);
  }

  /** Draws what the body reflects as white and matt, in the light of a layer. */
  #drawLight(pass, body, picture, cameras, layer) {
    const tiles = (this.#tiles ??= new TilePass(this.device, this.#app.renderer));
    const matt = (this.#matt ??= mattMaterial());
    const { scene, renderer } = this.#app;
    const light = {
      lightList: layer.getLightList(scene.clusteredLightingEnabled),
      lightClusters: renderer.worldClustersAllocator._clusters.get(layer.getLightIdHash())?.lightClusters,
    };
    tiles.init(picture);
    tiles.setClearColor(new pc.Color(0, 0, 0, emptyOf(pass)));
    tiles.setClearDepth(1);
    Object.assign(tiles, { cameras, meshInstances: [body.copy(matt)], light });
    tiles.render();
  }

  #drawLayers(pass, body, { layers, packed }, cameras, margin) {
    const tiles = (this.#tiles ??= new TilePass(this.device, this.#app.renderer));
    const empty = emptyOf(pass, Math.max(...cameras.map(({ nearClip, farClip }) => farClip - nearClip), 1));
    layersOf(pass).forEach(({ back, before }, index) => {
      const material = this.#materialOf(back, before >= 0);
      material.setParameter('sss_from_plane', Number(pass.seenFrom !== 'eye'));
      material.setParameter('sss_margin', margin);
      if (before >= 0) material.setParameter('sss_front', layers[before].colorBuffer);
      tiles.init(layers[index]);
      tiles.setClearColor(new pc.Color(empty, empty, empty, 1));
      tiles.setClearDepth(1);
      Object.assign(tiles, { cameras, meshInstances: [body.copy(material)], light: {} });
      tiles.render();
    });
    if (layers.length === 1) return;
    const packing = (this.#packing ??= packingPass(this.device));
    LAYERS.forEach((name, index) => this.device.scope.resolve(name).setValue((layers[index] ?? layers[0]).colorBuffer));
    packing.init(packed);
    packing.render();
  }

  #materialOf(back, peels) {
    const key = `${back} ${peels}`;
    if (!this.#materials.has(key)) this.#materials.set(key, distanceMaterial(this.device, back, peels));
    return /** @type {pc.ShaderMaterial} */ (this.#materials.get(key));
  }

  dispose() {
    this.#app?.off('prerender', this.#prepare, this);
    for (const camera of [...this.#before.keys()]) this.#leave(camera);
    for (const body of [...this.#bodies.values()]) this.#forget(body);
    for (const material of this.#materials.values()) material.destroy();
    this.#matt?.destroy();
    this.#packing?.quadRender?.destroy();
  }
}

/** The size and the rows of what a camera draws into. */
function sizeOf({ renderTarget, rect }, device) {
  const { width, height } = renderTarget ?? device;
  const [across, up] = [width * rect.z, height * rect.w].map((value) => Math.max(Math.floor(value), 1));
  return { width: across, height: up, origin: renderTarget?.origin };
}
