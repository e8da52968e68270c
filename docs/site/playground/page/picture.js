// The picture: the stage and the panel of the live preview, with static bodies, textures and scenes.

import { box, checkbox, list } from './preview/elements.js';
import { FlatStage } from './preview/flat_stage.js';
import { Panel } from './preview/panel.js';
import { PLAIN, Stage } from './preview/stage.js';

/** @typedef {import('./editor.js').Files} Files */
/** @typedef {{ flat?: import('../../../../src/sssgen/preview/page_messages.js').Flat, controls: import('../../../../src/sssgen/preview/page_messages.js').Control[],
 *   textures: import('../../../../src/sssgen/preview/page_messages.js').Slot[], texture_files: Files }} Head  What a picture has from the files alone. */
/** @typedef {{ head: any, texels: Record<string, import('../../../../src/sssgen/preview/page_messages.js').Texels>, values: object, in_scene: string[] }} Scene
 *   `head` is the rest of the picture. */
/** @typedef {{ name: string, title: string, main: string, files: Files, scenes: Record<string, Scene>, texture_files: Files,
 *   body_files: string[], head?: Head }} Start  An example; its scenes are by shape. A preset has its head: it is drawn without Python. */

const [shape, renderer, environment] = [list('shape'), list('renderer'), checkbox('environment')];
const OWN = 'its own';

export class Picture {
  /** `files()` are the files in the editor.
   * @param {import('./pieces.js').Pieces} pieces @param {() => Files} files */
  constructor(pieces, files) {
    this.pieces = pieces;
    this.files = files;
    /** @type {Start | null} */
    this.start = null;
    /** @type {import('./preview/pane.js').AnyStage | null} */
    this.stage = null;
    /** @type {Head | null} */
    this.head = null;
    /** @type {Map<string, any> | null} */
    this.linked = null;  // the values of a link
    /** @type {Promise<unknown>} */
    this.waiting = Promise.resolve();
    this.panel = new Panel(box('controls'), (property, numbers) => this.stage?.set(property, numbers));
    shape.addEventListener('change', () => this.next(() => this.draw()));
    environment.addEventListener('change', () => this.arrange());
    renderer.addEventListener('change', () => this.next(async () => { this.drop(); await this.draw(); }));
    this.ready = this.next(() => this.stageOf(renderer.value));
  }

  /** One picture after the other.
   * @param {() => unknown} work */
  next(work) {
    this.waiting = this.waiting.then(work, work);
    return this.waiting;
  }

  /** A stage of that renderer; where the browser has no WebGPU, its fallback.
   * @param {string} kind */
  async stageOf(kind) {
    if (this.stage || this.start && !this.scene()?.head.body) return;
    const gpu = kind === 'webgpu' && await navigator.gpu?.requestAdapter().catch(() => null);
    const chosen = kind === 'webgpu' && !gpu ? 'webgl2' : kind;
    renderer.value = chosen;
    const stage = new Stage(box('stage'), chosen, this.pieces.get);
    await stage.start();
    this.stage = stage;
    this.arrange();
  }

  /** Lights the body by its surroundings, or by the lamps alone. */
  arrange() { this.stage?.arrange({ ...PLAIN, light: { ...PLAIN.light, kind: environment.checked ? 'studio' : 'none' } }); }

  drop() {
    this.stage?.dispose();
    this.stage = null;
    box('stage').replaceChildren();
    box('stage').style.background = '';
  }

  /** Another start; `state` is that of a link.
   * @param {Start} start @param {{ shape: string, values?: object } | null} state */
  begin(start, state) {
    this.start = start;
    this.head = null;
    this.panel.show([]);
    this.linked = state?.values ? new Map(Object.entries(state.values)) : null;
    const shapes = Object.keys(start.scenes);
    shape.replaceChildren(...shapes.map((name) => new Option(name || OWN, name)));
    shape.value = state && shapes.includes(state.shape) ? state.shape : '';
    const body = this.scene()?.head.body;
    for (const id of ['shape-row', 'renderer-row', 'environment-row']) box(id).hidden = !body;
    if (body) this.pieces.body(body); else this.next(() => this.drop());
    this.note('');
  }

  scene() { return this.start?.scenes[shape.value]; }

  state() { return { shape: shape.value, values: Object.fromEntries(this.panel.values) }; }

  /** The picture of Python's answer; the last one stays where there is none.
   * @param {{ head?: Head, note?: string }} answer */
  async show(answer) {
    if (answer.head) this.head = answer.head;
    await this.next(() => this.draw());
    if (answer.note) this.note(answer.note);
  }

  async draw() {
    const { head } = this;
    if (!head) return;
    if (this.stage && (this.stage.kind === 'flat') !== Boolean(head.flat)) this.drop();
    if (head.flat) await this.drawFlat(head); else await this.drawBody(head);
  }

  /** A picture of one triangle: plain GLSL, or a material that makes its own rays.
   * @param {Head} head */
  async drawFlat(head) {
    const scene = this.scene();
    if (!this.stage) {
      const stage = new FlatStage(box('stage'), this.pieces.get);
      await stage.start();
      this.stage = stage;
    }
    const textures = head.textures.map((row) => ({ ...row, texels: scene?.texels[row.source_name] })).filter((row) => row.texels);
    this.showControls(head);
    await this.stage.show({ ...head, ...scene?.head, textures, flat: { ...head.flat, ...scene?.head.flat } }, this.panel.values);
    const missing = head.textures.filter((row) => !scene?.texels[row.source_name]);
    this.note(missing.map((row) => `The picture of ${row.source_name} is not on this page: it is black.`).join('\n'));
  }

  /** @param {Head} head */
  showControls(head) {
    box('parameters').hidden = Boolean(head.flat) && !head.controls.length;
    this.panel.show(head.controls);
    if (this.linked) this.useValues(this.linked);
  }

  /** @param {Head} head */
  async drawBody(head) {
    const [start, scene] = [this.start, this.scene()];
    if (!start || !scene) return;
    await this.stageOf(renderer.value);
    this.pieces.body(scene.head.body);
    const missing = [];
    const textures = head.textures.map((row) => {
      const own = head.texture_files[row.source_name] === start.texture_files[row.source_name];
      const texels = own ? scene.texels[row.source_name] : undefined;
      if (!own && !row.drawn) missing.push(row.source_name);
      return texels ? { ...row, texels } : row;
    });
    this.showControls(head);
    await this.stage?.show({ ...scene.head, ...head, textures }, this.panel.values);
    const files = this.files();
    const bodies = start.body_files.filter((name) => files[name] !== start.files[name]);
    this.note([
      ...missing.map((name) => `The picture of ${name} is not on this page: it is drawn with its default.`),
      ...bodies.map((name) => `The mesh is still that of the first ${name}; the shader's own lengths follow the edit.`),
    ].join('\n'));
  }

  /** The values that a link gives to the controls.
   * @param {Map<string, any>} linked */
  useValues(linked) {
    for (const control of this.panel.controls) {
      const numbers = linked.get(control.property);
      if (!Array.isArray(numbers) || numbers.length !== control.value.length || !numbers.every(Number.isFinite)) continue;
      this.panel.values.set(control.property, numbers);
    }
    this.linked = null;
    this.panel.show(this.panel.controls);
  }

  /** @param {string} text */
  note(text) {
    box('note').textContent = text;
    box('note').hidden = !text;
  }
}
