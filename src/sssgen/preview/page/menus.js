// The menus that change the material: presets, media, and the techniques of the chain.

import { ChoiceGrid } from './choice_grid.js';
import { dialogOf } from './dialog.js';
import { make } from './elements.js';

/** @typedef {import('./choice_grid.js').Choice} Choice */
/** @typedef {import('../page_messages.js').TechniqueRow} TechniqueRow */
/** @typedef {import('../page_messages.js').StageRow} StageRow */
/** @typedef {{ ask: (question: object) => void, edit: (change: object) => void, use: (parameters: Record<string, number | number[]>, name: string) => void }} MenuPage
 *   What the menus ask of the page: a question to Python, a change of the file, values for the controls. */

export class Menus {
  /** @param {MenuPage} page */
  constructor(page) {
    this.page = page;
    /** @type {StageRow | null} */
    this.replaced = null;  // the stage whose technique is to be replaced; null for a new one
    this.presets = this.presetDialog();
    this.media = this.mediaDialog();
    this.techniques = this.techniqueDialog();
  }

  presetDialog() {
    const grid = make('div');
    this.presetGrid = new ChoiceGrid(grid, (preset) => {
      this.preset = preset;
      about.textContent = preset.doc;
      size.value = String(preset.size_mm);
      apply.disabled = false;
    });
    this.quality = make('select', { id: 'preset-quality' });
    const size = make('input', { type: 'number', min: 0.001, step: 'any', id: 'preset-size' });
    const about = make('p', { className: 'about', textContent: 'A ready material takes the place of the chain: its thickness, its light inside, its colour. Other stages of the surface, such as a normal map, stay.' });
    const apply = make('button', { className: 'main', textContent: 'Use it', id: 'use-preset', disabled: true });
    apply.addEventListener('click', () => {
      this.presets.close();
      this.page.edit({ action: 'preset', preset: this.preset?.name, quality: this.quality?.value, size_mm: Number(size.value) || 0 });
    });
    const settings = make('div', { className: 'settings' }, make('label', {}, 'Quality ', this.quality), make('label', {}, 'The body is ', size, ' mm large'), apply);
    return dialogOf('presets', 'Presets', grid, make('footer', {}, about, settings));
  }

  mediaDialog() {
    const grid = make('div');
    this.mediaGrid = new ChoiceGrid(grid, (medium) => {
      this.medium = medium;
      about.textContent = `${medium.doc} Mean free path ${Number((medium.depth_mm ?? 0).toPrecision(3))} mm.`;
      apply.disabled = false;
    });
    const unit = make('input', { type: 'number', min: 0.001, step: 'any', value: '10', id: 'unit-mm' });
    const about = make('p', { className: 'about', textContent: 'A measured medium sets the albedo, the extinction and the mean free path. Save then writes them.' });
    const apply = make('button', { className: 'main', textContent: 'Use it', id: 'use-medium', disabled: true });
    apply.addEventListener('click', () => {
      this.media.close();
      this.page.ask({ kind: 'medium', name: this.medium?.name, unit_mm: Number(unit.value) || 10 });
    });
    return dialogOf('media', 'Media', grid, make('footer', {}, about, make('div', { className: 'settings' }, make('label', {}, 'A world unit is ', unit, ' mm'), apply)));
  }

  techniqueDialog() {
    this.search = make('input', { type: 'search', placeholder: 'Search', id: 'search-techniques' });
    this.search.addEventListener('input', () => this.filter());
    this.rows = make('div', { className: 'techniques' });
    this.heading = make('p', { className: 'about' });
    return dialogOf('techniques', 'Techniques', make('div', { className: 'settings' }, this.search), this.heading, this.rows);
  }

  /** The dialog of presets or of media; their lists are asked for once.
   * @param {HTMLDialogElement} dialog */
  open(dialog) {
    if (!this.asked) this.page.ask({ kind: 'menus' });
    this.asked = true;
    dialog.showModal();
  }

  /** The techniques for a new stage, or in place of a stage.
   * @param {StageRow | null} stage */
  openTechniques(stage) {
    this.replaced = stage;
    if (this.heading) this.heading.textContent = stage ? `In place of ${stage.technique}` : 'A new stage. Those that the chain cannot link say why.';
    this.rows?.replaceChildren(make('p', { className: 'about', textContent: '…' }));
    if (this.search) this.search.value = '';
    this.techniques.showModal();
    this.page.ask({ kind: 'techniques', path: stage?.path ?? [] });
  }

  /** An answer of Python; returns whether it was for a menu.
   * @param {any} message */
  heard(message) {
    if (message.kind === 'menus') {
      this.presetGrid?.showPresets(message.presets);
      this.mediaGrid?.show(message.media);
      this.quality?.replaceChildren(...Object.entries(message.qualities).map(([name, needs]) => Object.assign(new Option(name, name), { title: needs })));
      if (this.quality) this.quality.value = 'good';
    } else if (message.kind === 'medium') this.page.use(message.parameters, message.name);
    else if (message.kind === 'techniques') this.list(message.rows);
    else return false;
    return true;
  }

  /** @param {TechniqueRow[]} rows */
  list(rows) {
    const shown = rows.filter((row) => row.name !== this.replaced?.technique);
    this.rows?.replaceChildren(...[...Map.groupBy(shown, (row) => row.section)].map(([section, members]) =>
      make('section', {}, make('h3', { textContent: section }), ...members.map((row) => this.technique(row)))));
    this.filter();
    this.search?.focus();
  }

  /** @param {TechniqueRow} row */
  technique(row) {
    const tags = [...(row.baseline ? ['as published'] : []), ...row.needs].map((text) => make('span', { className: 'tag', textContent: text }));
    const button = make('button', { className: 'technique', disabled: Boolean(row.reason) },
      make('b', { textContent: row.name }), make('span', { textContent: row.summary }), make('span', { className: 'tags' }, ...tags),
      ...(row.reason ? [make('span', { className: 'reason', textContent: row.reason })] : []));
    button.dataset.name = row.name;
    button.addEventListener('click', () => {
      this.techniques.close();
      this.page.edit({ action: this.replaced ? 'replace' : 'add', technique: row.name, path: this.replaced?.path ?? [] });
    });
    return button;
  }

  /** Shows the techniques that have the words of the search. */
  filter() {
    const words = (this.search?.value ?? '').toLowerCase().split(/\s+/).filter(Boolean);
    for (const button of this.rows?.querySelectorAll('button') ?? []) button.hidden = !words.every((word) => button.textContent?.toLowerCase().includes(word));
    for (const section of this.rows?.querySelectorAll('section') ?? []) section.hidden = !section.querySelector('button:not([hidden])');
  }
}
