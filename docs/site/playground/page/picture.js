// The picture: the stage and the panel of the live preview, with static bodies, textures and scenes.

import { FlatStage } from './preview/flat_stage.js';
import { Panel } from './preview/panel.js';
import { Stage } from './preview/stage.js';

const element = (id) => document.getElementById(id);
const OWN = 'its own';

export class Picture {
  constructor(pieces, say) {
    Object.assign(this, { pieces, say, start: null, stage: null, head: null, waiting: Promise.resolve() });
    this.panel = new Panel(element('controls'), (property, numbers) => this.stage?.set(property, numbers));
    element('shape').addEventListener('change', () => this.next(() => this.draw()));
    element('environment').addEventListener('change', () => this.stage?.environment(element('environment').checked));
    element('renderer').addEventListener('change', () => this.next(async () => { this.drop(); await this.draw(); }));
    this.ready = this.next(() => this.stageOf(element('renderer').value));
  }

  /** One picture after the other. */
  next(work) {
    this.waiting = this.waiting.then(work, work);
    return this.waiting;
  }

  /** A stage of that renderer; where the browser has no WebGPU, its fallback. */
  async stageOf(kind) {
    if (this.stage || this.start && !this.scene()?.head.body) return;
    const gpu = kind === 'webgpu' && await navigator.gpu?.requestAdapter().catch(() => null);
    const chosen = kind === 'webgpu' && !gpu ? 'webgl2' : kind;
    element('renderer').value = chosen;
    const stage = new Stage(element('stage'), chosen, this.pieces.get);
    await stage.start();
    this.stage = stage;
  }

  drop() {
    this.stage?.dispose();
    this.stage = null;
    element('stage').replaceChildren();
    element('stage').style.background = '';
  }

  /** Another start; `state` is that of a link. */
  begin(start, state) {
    this.start = start;
    this.head = null;
    this.panel.show([]);
    this.linked = state?.values ? new Map(Object.entries(state.values)) : null;
    const shapes = Object.keys(start.scenes);
    element('shape').replaceChildren(...shapes.map((shape) => new Option(shape || OWN, shape)));
    element('shape').value = shapes.includes(state?.shape) ? state.shape : '';
    const body = this.scene()?.head.body;
    for (const id of ['shape-row', 'renderer-row', 'environment-row']) element(id).hidden = !body;
    if (body) this.pieces.body(body); else this.next(() => this.drop());
    this.note('');
  }

  scene() { return this.start?.scenes[element('shape').value]; }

  state() { return { shape: element('shape').value, values: Object.fromEntries(this.panel.values) }; }

  /** The picture of Python's answer; the last one stays where there is none. */
  async show(answer) {
    if (answer.head) this.head = answer.head;
    await this.next(() => this.draw());
    if (answer.note) this.note(answer.note);
  }

  async draw() {
    const { head } = this;
    if (!head) return;
    if (this.stage && (this.stage.kind === 'flat') !== Boolean(head.flat)) this.drop();
    if (head.flat) await this.drawFlat(); else await this.drawBody();
  }

  /** A picture of one triangle: plain GLSL, or a material that makes its own rays. */
  async drawFlat() {
    const scene = this.scene();
    if (!this.stage) {
      const stage = new FlatStage(element('stage'), this.pieces.get);
      await stage.start();
      this.stage = stage;
    }
    const textures = this.head.textures.map((row) => ({ ...row, texels: scene?.texels[row.source_name] })).filter((row) => row.texels);
    this.showControls();
    await this.stage.show({ ...this.head, ...scene?.head, textures, flat: { ...this.head.flat, ...scene?.head.flat } }, this.panel.values);
    const missing = this.head.textures.filter((row) => !scene?.texels[row.source_name]);
    this.note(missing.map((row) => `The picture of ${row.source_name} is not on this page: it is black.`).join('\n'));
  }

  showControls() {
    document.querySelector('aside').hidden = Boolean(this.head.flat) && !this.head.controls.length;
    this.panel.show(this.head.controls);
    if (this.linked) this.valuesOfLink();
  }

  async drawBody() {
    const scene = this.scene();
    await this.stageOf(element('renderer').value);
    this.pieces.body(scene.head.body);
    const missing = [];
    const textures = this.head.textures.map((row) => {
      const own = this.head.texture_files[row.source_name] === this.start.texture_files[row.source_name];
      const texels = own ? scene.texels[row.source_name] : undefined;
      if (!own && !row.drawn) missing.push(row.source_name);
      return texels ? { ...row, texels } : row;
    });
    this.showControls();
    await this.stage.show({ ...scene.head, ...this.head, textures }, this.panel.values);
    const bodies = this.start.body_files.filter((name) => globalThis.playground.editor.files[name] !== this.start.files[name]);
    this.note([
      ...missing.map((name) => `The picture of ${name} is not on this page: it is drawn with its default.`),
      ...bodies.map((name) => `The mesh is still that of the first ${name}; the shader's own lengths follow the edit.`),
    ].join('\n'));
  }

  /** The values that a link gives to the controls. */
  valuesOfLink() {
    for (const control of this.panel.controls) {
      const numbers = this.linked.get(control.property);
      if (!Array.isArray(numbers) || numbers.length !== control.value.length || !numbers.every(Number.isFinite)) continue;
      this.panel.values.set(control.property, numbers);
    }
    this.linked = null;
    this.panel.show(this.panel.controls);
  }

  note(text) {
    element('note').textContent = text;
    element('note').hidden = !text;
  }
}
