// The chain of a material: its stages in the order in which they run, with buttons that change them.

import { make } from './elements.js';

/** @typedef {import('../page_messages.js').StageRow} StageRow */

const FEW = 5;  // stages that are shown at first

/** The list; `replace` and `remove` are called with a stage, `add` for a new one. */
export class Chain {
  /** @param {HTMLElement} root @param {{ add: () => void, replace: (stage: StageRow) => void, remove: (stage: StageRow) => void }} actions */
  constructor(root, actions) {
    this.root = root;
    this.actions = actions;
    /** @type {boolean | null} */
    this.open = null;  // what the user chose
  }

  /** @param {StageRow[]} stages */
  show(stages) {
    this.root.hidden = !stages.length;
    const add = make('button', { textContent: '+ Stage', title: 'Add a technique to the chain', id: 'add-stage' });
    add.addEventListener('click', (event) => { event.preventDefault(); this.actions.add(); });
    const summary = make('summary', {}, `chain of ${stages.length} stages`, add);
    const list = make('details', { open: this.open ?? stages.length <= FEW }, summary, make('ol', {}, ...stages.map((stage) => this.row(stage))));
    summary.addEventListener('click', (event) => { if (!event.defaultPrevented) this.open = !list.open; });
    this.root.replaceChildren(list);
  }

  /** @param {StageRow} stage */
  row(stage) {
    const actions = stage.changes ? [
      this.button('⇄', `Another technique in place of ${stage.technique}`, () => this.actions.replace(stage)),
      this.button('✕', `Remove ${stage.technique}`, () => this.actions.remove(stage)),
    ] : [];
    return make('li', { title: stage.doc }, make('span', { className: 'role', textContent: stage.role }), make('span', { className: 'name', textContent: stage.technique }), ...actions);
  }

  /** @param {string} text @param {string} title @param {() => void} clicked */
  button(text, title, clicked) {
    const button = make('button', { className: 'icon', textContent: text, title });
    button.addEventListener('click', clicked);
    return button;
  }
}
