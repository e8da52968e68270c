// The page of `sssgen preview`: it shows what the server sends, and sends back what is to be saved.

import { Chain } from './chain.js';
import { MESHES, onChoice, onDrop, refusal } from './chosen_files.js';
import { connect } from './connection.js';
import { CostBox } from './cost.js';
import { box, button, list, make } from './elements.js';
import { EmittedText } from './emitted_text.js';
import { FrameWatch } from './frame_time.js';
import { Menus } from './menus.js';
import { Pane } from './pane.js';
import { SaveAs } from './save_as.js';
import { Stage } from './stage.js';
import { StageBar } from './stage_bar.js';

/** @typedef {import('../page_messages.js').PictureMessage} PictureMessage */

const [renderer, shape, beside] = [list('renderer'), list('shape'), list('beside')];
const [save, saveAs, reset, undo] = [button('save'), button('save-as'), button('reset'), button('undo')];
/** @type {Map<string, ArrayBuffer>} */
const pieces = new Map();  // by their digests
/** @type {Pane[]} */
const panes = [];
let active = 0;  // the pane whose controls are shown
/** @type {PictureMessage[]} */
const newest = [];  // the last picture of each pane
/** @type {Promise<unknown>} */
let waiting = Promise.resolve();

const say = (/** @type {string} */ text) => { box('status').textContent = text; };

/** @type {import('./pane.js').Page} */
const page = {
  say,

  /** A piece of the pictures, fetched once while pictures name it. */
  async pieceOf(digest) {
    const piece = pieces.get(digest) ?? await python.piece(digest);
    pieces.set(digest, piece);
    return piece;
  },

  settings: () => ({ renderer: renderer.value, arranged: bar.settings }),
  fallback(kind) { renderer.value = kind; },

  changed(pane, property, numbers) {
    pane.stage?.set(property, numbers);
    if (pane === panes[0] && follows()) panes[1].stage?.set(property, numbers);
    enable();
  },

  looked(pane) { for (const other of panes) if (other !== pane && pane.stage?.orbit) other.follow(pane.stage); },

  texture(pane, row, file) {
    python.sendFile({ kind: 'texture', pane: pane.number, slot: row.property, name: file?.name ?? '' }, file ?? '');
  },
};

/** Whether the second pane has the values of the first: the same material without guards. */
const follows = () => panes.length > 1 && panes[0].last?.beside === 'guards';

/** The stage of a pane that shows a body. @param {Pane} [pane] */
const stageOf = (pane) => (pane?.stage instanceof Stage && pane.stage.mesh ? pane.stage : null);

const bar = new StageBar(box('stage-bar'), {
  stages: () => panes.flatMap((pane) => stageOf(pane) ?? []),
  shown: () => stageOf(shownPane()),
  say,
  save: (lights) => python.send({ kind: 'lights', pane: shownPane().number, lights }),
});

const shownPane = () => panes[active] ?? panes[0];

/** Whether there is something to save, and to undo. Where the file is not the user's, Save offers a copy. */
function enable() {
  const pane = shownPane();
  const [reason, copies] = [pane?.picture?.saves ?? '', Boolean(pane?.picture?.copies)];
  save.disabled = !pane?.changed || Boolean(reason && !copies);
  save.textContent = reason && copies ? 'Save…' : 'Save';
  saveAs.disabled = !copies;
  undo.disabled = !pane?.last?.undoes;
  undo.title = pane?.last?.undoes ? `Take back the last change of ${pane.last.undoes}` : 'Nothing was written';
  box('saved-in').textContent = reason && copies ? 'This comes with sssgen and stays as it is: Save makes a copy of your own.' : reason || (pane?.picture?.saved_in ?? '');
  box('saved-in').title = reason;
  box('saved-in').hidden = !box('saved-in').textContent;
  reset.disabled = !pane?.changed;
}

function complain() {
  const texts = panes.filter((pane) => pane.complaint).map((pane) => (panes.length > 1 ? `${pane.last?.label}\n` : '') + pane.complaint);
  box('error').hidden = texts.length === 0;
  box('error').textContent = texts.join('\n\n');
}

/** As many panes as the server shows.
 * @param {number} count */
function fit(count) {
  while (panes.length > count) {
    const pane = panes.pop();
    pane?.stop();
    pane?.root.remove();
  }
  while (panes.length < count) {
    const pane = new Pane(page, panes.length);
    panes.push(pane);
    box('stage').append(pane.root);
  }
  active = Math.min(active, count - 1);
  document.body.classList.toggle('beside', count > 1);
}

/** The lists and the controls of the pane that was chosen. */
function fill() {
  const pane = shownPane();
  if (!pane?.last) return;
  const { picture, besides } = pane.last;
  box('title').textContent = picture.title;
  document.title = `${picture.title} · sssgen preview`;
  const name = (/** @type {string} */ one) => (one === 'mesh' ? picture.mesh : one || "the scene's own");
  shape.replaceChildren(...picture.shapes.map((one) => new Option(name(one), one)));
  shape.value = picture.shape;
  box('shape-note').textContent = picture.note ?? '';
  box('shape-note').hidden = !picture.note;
  box('warnings').replaceChildren(...(picture.warnings ?? []).map((text) => make('li', { textContent: text })));
  box('warnings').hidden = !picture.warnings?.length;
  chain.show(pane.last.stages);
  for (const id of ['open-presets', 'open-media']) button(id).disabled = !picture.copies;
  beside.replaceChildren(...Object.entries(besides).map(([value, text]) => new Option(text, value)));
  beside.value = pane.last.beside;
  for (const id of ['shape-row', 'renderer-row']) box(id).hidden = Boolean(picture.flat);
  box('tabs').hidden = panes.length < 2;
  box('tabs').replaceChildren(...panes.filter((one) => one.last).map((one) => {
    const label = one.last?.label;
    const tab = make('button', { textContent: label, title: label });
    tab.setAttribute('role', 'tab');
    tab.setAttribute('aria-selected', String(one === pane));
    tab.addEventListener('click', () => { active = one.number; fill(); emitted.renew(); });
    return tab;
  }));
  box('controls').replaceChildren(box('chain'), pane.controls, pane.textures, box('cost'));
  cost.show(picture);
  pane.controls.inert = pane.textures.inert = follows() && pane.number > 0;
  enable();
}

/** @param {PictureMessage} message */
async function show(message) {
  fit(message.panes);
  const pane = panes[message.pane];
  const failed = pane.show(message, pane.number > 0 && follows() ? panes[0].panel.values : undefined);
  fill();
  const reason = await failed;
  pane.complaint = message.error || (reason && `the page cannot draw it: ${reason}`);
  complain();
  if (pane.number > 0) pane.follow(panes[0].stage);
  bar.show(stageOf(shownPane()));
  if (!reason && pane.number === 0) document.body.dataset.version = String(message.version);
  const named = new Set(panes.flatMap((one) => one.named));
  for (const digest of pieces.keys()) if (!named.has(digest)) pieces.delete(digest);
}

/** One picture after the other. */
const next = (/** @type {() => unknown} */ work) => { waiting = waiting.then(work, work); return waiting; };

next(() => { fit(1); return panes[0].prepare(); });

const python = connect((message) => {
  if (message.kind === 'picture') {
    newest[message.pane] = message;
    next(() => (message === newest[message.pane] ? show(message) : null));  // what came in between is not drawn
    if (message.pane === active) emitted.renew();
  }
  else if (message.kind === 'measured') cost.heard(message);
  else if (message.kind === 'existing') copying.heard(message);
  else if (menus.heard(message) || (message.kind === 'error' && copying.refuse(message.text))) return;
  else if (message.kind === 'text' || message.kind === 'source') emitted.heard(message);
  else { say(message.text); fill(); }  // what was asked for is not shown
}, () => {
  say('sssgen preview has ended. Start it again, and open its new address.');
  save.disabled = true;
});

/** Another body, which Python reads from the file.
 * @param {File} file */
function useMesh(file) {
  const reason = refusal(file, MESHES, shownPane()?.last?.limit ?? 0);
  say(reason);
  if (!reason) python.sendFile({ kind: 'mesh', name: file.name }, file);
}

const cost = new CostBox(box('cost'), box('facts'), (question) => python.send({ ...question, pane: active }));
/** A change of the file; where the file comes with sssgen, a copy is offered first.
 * @param {object} change */
function edit(change) {
  const pane = shownPane();
  if (pane.picture?.saves) copying.open(pane.picture.name);
  else python.send({ kind: 'edit', pane: pane.number, ...change });
}

/** What was changed by hand, for a message that saves it.
 * @param {Pane} pane */
const changes = (pane) => ({ pane: pane.number, values: Object.fromEntries(pane.panel.values), look: Object.fromEntries(pane.panel.look) });

const copying = new SaveAs({
  ask: (question) => python.send({ ...question, pane: shownPane().number }),
  save: (name, replace) => python.send({ kind: 'save_as', name, replace, ...changes(shownPane()) }),
});
const menus = new Menus({
  ask: (question) => python.send({ ...question, pane: shownPane().number }),
  edit,
  use(parameters, name) {
    const used = shownPane().panel.use(parameters);
    say(used ? `The medium is ${name}. Save writes it.` : 'No technique of this material has a medium.');
  },
});
const chain = new Chain(box('chain'), {
  add: () => menus.openTechniques(null),
  replace: (stage) => menus.openTechniques(stage),
  remove: (stage) => edit({ action: 'remove', path: stage.path }),
});
const frames = new FrameWatch(() => {
  const { stage } = shownPane() ?? {};
  return stage instanceof Stage ? stage : null;
}, (time, size) => cost.frame(time, size));
cost.measure = () => frames.measure();
const emitted = new EmittedText(box('emitted'), (question) => python.send({ ...question, pane: active }));
button('show-text').addEventListener('click', () => emitted.toggle(!emitted.open));
onDrop(document.body, (file) => (bar.takes(file) ? bar.useFile(file) : useMesh(file)));
onChoice(button('choose-mesh'), MESHES, useMesh);
shape.addEventListener('change', () => python.send({ kind: 'shape', shape: shape.value }));
beside.addEventListener('change', () => python.send({ kind: 'beside', beside: beside.value }));
renderer.addEventListener('change', () => next(async () => {
  for (const pane of panes) {
    pane.stop();
    if (pane.last) await show(pane.last);
  }
}));
save.addEventListener('click', () => {
  const pane = shownPane();
  if (pane.picture?.saves) copying.open(pane.picture.name);
  else python.send({ kind: 'save', ...changes(pane) });
});
saveAs.addEventListener('click', () => copying.open(shownPane().picture?.name ?? 'material'));
undo.addEventListener('click', () => python.send({ kind: 'undo', pane: shownPane().number }));
button('open-presets').addEventListener('click', () => menus.open(menus.presets));
button('open-media').addEventListener('click', () => menus.open(menus.media));
reset.addEventListener('click', () => {
  const pane = shownPane();
  pane.panel.reset();
  for (const row of pane.picture?.textures ?? []) if (row.chosen) page.texture(pane, row, null);
});
addEventListener('error', (event) => say(event.message));
addEventListener('unhandledrejection', (event) => say(String(event.reason?.message ?? event.reason)));
globalThis.preview = { panes, bar, get stage() { return panes[0]?.stage; }, get panel() { return panes[0].panel; } };
