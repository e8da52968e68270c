// The page of `sssgen preview`: it shows what the server sends, and sends back what is to be saved.

import { MESHES, onChoice, onDrop, refusal } from './chosen_files.js';
import { connect } from './connection.js';
import { CostBox } from './cost.js';
import { EmittedText } from './emitted_text.js';
import { Pane } from './pane.js';

const element = (id) => document.getElementById(id);
const pieces = new Map();
const panes = [];
let active = 0;  // the pane whose controls are shown
const newest = [];  // the last picture of each pane
let waiting = Promise.resolve();

const say = (text) => { element('status').textContent = text; };

const page = {
  say,

  /** A piece of the pictures, fetched once while pictures name it. */
  async pieceOf(digest) {
    if (!pieces.has(digest)) pieces.set(digest, await python.piece(digest));
    return pieces.get(digest);
  },

  settings: () => ({ renderer: element('renderer').value, environment: element('environment').checked }),
  fallback(renderer) { element('renderer').value = renderer; },

  changed(pane, property, numbers) {
    pane.stage?.set(property, numbers);
    if (pane === panes[0] && follows()) panes[1].stage?.set(property, numbers);
    buttons();
  },

  looked(pane) { for (const other of panes) if (other !== pane && pane.stage?.orbit) other.follow(pane.stage); },

  texture(pane, row, file) {
    python.sendFile({ kind: 'texture', pane: pane.number, slot: row.property, name: file?.name ?? '' }, file ?? '');
  },
};

/** Whether the second pane has the values of the first: the same material without guards. */
const follows = () => panes.length > 1 && panes[0].last?.beside === 'guards';

const shownPane = () => panes[active] ?? panes[0];

function buttons() {
  const pane = shownPane();
  const reason = pane?.picture?.saves ?? '';
  element('save').disabled = !pane?.changed || Boolean(reason);
  element('saved-in').textContent = reason || (pane?.picture?.saved_in ?? '');
  element('saved-in').hidden = !element('saved-in').textContent;
  element('reset').disabled = !pane?.changed;
}

function complain() {
  const texts = panes.filter((pane) => pane.complaint).map((pane) => (panes.length > 1 ? `${pane.last.label}\n` : '') + pane.complaint);
  element('error').hidden = texts.length === 0;
  element('error').textContent = texts.join('\n\n');
}

/** As many panes as the server shows. */
function fit(count) {
  while (panes.length > count) {
    const pane = panes.pop();
    pane.stop();
    pane.root.remove();
  }
  while (panes.length < count) {
    panes.push(new Pane(page, panes.length));
    element('stage').append(panes.at(-1).root);
  }
  active = Math.min(active, count - 1);
  document.body.classList.toggle('beside', count > 1);
}

/** The lists and the controls of the pane that was chosen. */
function list() {
  const pane = shownPane();
  if (!pane?.last) return;
  const { picture, beside, besides } = pane.last;
  element('title').textContent = picture.title;
  document.title = `${picture.title} · sssgen preview`;
  const name = (shape) => (shape === 'mesh' ? picture.mesh : shape || "the scene's own");
  element('shape').replaceChildren(...picture.shapes.map((shape) => new Option(name(shape), shape)));
  element('shape').value = picture.shape;
  element('shape-note').textContent = picture.note ?? '';
  element('shape-note').hidden = !picture.note;
  element('beside').replaceChildren(...Object.entries(besides).map(([value, text]) => new Option(text, value)));
  element('beside').value = beside;
  for (const id of ['shape-row', 'renderer-row', 'environment-row']) element(id).hidden = Boolean(picture.flat);
  element('tabs').hidden = panes.length < 2;
  element('tabs').replaceChildren(...panes.filter((one) => one.last).map((one) => {
    const tab = Object.assign(document.createElement('button'), { textContent: one.last.label, title: one.last.label });
    tab.setAttribute('role', 'tab');
    tab.setAttribute('aria-selected', String(one === pane));
    tab.addEventListener('click', () => { active = one.number; list(); emitted.renew(); });
    return tab;
  }));
  element('controls').replaceChildren(pane.textures, pane.controls, element('cost'));
  cost.show(picture);
  pane.controls.inert = pane.textures.inert = follows() && pane.number > 0;
  buttons();
}

async function show(message) {
  fit(message.panes);
  const pane = panes[message.pane];
  const failed = pane.show(message, pane.number > 0 && follows() ? panes[0].panel.values : undefined);
  list();
  const reason = await failed;
  pane.complaint = message.error || (reason && `the page cannot draw it: ${reason}`);
  complain();
  if (pane.number > 0) pane.follow(panes[0].stage ?? {});
  if (!reason && pane.number === 0) document.body.dataset.version = message.version;
  const named = new Set(panes.flatMap((one) => one.named));
  for (const digest of pieces.keys()) if (!named.has(digest)) pieces.delete(digest);
}

/** One picture after the other. */
const next = (work) => { waiting = waiting.then(work, work); return waiting; };

const python = connect((message) => {
  if (message.kind === 'picture') {
    newest[message.pane] = message;
    next(() => (message === newest[message.pane] ? show(message) : null));  // what came in between is not drawn
    if (message.pane === active) emitted.renew();
  }
  else if (message.kind === 'measured') cost.heard(message);
  else if (message.kind === 'text' || message.kind === 'source') emitted.heard(message);
  else { say(message.text); list(); }  // what was asked for is not shown
}, () => {
  say('sssgen preview has ended. Start it again, and open its new address.');
  element('save').disabled = true;
});

/** Another body, which Python reads from the file. */
function useMesh(file) {
  const reason = refusal(file, MESHES, shownPane()?.last?.limit ?? 0);
  say(reason);
  if (!reason) python.sendFile({ kind: 'mesh', name: file.name }, file);
}

const cost = new CostBox(element('cost'), (question) => python.send({ ...question, pane: active }));
const emitted = new EmittedText(element('emitted'), (question) => python.send({ ...question, pane: active }));
element('show-text').addEventListener('click', () => emitted.toggle(!emitted.open));
onDrop(document.body, useMesh);
onChoice(element('choose-mesh'), MESHES, useMesh);
element('shape').addEventListener('change', () => python.send({ kind: 'shape', shape: element('shape').value }));
element('beside').addEventListener('change', () => python.send({ kind: 'beside', beside: element('beside').value }));
element('environment').addEventListener('change', () => {
  for (const pane of panes) pane.stage?.environment(element('environment').checked);
});
element('renderer').addEventListener('change', () => next(async () => {
  for (const pane of panes) {
    pane.stop();
    if (pane.last) await show(pane.last);
  }
}));
element('save').addEventListener('click', () => {
  const pane = shownPane();
  python.send({ kind: 'save', pane: pane.number, values: Object.fromEntries(pane.panel.values) });
});
element('reset').addEventListener('click', () => {
  const pane = shownPane();
  pane.panel.reset();
  for (const row of pane.picture.textures.filter((one) => one.chosen)) page.texture(pane, row, null);
});
addEventListener('error', (event) => say(event.message));
addEventListener('unhandledrejection', (event) => say(String(event.reason?.message ?? event.reason)));
globalThis.preview = { panes, get stage() { return panes[0]?.stage; }, get panel() { return panes[0].panel; } };
