// One picture of the page with its controls: what the server sends is drawn, changes by hand are kept.

import { make } from './elements.js';
import { FlatStage } from './flat_stage.js';
import { Panel } from './panel.js';
import { Stage } from './stage.js';
import { TextureSlots } from './texture_slots.js';

/** @typedef {import('../page_messages.js').Picture} Picture */
/** @typedef {import('../page_messages.js').Slot} Slot */
/** @typedef {{ pieceOf: import('../page_messages.js').PieceOf, say: (text: string) => void, looked: (pane: Pane) => void,
 *   changed: (pane: Pane, property: string, numbers: number[]) => void, texture: (pane: Pane, row: Slot, file: File | null) => void,
 *   settings: () => { renderer: string, arranged: import('./stage.js').Settings }, fallback: (renderer: string) => void }} Page
 *   What a pane asks of the page. */
/** @typedef {{ kind: string, start(): Promise<void>, show(picture: Picture, values: import('../page_messages.js').Values): Promise<void>,
 *   set(property: string, numbers: number[]): void, arrange(settings: import('./stage.js').Settings): void, ask(): void, dispose(): void,
 *   orbit?: Stage['orbit'], camera?: Stage['camera'] }} AnyStage  What both kinds of stages have. */

/** A picture, with its controls and its texture slots. */
export class Pane {
  /** @param {Page} page @param {number} number */
  constructor(page, number) {
    this.page = page;
    this.number = number;
    /** @type {AnyStage | null} */
    this.stage = null;
    /** @type {import('../page_messages.js').PictureMessage | null} */
    this.last = null;
    this.complaint = '';
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
    const texels = [this.picture?.environment, ...(this.picture?.textures ?? []).map((texture) => texture.texels)];
    return [this.picture?.body, ...texels.flatMap((one) => one?.levels.map((level) => level.data) ?? [])];
  }

  /** Shows a message; returns why it cannot be drawn, or ''.
   * @param {import('../page_messages.js').PictureMessage} message @param {import('../page_messages.js').Values} [values] */
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
      this.root.dataset.version = String(message.version);
      return '';
    } catch (reason) {
      return reason.message;
    } finally {
      this.busy = false;
    }
  }

  /** Starts a stage before there is a picture: a browser takes long for its first one. */
  async prepare() {
    this.stage ??= await this.stageFor({ flat: undefined }, this.page.settings().renderer);
  }

  /** A stage with the chosen renderer; without WebGPU that of WebGL 2, which is said.
   * @param {Pick<Picture, 'flat'>} picture @param {string} kind  of `rendererOf`
   * @returns {Promise<AnyStage>} */
  async stageFor(picture, kind) {
    const { pieceOf, say, settings, fallback } = this.page;
    /** @type {AnyStage} */
    const next = picture.flat ? new FlatStage(this.place, pieceOf) : new Stage(this.place, kind, pieceOf);
    try {
      await next.start();
      next.arrange(settings().arranged);
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

  /** Looks as another pane does.
   * @param {AnyStage | null} [other] */
  follow(other) {
    const [own, seen] = [this.stage, other];
    if (!own?.orbit || !own.camera || !seen?.orbit || !seen.camera) return;
    if (own.camera.position.equals(seen.camera.position) && own.orbit.target.equals(seen.orbit.target)) return;
    own.camera.position.copy(seen.camera.position);
    own.orbit.target.copy(seen.orbit.target);
    own.orbit.update();
    own.ask();
  }

  stop() {
    this.stage?.dispose();
    this.stage = null;
  }
}
