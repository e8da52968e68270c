// The controls of a material's parameters, grouped by technique. A medium is shown as an artist or as a physicist has it.

import { ControlRow, shorter } from './control_row.js';
import { make } from './elements.js';
import { DEPTHS, albedoOf, coefficients, colorOf, depthOf, inverse, meanFreePath } from './medium_look.js';

/** @typedef {import('../page_messages.js').Control} Control */
/** @typedef {import('./control_row.js').Field} Field */

const MODES = { artist: 'Artist', physical: 'Physical' };

/** The panel: `changed(property, numbers)` is called for each change by hand. */
export class Panel {
  /** @param {HTMLElement} root @param {(property: string, numbers: number[]) => void} changed */
  constructor(root, changed) {
    this.root = root;
    this.changed = changed;
    this.mode = 'artist';  // of MODES
    /** @type {import('../page_messages.js').Values} */
    this.values = new Map();  // property → numbers that differ from the file's
    /** @type {import('../page_messages.js').Values} */
    this.look = new Map();  // property → numbers of the look that it follows from
    /** @type {Control[]} */
    this.controls = [];
    /** @type {ControlRow[]} */
    this.rows = [];
    /** @type {(() => void)[]} */
    this.refills = [];  // of what follows from the numbers
  }

  /** Shows the controls of a picture. A change by hand stays while the file's value is the same.
   * @param {Control[]} controls */
  show(controls) {
    const before = new Map(this.controls.map((control) => [control.property, control.value.join()]));
    const same = (/** @type {string} */ property) => controls.some((one) => one.property === property && before.get(property) === one.value.join());
    for (const property of [...this.values.keys()]) if (before.has(property) && !same(property)) this.forget(property);
    for (const property of [...this.values.keys()]) if (!controls.some((one) => one.property === property)) this.forget(property);
    this.controls = controls;
    this.draw();
  }

  /** @param {string} property */
  forget(property) { this.values.delete(property); this.look.delete(property); }

  draw() {
    this.rows = [];
    this.refills = [];
    this.root.replaceChildren();
    const shown = this.controls.filter((control) => !control.drawn && !control.placed && !control.type.startsWith('mat'));
    if (shown.some((control) => this.isMedium(control))) this.root.append(this.modes());
    for (const [technique, members] of Map.groupBy(shown, (control) => control.technique)) {
      const fields = this.ordered(members.filter((control) => !this.isHidden(control))).map((control) => this.field(control));
      const rows = fields.map((field) => new ControlRow(field));
      this.rows.push(...rows);
      this.root.append(make('h2', { textContent: technique ? technique.replaceAll('_', ' ') : 'uniforms' }), ...rows.map((row) => row.root));
      if (this.mode === 'physical') this.root.append(...this.derived(members));
    }
  }

  /** The parameters of a technique, its look first: colour, then depth.
   * @param {Control[]} members */
  ordered(members) {
    const rank = (/** @type {Control} */ control) => (this.mode === 'artist' && this.isMedium(control) ? ['color', 'depth'].indexOf(control.look) : 2);
    return members.toSorted((one, other) => rank(one) - rank(other));
  }

  /** The switch between both ways to give a medium. */
  modes() {
    const buttons = Object.entries(MODES).map(([mode, text]) => {
      const button = make('button', { textContent: text, title: mode === 'artist' ? 'Colour and depth' : 'Albedo and extinction, with σa and σs' });
      button.setAttribute('aria-pressed', String(mode === this.mode));
      button.dataset.mode = mode;
      button.addEventListener('click', () => { this.mode = mode; this.draw(); });
      return button;
    });
    return make('div', { className: 'row modes' }, make('label', { textContent: 'Medium as' }), make('span', { className: 'switch' }, ...buttons));
  }

  /** Whether a parameter has a key of the look in its place. @param {Control} control */
  isMedium(control) { return Boolean(control.look) && control.value.length === 3; }

  /** Whether a parameter follows from the look of another one that is shown. @param {Control} control */
  isHidden(control) { return this.mode === 'artist' && Boolean(control.look) && !this.isMedium(control) && Boolean(this.mediumOf(control)); }

  /** The parameter that a mean free path follows from. @param {Control} control */
  mediumOf(control) {
    return this.controls.find((one) => one.technique === control.technique && one.look === control.look && this.isMedium(one));
  }

  /** @param {Control} control */
  numbers(control) { return [...this.values.get(control.property) ?? control.value]; }

  /** @param {Control} control @returns {Field} */
  field(control) {
    const { property, type, doc, name, channels, color, range, unit } = control;
    if (this.mode === 'artist' && this.isMedium(control)) return this.lookField(control);
    return {
      property, key: name, name, doc, type, channels, color, range, unit: unit ?? '', label: control.label.replaceAll('_', ' '),
      read: () => this.numbers(control),
      write: (numbers) => { this.look.delete(property); this.set(control, numbers); },
      undo: () => this.set(control, control.value),
      changed: () => this.values.has(property),
    };
  }

  /** The colour in place of an albedo, or the depth in place of an extinction.
   * @param {Control} control @returns {Field} */
  lookField(control) {
    const { property, type, look } = control;
    const isColor = look === 'color';
    const [of, to] = isColor ? [colorOf, albedoOf] : [depthOf, inverse];
    const followers = this.controls.filter((one) => one.technique === control.technique && one.look === look && !this.isMedium(one));
    return {
      property, key: look, label: look, name: look, type, channels: 'RGB', color: isColor, unit: isColor ? '1' : 'm',
      doc: isColor ? 'What a thick body reflects of diffuse light' : 'How deep light reaches: the mean free path, per channel, in world units',
      range: isColor ? [0, 1] : /** @type {[number, number]} */ (DEPTHS),
      read: () => [...this.look.get(property) ?? this.numbers(control).map(of)],
      write: (numbers) => {
        for (const one of [control, ...followers]) this.look.set(one.property, numbers);
        this.set(control, numbers.map(to));
        for (const one of followers) this.set(one, [meanFreePath(numbers)]);
      },
      undo: () => { for (const one of [control, ...followers]) this.set(one, one.value); },
      changed: () => this.values.has(property),
    };
  }

  /** The coefficients of the medium, where a technique has its albedo and its extinction.
   * @param {Control[]} members */
  derived(members) {
    const [albedo, extinction] = ['color', 'depth'].map((look) => members.find((one) => one.look === look && this.isMedium(one)));
    if (!albedo || !extinction) return [];
    const box = make('div', { className: 'derived' });
    const fill = () => {
      const { absorption, scattering } = coefficients(this.numbers(extinction), this.numbers(albedo));
      const row = (/** @type {string} */ name, /** @type {number[]} */ numbers) => make('tr', {}, make('th', { textContent: name }), ...numbers.map((one) => make('td', { textContent: shorter(one) })), make('td', { className: 'unit', textContent: extinction.unit }));
      box.replaceChildren(make('table', {}, row('absorption σa', absorption), row('scattering σs', scattering)));
    };
    fill();
    this.refills.push(fill);
    return [box];
  }

  /** Sets numbers; the file's are no change.
   * @param {Control} control @param {number[]} numbers */
  set(control, numbers) {
    if (numbers.join() === control.value.join()) this.forget(control.property);
    else this.values.set(control.property, numbers);
    for (const refill of this.refills) refill();
    this.changed(control.property, numbers);
  }

  /** Sets parameters by their names in techniques, as a medium gives them; returns whether the material has any.
   * @param {Record<string, number | number[]>} parameters */
  use(parameters) {
    const given = this.controls.filter((control) => control.name in parameters && !control.drawn);
    for (const control of given) {
      const numbers = [parameters[control.name]].flat();
      const [low, high] = control.range ?? [-Infinity, Infinity];
      if (numbers.length !== control.value.length) continue;
      this.look.delete(control.property);
      this.set(control, numbers.map((number) => Math.min(Math.max(number, low), high)));
    }
    this.fill();
    return given.length > 0;
  }

  fill() { for (const row of this.rows) row.fill(); }

  /** Gives up all changes by hand. */
  reset() {
    for (const control of this.controls.filter((one) => this.values.has(one.property))) this.set(control, control.value);
    this.fill();
  }
}
