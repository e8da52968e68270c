// The playground: the editor's files go to Python in a worker; text and the picture's head come back.

import { Compiler } from './compiler.js';
import { Editor } from './editor.js';
import { EmittedText } from './emitted_text.js';
import { Pieces } from './pieces.js';
import { unpacked } from './packed.js';
import { Picture } from './picture.js';
import { packedState, unpackedState } from './state_link.js';

const element = (id) => document.getElementById(id);
const say = (text) => { element('message').textContent = text; };
const python = (text, failed = false) => {
  element('python').textContent = text;
  element('python').classList.toggle('failed', failed);
};

const compiler = new Compiler(globalThis.pythonWorker, (kind, text) => {
  if (kind === 'started') python('Python runs, sssgen is loading …');
  if (kind === 'failed') python(`Python does not start: ${text}`, true);
});
const pieces = new Pieces();
const picture = new Picture(pieces, say);
const editor = new Editor(element('files'), element('editor'), () => refresh(true));
const emitted = new EmittedText(element('parts'), element('text'));
let start = null;

async function startOf(name) {
  return JSON.parse(new TextDecoder().decode(await unpacked(`starts/${name}.json`)));
}

/** Begins with an example, or with the state of a link. */
async function begin(name, state = null) {
  start = await startOf(name);
  element('start').value = name;
  document.title = `${start.title} · sssgen playground`;
  picture.begin(start, state);
  editor.show(state?.files ?? start.files, start.files, state?.open ?? start.main);
  for (const id of ['target', 'form']) if (state?.[id]) element(id).value = state[id];
  await refresh(false);
}

/** What Python is asked of the files as they are now. */
function request(part) {
  const { values = {}, in_scene = [] } = picture.scene() ?? {};
  const form = start.main.endsWith('.toml') ? element('form').value : 'shader';
  return { part, example: start.name, files: { ...editor.files }, main: start.main, target: element('target').value, form, values, in_scene };
}

/** Asks Python for the picture of the files as they are now, and then for the text. */
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
    Object.assign(document.body.dataset, { version, milliseconds: all });
    await write(compared, drawn.errors);
  } catch (reason) {  // a fault of sssgen, not of the files
    complain(`sssgen failed on these files: ${reason.message.trim().split('\n').pop()}`);
  }
}

/** Shows the text for the target; `errors` are those of the picture, which come first. */
async function write(compared, errors = '') {
  const asked = start;
  const written = await compiler.ask(request('text'));
  if (!written || asked !== start) return;
  emitted.show(written.texts ?? {}, written.errors === errors ? '' : written.errors, compared);  // one error is shown once
  element('copy').disabled = Boolean(emitted.refused);
  if (!errors) complain('', written.warnings);
}

function complain(errors, warnings = '') {
  element('errors').hidden = !errors && !warnings;
  element('errors').classList.toggle('warning', !errors);
  element('errors').textContent = errors || warnings;
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied`);
  } catch {
    say('the browser does not let this page copy: take it from the address bar');
  }
  setTimeout(() => say(''), 4000);
}

async function state() {
  return {
    start: start.name, files: editor.files, open: editor.open, target: element('target').value, form: element('form').value,
    ...picture.state(),
  };
}

/** What the address says: `#NAME`, or `#s=STATE` for a whole state; the first example where it says nothing. */
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

const options = (rows) => rows.map(({ name, title }) => new Option(title, name));
const listed = await (await fetch('starts.json')).json();
element('start').append(...options(listed.starts));
element('target').append(...options(listed.targets));
element('target').value = 'wgsl';
element('start').addEventListener('change', () => {
  history.replaceState(null, '', `#${element('start').value}`);
  begin(element('start').value);
});
for (const id of ['target', 'form']) element(id).addEventListener('change', () => write(false));
element('again').addEventListener('click', () => begin(start.name));
element('copy').addEventListener('click', () => copy(emitted.text, emitted.open));
element('link').addEventListener('click', async () => {
  history.replaceState(null, '', `#s=${await packedState(await state())}`);
  await copy(location.href, 'link');
});
addEventListener('hashchange', () => fromAddress(listed));
addEventListener('error', (event) => say(event.message));
addEventListener('unhandledrejection', (event) => say(String(event.reason?.message ?? event.reason)));
globalThis.playground = { editor, picture, emitted, get start() { return start; } };
fromAddress(listed);
