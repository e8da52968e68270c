// The demo's picture: the stage of the live preview in the surroundings that a project of `sssgen use` has.

import * as THREE from 'three';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { ballOf } from './preview/coarse_body.js';
import { Stage } from './preview/stage.js';

const LAMP = [-1.75, 0.95, -2.3];  // in radii of the body: in the picture, where it can be dragged
const BACKGROUND = 0x121316;
const SWAY = 0.22;  // radians, to each side
const PERIOD = 14;  // seconds

export class DemoStage extends Stage {
  /** @param {HTMLElement} root @param {import('../../../../src/sssgen/preview/page_messages.js').PieceOf} pieceOf */
  constructor(root, pieceOf) {
    super(root, 'webgl', pieceOf);
    this.touched = matchMedia('(prefers-reduced-motion: reduce)').matches;  // then the view rests
    this.angle = 0;
  }

  async start() {
    await super.start();
    const renderer = /** @type {THREE.WebGLRenderer} */ (this.renderer);
    this.scene.background = new THREE.Color(BACKGROUND);
    this.scene.environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
    for (const kind of ['pointerdown', 'wheel']) renderer.domElement.addEventListener(kind, () => { this.touched = true; });
    Object.assign(this.orbit, { enableZoom: false, enablePan: false, maxPolarAngle: 0.52 * Math.PI });
    requestAnimationFrame((time) => this.sway(time));
  }

  /** @param {import('../../../../src/sssgen/preview/page_messages.js').BodyPicture} picture @param {ArrayBuffer} body
   * @param {import('./preview/material.js').EmittedMaterial} material */
  place(picture, body, material) {
    super.place(picture, body, material);
    if (this.ground) return;
    const { radius, center } = ballOf(this.mesh);
    const low = new THREE.Box3().setFromObject(this.mesh).min.y;
    this.ground = new THREE.Mesh(
      new THREE.CircleGeometry(12 * radius, 96).rotateX(-Math.PI / 2), new THREE.MeshStandardMaterial({ color: 0x2a2826, roughness: 0.9 }),
    );
    this.ground.position.set(center.x, low, center.z);
    this.ground.receiveShadow = true;
    this.scene.fog = new THREE.Fog(BACKGROUND, 6 * radius, 12 * radius);
    this.scene.add(this.ground);
  }

  /** The scene's lamps; the one behind the body is a spot light, as a point light would draw its shadow six times.
   * @param {import('../../../../src/sssgen/preview/page_messages.js').BodyPicture} picture */
  light(picture) {
    const before = this.lit;
    super.light(picture);
    if (this.lit === before) return;
    const { radius, center } = ballOf(this.mesh);
    for (const [index, lamp] of this.lamps.entries()) {
      if (!(lamp instanceof THREE.PointLight)) { this.scene.remove(this.handles[index]); continue; }
      const place = new THREE.Vector3(...LAMP).multiplyScalar(radius);
      const nearer = place.lengthSq() / lamp.position.distanceToSquared(center);
      const spot = new THREE.SpotLight(lamp.color, lamp.intensity * nearer, 0, 0.55, 0.6);
      spot.position.copy(place).add(center);
      spot.target.position.copy(center);
      spot.target.updateMatrixWorld();
      spot.castShadow = true;
      spot.shadow.mapSize.set(1024, 1024);
      Object.assign(spot.shadow, { radius: 3, normalBias: 0.01 * radius });
      Object.assign(spot.shadow.camera, { near: radius, far: 9 * radius });
      this.scene.remove(lamp);
      this.scene.add(spot);
      this.handles[index].userData.lamp = this.lamps[index] = spot;
    }
  }

  /** Turns the view a little to and fro until somebody touches it, on machines that draw it at once.
   * @param {number} time  in milliseconds */
  sway(time) {
    if (this.touched) return;
    requestAnimationFrame((next) => this.sway(next));
    if (!this.mesh || this.drafts.level > 0 || document.hidden) return;
    const angle = SWAY * Math.sin(time / 1000 * 2 * Math.PI / PERIOD);
    this.camera.position.sub(this.orbit.target).applyAxisAngle(THREE.Object3D.DEFAULT_UP, angle - this.angle).add(this.orbit.target);
    this.angle = angle;
    this.orbit.update();
  }
}
