// One picture of the page with its controls: what the server sends is drawn, changes by hand are kept.

import { FlatStage } from './flat_stage.js';
import { Panel } from './panel.js';
import { Stage } from './stage.js';
import { TextureSlots } from './texture_slots.js';

const make = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};

/** `page` has: pieceOf(digest), say(text), changed(pane, property, numbers), looked(pane), texture(pane, row, file), settings. */
export class Pane {
  constructor(page, number) {
    Object.assign(this, { page, number, stage: null, last: null });
    this.root = make('div', { className: 'pane' });
    this.caption = make('div', { className: 'caption' });
    this.place = make('div', { className: 'place' });
    this.root.append(this.place, this.caption);
    this.controls = make('div');
    this.textures = make('div');
    this.panel = new Panel(this.controls, (property, numbers) => page.changed(this, property, numbers));
    this.slots = new TextureSlots(this.textures, page.pieceOf, (row, file) => page.texture(this, row, file), page.say);
  }

  get picture() { return this.last?.picture; }

  /** Whether something was changed by hand and is in no file. */
  get changed() { return this.panel.values.size > 0 || Boolean(this.picture?.textures.some((row) => row.chosen)); }

  /** The digests that the picture needs. */
  get named() {
    const textures = this.picture?.textures ?? [];
    return [this.picture?.body, ...textures.flatMap((texture) => texture.texels?.levels.map((level) => level.data) ?? [])];
  }

  /** Shows a message; returns why it cannot be drawn, or ''. */
  async show(message, values) {
    const { picture } = message;
    const same = this.stage && this.root.dataset.version === String(message.version) && this.last?.beside === message.beside;
    this.last = message;
    if (same && message.error) return '';  // the last good picture stays as it is
    this.caption.textContent = message.label;
    this.place.hidden = Boolean(picture.missing);
    this.panel.show(picture.controls);
    this.slots.show(picture.textures, message.limit);
    try {
      if (this.stage && (this.stage.kind === 'flat') !== Boolean(picture.flat)) this.stop();
      this.stage ??= await this.stageFor(picture, this.page.settings().renderer);
      this.busy = true;
      await this.stage.show(picture, values ?? this.panel.values);
      this.root.dataset.version = message.version;
      return '';
    } catch (reason) {
      return reason.message;
    } finally {
      this.busy = false;
    }
  }

  /** A stage with the chosen renderer; without WebGPU that of WebGL 2, which is said. */
  async stageFor(picture, kind) {
    const { pieceOf, say, settings, fallback } = this.page;
    const next = picture.flat ? new FlatStage(this.place, pieceOf) : new Stage(this.place, kind, pieceOf);
    try {
      await next.start();
      next.environment(settings().environment);
      next.orbit?.addEventListener('change', () => { if (!this.busy) this.page.looked(this); });
      return next;
    } catch (error) {
      next.dispose();
      if (picture.flat || kind !== 'webgpu') throw error;
      say(`WebGPU is not available here (${error.message}): this is its WebGL 2 fallback.`);
      fallback('webgl2');
      return this.stageFor(picture, 'webgl2');
    }
  }

  /** Looks as another pane does. */
  follow({ camera, orbit }) {
    if (!orbit || !this.stage?.orbit || this.stage.camera.position.equals(camera.position) && this.stage.orbit.target.equals(orbit.target)) return;
    this.stage.camera.position.copy(camera.position);
    this.stage.orbit.target.copy(orbit.target);
    this.stage.orbit.update();
    this.stage.ask();
  }

  stop() {
    this.stage?.dispose();
    this.stage = null;
  }
}
