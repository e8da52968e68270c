// The picture: a body with an emitted material, lamps that can be dragged, an eye that goes around.

import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { ballOf, coarseOf, geometryOf } from './coarse_body.js';
import { Drafts } from './drafts.js';
import { materialOf, programOf, update, valueOf } from './material.js';
import { rendererOf } from './renderer.js';

/** @typedef {import('../page_messages.js').BodyPicture} BodyPicture */
/** @typedef {import('./coarse_body.js').Body} Body */
/** @typedef {import('./material.js').EmittedMaterial} EmittedMaterial */
/** @typedef {THREE.PointLight | THREE.SpotLight | THREE.DirectionalLight} Lamp */
/** @typedef {THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial> & { userData: { lamp: Lamp } }} Handle */

const WRAPS = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };
const HANDLE = 0.035;  // of half the picture's height

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
    /** @type {Lamp[]} */
    this.lamps = [];
    /** @type {Handle[]} */
    this.handles = [];
    this.drawn = 0;  // frames
    this.view = 35;  // the scene's field of view, in degrees
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera();
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
    this.follow(canvas);
    this.sizes = new ResizeObserver(() => this.fit());
    this.sizes.observe(this.root);
    this.fit();
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!width || !height) return;
    this.share = 0;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.widen();
    this.ask();
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
    const body = await this.pieceOf(picture.body);
    /** @type {Record<string, THREE.Texture>} */
    const textures = {};
    for (const { property, texels } of picture.textures) if (texels) textures[property] = await this.textureOf(texels);
    const program = programOf(picture);
    const kept = this.mesh && this.program === program;
    const material = kept ? this.mesh.material : await materialOf(picture, values, textures);
    if (kept) update(material, picture, values, textures);
    else {
      if (picture.two_sided) material.side = THREE.DoubleSide;
    }
    this.program = program;
    this.forget(new Set(Object.values(textures)));
    this.place(picture, body, material);
    this.light(picture);
    if (this.shown !== `${picture.name} ${picture.shape}`) this.look(picture);
    this.shown = `${picture.name} ${picture.shape}`;
    this.picture = picture;
    this.renderer.toneMapping = picture.tone_mapping ? THREE.NeutralToneMapping : THREE.LinearToneMapping;
    this.renderer.toneMappingExposure = picture.exposure;
    this.root.style.background = `linear-gradient(to top, ${picture.background.map(styleOf).join(', ')})`;
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
      this.mesh.castShadow = this.mesh.receiveShadow = true;
      this.mesh.matrixAutoUpdate = false;
      this.scene.add(this.mesh);
    } else {
      this.exchange(material);
    }
    this.mesh.matrix.fromArray(picture.model);
    this.mesh.updateMatrixWorld(true);
    material.envMap = this.sky ?? null;
  }

  /** Gives the body another material.
   * @param {EmittedMaterial} material */
  exchange(material) {
    if (this.mesh.material !== material) this.mesh.material.dispose();
    this.mesh.material = material;
  }

  /** @param {BodyPicture} picture */
  light(picture) {
    const key = JSON.stringify([picture.lights, picture.ambient, picture.shadows, picture.body]);
    if (key === this.lit) return;
    this.lit = key;
    this.scene.remove(...this.lamps, ...this.handles, ...(this.even ? [this.even] : []));
    this.even = new THREE.AmbientLight(new THREE.Color(...picture.ambient), Math.PI);
    // three's lights are irradiance, those of a scene radiance: their ratio is pi
    this.lamps = picture.lights.map(({ position: [x, y, z, w], color }) => {
      const lamp = new (w ? THREE.PointLight : THREE.DirectionalLight)(new THREE.Color(...color), Math.PI);
      lamp.position.set(x, y, z);
      return lamp;
    });
    if (picture.shadows && this.lamps.length) this.shadow(this.lamps[0]);
    this.handles = this.lamps.map((lamp) => {
      const color = lamp.color.clone().multiplyScalar(1 / Math.max(lamp.color.r, lamp.color.g, lamp.color.b, 1e-6));
      const handle = new THREE.Mesh(new THREE.SphereGeometry(1, 16, 12), new THREE.MeshBasicMaterial({ color, toneMapped: false }));
      return Object.assign(handle, { userData: { lamp } });
    });
    this.scene.add(this.even, ...this.lamps, ...this.handles);
  }

  /** Shadows of a lamp, in a map around the body.
   * @param {Lamp} lamp */
  shadow(lamp) {
    const ball = ballOf(this.mesh);
    lamp.castShadow = true;
    lamp.shadow.mapSize.set(2048, 2048);
    lamp.shadow.normalBias = 0.01 * ball.radius;
    if (lamp instanceof THREE.DirectionalLight) {
      const reach = 1.1 * ball.radius;
      Object.assign(lamp.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0, far: 6 * reach });
      lamp.position.normalize().multiplyScalar(3 * reach);
    }
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

  /** @param {boolean} on */
  environment(on) {
    this.sky = on ? sky() : null;
    this.scene.environment = this.sky;
    if (this.mesh) { this.mesh.material.envMap = this.sky; this.mesh.material.needsUpdate = true; }
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

  frame() {
    if (!this.mesh) return;
    this.hold();
    const away = this.camera.position.distanceTo(this.ball.center);  // bodies are millimetres or kilometres large
    Object.assign(this.camera, { near: 0.005 * away, far: 50 * away }).updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    this.drawn += 1;
  }

  /** The lamps' handles: a point light's at its place, that of a light from afar beside the body. */
  hold() {
    const ball = ballOf(this.mesh);
    for (const handle of this.handles) {
      const { lamp } = handle.userData;
      handle.position.copy(lamp.position);
      if (lamp instanceof THREE.DirectionalLight) handle.position.normalize().multiplyScalar(1.35 * ball.radius).add(ball.center);
      handle.scale.setScalar(HANDLE * handle.position.distanceTo(this.camera.position) * Math.tan(this.view * Math.PI / 360));
      lamp.updateMatrixWorld();
    }
    this.ball = ball;
  }

  /** Lets the pointer move the lamps.
   * @param {HTMLCanvasElement} canvas */
  follow(canvas) {
    const rays = new THREE.Raycaster();
    /** @type {Handle | null} */
    let held = null;
    const aim = (/** @type {PointerEvent} */ event) => {
      const box = canvas.getBoundingClientRect();
      rays.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height), this.camera);
    };
    canvas.addEventListener('pointerdown', (event) => {
      aim(event);
      held = /** @type {Handle | undefined} */ (rays.intersectObjects(this.handles)[0]?.object) ?? null;
      if (!held) return;
      this.orbit.enabled = false;
      canvas.setPointerCapture(event.pointerId);
    }, { capture: true });
    canvas.addEventListener('pointermove', (event) => {
      if (!held) return;
      aim(event);
      const { lamp } = held.userData;
      if (lamp instanceof THREE.DirectionalLight) {
        const off = lamp.position.length();
        lamp.position.copy(this.onSphere(rays.ray, 1.35 * this.ball.radius, held.position)).sub(this.ball.center).setLength(off);
      }
      else rays.ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), lamp.position), lamp.position);
      this.ask();
    });
    const release = () => { held = null; this.orbit.enabled = true; };
    canvas.addEventListener('pointerup', release);
    canvas.addEventListener('pointercancel', release);
  }

  /** The point of a sphere around the body on a ray, on the side where the handle is; beside it the nearest one.
   * @param {THREE.Ray} ray @param {number} radius @param {THREE.Vector3} before */
  onSphere(ray, radius, before) {
    const middle = ray.direction.dot(this.ball.center.clone().sub(ray.origin));
    const nearest = ray.at(middle, new THREE.Vector3());
    const off = nearest.distanceTo(this.ball.center);
    if (off >= radius) return nearest.sub(this.ball.center).setLength(radius).add(this.ball.center);
    const half = Math.sqrt(radius * radius - off * off);
    const behind = ray.direction.dot(before.clone().sub(this.ball.center)) > 0;
    return ray.at(middle + (behind ? half : -half), new THREE.Vector3());
  }

  dispose() {
    this.drafts.dispose();
    this.sizes?.disconnect();
    this.orbit?.dispose();
    this.bodies?.forEach((one) => one.dispose());
    this.mesh?.material.dispose();
    this.textures.forEach((texture) => texture.dispose());
    this.renderer?.dispose();
  }
}

/** @param {number[]} linear */
function styleOf(linear) {
  return `#${new THREE.Color().fromArray(linear.map((number) => Math.min(Math.max(number, 0), 1))).getHexString()}`;
}

/** A studio as an environment: dark below, bright above, with a window. */
function sky() {
  const [width, height] = [64, 32];
  const data = new Float32Array(width * height * 4);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const up = (y + 0.5) / height;
      const window = x > 38 && x < 50 && y > 17 && y < 27 ? 6 : 0;
      data.set([0.08 + 0.25 * up + window, 0.09 + 0.27 * up + window, 0.1 + 0.32 * up + window, 1], 4 * (y * width + x));
    }
  }
  const texture = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, THREE.FloatType);
  return Object.assign(texture, { mapping: THREE.EquirectangularReflectionMapping, magFilter: THREE.LinearFilter, minFilter: THREE.LinearFilter, needsUpdate: true });
}
