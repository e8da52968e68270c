// The controls of a material's parameters, grouped by technique.

import * as THREE from 'three';
import { make } from './elements.js';

/** @typedef {import('../page_messages.js').Control} Control */
/** @typedef {Control & { range: [number, number] }} Ranged */

const shorter = (/** @type {number} */ number) => String(Number(number.toPrecision(5)));

/** The least value above 0 on the slider of a range over powers of ten, which is logarithmic; 0 on an even slider.
 * @param {Ranged} control */
function leastOf({ range: [low, high] }) {
  if (low === 0 && high > 1) return 0.0001 * high;
  return low > 0 && high / low > 500 ? low : 0;
}

/** The panel: `changed(property, numbers)` is called for each change by hand. */
export class Panel {
  /** @param {HTMLElement} root @param {(property: string, numbers: number[]) => void} changed */
  constructor(root, changed) {
    this.root = root;
    this.changed = changed;
    /** @type {import('../page_messages.js').Values} */
    this.values = new Map();  // property → numbers that differ from the file's
    /** @type {Control[]} */
    this.controls = [];
  }

  /** Shows the controls of a picture. A change by hand stays while the file's value is the same.
   * @param {Control[]} controls */
  show(controls) {
    const before = new Map(this.controls.map((control) => [control.property, control.value.join()]));
    for (const { property, value } of controls) {
      if (before.get(property) !== value.join()) this.values.delete(property);
    }
    for (const property of [...this.values.keys()]) {
      if (!controls.some((control) => control.property === property)) this.values.delete(property);
    }
    this.controls = controls;
    this.root.replaceChildren();
    const groups = Map.groupBy(controls.filter((control) => !control.drawn && !control.placed && !control.type.startsWith('mat')), (control) => control.technique);
    for (const [technique, members] of groups) {
      this.root.append(make('h2', { textContent: technique || 'uniforms' }), ...members.map((control) => this.row(control)));
    }
  }

  numbers(control) { return this.values.get(control.property) ?? control.value; }

  row(control) {
    const row = make('div', { className: 'row', title: `${control.doc} (${control.name})` });
    row.dataset.property = control.property;
    const undo = make('button', { className: 'undo', textContent: '↺', title: 'the value of the file' });
    undo.addEventListener('click', () => { this.set(control, row, control.value); this.fill(control, row); });
    row.append(make('label', { textContent: control.label.replaceAll('_', ' ') }), this.inputs(control, row), undo);
    this.fill(control, row);
    return row;
  }

  inputs(control, row) {
    const box = make('span', { className: 'vector' });
    const read = () => this.set(control, row, this.read(control, row));
    if (control.type === 'bool') box.append(make('input', { type: 'checkbox', className: 'number', oninput: read }));
    else if (control.color) {
      box.append(make('input', { type: 'color', oninput: () => this.picked(control, row) }));
      for (let index = 3; index < control.value.length; index++) box.append(this.number(control, read));
    } else if (control.value.length === 1 && control.range) {
      const slider = make('input', { type: 'range', min: 0, max: 1000, step: 1 });
      slider.addEventListener('input', () => {
        row.querySelector('.number').value = shorter(this.ofSlider(control, Number(slider.value) / 1000));
        read();
      });
      box.append(slider, this.number(control, read));
    } else for (let index = 0; index < control.value.length; index++) box.append(this.number(control, read));
    if (control.unit && control.unit !== '1') box.append(make('span', { className: 'unit', textContent: control.unit }));
    return box;
  }

  number(control, read) {
    const [low, high] = control.range ?? ['', ''];
    const field = make('input', { type: 'number', className: control.value.length === 3 ? 'number of-three' : 'number', step: /int/.test(control.type) ? 1 : 'any', min: low, max: high, oninput: read });
    field.addEventListener('change', () => this.fill(control, field.closest('.row')));  // it then shows what is drawn
    return field;
  }

  ofSlider(control, share) {
    const [low, high] = control.range;
    const least = leastOf(control);
    const value = least ? (share === 0 ? low : least * (high / least) ** share) : low + (high - low) * share;
    return /int/.test(control.type) ? Math.round(value) : value;
  }

  toSlider(control, value) {
    const [low, high] = control.range;
    const least = leastOf(control);
    if (least) return value <= least ? 0 : Math.log(value / least) / Math.log(high / least);
    return (value - low) / (high - low);
  }

  read(control, row) {
    const now = this.numbers(control);
    const fields = [...row.querySelectorAll('.number')];
    const from = control.color ? 3 : 0;
    const result = [...now];
    fields.forEach((field, index) => {
      const number = field.type === 'checkbox' ? Number(field.checked) : Number(field.value);
      if (field.type === 'checkbox' || (field.value !== '' && Number.isFinite(number))) result[from + index] = this.within(control, number);
    });
    return result;
  }

  within(control, number) {
    if (!control.range) return number;
    return Math.min(Math.max(number, control.range[0]), control.range[1]);
  }

  picked(control, row) {
    const color = new THREE.Color(row.querySelector('input[type=color]').value);
    this.set(control, row, [color.r, color.g, color.b, ...this.numbers(control).slice(3)]);
  }

  /** The numbers of a control, as its inputs show them. */
  fill(control, row) {
    const numbers = this.numbers(control);
    row.classList.toggle('changed', this.values.has(control.property));
    const picker = row.querySelector('input[type=color]');
    if (picker) picker.value = `#${new THREE.Color(...numbers.slice(0, 3).map((number) => Math.min(Math.max(number, 0), 1))).getHexString()}`;
    row.querySelectorAll('.number').forEach((field, index) => {
      const number = numbers[(control.color ? 3 : 0) + index];
      if (field.type === 'checkbox') field.checked = number !== 0; else field.value = shorter(number);
    });
    const slider = row.querySelector('input[type=range]');
    if (slider) slider.value = 1000 * this.toSlider(control, numbers[0]);
  }

  set(control, row, numbers) {
    if (numbers.join() === control.value.join()) this.values.delete(control.property);
    else this.values.set(control.property, numbers);
    row.classList.toggle('changed', this.values.has(control.property));
    const slider = row.querySelector('input[type=range]');
    if (slider && document.activeElement !== slider) slider.value = 1000 * this.toSlider(control, numbers[0]);
    this.changed(control.property, numbers);
  }

  /** Gives up all changes by hand. */
  reset() {
    for (const control of this.controls.filter((one) => this.values.has(one.property))) {
      const row = this.root.querySelector(`[data-property="${control.property}"]`);
      this.set(control, row, control.value);
      this.fill(control, row);
    }
  }
}
