// A row of the panel: a parameter, or a key of the medium's look, with its inputs. Colours are linear in files and sRGB
// in pickers.

import * as THREE from 'three';
import { make } from './elements.js';

/** @typedef {{ property: string, key: string, label: string, name: string, doc: string, type: string, channels: string, color: boolean, unit: string,
 *   range: [number, number] | null, read(): number[], write(numbers: number[]): void, undo(): void, changed(): boolean }} Field
 *   What a row shows: `read` and `write` are its numbers, `undo` takes the file's. */

export const shorter = (/** @type {number} */ number, digits = 5) => String(Number(number.toPrecision(digits)));

/** The least value above 0 on the slider of a range over powers of ten, which is logarithmic; 0 on an even slider.
 * @param {[number, number]} range */
function leastOf([low, high]) {
  if (low === 0 && high > 1) return 0.0001 * high;
  return low > 0 && high / low > 500 ? low : 0;
}

export class ControlRow {
  /** @param {Field} field */
  constructor(field) {
    this.field = field;
    /** @type {HTMLInputElement[]} */
    this.numbers = [];
    /** @type {HTMLInputElement | null} */
    this.picker = null;
    /** @type {HTMLInputElement | null} */
    this.slider = null;
    this.undo = make('button', { className: 'undo', textContent: '↺', title: 'the value of the file' });
    this.undo.addEventListener('click', () => { field.undo(); this.fill(); });
    this.unit = field.unit && field.unit !== '1' ? [make('span', { className: 'unit', textContent: field.unit })] : [];
    this.several = field.read().length > 1;
    const label = make('label', { textContent: field.label }, ...(this.several ? [' ', ...this.unit] : []));
    this.root = make('div', { className: 'row', title: `${field.doc} (${field.name})` }, label, this.inputs(), this.undo);
    this.root.dataset.property = field.property;
    this.root.dataset.key = field.key;
    this.fill();
  }

  inputs() {
    const { field } = this;
    const box = make('span', { className: 'vector' });
    const count = field.read().length;
    if (field.type === 'bool') box.append(this.number('', { type: 'checkbox' }));
    else if (this.several) {
      if (field.color) {
        this.picker = make('input', { type: 'color', title: 'sRGB; the numbers beside it are linear', oninput: () => this.picked() });
        box.append(this.picker);
      }
      for (let index = 0; index < count; index++) box.append(this.channel(field.channels[index] ?? ''));
    } else {
      if (field.range) {
        this.slider = make('input', { type: 'range', min: 0, max: 1000, step: 1, oninput: () => this.slid() });
        box.append(this.slider);
      }
      box.append(this.number(''));
    }
    if (!this.several) box.append(...this.unit);
    return box;
  }

  /** A number with the name of its channel.
   * @param {string} name */
  channel(name) {
    const label = make('span', { className: 'channel' }, make('span', { textContent: name }), this.number(name));
    label.dataset.channel = name;
    return label;
  }

  /** @param {string} name @param {object} [properties] */
  number(name, properties = {}) {
    const { field } = this;
    const [low, high] = field.range ?? ['', ''];
    const input = make('input', { type: 'number', className: 'number', step: /int/.test(field.type) ? 1 : 'any', min: low, max: high, ...properties });
    input.setAttribute('aria-label', name ? `${field.label}, ${name}` : field.label);
    const index = this.numbers.length;
    input.addEventListener('input', () => this.typed(index));
    input.addEventListener('change', () => this.fill());  // it then shows what is drawn
    this.numbers.push(input);
    return input;
  }

  /** Takes the number of one input; the others are rounded where they are shown.
   * @param {number} index */
  typed(index) {
    const [numbers, input] = [this.field.read(), this.numbers[index]];
    const number = input.type === 'checkbox' ? Number(input.checked) : Number(input.value);
    if (input.type === 'number' && (input.value === '' || !Number.isFinite(number))) return;
    numbers[index] = this.within(number);
    this.field.write(numbers);
    this.mark();
  }

  /** @param {number} number */
  within(number) {
    const { range } = this.field;
    return range ? Math.min(Math.max(number, range[0]), range[1]) : number;
  }

  picked() {
    const { r, g, b } = new THREE.Color(this.picker?.value);
    this.field.write([r, g, b, ...this.field.read().slice(3)]);
    this.fill();
  }

  slid() {
    this.field.write([this.ofSlider(Number(this.slider?.value) / 1000)]);
    this.fill();
  }

  /** @param {number} share */
  ofSlider(share) {
    const range = this.field.range ?? [0, 1];
    const [low, high] = range;
    const least = leastOf(range);
    const value = least ? (share === 0 ? low : least * (high / least) ** share) : low + (high - low) * share;
    return /int/.test(this.field.type) ? Math.round(value) : value;
  }

  /** @param {number} value */
  toSlider(value) {
    const range = this.field.range ?? [0, 1];
    const [low, high] = range;
    const least = leastOf(range);
    if (least) return value <= least ? 0 : Math.log(value / least) / Math.log(high / least);
    return (value - low) / (high - low);
  }

  /** Shows the numbers in the inputs. */
  fill() {
    const numbers = this.field.read();
    this.numbers.forEach((input, index) => {
      if (input.type === 'checkbox') input.checked = numbers[index] !== 0; else input.value = shorter(numbers[index], this.several ? 3 : 5);
    });
    this.mark();
  }

  /** Shows the numbers in the picker and the slider, and whether they differ from the file's. */
  mark() {
    const numbers = this.field.read();
    this.root.classList.toggle('changed', this.field.changed());
    const [red, green, blue] = numbers.map((number) => Math.min(Math.max(number, 0), 1));
    if (this.picker) this.picker.value = `#${new THREE.Color(red, green, blue).getHexString()}`;
    if (this.slider && document.activeElement !== this.slider) this.slider.value = String(1000 * this.toSlider(numbers[0]));
  }
}
