// The picture: a body with an emitted material in its lamps and surroundings, an eye that goes around.

import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { ballOf, coarseOf, geometryOf } from './coarse_body.js';
import { Drafts } from './drafts.js';
import { Ground } from './ground.js';
import { Lamps } from './lamps.js';
import { materialOf, programOf, update, valueOf } from './material.js';
import { rendererOf } from './renderer.js';
import { Surroundings } from './surroundings.js';

/** @typedef {import('../page_messages.js').BodyPicture} BodyPicture */
/** @typedef {import('./coarse_body.js').Body} Body */
/** @typedef {import('./material.js').EmittedMaterial} EmittedMaterial */
/** @typedef {{ light: import('./surroundings.js').Light, ground: boolean, lampsShown: boolean }} Settings
 *   `lampsShown`: also those behind the body. */

const WRAPS = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };
/** What a stage shows besides its picture, until a person changes it. */
export const PLAIN = {
  light: { kind: 'none', panorama: null, strength: 1, turn: 0, background: false, blur: 0.4 }, ground: false, lampsShown: false,
};

/** One renderer on one canvas. Another renderer is another stage. */
export class Stage {
  /** @type {import('./renderer.js').Renderer} */
  renderer;  // from start() on
  /** @type {OrbitControls} */
  orbit;
  /** @type {THREE.Mesh<Body, EmittedMaterial>} */
  mesh;  // from show() on
  /** @type {Body[]} */
  bodies;  // the body, and its draft
  /** @type {THREE.Sphere} */
  ball;  // around the body

  /** @param {HTMLElement} root @param {string} kind  of `rendererOf` @param {import('../page_messages.js').PieceOf} pieceOf */
  constructor(root, kind, pieceOf) {
    this.root = root;
    this.kind = kind;
    this.pieceOf = pieceOf;
    /** @type {Map<string, THREE.DataTexture | THREE.Data3DTexture>} */
    this.textures = new Map();  // by the digests of their levels
    /** @type {Settings} */
    this.settings = PLAIN;
    /** @type {THREE.Texture | null} */
    this.sceneLight = null;  // from all around
    this.angle = 0;  // by which the body is turned, in radians
    this.model = new THREE.Matrix4();  // of the body that is not turned
    /** @type {string[]} */
    this.shades = [];  // of the background, from below
    this.drawn = 0;  // frames
    this.view = 35;  // the scene's field of view, in degrees
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera();
    this.lamps = new Lamps(this);
    this.surroundings = new Surroundings(this);
    this.ground = new Ground(this);
    this.drafts = new Drafts(this);
  }

  async start() {
    const canvas = document.createElement('canvas');
    this.renderer = await rendererOf(this.kind, canvas);
    this.renderer.autoClear = true;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.shadowMap.enabled = true;
    this.root.replaceChildren(canvas);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.addEventListener('change', () => this.ask());
    this.lamps.listen(canvas);
    this.sizes = new ResizeObserver(() => this.fit());
    this.sizes.observe(this.root);
    this.fit();
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!width || !height || this.drafts.held) return;
    this.size(width, height);
    this.ask();
  }

  /** @param {number} width @param {number} height */
  size(width, height) {
    this.share = 0;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.widen();
  }

  /** Draws from now on at a share of the full resolution.
   * @param {number} share */
  resolution(share) {
    if (share !== this.share) this.renderer.setPixelRatio(share * Math.min(devicePixelRatio, 2));
    this.share = share;
    this.mesh.geometry = this.bodies[share < 1 / 2 ? 1 : 0];
  }

  /** The scene's field of view; in a narrow picture that of its width, so that the body is not cut off. */
  widen() {
    const half = Math.tan(this.view * Math.PI / 360);
    this.camera.fov = Math.atan(half * Math.max(1, 1 / this.camera.aspect)) * 360 / Math.PI;
    this.camera.updateProjectionMatrix();
  }

  /** Shows a picture; `values` are the numbers that differ from the file's.
   * @param {BodyPicture} picture @param {import('../page_messages.js').Values} values */
  async show(picture, values) {
    const [body, panorama, ...filled] = await Promise.all([
      this.pieceOf(picture.body),
      picture.environment ? this.textureOf(picture.environment) : null,
      ...picture.textures.map(async ({ property, texels }) => (texels ? [[property, await this.textureOf(texels)]] : [])),
    ]);
    /** @type {Record<string, THREE.Texture>} */
    const textures = Object.fromEntries(filled.flat());
    const program = programOf(picture);
    const kept = this.mesh && this.program === program;
    const material = kept ? this.mesh.material : await materialOf(picture, values, textures);
    if (kept) update(material, picture, values, textures);
    else {
      if (picture.two_sided) material.side = THREE.DoubleSide;
    }
    this.program = program;
    if (panorama) panorama.mapping = THREE.EquirectangularReflectionMapping;
    this.sceneLight = panorama;
    this.forget(new Set([...(panorama ? [panorama] : []), ...Object.values(textures)]));
    this.place(picture, body, material);
    this.lamps.show(picture);
    this.arrange(this.settings);
    if (this.shown !== `${picture.name} ${picture.shape}`) this.look(picture);
    this.shown = `${picture.name} ${picture.shape}`;
    this.picture = picture;
    this.renderer.toneMapping = picture.tone_mapping ? THREE.NeutralToneMapping : THREE.LinearToneMapping;
    this.renderer.toneMappingExposure = picture.exposure;
    this.shades = picture.background.map(styleOf);
    this.root.style.background = `linear-gradient(to top, ${this.shades.join(', ')})`;
    await this.drafts.now();
  }

  /** @param {BodyPicture} picture @param {ArrayBuffer} body @param {EmittedMaterial} material */
  place(picture, body, material) {
    if (this.mesh?.userData.body !== picture.body) {
      const geometry = geometryOf(new Float32Array(body));
      if (this.mesh) { this.scene.remove(this.mesh); this.bodies.forEach((one) => one.dispose()); this.exchange(material); }
      this.bodies = [geometry, coarseOf(geometry)];
      this.mesh = new THREE.Mesh(geometry, material);
      this.mesh.userData.body = picture.body;
      this.mesh.castShadow = true;
      this.mesh.matrixAutoUpdate = false;
      this.scene.add(this.mesh);
    } else {
      this.exchange(material);
    }
    this.mesh.receiveShadow = picture.shadows;
    this.model.fromArray(picture.model);
    this.mesh.matrix.copy(this.model);
    this.mesh.updateMatrixWorld(true);
    this.ball = ballOf(this.mesh);
    this.turn(this.angle);
  }

  /** Turns the body about the upright axis through its middle.
   * @param {number} angle  in radians */
  turn(angle) {
    this.angle = angle;
    if (!this.mesh) return;
    const { x, y, z } = this.ball.center;
    this.mesh.matrix.makeTranslation(x, y, z).multiply(new THREE.Matrix4().makeRotationY(angle))
      .multiply(new THREE.Matrix4().makeTranslation(-x, -y, -z)).multiply(this.model);
    this.mesh.updateMatrixWorld(true);
    this.ground.place();
  }

  /** Shows the surroundings and the ground that a person chose.
   * @param {Settings} settings */
  arrange(settings) {
    this.settings = settings;
    this.surroundings.show(settings.light);
    this.lamps.even.intensity = settings.light.kind === 'none' ? Math.PI : 0;  // a scene's ambient light stands for surroundings
    this.ground.show(settings.ground);
    this.lamps.castShadows();
    this.ask();
  }

  /** Gives the body another material.
   * @param {EmittedMaterial} material */
  exchange(material) {
    if (this.mesh.material !== material) this.mesh.material.dispose();
    this.mesh.material = material;
  }

  /** @param {BodyPicture} picture */
  look(picture) {
    this.view = picture.camera.field_of_view;
    this.widen();
    this.camera.position.set(...picture.camera.position);
    this.orbit.target.set(...picture.camera.target);
    this.orbit.update();
  }

  /** @param {string} property @param {number[]} numbers */
  set(property, numbers) {
    const control = this.picture?.controls.find((one) => one.property === property);
    if (!control || !this.mesh) return;
    this.mesh.material[property] = valueOf(control, numbers);
    this.ask();
  }

  /** Gives up the textures that no picture has any more.
   * @param {Set<THREE.Texture>} used */
  forget(used) {
    for (const [key, texture] of this.textures) if (!used.has(texture)) { texture.dispose(); this.textures.delete(key); }
  }

  /** @param {import('../page_messages.js').Texels} texels */
  async textureOf({ dim, filter, wrap, levels }) {
    const key = levels.map((level) => level.data).join();
    let texture = this.textures.get(key);
    if (!texture) {
      const texels = await Promise.all(levels.map(async (level) => new Uint16Array(await this.pieceOf(level.data))));
      const [width, height, depth] = levels[0].size;
      texture = dim === '3D' ? new THREE.Data3DTexture(texels[0], width, height, depth) : new THREE.DataTexture(texels[0], width, height);
      const mag = filter === 'nearest' ? THREE.NearestFilter : THREE.LinearFilter;
      if (levels.length > 1) texture.mipmaps = levels.map((level, index) => ({ data: texels[index], width: level.size[0], height: level.size[1] }));
      Object.assign(texture, {
        format: THREE.RGBAFormat, type: THREE.HalfFloatType, magFilter: mag, minFilter: levels.length > 1 ? THREE.LinearMipmapLinearFilter : mag,
        wrapS: WRAPS[wrap], wrapT: WRAPS[wrap], wrapR: WRAPS[wrap], generateMipmaps: false, unpackAlignment: 1, needsUpdate: true,
      });
      this.textures.set(key, texture);
    }
    return texture;
  }

  ask() { this.drafts.ask(); }

  /** @param {boolean} [handles]  whether the lamps have handles */
  frame(handles = true) {
    if (!this.mesh) return;
    this.lamps.hold(this.ball, handles);
    const away = this.camera.position.distanceTo(this.ball.center);  // bodies are millimetres or kilometres large
    Object.assign(this.camera, { near: 0.005 * away, far: 50 * away }).updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    this.drawn += 1;
  }

  dispose() {
    this.drafts.dispose();
    this.sizes?.disconnect();
    this.orbit?.dispose();
    this.bodies?.forEach((one) => one.dispose());
    this.mesh?.material.dispose();
    this.textures.forEach((texture) => texture.dispose());
    this.lamps.lights = [];
    this.surroundings.dispose();
    this.ground.dispose();
    this.renderer?.dispose();
  }
}

/** @param {number[]} linear */
function styleOf(linear) {
  return `#${new THREE.Color().fromArray(linear.map((number) => Math.min(Math.max(number, 0), 1))).getHexString()}`;
}
