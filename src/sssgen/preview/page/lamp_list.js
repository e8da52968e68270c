// The list of a picture's lamps: their colours and strengths, one more or one less, and saved into the scene.

import * as THREE from 'three';
import { make } from './elements.js';
import { MOST_LAMPS, isDistant } from './lamps.js';

/** @typedef {import('./stage.js').Stage} Stage */

const STRONGEST = 4;  // of a slider, in strengths that the lamp had at first
const shorter = (/** @type {number} */ number) => String(Number(number.toPrecision(3)));

/** The list; `changed()` is called for each change, `save(lights)` writes the lamps.
 * @param {HTMLElement} root @param {Stage} stage @param {() => void} changed @param {(lights: import('../page_messages.js').Light[]) => void} save */
export function showLamps(root, stage, changed, save) {
  const { lamps } = stage;
  const notes = make('p', { className: 'note' });
  const renew = () => { showLamps(root, stage, changed, save); changed(); };
  const rows = lamps.all.map((lamp, index) => lampRow(lamp, index, () => { note(); changed(); }, () => { lamps.remove(index); renew(); }));
  const note = () => {
    const mapped = lamps.mapped;
    const without = lamps.all.flatMap((lamp, index) => (mapped.has(lamp) ? [] : [String(index + 1)]));
    rows.forEach((each, index) => each.classList.toggle('unmapped', !mapped.has(lamps.all[index])));
    notes.textContent = without.length
      ? `No depth map: ${without.join(', ')}. The passes of this material show the body to the brightest lamps only; the light of these comes through as if the body looked the same to them.` : '';
  };
  note();
  const add = make('button', { id: 'add-lamp', textContent: 'Add a lamp', disabled: lamps.all.length >= MOST_LAMPS, title: `At most ${MOST_LAMPS}, as in a scene` });
  add.addEventListener('click', () => { lamps.add(); renew(); });
  const keep = make('button', { id: 'save-lamps', textContent: 'Save lamps', title: 'Writes these lamps into the file of your scene' });
  keep.addEventListener('click', () => save(lamps.lights.map(rounded)));
  root.replaceChildren(
    ...(rows.length ? rows : [make('p', { className: 'note', textContent: 'There is no lamp.' })]), notes,
    make('div', { className: 'row buttons' }, add, keep),
    make('p', { className: 'note', textContent: 'Drag a lamp in the picture; with Shift it moves to the eye and away from it.' }),
  );
}

/** @param {import('./lamps.js').Lamp} lamp @param {number} index @param {() => void} changed @param {() => void} remove */
function lampRow(lamp, index, changed, remove) {
  const name = `lamp ${index + 1}`;
  const first = lamp.intensity / Math.PI;
  const color = make('input', { type: 'color', value: `#${lamp.color.getHexString()}`, title: 'Colour' });
  const slider = make('input', { type: 'range', min: 0, max: 1, step: 0.001, title: 'Strength' });
  const number = make('input', { type: 'number', className: 'number', min: 0, step: 'any', title: isDistant(lamp) ? 'Radiance' : 'Radiance at a distance of 1' });
  for (const [field, what] of /** @type {[HTMLElement, string][]} */ ([[color, 'colour'], [slider, 'strength'], [number, 'strength as a number']])) field.setAttribute('aria-label', `${name}, ${what}`);
  const fill = () => {
    const strength = lamp.intensity / Math.PI;
    slider.value = String(Math.sqrt(strength / (STRONGEST * (first || 1))));
    if (document.activeElement !== number) number.value = shorter(strength);
  };
  const set = (/** @type {number} */ strength) => { lamp.intensity = Math.PI * strength; fill(); changed(); };
  color.addEventListener('input', () => {
    const hue = new THREE.Color(color.value);
    const most = Math.max(hue.r, hue.g, hue.b);
    if (most > 0) lamp.color.copy(hue).multiplyScalar(1 / most);
    changed();
  });
  slider.addEventListener('input', () => set(STRONGEST * (first || 1) * Number(slider.value) ** 2));
  number.addEventListener('input', () => { if (number.value !== '' && Number(number.value) >= 0) set(Number(number.value)); });
  fill();
  const away = make('button', { className: 'remove', textContent: '×', title: `Remove ${name}` });
  away.addEventListener('click', remove);
  const label = make('span', { className: 'lamp', title: isDistant(lamp) ? 'a lamp from afar' : 'a lamp at a place' }, `${index + 1}`, make('small', { textContent: isDistant(lamp) ? 'far' : 'near' }));
  return make('div', { className: 'row' }, label, color, slider, number, away);
}

/** @param {import('../page_messages.js').Light} light */
function rounded({ position, color }) {
  const short = (/** @type {number[]} */ numbers) => numbers.map((number) => Number(number.toPrecision(5)));
  return { position: short(position), color: short(color) };
}
