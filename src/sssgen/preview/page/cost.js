// What a material costs, the time of a frame, and how far the picture is from the reference where that was measured: in
// short beside the picture, and as a table below the controls.

import { make } from './elements.js';

const DELAY = 400;
const UNITS = { operations: 'operations', transcendentals: 'transcendental functions', fetches: 'texture reads', volume_fetches: 'volume reads', distance_evaluations: 'distances' };
const TIMERS = { GPU: 'the timer of the GPU', clock: 'the clock, from the first call until the GPU is done: the time of the CPU is in it' };

/** The box, and the line `facts`; `ask` sends a question to Python. */
export class CostBox {
  /** @param {HTMLElement} root @param {HTMLElement} facts @param {(question: object) => void} ask */
  constructor(root, facts, ask) {
    this.ask = ask;
    /** @type {(() => void) | undefined} */
    this.measure = undefined;  // draws a frame and measures it
    this.table = make('table');
    this.error = make('p', { id: 'measured' });
    this.time = this.fact('frame-time');
    this.short = this.fact('short-cost');
    this.shortError = this.fact('short-error');
    facts.replaceChildren(this.time, this.short, this.shortError);
    root.append(make('h2', { textContent: 'static cost of one call' }), this.table, this.error);
  }

  /** @param {string} id */
  fact(id) { return make('span', { id, textContent: '…' }); }

  /** The cost of a picture; its error is asked for once no further picture follows.
   * @param {import('../page_messages.js').Picture} picture */
  show({ cost }) {
    const used = Object.keys(UNITS).filter((unit) => Object.values(cost).some((one) => one[unit]));
    this.table.replaceChildren(
      make('tr', {}, make('th'), ...used.map((unit) => make('th', { textContent: UNITS[unit] }))),
      ...Object.entries(cost).map(([entry, one]) => make('tr', {}, make('th', { textContent: entry }), ...used.map((unit) => make('td', { textContent: one[unit] ?? 0 })))),
    );
    const operations = Object.values(cost).reduce((sum, one) => sum + (one.operations ?? 0), 0);
    this.short.textContent = `${operations} operations`;
    this.short.title = `Static cost of one call of each part: ${Object.entries(cost).map(([entry, one]) => `${entry} ${one.operations ?? 0}`).join(', ')}. The table is below the controls.`;
    clearTimeout(this.later);
    this.later = setTimeout(() => this.ask({ kind: 'measured' }), DELAY);
  }

  /** The time of a frame; null for a button that measures it.
   * @param {import('./frame_time.js').FrameTime | null} time @param {number[]} size  in pixels */
  frame(time, size) {
    if (!time) {
      const button = make('button', { textContent: 'measure a frame', title: 'Frames are slow here: one more is drawn, and its time is shown' });
      button.addEventListener('click', () => { this.time.textContent = '…'; this.measure?.(); });
      this.time.replaceChildren(button);
      return;
    }
    const digits = time.milliseconds < 100 ? time.milliseconds.toPrecision(3) : Math.round(time.milliseconds);
    this.time.textContent = `${digits} ms (${time.timer})`;
    this.time.title = `A frame of ${size.join(' × ')} pixels, measured by ${TIMERS[time.timer]}. It has all that the stage draws.`;
  }

  /** The answer of Python.
   * @param {{ text: string, short: string }} answer */
  heard({ text, short }) {
    this.error.textContent = text;
    this.shortError.textContent = short;
    this.shortError.title = text;
    this.shortError.hidden = !short;
  }
}
