// The box with what a material costs, and how far it is from the reference where that was measured.

import { make } from './elements.js';

const DELAY = 400;
const UNITS = { operations: 'operations', transcendentals: 'transcendental functions', fetches: 'texture reads', volume_fetches: 'volume reads', distance_evaluations: 'distances' };

/** The box; `ask` sends a question to Python. */
export class CostBox {
  /** @param {HTMLElement} root @param {(question: object) => void} ask */
  constructor(root, ask) {
    this.ask = ask;
    this.table = make('table');
    this.error = make('p', { id: 'measured' });
    root.append(make('h2', { textContent: 'static cost of one call' }), this.table, this.error);
  }

  /** The cost of a picture; its error is asked for once no further picture follows.
   * @param {import('../page_messages.js').Picture} picture */
  show({ cost }) {
    const used = Object.keys(UNITS).filter((unit) => Object.values(cost).some((one) => one[unit]));
    this.table.replaceChildren(
      make('tr', {}, make('th'), ...used.map((unit) => make('th', { textContent: UNITS[unit] }))),
      ...Object.entries(cost).map(([entry, one]) => make('tr', {}, make('th', { textContent: entry }), ...used.map((unit) => make('td', { textContent: one[unit] ?? 0 })))),
    );
    clearTimeout(this.later);
    this.later = setTimeout(() => this.ask({ kind: 'measured' }), DELAY);
  }

  /** The answer of Python.
   * @param {{ text: string }} answer */
  heard({ text }) { this.error.textContent = text; }
}
