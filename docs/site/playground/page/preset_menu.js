// The menu of presets: a choice replaces the text of the material that is shown.

import { ChoiceGrid } from './preview/choice_grid.js';
import { dialogOf } from './preview/dialog.js';
import { make } from './preview/elements.js';

/** @typedef {import('./preview/choice_grid.js').PresetList & { texts: Record<string, string> }} Presets  As build_playground.py writes it. */

/** The menu; `chosen(text)` gets the file of the preset, for a body that is two units large. */
export class PresetMenu {
  /** @param {(text: string) => void} chosen */
  constructor(chosen) {
    const root = make('div');
    this.grid = new ChoiceGrid(root, ({ name }) => { this.dialog.close(); chosen(this.presets?.texts[name] ?? ''); });
    this.dialog = dialogOf('presets', 'Presets', root);
    /** @type {Presets | null} */
    this.presets = null;  // from the first open() on
  }

  async open() {
    this.presets ??= /** @type {Presets} */ (await (await fetch('presets.json')).json());
    this.grid.showPresets(this.presets);
    this.dialog.showModal();
  }
}
