// The demo of the first page: a row of presets, each on a body that turns, with its file and its text for an engine.
// All of this was emitted when the site was built. The compiler is loaded when the file is edited.

import { Compiler } from './compiler.js';
import { Editor } from './editor.js';
import { EmittedText } from './emitted_text.js';
import { Pieces } from './pieces.js';
import { unpackedJson } from './packed.js';
import { box, button, element } from './preview/elements.js';
import { packedState } from './state_link.js';

/** @typedef {import('./editor.js').Files} Files */
/** @typedef {import('./picture.js').Start & { head: import('./picture.js').Head }} Start */
/** @typedef {{ name: string, title: string, doc: string, picture: string, surroundings: number, commands: Record<string, string> }} Preset */
/** @typedef {{ first: string, presets: Preset[] }} Listed */

const here = (/** @type {string} */ path) => new URL(path, import.meta.url).href;
const say = (/** @type {string} */ text) => { box('demo-status').textContent = text; };
const [strip, targets] = [box('demo-presets'), box('demo-targets')];
const poster = element('demo-poster', HTMLImageElement);
const open = element('demo-open', HTMLAnchorElement);

const emitted = new EmittedText(document.createElement('nav'), box('demo-text'));
const editor = new Editor(document.createElement('nav'), box('demo-editor'), () => edited());
const pieces = new Pieces();
/** @type {Promise<import('./demo_stage.js').DemoStage> | null} */
let stage = null;
/** @type {Compiler | null} */
let compiler = null;
/** @type {Preset} */
let preset;
/** @type {Start} */
let start;
/** @type {Record<string, Files>} */
let texts = {};
let target = 'threejs';

/** Shows a preset: its picture at once, then its file, its text and the body.
 * @param {Preset} next */
async function show(next) {
  preset = next;
  poster.src = here(next.picture);
  poster.alt = `A mouse of ${next.title.toLowerCase()}`;
  box('demo-title').textContent = next.title;
  box('demo-doc').textContent = next.doc;
  for (const one of strip.querySelectorAll('button')) one.setAttribute('aria-pressed', String(one.dataset.name === next.name));
  const [record, written] = await Promise.all([unpackedJson(`starts/preset_${next.name}.json`), unpackedJson(`demo/${next.name}.json`)]);
  if (preset !== next) return;
  [start, texts] = [record, written];
  box('demo-source').textContent = start.main;
  editor.show(start.files, start.files, start.main);
  open.href = here(`index.html#preset_${next.name}`);
  say('');
  complain('');
  write(false);
  await draw(start.head);
}

/** Shows the text for the target, and the command that makes it.
 * @param {boolean} compared  whether changed lines are marked */
function write(compared, refused = '') {
  for (const one of targets.querySelectorAll('button')) one.setAttribute('aria-selected', String(one.dataset.target === target));
  const files = texts[target] ?? {};
  box('demo-copy').textContent = 'Copy';
  emitted.show(files, refused || (texts[target] ? '' : `${preset.title} has no text for this target.`), compared);
  box('demo-command').textContent = changed() ? `sssgen emit ${start.main} --target ${target} -o out` : preset.commands[target];
}

const changed = () => start.main in editor.files && editor.files[start.main] !== start.files[start.main];

/** Draws the body with a material; where the browser cannot, the poster stays.
 * @param {import('./picture.js').Head} head */
async function draw(head) {
  try {
    stage ??= begun();
    const [drawn, scene, asked] = [await stage, start.scenes[''], preset];
    pieces.body(scene.head.body);
    drawn.surround(asked.surroundings);
    await drawn.show({ ...scene.head, ...head, textures: head.textures }, new Map());
    box('demo').dataset.drawn = asked.name;
  } catch (reason) {
    box('demo').dataset.drawn = 'picture';
    box('demo-hint').textContent = `This browser does not draw it here (${reason.message}): a picture instead.`;
  }
}

async function begun() {
  if (!document.createElement('canvas').getContext('webgl2')) throw new Error('WebGL 2 is missing');
  const { DemoStage } = await import('./demo_stage.js');
  const result = new DemoStage(box('demo-stage'), pieces.get);
  await result.start();
  return result;
}

/** Asks the compiler for the edited file's picture, then for its text. */
async function edited() {
  open.href = here('index.html#s=' + await packedState({
    start: start.name, files: editor.files, open: start.main, target, form: 'shader', shape: '', values: {},
  }));
  if (!compiler) {
    say('The compiler is loading, once, 8 MB …');
    compiler = new Compiler(new Worker(new URL('./worker.js', import.meta.url), { type: 'module' }), (kind, text) => {
      if (kind === 'failed') say(`The compiler does not start: ${text}`);
    });
  }
  const asked = start;
  const { values, in_scene } = asked.scenes[''];
  const request = { example: asked.name, files: { ...editor.files }, main: asked.main, form: 'shader', values, in_scene };
  const began = performance.now();
  const picture = await compiler.ask({ ...request, part: 'picture', target });
  if (!picture || asked !== start) return;
  editor.mark(picture.diagnostics);
  complain(picture.errors || picture.warnings);
  say(picture.errors ? '' : `compiled here in ${(performance.now() - began).toFixed(0)} ms`);
  if (picture.head) await draw(picture.head);
  await retarget(true);
}

/** The text of the edited file for the target.
 * @param {boolean} compared */
async function retarget(compared) {
  const asked = start;
  const written = await compiler?.ask({
    part: 'text', example: asked.name, files: { ...editor.files }, main: asked.main, form: 'shader', target, values: {}, in_scene: [],
  });
  if (!written || asked !== start) return;
  const name = Object.keys(written.texts ?? {}).find((one) => !one.endsWith('.vert'));  // as demo.py chooses it
  if (name) texts = { ...texts, [target]: { [name]: written.texts[name] } };
  write(compared, written.errors);
}

/** @param {string} text */
function complain(text) {
  box('demo-errors').hidden = !text;
  box('demo-errors').textContent = text;
}

/** @type {Listed} */
const listed = await (await fetch(here('demo/demo.json'))).json();
strip.addEventListener('click', ({ target: clicked }) => {
  const name = clicked instanceof Element && clicked.closest('button')?.dataset.name;
  const next = listed.presets.find((one) => one.name === name);
  if (next) show(next);
});
targets.addEventListener('click', async ({ target: clicked }) => {
  const name = clicked instanceof Element && clicked.closest('button')?.dataset.target;
  if (!name) return;
  target = name;
  if (changed()) await retarget(false); else write(false);
});
button('demo-copy').addEventListener('click', async ({ currentTarget }) => {
  await navigator.clipboard.writeText(emitted.text);
  if (currentTarget instanceof Element) currentTarget.textContent = `${emitted.open} copied`;
});
button('demo-reset').addEventListener('click', () => show(preset));
globalThis.demo = { show, get stage() { return stage; }, editor, emitted };
const wanted = new URLSearchParams(location.search).get('preset');
await show(listed.presets.find(({ name }) => name === wanted) ?? listed.presets.find(({ name }) => name === listed.first) ?? listed.presets[0]);
