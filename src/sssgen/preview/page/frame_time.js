// How long a frame takes: by the GPU's own timer where the browser has one, else by the clock, until the GPU is done.

import { deviceOf } from './renderer.js';

const FRAMES = 5;
const LONGEST = 300;  // milliseconds after which no further frame is drawn
const REST = 700;  // milliseconds between looks at the stage

/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {{ milliseconds: number, timer: 'GPU' | 'clock' }} FrameTime */

/** Waits until the graphics processor has drawn.
 * @param {WebGL2RenderingContext} gl */
async function drawn(gl) {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  while (fence && !gl.isContextLost() && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) await new Promise((done) => setTimeout(done, 1));
  gl.deleteSync(fence);
}

/** The milliseconds of a frame by the GPU's timer; null where it is disturbed.
 * @param {WebGL2RenderingContext} gl @param {{ TIME_ELAPSED_EXT: number, GPU_DISJOINT_EXT: number }} timer @param {() => void} draw */
async function queried(gl, timer, draw) {
  const query = gl.createQuery();
  if (!query) return null;
  gl.beginQuery(timer.TIME_ELAPSED_EXT, query);
  try { draw(); } finally { gl.endQuery(timer.TIME_ELAPSED_EXT); }
  await drawn(gl);
  for (let tries = 0; tries < 50 && !gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE); tries++) await new Promise((done) => setTimeout(done, 5));
  const valid = gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE) && !gl.getParameter(timer.GPU_DISJOINT_EXT);
  const nanoseconds = valid ? gl.getQueryParameter(query, gl.QUERY_RESULT) : 0;
  gl.deleteQuery(query);
  return nanoseconds ? nanoseconds / 1e6 : null;
}

/** The median time of some frames of a stage that shows its full resolution.
 * @param {Stage} stage @returns {Promise<FrameTime>} */
export async function frameTime(stage) {
  const device = deviceOf(stage.renderer);
  const gl = device ? null : /** @type {WebGL2RenderingContext} */ (stage.renderer.getContext());
  const timer = gl?.getExtension('EXT_disjoint_timer_query_webgl2');
  const [byGpu, byClock] = [/** @type {number[]} */ ([]), /** @type {number[]} */ ([])];
  for (let frame = 0; frame < FRAMES && byClock.reduce((sum, one) => sum + one, 0) < LONGEST; frame++) {
    const start = performance.now();
    const own = gl && timer ? await queried(gl, timer, () => stage.frame()) : (stage.frame(), null);
    if (device) await device.queue.onSubmittedWorkDone();
    else if (gl) await drawn(gl);
    byClock.push(performance.now() - start);
    if (own !== null) byGpu.push(own);
  }
  const middle = (/** @type {number[]} */ all) => all.sort((a, b) => a - b)[all.length >> 1];
  return byGpu.length ? { milliseconds: middle(byGpu), timer: 'GPU' } : { milliseconds: middle(byClock), timer: 'clock' };
}

/** Measures each picture once it is drawn in full, where frames are fast; elsewhere when it is asked. `measured` gets the
 * time and the size in pixels, or null where a picture waits for the question. */
export class FrameWatch {
  /** @param {() => Stage | null} shown @param {(time: FrameTime | null, size: number[]) => void} measured */
  constructor(shown, measured) {
    this.shown = shown;
    this.measured = measured;
    this.last = '';
    this.busy = false;
    setInterval(() => this.look(), REST);
  }

  look() {
    const stage = this.shown();
    if (this.busy || document.hidden || !stage?.drafts.sharp) return;
    const { width, height } = stage.renderer.domElement;
    const key = [stage.kind, stage.program, stage.mesh.userData.body, width, height].join();
    if (key === this.last) return;
    this.last = key;
    if (stage.drafts.level > 0) this.measured(null, []);  // without a GPU a frame takes seconds
    else this.measure();
  }

  async measure() {
    const stage = this.shown();
    if (this.busy || !stage?.mesh) return;
    this.busy = true;
    try {
      const { width, height } = stage.renderer.domElement;
      this.measured(await frameTime(stage), [width, height]);
    } finally {
      this.busy = false;
    }
  }
}
