// The lamps of a picture: those of its scene at first, then what a person drags, adds and removes.

import * as THREE from 'three';

/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {THREE.PointLight | THREE.SpotLight | THREE.DirectionalLight} Lamp */
/** @typedef {THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial> & { userData: { lamp: Lamp } }} Handle */
/** @typedef {import('../page_messages.js').Light} Light */

/** As many as a scene, and a pass of each light, can have. */
export const MOST_LAMPS = 4;
const HANDLE = 0.035;  // of half the picture's height
const AFAR = 1.35;  // where the handle of a lamp from afar is, in radii of the body; in a closer view
const IN_VIEW = 0.95;  // of half the picture's height
const SHADOW_SIZE = { point: 1536, distant: 2048 };  // a point lamp has six pictures

export const isDistant = (/** @type {Lamp} */ lamp) => lamp instanceof THREE.DirectionalLight;

/** The lamps of a stage. `moved()` is called after a drag. */
export class Lamps {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {Lamp[]} */
    this.all = [];
    /** @type {Handle[]} */
    this.handles = [];
    this.even = new THREE.AmbientLight(0xffffff, 0);
    this.moved = () => {};
    this.chosen = /** @type {Lamp | null} */ (null);
    this.rays = new THREE.Raycaster();
    stage.scene.add(this.even);
  }

  /** The lamps of a picture's scene, where the picture has others than before.
   * @param {import('../page_messages.js').BodyPicture} picture */
  show(picture) {
    this.picture = picture;
    const key = JSON.stringify([picture.lights, picture.ambient, picture.body]);
    if (key === this.key) return;
    this.key = key;
    this.even.color.setRGB(...picture.ambient);
    this.lights = picture.lights;
  }

  /** The lamps as a scene has them: a point lamp at a place, one from afar in a direction; `color` is linear. */
  get lights() {
    return this.all.map((lamp) => {
      const { x, y, z } = isDistant(lamp) ? this.towards(lamp) : lamp.position;
      const strength = lamp.intensity / Math.PI;
      return { position: [x, y, z, isDistant(lamp) ? 0 : 1], color: lamp.color.toArray().map((part) => part * strength) };
    });
  }

  /** @param {Light[]} lights */
  set lights(lights) {
    this.all.forEach((lamp) => { this.stage.scene.remove(lamp); lamp.dispose(); });
    this.handles.forEach((handle) => { this.stage.scene.remove(handle); handle.geometry.dispose(); handle.material.dispose(); });
    this.all = lights.map(({ position: [x, y, z, w], color }) => {
      const strength = Math.max(...color, 1e-6);
      // three's lights are irradiance, those of a scene radiance: their ratio is pi
      const lamp = new (w ? THREE.PointLight : THREE.DirectionalLight)(new THREE.Color(...color).multiplyScalar(1 / strength), Math.PI * strength);
      lamp.position.set(x, y, z);
      return lamp;
    });
    this.handles = this.all.map((lamp) => {
      const handle = new THREE.Mesh(new THREE.SphereGeometry(1, 16, 12), new THREE.MeshBasicMaterial({ toneMapped: false }));
      handle.renderOrder = 1;
      return Object.assign(handle, { userData: { lamp } });
    });
    this.chosen = null;
    [...this.all, ...this.handles].forEach((each) => this.stage.scene.add(each));
    const ball = this.stage.ball;
    for (const lamp of this.all) if (isDistant(lamp)) this.aim(lamp, lamp.position.clone(), ball);
    this.castShadows();
  }

  /** Takes over the lamps of a stage beside this one.
   * @param {Lamps} others */
  follow(others) {
    const alike = this.all.length === others.all.length && this.all.every((lamp, index) => isDistant(lamp) === isDistant(others.all[index]));
    if (!alike) { this.lights = others.lights; return; }
    this.all.forEach((lamp, index) => {
      const other = others.all[index];
      lamp.color.copy(other.color);
      lamp.intensity = other.intensity;
      if (isDistant(lamp)) this.aim(lamp, others.towards(other), this.stage.ball);
      else lamp.position.copy(other.position);
    });
  }

  /** A new, weak lamp beside the eye. */
  add() {
    const { camera, ball } = this.stage;
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const place = camera.position.clone().sub(ball.center).setLength(1.6 * ball.radius).addScaledVector(right, 1.6 * ball.radius).add(ball.center);
    place.y += ball.radius;
    const strength = 0.4 * place.distanceToSquared(ball.center);
    this.lights = [...this.lights, { position: [place.x, place.y, place.z, 1], color: [strength, strength, strength] }];
  }

  /** @param {number} index */
  remove(index) { this.lights = this.lights.filter((_, other) => other !== index); }

  /** The unit direction towards a lamp from afar.
   * @param {Lamp} lamp */
  towards(lamp) { return lamp.position.clone().sub(/** @type {THREE.DirectionalLight} */ (lamp).target.position).normalize(); }

  /** Lets a lamp from afar shine from a direction.
   * @param {Lamp} lamp @param {THREE.Vector3} direction @param {THREE.Sphere} ball */
  aim(lamp, direction, ball) {
    const { target } = /** @type {THREE.DirectionalLight} */ (lamp);
    target.position.copy(ball.center);
    target.updateMatrixWorld();
    lamp.position.copy(ball.center).addScaledVector(direction.normalize(), 3 * ball.radius);
  }

  /** The scene's shadow is that of its first lamp; a ground shows those of all. */
  castShadows() {
    const { ground } = this.stage.settings;
    this.all.forEach((lamp, index) => {
      lamp.castShadow = ground || Boolean(this.picture?.shadows && index === 0);
      const size = SHADOW_SIZE[isDistant(lamp) ? 'distant' : 'point'];
      lamp.shadow.mapSize.set(size, size);
      lamp.shadow.radius = 5;
    });
  }

  /** Those whose depth maps the material has: the passes show the brightest at the body; from afar only lamps from afar, if there are any.
   * It is the rule of the material's own passes. */
  get mapped() {
    const { ball } = this.stage;
    const strength = (/** @type {Lamp} */ lamp) => lamp.intensity * Math.max(lamp.color.r, lamp.color.g, lamp.color.b)
      / (isDistant(lamp) ? 1 : Math.max(lamp.position.distanceToSquared(ball.center), 1e-6));
    const shining = this.all.filter((lamp) => strength(lamp) > 0).sort((one, other) => strength(other) - strength(one));
    const seen = (this.picture?.lamp_passes ?? []).map(({ seen_from, views }) => {
      const afar = seen_from === 'distant light' ? shining.filter(isDistant) : [];
      return (afar.length ? afar : shining).slice(0, views);
    });
    return new Set(this.all.filter((lamp) => seen.every((lamps) => lamps.includes(lamp))));
  }

  /** Where the handles of lamps from afar are: around the body, or what the eye sees of it. */
  get seats() {
    const { ball, camera, orbit, view } = this.stage;
    const half = camera.position.distanceTo(orbit.target) * Math.tan(view * Math.PI / 360);
    return IN_VIEW * half < AFAR * ball.radius ? new THREE.Sphere(orbit.target, IN_VIEW * half) : new THREE.Sphere(ball.center, AFAR * ball.radius);
  }

  /** Before a frame: the handles, a point lamp's at its place, that of a lamp from afar beside the body; and what the shadows see.
   * @param {THREE.Sphere} ball @param {boolean} visible */
  hold(ball, visible) {
    const { camera, view, settings } = this.stage;
    const { seats } = this;
    for (const handle of this.handles) {
      const { lamp } = handle.userData;
      if (isDistant(lamp)) this.aim(lamp, this.towards(lamp), ball);
      handle.position.copy(lamp.position);
      if (isDistant(lamp)) handle.position.copy(seats.center).addScaledVector(this.towards(lamp), seats.radius);
      const size = lamp === this.chosen ? 1.4 : 1;
      handle.scale.setScalar(size * HANDLE * handle.position.distanceTo(camera.position) * Math.tan(view * Math.PI / 360));
      handle.material.color.copy(lamp.color);
      handle.material.depthTest = !settings.lampsShown;
      handle.visible = visible;
      this.frame(lamp, ball);
      lamp.updateMatrixWorld();
      this.renewShadow(lamp);
    }
  }

  /** Lets a shadow be drawn again once the lamp or the body has moved: not for each frame, in which only the eye has.
   * @param {Lamp} lamp */
  renewShadow(lamp) {
    const { mesh } = this.stage;
    const seen = JSON.stringify([lamp.castShadow, lamp.position, mesh.geometry.id, mesh.matrix.elements]);
    lamp.shadow.autoUpdate = false;
    if (lamp.userData.seen !== seen) lamp.shadow.needsUpdate = true;
    lamp.userData.seen = seen;
  }

  /** What a lamp's shadow map sees: the body; its shadow falls farther.
   * @param {Lamp} lamp @param {THREE.Sphere} ball */
  frame(lamp, { center, radius }) {
    const { shadow } = lamp;
    shadow.normalBias = 0.01 * radius;
    if (isDistant(lamp)) {
      const reach = 1.1 * radius;
      Object.assign(shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 3 * radius - reach, far: 20 * radius });
    } else {
      const away = lamp.position.distanceTo(center);
      Object.assign(shadow.camera, { near: Math.max(away - 1.1 * radius, 0.02 * radius), far: away + 20 * radius });
    }
    shadow.camera.updateProjectionMatrix();
  }

  /** Lets the pointer move the lamps: in the plane of the view, with Shift to the eye and away from it.
   * @param {HTMLCanvasElement} canvas */
  listen(canvas) {
    const { rays, stage } = this;
    /** @type {Handle | null} */
    let held = null;
    const aim = (/** @type {PointerEvent} */ event) => {
      const box = canvas.getBoundingClientRect();
      rays.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height), stage.camera);
    };
    canvas.addEventListener('pointerdown', (event) => {
      aim(event);
      held = /** @type {Handle | undefined} */ (rays.intersectObjects(this.handles)[0]?.object) ?? null;
      if (!held) return;
      this.chosen = held.userData.lamp;
      stage.orbit.enabled = false;
      canvas.setPointerCapture(event.pointerId);
    }, { capture: true });
    canvas.addEventListener('pointermove', (event) => {
      if (!held) return;
      aim(event);
      this.drag(held, event.shiftKey ? event.movementY / canvas.clientHeight : 0, event.shiftKey);
      this.moved();
      stage.ask();
    });
    const release = () => {
      if (held) this.moved();
      held = null;
      stage.orbit.enabled = true;
    };
    canvas.addEventListener('pointerup', release);
    canvas.addEventListener('pointercancel', release);
  }

  /** Moves a lamp to the ray of the pointer, or by a share of its distance towards the eye.
   * @param {Handle} handle @param {number} nearer @param {boolean} inDepth */
  drag(handle, nearer, inDepth) {
    const { ball, camera } = this.stage;
    const { lamp } = handle.userData;
    const { seats } = this;
    if (isDistant(lamp)) this.aim(lamp, onSphere(this.rays.ray, seats, handle.position).sub(seats.center), ball);
    else if (inDepth) lamp.position.lerp(camera.position, Math.min(nearer, 0.9));
    else this.rays.ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(camera.getWorldDirection(new THREE.Vector3()), lamp.position), lamp.position);
  }
}

/** The point of a sphere on a ray, on the side where the handle is; beside it the nearest one.
 * @param {THREE.Ray} ray @param {THREE.Sphere} sphere @param {THREE.Vector3} before */
function onSphere(ray, { center, radius }, before) {
  const middle = ray.direction.dot(center.clone().sub(ray.origin));
  const nearest = ray.at(middle, new THREE.Vector3());
  const off = nearest.distanceTo(center);
  if (off >= radius) return nearest.sub(center).setLength(radius).add(center);
  const half = Math.sqrt(radius * radius - off * off);
  const behind = ray.direction.dot(before.clone().sub(center)) > 0;
  return ray.at(middle + (behind ? half : -half), new THREE.Vector3());
}
