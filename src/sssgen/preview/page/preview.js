// The page of `sssgen preview`: it shows what the server sends, and sends back what is to be saved.

import { MESHES, onChoice, onDrop, refusal } from './chosen_files.js';
import { connect } from './connection.js';
import { CostBox } from './cost.js';
import { EmittedText } from './emitted_text.js';
import { Panel } from './panel.js';
import { Stage } from './stage.js';
import { TextureSlots } from './texture_slots.js';

const element = (id) => document.getElementById(id);
const pieces = new Map();
let stage = null;
let last = null;
let waiting = Promise.resolve();

const say = (text) => { element('status').textContent = text; };

/** A piece of the picture, fetched once while pictures name it. */
async function pieceOf(digest) {
  if (!pieces.has(digest)) pieces.set(digest, await python.piece(digest));
  return pieces.get(digest);
}

const panel = new Panel(element('controls'), (property, numbers) => {
  stage?.set(property, numbers);
  buttons();
});

const slots = new TextureSlots(element('textures'), pieceOf, (row, file) => {
  python.sendFile({ kind: 'texture', slot: row.property, name: file?.name ?? '' }, file ?? '');
}, say);

function buttons() {
  const textures = last?.picture.textures.some((row) => row.chosen);
  element('save').disabled = element('reset').disabled = panel.values.size === 0 && !textures;
}

function complain(text) {
  element('error').hidden = !text;
  element('error').textContent = text;
}

/** A stage with the chosen renderer; without WebGPU that of WebGL 2, which is said. */
async function stageFor(kind) {
  const next = new Stage(element('stage'), kind, pieceOf);
  try {
    await next.start();
    next.environment(element('environment').checked);
    return next;
  } catch (error) {
    next.dispose();
    if (kind !== 'webgpu') throw error;
    say(`WebGPU is not available here (${error.message}): this is its WebGL 2 fallback.`);
    element('renderer').value = 'webgl2';
    return stageFor('webgl2');
  }
}

async function show(message) {
  last = message;
  const { picture, error } = message;
  complain(error);
  element('title').textContent = picture.title;
  document.title = `${picture.title} · sssgen preview`;
  const shapes = picture.shapes.map((shape) => new Option(shape === 'mesh' ? picture.mesh : shape || "the scene's own", shape));
  element('shape').replaceChildren(...shapes);
  element('shape').value = picture.shape;
  panel.show(picture.controls);
  cost.show(picture);
  slots.show(picture.textures, message.limit);
  buttons();
  try {
    stage ??= await stageFor(element('renderer').value);
    await stage.show(picture, panel.values);
    document.body.dataset.version = message.version;
  } catch (reason) {
    complain(error || `the page cannot draw it: ${reason.message}`);
  }
  const named = new Set([picture.body, ...picture.textures.flatMap((texture) => texture.texels?.levels.map((level) => level.data) ?? [])]);
  for (const digest of pieces.keys()) if (!named.has(digest)) pieces.delete(digest);
}

/** One picture after the other. */
const next = (work) => { waiting = waiting.then(work, work); return waiting; };

const python = connect((message) => {
  if (message.kind === 'picture') { next(() => show(message)); emitted.renew(); }
  else if (message.kind === 'measured') cost.heard(message);
  else if (message.kind === 'text' || message.kind === 'source') emitted.heard(message);
  else say(message.text);
}, () => {
  say('sssgen preview has ended. Start it again, and open its new address.');
  element('save').disabled = true;
});

/** Another body, which Python reads from the file. */
function useMesh(file) {
  const reason = refusal(file, MESHES, last?.limit ?? 0);
  say(reason);
  if (!reason) python.sendFile({ kind: 'mesh', name: file.name }, file);
}

const cost = new CostBox(element('cost'), (question) => python.send(question));
const emitted = new EmittedText(element('emitted'), (question) => python.send(question));
element('show-text').addEventListener('click', () => emitted.toggle(!emitted.open));
onDrop(document.body, useMesh);
onChoice(element('choose-mesh'), MESHES, useMesh);
element('shape').addEventListener('change', () => python.send({ kind: 'shape', shape: element('shape').value }));
element('environment').addEventListener('change', () => stage?.environment(element('environment').checked));
element('renderer').addEventListener('change', () => next(async () => {
  stage?.dispose();
  stage = null;
  if (last) await show(last);
}));
element('save').addEventListener('click', () => python.send({ kind: 'save', values: Object.fromEntries(panel.values) }));
element('reset').addEventListener('click', () => {
  panel.reset();
  for (const row of last.picture.textures.filter((one) => one.chosen)) slots.chosen(row, null);
});
addEventListener('error', (event) => say(event.message));
addEventListener('unhandledrejection', (event) => say(String(event.reason?.message ?? event.reason)));
globalThis.preview = { get stage() { return stage; }, panel };
