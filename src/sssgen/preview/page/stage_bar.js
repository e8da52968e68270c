// The bar below the picture: surroundings, ground, lamps, turntable, views, and what is saved of them as pictures and films.

import { onChoice, refusal, suffixOf } from './chosen_files.js';
import { make } from './elements.js';
import { filmSheet, pictureSheet } from './export_sheets.js';
import { showLamps } from './lamp_list.js';
import { largestSide } from './offscreen.js';
import { barButton, choice, opens, row, slider, tick } from './sheets.js';
import { PLAIN } from './stage.js';
import { PANORAMAS, panoramaOf } from './surroundings.js';
import { VIEWS } from './views.js';

/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {{ stages: () => Stage[], shown: () => Stage | null, say: (text: string) => void, save: (lights: import('../page_messages.js').Light[]) => void }} Page
 *   The stages with a body; the one whose controls are shown; `save` writes lamps into the scene. */

const KINDS = { none: 'the scene', studio: 'studio', sky: 'clear sky', file: 'file…' };
const LARGEST = 256 << 20;  // bytes of a panorama

/** The bar, and the settings of all stages. */
export class StageBar {
  /** @param {HTMLElement} root @param {Page} page */
  constructor(root, page) {
    this.root = root;
    this.page = page;
    /** @type {import('./stage.js').Settings} */
    this.settings = { ...PLAIN, light: { ...PLAIN.light } };
    this.sceneLit = false;  // by surroundings of its own
    this.turning = 0;  // the frame that was requested
    this.speed = 6;  // turns in a minute
    this.lampSheet = make('div');
    this.kind = choice(KINDS, 'surroundings');
    this.file = make('p', { className: 'note', hidden: true });
    const name = () => page.shown()?.picture?.name ?? 'picture';
    const tools = this.tools = {
      surroundings: barButton('surroundings', 'Surroundings', 'The light from all around: a studio, a sky, or your own .hdr or .exr'),
      ground: barButton('ground', 'Ground', 'A ground with the shadow of the body'),
      lamps: barButton('lamps', 'Lamps', 'Add, remove and colour lamps; drag them in the picture'),
      turntable: barButton('turntable', 'Turntable', 'Let the body turn'),
      view: barButton('view', 'View', 'Where the eye is, and how fast the body turns'),
      picture: barButton('picture', 'Picture', 'Save a picture of any size'),
      film: barButton('film', 'Film', 'Save a turn of the body as a film'),
    };
    const gap = () => make('span', { className: 'gap' });
    const sheets = [this.surroundingsSheet(), this.lampSheet, this.viewSheet(), pictureSheet(page.shown, name), filmSheet(page.shown, name)];
    root.replaceChildren(tools.surroundings, tools.ground, tools.lamps, gap(), tools.turntable, tools.view, gap(), tools.picture, tools.film, ...sheets);
    [tools.surroundings, tools.lamps, tools.view, tools.picture, tools.film].forEach((button, index) => {
      opens(button, sheets[index], button === tools.lamps ? (open) => this.openLamps(open) : undefined);
    });
    tools.ground.addEventListener('click', () => this.change({ ground: !this.settings.ground }));
    tools.turntable.addEventListener('click', () => this.turntable(!this.turning));
    this.press();
  }

  /** After each picture: the bar of this stage.
   * @param {Stage | null} stage */
  show(stage) {
    this.root.hidden = !stage;
    if (!stage) return;
    stage.lamps.moved = () => this.lit(stage);
    this.sceneLit = Boolean(stage.sceneLight);
    this.press();
    this.listLamps(stage);
  }

  /** @param {Stage} stage */
  listLamps(stage) {
    if (!this.lampSheet.matches(':popover-open')) return;
    showLamps(this.lampSheet, stage, () => this.lit(stage), this.page.save);
  }

  /** @param {boolean} open */
  openLamps(open) {
    const stage = this.page.shown();
    this.change({ lampsShown: open });
    if (open && stage) this.listLamps(stage);
  }

  /** The lamps of a stage have changed: those of the stages beside it follow.
   * @param {Stage} stage */
  lit(stage) {
    for (const other of this.page.stages()) {
      if (other !== stage) other.lamps.follow(stage.lamps);
      other.ask();
    }
  }

  /** @param {Partial<import('./stage.js').Settings>} settings */
  change(settings) {
    Object.assign(this.settings, settings);
    for (const stage of this.page.stages()) stage.arrange(this.settings);
    this.press();
  }

  /** @param {Partial<import('./surroundings.js').Light>} light */
  light(light) { this.change({ light: { ...this.settings.light, ...light } }); }

  /** Shows what is on. */
  press() {
    const { tools, settings } = this;
    tools.surroundings.classList.toggle('on', settings.light.kind !== 'none');
    for (const [tool, on] of /** @type {const} */ ([[tools.ground, settings.ground], [tools.turntable, Boolean(this.turning)]])) tool.setAttribute('aria-pressed', String(on));
    this.sliders?.classList.toggle('unused', settings.light.kind === 'none' && !this.sceneLit);
  }

  surroundingsSheet() {
    const { light } = this.settings;
    const kind = this.kind;
    const open = make('button', { textContent: 'Open…', title: 'A panorama as .hdr or .exr; or drop it on the page' });
    kind.addEventListener('change', () => {
      if (kind.value !== 'file' || this.settings.light.panorama) this.light({ kind: kind.value });
      else { kind.value = this.settings.light.kind; open.click(); }
    });
    this.sliders = make('div', {},
      slider({ label: 'Strength', min: 0, max: 3, step: 0.01, value: light.strength, id: 'surroundings-strength' }, (strength) => this.light({ strength })),
      slider({ label: 'Turned', min: -180, max: 180, step: 1, value: light.turn, unit: '°', id: 'surroundings-turn' }, (turn) => this.light({ turn })),
      tick('Background', light.background, (background) => this.light({ background }), 'surroundings-background'),
      slider({ label: 'Blur', min: 0, max: 1, step: 0.01, value: light.blur, id: 'surroundings-blur' }, (blur) => this.light({ blur })));
    const sheet = make('div', {}, row('Light from', kind, open), this.file, this.sliders);
    onChoice(open, PANORAMAS, (file) => this.useFile(file));
    return sheet;
  }

  /** Takes a panorama. It stays on this page.
   * @param {File} file */
  async useFile(file) {
    const stage = this.page.shown();
    const reason = refusal(file, PANORAMAS, LARGEST);
    if (reason || !stage) { this.page.say(reason); return; }
    try {
      const panorama = await panoramaOf(file, largestSide(stage.renderer) * 2);
      this.settings.light.panorama?.dispose();
      this.light({ kind: 'file', panorama });
      this.kind.value = 'file';
      this.file.hidden = false;
      this.file.textContent = file.name;
      this.page.say('');
    } catch (error) {
      this.page.say(`${file.name} cannot be read as a panorama: ${error.message ?? error}`);
    }
  }

  /** Whether a file is one of a panorama, by its name. @param {File} file */
  takes(file) { return PANORAMAS.includes(suffixOf(file)); }

  viewSheet() {
    const buttons = Object.entries(VIEWS).map(([name, { label, title, look }]) => {
      const button = make('button', { textContent: label, title, id: `view-${name}` });
      button.addEventListener('click', () => {
        if (name === 'scene') this.turntable(false);
        for (const stage of this.page.stages()) look(stage);
        const shown = this.page.shown();
        if (shown) this.listLamps(shown);
      });
      return button;
    });
    return make('div', {}, make('div', { className: 'row buttons' }, ...buttons),
      slider({ label: 'Turntable', min: -30, max: 30, step: 1, value: this.speed, unit: ' /min', id: 'turntable-speed' }, (speed) => { this.speed = speed; }));
  }

  /** @param {boolean} on */
  turntable(on) {
    cancelAnimationFrame(this.turning);
    this.turning = 0;
    if (on) {
      let last = performance.now();
      const turn = (/** @type {number} */ now) => {
        const angle = (now - last) / 60e3 * this.speed * 2 * Math.PI;
        last = now;
        for (const stage of this.page.stages()) if (!stage.drafts.held) { stage.turn(stage.angle + angle); stage.ask(); }
        this.turning = requestAnimationFrame(turn);
      };
      this.turning = requestAnimationFrame(turn);
    }
    this.press();
  }
}
