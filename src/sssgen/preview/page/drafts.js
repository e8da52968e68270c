// Frames while something changes: at a resolution that this machine draws at once; at full resolution after a rest.

import { deviceOf } from './renderer.js';

const BUDGET = 40;
const REST = 250;
const SHARES = [1, 1 / 2, 1 / 4];

/** @typedef {import('./stage.js').Stage} Stage */

/** Decides when a stage draws, and at which share of its resolution. */
export class Drafts {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    this.level = SHARES.length - 1;  // of the next draft, in SHARES
    this.asked = 0;  // the frame that was requested
    this.turn = 0;
    this.busy = false;
    this.again = false;
    this.sharp = false;  // whether the last picture has the full resolution
    this.held = false;  // whether something else draws
  }

  /** Draws nothing until `release()`; waits for a picture that is under way. */
  async hold() {
    this.held = true;
    clearTimeout(this.rest);
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    while (this.busy) await new Promise((done) => setTimeout(done, 5));
  }

  release() {
    this.held = false;
    this.ask();
  }

  /** A draft with the next frame of the page. */
  ask() {
    this.sharp = false;
    clearTimeout(this.rest);
    if (this.held) return;
    if (this.busy) this.again = true;
    else this.asked ||= requestAnimationFrame(() => { this.asked = 0; this.draw(this.level); });
  }

  /** A draft at once. */
  now() {
    this.sharp = false;
    clearTimeout(this.rest);
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    return this.draw(this.level);
  }

  /** Draws at a level; what is asked meanwhile follows when the picture is there, so that no frames pile up.
   * @param {number} level */
  async draw(level) {
    const [start, turn] = [performance.now(), ++this.turn];
    if (!this.stage.mesh || this.held) return;
    this.busy = true;
    try {
      this.stage.resolution(SHARES[level]);
      this.stage.frame();
      await this.drawn();
    } finally {
      if (turn === this.turn) this.busy = false;
    }
    if (turn !== this.turn) return;
    this.adapt(level, performance.now() - start);
    if (this.held) return;
    if (this.again) { this.again = false; this.ask(); }
    else if (level === 0) this.sharp = true;
    else this.rest = setTimeout(() => this.draw(level - 1), REST);
  }

  /** The level of the next drafts, by the milliseconds of the last one.
   * @param {number} level @param {number} took */
  adapt(level, took) {
    if (took > BUDGET) this.level = Math.min(Math.max(this.level, level + 1), SHARES.length - 1);
    else if (took < BUDGET / 3) this.level = Math.max(Math.min(this.level, level - 1), 0);
  }

  /** Waits until the graphics processor has drawn what was asked of it. */
  async drawn() {
    const { renderer } = this.stage;
    const device = deviceOf(renderer);
    if (device) { await device.queue.onSubmittedWorkDone(); return; }
    const gl = /** @type {WebGL2RenderingContext} */ (renderer.getContext());
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    if (!fence) return;
    while (!gl.isContextLost() && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
      await new Promise((done) => setTimeout(done, 2));
    }
    gl.deleteSync(fence);
  }

  dispose() {
    clearTimeout(this.rest);
    cancelAnimationFrame(this.asked);
    this.turn += 1;
    this.again = false;
  }
}
