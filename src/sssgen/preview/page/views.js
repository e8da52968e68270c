// Places of the eye: in front of the body, against the light, and that of the scene.

import * as THREE from 'three';
import { isDistant } from './lamps.js';

const MARGIN = 1.12;  // by how much the view is larger than the body

/** @typedef {import('./stage.js').Stage} Stage */

/** The eye looks at the whole body from a direction.
 * @param {Stage} stage @param {THREE.Vector3} direction */
function lookFrom(stage, direction) {
  const { ball, camera, orbit } = stage;
  const narrow = Math.min(1, camera.aspect);
  const half = Math.atan(Math.tan(camera.fov * Math.PI / 360) * narrow);
  camera.position.copy(ball.center).addScaledVector(direction.normalize(), MARGIN * ball.radius / Math.sin(half));
  orbit.target.copy(ball.center);
  orbit.update();
  stage.ask();
}

/** The way to the lamp that is brightest at the body; null where there is none.
 * @param {Stage} stage */
function towardsBrightest({ lamps, ball }) {
  const rows = lamps.all.map((lamp) => {
    const way = isDistant(lamp) ? lamps.towards(lamp) : lamp.position.clone().sub(ball.center);
    return { way, strength: lamp.intensity / (isDistant(lamp) ? 1 : Math.max(way.lengthSq(), 1e-6)) };
  });
  return rows.sort((one, other) => other.strength - one.strength)[0]?.way ?? null;
}

/** @type {Record<string, { label: string, title: string, look: (stage: Stage) => void }>} */
export const VIEWS = {
  front: {
    label: 'Front', title: 'The eye in front of the body',
    look(stage) { lookFrom(stage, new THREE.Vector3(0, 0.18, 1)); },
  },
  against: {
    label: 'Back-lit', title: 'The brightest lamp behind the body',
    look(stage) {
      const way = towardsBrightest(stage);
      if (!way) return;
      // a little beside the lamp, so that it does not shine into the eye past the body
      way.setY(0.35 * way.y).applyAxisAngle(new THREE.Vector3(0, 1, 0), 0.3);
      lookFrom(stage, way.lengthSq() > 0 ? way.negate().setY(Math.abs(way.y) + 0.15 * way.length()) : new THREE.Vector3(0, 0, 1));
    },
  },
  scene: {
    label: 'Reset', title: "The scene's own eye and lamps, the body not turned",
    look(stage) {
      if (!stage.picture) return;
      stage.lamps.lights = stage.picture.lights;
      stage.turn(0);
      stage.look(stage.picture);
      stage.ask();
    },
  },
};
