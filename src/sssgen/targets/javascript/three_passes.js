// What three draws before a material: pictures of the body alone, as the eye or a light sees it, and of the scene without it. A
// picture that the page sets itself is not drawn.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { LAYERS, LAYER_GAP, PACKING, SIDE, emptyOf, isFiltered, isVolume, layersOf, lightsOf, showsLight, tileOf, tilesOf, viewNumbers } from './frame_passes.js';
import { Responses } from './inner_volume.js';
import { InnerLight } from './three_inner_light.js';

/** The layer of three that only a pass draws. */
const ALONE = 31;
/** The largest width of a picture of the scene, in texels. */
const MOST = 1024;
/** Whether a picture of the scene is drawn now: its objects keep the pictures that they have, as each may need that of the other. */
let drawsScene = false;

/** Whether a pass shows the scene without the body. */
const showsScene = ({ layers }) => layers.length === 0;

// The materials of a pass: they write the distance from the eye or from the light's plane.

const VERTEX = /* glsl */ `
#include <common>
#include <batching_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
varying vec3 sss_place;
void main() {
  #include <batching_vertex>
  #include <skinbase_vertex>
  #include <morphinstance_vertex>
  #include <begin_vertex>
  #include <morphtarget_vertex>
  #include <skinning_vertex>
  #include <project_vertex>
  sss_place = mvPosition.xyz;
}`;

const FRAGMENT = /* glsl */ `
varying vec3 sss_place;
uniform bool fromPlane;
uniform float start;
uniform float margin;
uniform sampler2D front;
void main() {
  float distance = fromPlane ? -sss_place.z - start : length(sss_place);
  // the surfaces behind those of the layer before
  if (margin > 0.0 && distance < texelFetch(front, ivec2(gl_FragCoord.xy), 0).r + margin) discard;
  gl_FragColor = vec4(distance, 0.0, 0.0, 1.0);
}`;

const emptyPicture = () => new THREE.DataTexture(new Float32Array(4), 1, 1, THREE.RGBAFormat, THREE.FloatType);
/** The uniforms of a ShaderMaterial. */
const glslUniforms = (values) => Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));

/**
 * A material that writes distances, and its uniforms. `nodes`: for WebGPURenderer.
 * @returns {{ uniforms: Record<string, any>, material: THREE.Material }}
 */
function distanceMaterial(nodes, side) {
  if (!nodes) {
    const uniforms = glslUniforms({ fromPlane: false, start: 0, margin: 0, front: emptyPicture() });
    return { uniforms, material: new THREE.ShaderMaterial({ side, uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT }) };
  }
  const uniforms = { fromPlane: TSL.uniform(0), start: TSL.uniform(0), margin: TSL.uniform(0), front: TSL.textureLoad(emptyPicture(), TSL.ivec2(TSL.screenCoordinate)) };
  const distance = TSL.select(uniforms.fromPlane.greaterThan(0), TSL.positionView.z.negate().sub(uniforms.start), TSL.positionView.length());
  const fragmentNode = TSL.Fn(() => {
    TSL.Discard(uniforms.margin.greaterThan(0).and(distance.lessThan(uniforms.front.r.add(uniforms.margin))));
    return TSL.vec4(distance, 0, 0, 1);
  })();
  return { uniforms, material: Object.assign(new THREE.NodeMaterial(), { side, fragmentNode }) };
}

/**
 * A material that writes four layers into one picture.
 * @returns {{ uniforms: Record<string, any>, material: THREE.Material }}
 */
function packingMaterial(nodes) {
  const settings = { depthTest: false, depthWrite: false };
  if (!nodes) {
    const uniforms = glslUniforms(Object.fromEntries(LAYERS.map((name) => [name, emptyPicture()])));
    const vertexShader = 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';
    return { uniforms, material: new THREE.ShaderMaterial({ ...settings, uniforms, vertexShader, fragmentShader: PACKING.glsl }) };
  }
  const uniforms = Object.fromEntries(LAYERS.map((name) => [name, TSL.textureLoad(emptyPicture(), TSL.ivec2(TSL.screenCoordinate))]));
  /** @type {any} */
  const layers = LAYERS.map((name) => uniforms[name].r);
  const fragmentNode = TSL.vec4(...layers);
  const vertexNode = TSL.vec4(TSL.positionGeometry.xy, 0, 1);
  return { uniforms, material: Object.assign(new THREE.NodeMaterial(), { ...settings, vertexNode, fragmentNode }) };
}

/** A white matt material, whose alpha is the distance from a plane at the distance `plane` from the eye's. */
function mattMaterial(nodes) {
  const settings = { roughness: 1, specularIntensity: 0, blending: THREE.NoBlending, fog: false };
  if (nodes) {
    const plane = TSL.uniform(0), distance = TSL.positionView.z.negate().sub(plane);
    return { plane, material: new THREE.MeshPhysicalNodeMaterial({ ...settings, outputNode: TSL.vec4(TSL.output.rgb, distance) }) };
  }
  const plane = { value: 0 }, material = new THREE.MeshPhysicalMaterial(settings);
  material.onBeforeCompile = (shader) => {
    shader.uniforms.sss_plane = plane;
    shader.fragmentShader = `uniform float sss_plane;\n${shader.fragmentShader}`
      .replace('#include <opaque_fragment>', 'gl_FragColor = vec4(outgoingLight, vViewPosition.z - sss_plane);');
  };
  return { plane, material };
}

/** @param {boolean} filtered whether filters may blend the texels @param {boolean} blended whether they do */
function pictureOf(width, height, type, filtered, blended) {
  // in WebGPU three declares no sampler for a texture that neither filter blends; shaders name the level, for which the second is used
  const [minFilter, magFilter] = [filtered, blended].map((linear) => (linear ? THREE.LinearFilter : THREE.NearestFilter));
  const settings = { type, format: THREE.RGBAFormat, minFilter, magFilter };
  return new THREE.WebGLRenderTarget(width, height, settings); // WebGPURenderer takes it, too
}

/** A picture of the scene, with levels. */
function scenePictureOf(width) {
  const settings = { type: THREE.HalfFloatType, samples: 4, generateMipmaps: true, minFilter: THREE.LinearMipmapLinearFilter };
  return new THREE.WebGLRenderTarget(width, width, settings);
}

// The lights of a body.

const placeOf = (object) => new THREE.Vector3().setFromMatrixPosition(object.matrixWorld);

/** The ball around a body, in world space. */
function ballOf(object) {
  if (object.computeBoundingSphere) object.computeBoundingSphere(); // of bones, instances
  else if (!object.geometry.boundingSphere) object.geometry.computeBoundingSphere();
  return (object.boundingSphere ?? object.geometry.boundingSphere).clone().applyMatrix4(object.matrixWorld);
}

/** The lights of a scene that a pass shows. */
function lightsAt(ball, scene, camera, pass) {
  const lights = [];
  scene.traverseVisible((light) => {
    const near = light.isPointLight || light.isSpotLight || light.isRectAreaLight, directional = light.isDirectionalLight;
    if (!(directional || near) || !light.layers.test(camera.layers)) return;
    const fall = near ? Math.max(placeOf(light).distanceToSquared(ball.center), 1e-6) : 1;
    const area = light.isRectAreaLight ? light.width * light.height : 1;
    lights.push({ light, directional, strength: (area * light.intensity * Math.max(light.color.r, light.color.g, light.color.b)) / fall });
  });
  return lightsOf(lights, pass);
}

/** A camera that sees all of a ball from a light; `distant`: as if it were far away. */
function lampOf(light, ball, distant, coordinateSystem) {
  const radius = ball.radius * 1.02;
  const way = placeOf(light).sub(light.isDirectionalLight ? placeOf(light.target) : ball.center);
  const afar = distant || light.isDirectionalLight;
  const distance = afar ? 2 * radius : Math.max(way.length(), 1e-6);
  const half = Math.min(Math.asin(Math.min(radius / distance, 1)), 1.5);
  const lamp = afar
    ? new THREE.OrthographicCamera(-radius, radius, radius, -radius)
    : new THREE.PerspectiveCamera((half * 360) / Math.PI, 1);
  Object.assign(lamp, { near: Math.max(distance - radius, 0.001 * distance), far: distance + radius, coordinateSystem });
  lamp.position.copy(ball.center).addScaledVector(way.normalize(), distance);
  if (Math.abs(way.y) > 0.99) lamp.up.set(0, 0, 1);
  lamp.lookAt(ball.center);
  lamp.updateProjectionMatrix();
  lamp.updateMatrixWorld();
  return lamp;
}

/** World space to a tile of the picture. */
function viewOf(lamp, tile, tiles, up, start = lamp.near) {
  const clip = new THREE.Matrix4().multiplyMatrices(lamp.projectionMatrix, lamp.matrixWorldInverse);
  return new THREE.Matrix4().fromArray(viewNumbers(clip.elements, lamp.matrixWorldInverse.elements, -1, start, up, tile, tiles));
}

/**
 * The pictures of a pass of an object: each layer, and all in one.
 * @typedef {{ layers: THREE.RenderTarget[], packed: THREE.RenderTarget }} Pictures
 */

/** The passes of a material, in one renderer. */
class Drawing {
  /** For each object, by the names of passes. @type {Map<THREE.Object3D, Record<string, Pictures>>} */
  #pictures = new Map();

  constructor(renderer) {
    this.nodes = renderer.isWebGPURenderer === true;
    this.gpu = this.nodes && renderer.backend.isWebGPUBackend === true;
    // half floats where a device does not filter others: three declares no sampler for a texture that it cannot filter
    this.filters = this.gpu || Boolean((renderer.extensions ?? renderer.backend.extensions).has('OES_texture_float_linear'));
    this.type = this.gpu && !renderer.hasFeature('float32-filterable') ? THREE.HalfFloatType : THREE.FloatType;
    this.fronts = distanceMaterial(this.nodes, THREE.FrontSide);
    this.backs = distanceMaterial(this.nodes, THREE.BackSide);
    this.packing = packingMaterial(this.nodes);
    this.matt = mattMaterial(this.nodes);
    /** That of the page, without what it sees. @type {any} */
    this.eye = new THREE.PerspectiveCamera();
    this.eye.matrixWorldAutoUpdate = false;
    /** The colour and the opacity of the page's empty picture. @type {any} */
    this.clear = [new THREE.Color(), 0];
    this.blank = emptyPicture();
    this.innerLight = new InnerLight();
    this.scene = Object.assign(new THREE.Scene(), { matrixWorldAutoUpdate: false });
    this.quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.packing.material);
    this.quad.frustumCulled = false;
    this.camera = new THREE.OrthographicCamera();
  }

  /** Draws with `work`, and leaves the renderer as it was. */
  apart(renderer, work) {
    const state = {
      target: [renderer.getRenderTarget(), renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()],
      color: renderer.getClearColor(new THREE.Color()), alpha: renderer.getClearAlpha(),
      mrt: renderer.getMRT?.(), objectFunction: renderer.getRenderObjectFunction?.(),
      values: Object.fromEntries(['autoClear', 'toneMapping', 'opaque', 'transparent'].filter((name) => name in renderer).map((name) => [name, renderer[name]])),
      shadows: renderer.shadowMap.autoUpdate, presents: renderer.xr?.enabled,
    };
    this.clear = [state.color, state.alpha];
    renderer.setMRT?.(null);
    renderer.setRenderObjectFunction?.(null);
    renderer.shadowMap.autoUpdate = false;
    if (renderer.xr) renderer.xr.enabled = false;
    Object.assign(renderer, { autoClear: false, toneMapping: THREE.NoToneMapping });
    for (const name of ['opaque', 'transparent']) if (name in renderer) renderer[name] = true;
    try {
      work();
    } finally {
      Object.assign(renderer, state.values);
      renderer.shadowMap.autoUpdate = state.shadows;
      if (renderer.xr) renderer.xr.enabled = state.presents;
      renderer.setRenderObjectFunction?.(state.objectFunction);
      renderer.setMRT?.(state.mrt);
      renderer.setRenderTarget(...state.target);
      renderer.setClearColor(state.color, state.alpha);
    }
  }

  /** Draws one pass of an object into its pictures. */
  draw(renderer, pass, pictures, object, cameras, tileSize) {
    const eye = pass.seenFrom === 'eye';
    const empty = emptyOf(pass, Math.max(...cameras.map(({ near, far }) => far - near), 1));
    const margin = LAYER_GAP * ballOf(object).radius;
    layersOf(pass).forEach(({ back, before }, index) => {
      const { material, uniforms } = back ? this.backs : this.fronts;
      uniforms.fromPlane.value = this.nodes ? Number(!eye) : !eye;
      uniforms.margin.value = before < 0 ? 0 : margin;
      uniforms.front.value = before < 0 ? this.blank : pictures.layers[before].texture;
      const picture = pictures.layers[index];
      picture.viewport.set(0, 0, picture.width, picture.height);
      picture.scissor.set(0, 0, picture.width, picture.height);
      renderer.setRenderTarget(picture);
      renderer.setClearColor(new THREE.Color(empty, empty, empty), 1); // three encodes it for the target that is set
      renderer.clear();
      cameras.forEach((camera, index) => {
        const tile = tileOf(index);
        picture.viewport.set(tileSize.x * tile.x, tileSize.y * tile.y, tileSize.x, tileSize.y);
        picture.scissor.copy(picture.viewport);
        renderer.setRenderTarget(picture);
        uniforms.start.value = camera.near;
        this.alone(renderer, object, material, camera);
      });
    });
    if (pictures.layers.length === 1) return;
    pictures.layers.forEach(({ texture }, index) => (this.packing.uniforms[LAYERS[index]].value = texture));
    renderer.setRenderTarget(pictures.packed);
    this.scene.overrideMaterial = null;
    this.scene.children = [this.quad];
    renderer.render(this.scene, this.camera);
  }

  /** Draws what a white matt object reflects in the light and the shadows of its scene. */
  drawLight(renderer, pass, picture, object, scene, camera, plane) {
    this.matt.plane.value = plane;
    this.see(camera);
    const seen = [object];
    scene.traverseVisible((light) => {
      if (light.isLight && light.layers.test(camera.layers)) seen.push(light);
    });
    const masks = seen.map(({ layers }) => layers.mask), { material } = object;
    const { background, backgroundNode = null, fog, overrideMaterial } = scene;
    const { envMap, envMapIntensity, envMapRotation } = material;
    Object.assign(this.matt.material, { envMap, envMapIntensity, envMapRotation, side: material.side, flatShading: material.flatShading });
    if (this.nodes) {
      // WebGPURenderer draws the shadows of what this camera sees: it sees all, and draws the object
      renderer.setRenderObjectFunction((each, ...others) => {
        if (each === object) renderer.renderObject(each, ...others);
      });
    } else {
      this.eye.layers.set(ALONE);
      seen.forEach(({ layers }) => layers.enable(ALONE));
    }
    object.material = this.matt.material;
    Object.assign(scene, { background: null, backgroundNode: null, fog: null, overrideMaterial: null });
    try {
      picture.viewport.set(0, 0, picture.width, picture.height);
      picture.scissor.copy(picture.viewport);
      renderer.setRenderTarget(picture);
      renderer.setClearColor(new THREE.Color(0, 0, 0), emptyOf(pass));
      renderer.clear();
      renderer.render(scene, this.eye);
    } finally {
      Object.assign(scene, { background, backgroundNode, fog, overrideMaterial });
      object.material = material;
      renderer.setRenderObjectFunction?.(null);
      seen.forEach(({ layers }, index) => (layers.mask = masks[index]));
    }
  }

  /** Draws the scene without the objects of a material. */
  drawScene(renderer, picture, material, scene, camera) {
    this.see(camera);
    /** @type {Set<any>} */
    const hidden = new Set();
    scene.traverseVisible((each) => {
      if (each.material === material) hidden.add(each);
    });
    const masks = [...hidden].map(({ layers }) => layers.mask);
    // the shadows of hidden objects stay: WebGPURenderer draws them again, for this camera
    if (this.nodes) renderer.setRenderObjectFunction((each, ...others) => {
      if (!hidden.has(each)) renderer.renderObject(each, ...others);
    });
    else hidden.forEach(({ layers }) => (layers.mask = 0));
    drawsScene = true;
    try {
      picture.viewport.set(0, 0, picture.width, picture.height);
      renderer.setRenderTarget(picture);
      renderer.setClearColor(...this.clear);
      renderer.clear();
      renderer.render(scene, this.eye);
    } finally {
      drawsScene = false;
      renderer.setRenderObjectFunction?.(null);
      [...hidden].forEach(({ layers }, index) => (layers.mask = masks[index]));
    }
  }

  /** Gives the own camera the view of another. */
  see(camera) {
    for (const name of ['matrixWorld', 'matrixWorldInverse', 'projectionMatrix', 'projectionMatrixInverse']) this.eye[name].copy(camera[name]);
    this.eye.coordinateSystem = camera.coordinateSystem;
    this.eye.layers.mask = camera.layers.mask;
  }

  /** Draws an object with another material, without its children. */
  alone(renderer, object, material, camera) {
    const masks = [object.layers.mask, camera.layers.mask];
    object.layers.enable(ALONE);
    camera.layers.set(ALONE);
    this.scene.children = [object]; // whose parent stays
    this.scene.overrideMaterial = material;
    renderer.render(this.scene, camera);
    this.scene.children = [];
    [object.layers.mask, camera.layers.mask] = masks;
  }

  /** The pictures of a pass of an object, in a size. */
  picturesOf(object, pass, size) {
    if (!this.#pictures.has(object)) this.#pictures.set(object, {});
    const own = /** @type {Record<string, Pictures>} */ (this.#pictures.get(object));
    const scene = showsScene(pass), kinds = scene || showsLight(pass) ? [pass.name] : pass.layers;
    const newPicture = () => (scene ? scenePictureOf(size.x) : pictureOf(size.x, size.y, this.type, this.filters, this.filters && isFiltered(pass)));
    const layers = own[pass.name]?.layers ?? kinds.map(newPicture);
    const packed = own[pass.name]?.packed ?? (layers.length > 1 ? newPicture() : layers[0]);
    for (const picture of [...layers, packed]) {
      if (picture.width !== size.x || picture.height !== size.y) picture.setSize(size.x, size.y);
      picture.scissorTest = !scene && (picture !== packed || layers.length === 1);
    }
    return (own[pass.name] = { layers, packed });
  }

  /** Frees the pictures of an object. */
  forget(object) {
    for (const { layers, packed } of Object.values(this.#pictures.get(object) ?? {})) [...layers, packed].forEach((picture) => picture.dispose());
    this.#pictures.delete(object);
    this.innerLight.forget(object);
  }

  dispose() {
    for (const material of [this.fronts.material, this.backs.material, this.packing.material, this.matt.material]) material.dispose();
    this.quad.geometry.dispose();
    this.innerLight.dispose();
  }
}

/** The passes of a material. */
export class Passes {
  /** @type {Map<any, Drawing>} */
  #drawings = new Map();
  /** Those that have pictures. @type {Set<THREE.Object3D>} */
  #objects = new Set();

  /** @param {{ target: any }} event */
  #onRemoved = ({ target }) => this.#forget(target);

  /** @param {import('./frame_passes.js').Pass[]} passes */
  constructor(passes) {
    this.passes = passes;
    this.responses = new Responses(passes);
  }

  /**
   * Draws the passes whose textures are not `given` for an object, and sets the textures and views with `set`.
   * @param {{ renderer: any, scene: THREE.Scene, camera: THREE.Camera, object: THREE.Mesh }} frame
   * @param {(property: string) => boolean} given
   * @param {(property: string, value: any) => void} set
   */
  draw({ renderer, scene, camera, object }, given, set) {
    const passes = this.passes.filter((pass) => !given(pass.texture));
    if (!passes.length || drawsScene) return;
    let drawing = this.#drawings.get(renderer);
    if (!drawing) this.#drawings.set(renderer, (drawing = new Drawing(renderer)));
    this.#objects.add(object);
    object.addEventListener('removed', this.#onRemoved); // which has it once
    drawing.apart(renderer, () => {
      for (const pass of passes) this.#drawPass(drawing, pass, { renderer, scene, camera, object }, set);
    });
    object.modelViewMatrix.multiplyMatrices(camera.matrixWorldInverse, object.matrixWorld);
    object.normalMatrix.getNormalMatrix(object.modelViewMatrix);
  }

  #drawPass(drawing, pass, { renderer, scene, camera, object }, set) {
    if (isVolume(pass)) {
      const response = this.responses.loaded(pass.texture);
      if (response) set(pass.texture, drawing.innerLight.draw({ renderer, scene, camera, object }, response));
      return;
    }
    const eye = pass.seenFrom === 'eye', ball = ballOf(object);
    let cameras = [camera];
    // distances on both sides of the body's middle are small enough for half floats
    const plane = -ball.center.clone().applyMatrix4(camera.matrixWorldInverse).z;
    if (!eye) {
      const system = drawing.gpu ? THREE.WebGPUCoordinateSystem : THREE.WebGLCoordinateSystem;
      const distant = pass.seenFrom === 'distant light';
      cameras = lightsAt(ball, scene, camera, pass).map((light) => lampOf(light, ball, distant, system));
    }
    const tiles = tilesOf(cameras.length), tile = eye ? sizeOf(renderer) : new THREE.Vector2(SIDE, SIDE);
    if (showsScene(pass)) {
      const levels = Math.floor(Math.log2(Math.min(Math.max(tile.x, tile.y), MOST)));
      tile.setScalar(2 ** levels);
      if (pass.size) set(pass.size, levels);
    }
    const pictures = drawing.picturesOf(object, pass, new THREE.Vector2(tile.x * tiles.across, tile.y * tiles.up));
    pass.views.forEach((view, index) => {
      const { x, y } = tileOf(index);
      // the rows of WebGPURenderer's fallback count upwards, its viewports downwards
      const corner = { x, y: drawing.nodes && !drawing.gpu ? tiles.up - 1 - y : y };
      // a view of zeros shows nothing
      const matrix = cameras[index] ? viewOf(cameras[index], corner, tiles, drawing.gpu ? -1 : 1, eye ? plane : undefined) : new THREE.Matrix4().multiplyScalar(0);
      set(view, matrix);
    });
    if (showsScene(pass)) drawing.drawScene(renderer, pictures.packed, object.material, scene, camera);
    else if (showsLight(pass)) drawing.drawLight(renderer, pass, pictures.packed, object, scene, camera, plane);
    else drawing.draw(renderer, pass, pictures, object, cameras, tile);
    set(pass.texture, pictures.packed.texture);
  }

  #forget(object) {
    for (const drawing of this.#drawings.values()) drawing.forget(object);
    this.#objects.delete(object);
    object.removeEventListener('removed', this.#onRemoved);
  }

  dispose() {
    for (const object of [...this.#objects]) this.#forget(object);
    for (const drawing of this.#drawings.values()) drawing.dispose();
    this.#drawings.clear();
  }
}

/** The size of what a renderer draws into. */
function sizeOf(renderer) {
  const picture = renderer.getRenderTarget();
  return picture ? new THREE.Vector2(picture.width, picture.height) : renderer.getDrawingBufferSize(new THREE.Vector2());
}
