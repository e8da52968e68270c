// The playground: the editor's files go to Python in a worker; text and the picture's head come back.

import { Compiler } from './compiler.js';
import { Editor } from './editor.js';
import { EmittedText } from './emitted_text.js';
import { Pieces } from './pieces.js';
import { unpackedJson } from './packed.js';
import { Picture } from './picture.js';
import { box, button, list, make } from './preview/elements.js';
import { PresetMenu } from './preset_menu.js';
import { packedState, unpackedState } from './state_link.js';

/** @typedef {import('./picture.js').Start} Start */
/** @typedef {{ start: string, files: import('./editor.js').Files, open: string, target: string, form: string, shape: string,
 *   values: object }} State  What a link has. */
/** @typedef {{ starts: { name: string, title: string, preset: boolean }[], targets: { name: string, title: string }[], first: string }} Listed */

const [target, form, starts] = [list('target'), list('form'), list('start')];
const copyButton = button('copy');
const say = (/** @type {string} */ text) => { box('message').textContent = text; };
const python = (/** @type {string} */ text, failed = false) => {
  box('python').textContent = text;
  box('python').classList.toggle('failed', failed);
};

const compiler = new Compiler(globalThis.pythonWorker, (kind, text) => {
  if (kind === 'started') python('Python runs, sssgen is loading …');
  if (kind === 'failed') python(`Python does not start: ${text}`, true);
});
const picture = new Picture(new Pieces(), () => editor.files);
const editor = new Editor(box('files'), box('editor'), () => refresh(true));
const emitted = new EmittedText(box('parts'), box('text'));
/** @type {Start} */
let start;

/** Begins with an example, or with the state of a link.
 * @param {string} name @param {State | null} state */
async function begin(name, state = null) {
  start = await unpackedJson(`starts/${name}.json`);
  starts.value = name;
  document.title = `${start.title} · sssgen playground`;
  picture.begin(start, state);
  button('open-presets').disabled = !picture.scene()?.head.body;
  editor.show(state?.files ?? start.files, start.files, state?.open ?? start.main);
  if (state?.target) target.value = state.target;
  if (state?.form) form.value = state.form;
  if (start.head && !state) picture.show({ head: start.head });  // while Python is loading
  await refresh(false);
}

const menu = new PresetMenu((text) => {
  const renamed = text.replace(/^name = ".*"$/m, `name = "${start.name}"`);
  editor.show({ ...editor.files, [start.main]: renamed }, start.files, start.main);
  refresh(true);
});

/** What Python is asked of the files as they are now.
 * @param {'picture' | 'text'} part */
function request(part) {
  const { values = {}, in_scene = [] } = picture.scene() ?? {};
  const asked = { target: target.value, form: start.main.endsWith('.toml') ? form.value : 'shader' };
  return { part, example: start.name, files: { ...editor.files }, main: start.main, ...asked, values, in_scene };
}

/** Asks Python for the picture of the files as they are now, and then for the text.
 * @param {boolean} compared  whether changed lines of the text are marked */
async function refresh(compared) {
  const [began, asked] = [performance.now(), start];
  try {
    const drawn = await compiler.ask(request('picture'));
    if (!drawn || asked !== start) return;
    const computed = performance.now() - began;
    editor.mark(drawn.diagnostics);
    complain(drawn.errors);
    try {
      await picture.show(drawn);
    } catch (reason) {
      complain(drawn.errors || `the page cannot draw it: ${reason.message}`);
    }
    const [all, version] = [performance.now() - began, Number(document.body.dataset.version ?? 0) + 1];
    python(version > 1 ? `Python ${computed.toFixed(0)} ms, picture ${(all - computed).toFixed(0)} ms` : `first picture after ${(performance.now() / 1000).toFixed(1)} s`);
    Object.assign(document.body.dataset, { version: String(version), milliseconds: String(all) });
    await write(compared, drawn.errors);
  } catch (reason) {  // a fault of sssgen, not of the files
    complain(`sssgen failed on these files: ${reason.message.trim().split('\n').pop()}`);
  }
}

/** Shows the text for the target; `errors` are those of the picture, which come first.
 * @param {boolean} compared */
async function write(compared, errors = '') {
  const asked = start;
  const written = await compiler.ask(request('text'));
  if (!written || asked !== start) return;
  emitted.show(written.texts ?? {}, written.errors === errors ? '' : written.errors, compared);  // one error is shown once
  copyButton.disabled = Boolean(emitted.refused);
  if (!errors) complain('', written.warnings);
}

/** @param {string} errors */
function complain(errors, warnings = '') {
  box('errors').hidden = !errors && !warnings;
  box('errors').classList.toggle('warning', !errors);
  box('errors').textContent = errors || warnings;
}

/** @param {string} text @param {string} what */
async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied`);
  } catch {
    say('the browser does not let this page copy: take it from the address bar');
  }
  setTimeout(() => say(''), 4000);
}

/** @returns {State} */
function state() {
  return {
    start: start.name, files: editor.files, open: editor.open, target: target.value, form: form.value,
    ...picture.state(),
  };
}

/** What the address says: `#NAME`, or `#s=STATE` for a whole state; the first example where it says nothing.
 * @param {Listed} listed */
async function fromAddress(listed) {
  const text = location.hash.slice(1);
  try {
    if (text.startsWith('s=')) {
      const linked = await unpackedState(text.slice(2));
      if (!listed.starts.some(({ name }) => name === linked.start)) throw new Error('it names no example');
      const whole = Object.values(linked.files ?? {}).every((one) => typeof one === 'string') && Object.keys(linked.files ?? {}).length;
      if (!whole) throw new Error('it has no files');
      return await begin(linked.start, linked);
    }
  } catch (reason) {
    say(`the link cannot be read: ${reason.message}`);
  }
  return begin(listed.starts.some(({ name }) => name === text) ? text : listed.first);
}

const options = (/** @type {{ name: string, title: string }[]} */ rows) => rows.map(({ name, title }) => new Option(title, name));
/** @type {Listed} */
const listed = await (await fetch('starts.json')).json();
for (const [label, preset] of /** @type {const} */ ([['Presets, on a mouse', true], ['Examples', false]])) {
  const rows = listed.starts.filter((row) => row.preset === preset);
  if (rows.length) starts.append(make('optgroup', { label }, ...options(rows)));
}
target.append(...options(listed.targets));
target.value = 'wgsl';
starts.addEventListener('change', () => {
  history.replaceState(null, '', `#${starts.value}`);
  begin(starts.value);
});
for (const choice of [target, form]) choice.addEventListener('change', () => write(false));
button('open-presets').addEventListener('click', () => menu.open());
button('again').addEventListener('click', () => begin(start.name));
copyButton.addEventListener('click', () => copy(emitted.text, emitted.open));
button('link').addEventListener('click', async () => {
  history.replaceState(null, '', `#s=${await packedState(state())}`);
  await copy(location.href, 'link');
});
addEventListener('hashchange', () => fromAddress(listed));
addEventListener('error', (event) => say(event.message));
addEventListener('unhandledrejection', (event) => say(String(event.reason?.message ?? event.reason)));
globalThis.playground = { editor, picture, emitted, get start() { return start; } };
fromAddress(listed);
