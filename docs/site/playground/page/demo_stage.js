// The demo's picture: the stage of the live preview in the studio and on the ground, with its lamp behind the body.

import * as THREE from 'three';
import { isDistant } from './preview/lamps.js';
import { PLAIN, Stage } from './preview/stage.js';

/** @typedef {import('../../../../src/sssgen/preview/page_messages.js').BodyPicture} BodyPicture */

const LAMP = new THREE.Vector3(-1.75, 0.95, -2.3);  // in radii of the body: in the picture, where it can be dragged
const GROUND = 0x2a2826;
const STUDIO = 5 / 3;  // a scene's unit of surroundings is half of three's room, a stage's 0.3 of it
const SWAY = 0.22;  // radians, to each side
const PERIOD = 14;  // seconds

export class DemoStage extends Stage {
  /** @param {HTMLElement} root @param {import('../../../../src/sssgen/preview/page_messages.js').PieceOf} pieceOf */
  constructor(root, pieceOf) {
    super(root, 'webgl', pieceOf);
    this.touched = matchMedia('(prefers-reduced-motion: reduce)').matches;  // then the view rests
    this.swayed = 0;
  }

  async start() {
    await super.start();
    this.ground.show(true);
    this.ground.mesh?.material.color.set(GROUND);
    for (const kind of ['pointerdown', 'wheel']) this.root.addEventListener(kind, () => { this.touched = true; });
    Object.assign(this.orbit, { enableZoom: false, enablePan: false, maxPolarAngle: 0.52 * Math.PI });
    requestAnimationFrame((time) => this.sway(time));
  }

  /** The surroundings of the next pictures.
   * @param {number} strength  as scenes have it */
  surround(strength) { this.settings = { light: { ...PLAIN.light, kind: 'studio', strength: STUDIO * strength }, ground: true, lampsShown: false }; }

  /** The scene's view, with its lamp at the demo's place.
   * @param {BodyPicture} picture */
  look(picture) {
    super.look(picture);
    this.swayed = 0;
    this.lamps.lights = picture.lights.map((light) => (light.position[3] ? behind(light, this.ball) : light));
    const front = this.lamps.handles.filter((handle) => isDistant(handle.userData.lamp));  // they would hide an ear
    this.scene.remove(...front);
    this.lamps.handles = this.lamps.handles.filter((handle) => !front.includes(handle));
  }

  /** Turns the view a little to and fro until somebody touches it, on machines that draw it at once.
   * @param {number} time  in milliseconds */
  sway(time) {
    if (this.touched) return;
    requestAnimationFrame((next) => this.sway(next));
    if (!this.mesh || this.drafts.level > 0 || document.hidden) return;
    const angle = SWAY * Math.sin(time / 1000 * 2 * Math.PI / PERIOD);
    this.camera.position.sub(this.orbit.target).applyAxisAngle(THREE.Object3D.DEFAULT_UP, angle - this.swayed).add(this.orbit.target);
    this.swayed = angle;
    this.orbit.update();
  }
}

/** A point lamp at the demo's place, as bright at the body as at its own.
 * @param {import('../../../../src/sssgen/preview/page_messages.js').Light} light @param {THREE.Sphere} ball */
function behind({ position: [x, y, z], color }, { center, radius }) {
  const place = LAMP.clone().multiplyScalar(radius);
  const farther = place.lengthSq() / new THREE.Vector3(x, y, z).distanceToSquared(center);
  return { position: [...place.add(center).toArray(), 1], color: color.map((part) => part * farther) };
}
