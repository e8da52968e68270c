// The sheets that save a picture of any size, and a turn of the body as a film.

import { make } from './elements.js';
import { Offscreen, largestSide } from './offscreen.js';
import { filmWriter, framesWriter } from './recording.js';
import { choice, row, tick } from './sheets.js';

/** @typedef {import('./stage.js').Stage} Stage */

const SIZES = { '1920x1080': '1920 × 1080', '1080x1080': '1080 × 1080', '3840x2160': '3840 × 2160', window: 'as on the page', own: 'another size' };
const RATES = { 24: '24', 25: '25', 30: '30', 60: '60' };
const LONGEST = 120;  // seconds

/** Hands a file to the browser.
 * @param {Blob} blob @param {string} name */
function download(blob, name) {
  const link = make('a', { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60e3);
}

/** Rows with a size: presets, and the numbers.
 * @param {string} id @param {() => Stage | null} stageOf */
function sizeRows(id, stageOf) {
  const preset = choice(SIZES, `${id}-size`);
  const [width, height] = ['width', 'height'].map((side) => make('input', { type: 'number', className: 'number', id: `${id}-${side}`, min: 16, value: side === 'width' ? 1920 : 1080, title: `The ${side} in pixels` }));
  preset.addEventListener('change', () => {
    const canvas = stageOf()?.renderer.domElement;
    const [x, y] = preset.value === 'window' && canvas ? [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * devicePixelRatio)) : preset.value.split('x').map(Number);
    if (x && y) Object.assign(width, { value: String(x) }), Object.assign(height, { value: String(y) });
  });
  for (const field of [width, height]) field.addEventListener('input', () => { preset.value = 'own'; });
  return {
    rows: [row('Size', preset), row('Pixels', width, '×', height)],
    /** The size; throws for one that cannot be drawn. @param {Stage} stage @param {number} multiple */
    size(stage, multiple = 1) {
      const most = largestSide(stage.renderer);
      const [x, y] = [width, height].map((field) => Math.round(Number(field.value) / multiple) * multiple);
      if (!(Math.min(x, y) >= 16 && Math.max(x, y) <= most)) throw new Error(`A side has 16 to ${most} pixels here.`);
      return { width: x, height: y };
    },
  };
}

/** The sheet that saves a picture.
 * @param {() => Stage | null} stageOf @param {() => string} nameOf */
export function pictureSheet(stageOf, nameOf) {
  let transparent = false;
  const size = sizeRows('picture', stageOf);
  const said = make('p', { className: 'note' });
  const save = make('button', { id: 'save-picture', className: 'main', textContent: 'Save the picture' });
  save.addEventListener('click', () => busy(save, said, async () => {
    const stage = stageOf();
    if (!stage) return '';
    const { width, height } = size.size(stage);
    const blob = await pictureOf(stage, { width, height, transparent });
    download(blob, `${nameOf()}_${width}x${height}.png`);
    return `Saved: ${width} × ${height}.`;
  }));
  return make('div', {}, ...size.rows, tick('Transparent', false, (on) => { transparent = on; }, 'picture-transparent'), make('div', { className: 'row buttons' }, save), said);
}

/** A PNG file.
 * @param {Stage} stage @param {import('./offscreen.js').Format} format */
export async function pictureOf(stage, format) {
  const offscreen = new Offscreen(stage, format);
  await offscreen.start();
  try {
    return await offscreen.frame().convertToBlob();
  } finally {
    offscreen.end();
  }
}

/** Runs the work of a button; what goes wrong is said.
 * @param {HTMLButtonElement} button @param {HTMLElement} said @param {() => Promise<string>} work */
async function busy(button, said, work) {
  button.disabled = true;
  said.textContent = 'Drawing…';
  await new Promise((done) => setTimeout(done, 30));  // the page shows that
  said.textContent = await work().catch((error) => String(error.message ?? error));
  button.disabled = false;
}

/** The sheet that saves a turn as a film or as frames.
 * @param {() => Stage | null} stageOf @param {() => string} nameOf */
export function filmSheet(stageOf, nameOf) {
  let stopped = false;
  const size = sizeRows('film', stageOf);
  const seconds = make('input', { type: 'number', className: 'number', id: 'film-seconds', min: 0.1, max: LONGEST, step: 'any', value: 6 });
  const rate = choice(RATES, 'film-rate');
  rate.value = '30';
  const kind = choice({ webm: 'film (WebM)', zip: 'frames (PNG in a zip)' }, 'film-kind');
  const said = make('p', { className: 'note' });
  const progress = make('progress', { value: 0, hidden: true });
  const save = make('button', { id: 'save-film', className: 'main', textContent: 'Save a turn' });
  const stop = make('button', { textContent: 'Stop', disabled: true });
  stop.addEventListener('click', () => { stopped = true; });
  save.addEventListener('click', () => busy(save, said, async () => {
    const stage = stageOf();
    if (!stage) return '';
    if (!(Number(seconds.value) > 0 && Number(seconds.value) <= LONGEST)) throw new Error(`A film has up to ${LONGEST} seconds.`);
    const format = { ...size.size(stage, 2), transparent: false };  // coded frames have even sides
    const film = { ...format, rate: Number(rate.value), count: Math.max(1, Math.round(Number(seconds.value) * Number(rate.value))) };
    stopped = false;
    Object.assign(stop, { disabled: false });
    Object.assign(progress, { hidden: false, value: 0 });
    const shown = (/** @type {number} */ index) => { progress.value = index / film.count; said.textContent = `Frame ${index} of ${film.count}`; return !stopped; };
    const file = await filmOf(stage, film, kind.value, shown).finally(() => { stop.disabled = true; progress.hidden = true; });
    if (!file) return 'Stopped: nothing is saved.';
    download(file.blob, `${nameOf()}_turn.${file.name}`);
    return file.name === kind.value ? `Saved: ${film.count} frames.` : `Saved: ${film.count} frames as PNG in a zip, as this browser codes no film of this size.`;
  }));
  return make('div', {}, row('Seconds', seconds), row('Frames', rate, 'a second'), ...size.rows, row('As', kind), make('div', { className: 'row buttons' }, save, stop), progress, said);
}

/** A whole turn of the body in a film: WebM where the browser codes it, else frames; null where `shown(index)` says false.
 * @param {Stage} stage @param {import('./recording.js').Film & import('./offscreen.js').Format} film @param {string} kind @param {(index: number) => boolean} shown */
export async function filmOf(stage, film, kind, shown) {
  const writer = (kind === 'webm' && await filmWriter(film)) || framesWriter();
  const offscreen = new Offscreen(stage, film);
  await offscreen.start();
  try {
    for (let index = 0; index < film.count; index++) {
      if (!shown(index)) return null;
      await writer.add(offscreen.frame(2 * Math.PI * index / film.count), index);
      await new Promise((done) => setTimeout(done));  // the page stays alive
    }
    return { blob: await writer.blob(), name: writer.name };
  } finally {
    offscreen.end();
  }
}
