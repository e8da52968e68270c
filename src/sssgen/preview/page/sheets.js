// The parts of the bar below the picture: buttons with an icon, sheets that open above them, rows of a sheet.

import { make } from './elements.js';

/** Lines of icons in a square of 16. */
const ICONS = {
  surroundings: 'M8 1.5a6.5 6.5 0 1 0 0 13a6.5 6.5 0 0 0 0-13M1.8 9.5c4 2 8.4 2 12.4 0M4.5 4.5l1 1M8 3v1.5M11.5 4.5l-1 1',
  ground: 'M1.5 11.5l3-4h7l3 4zM8 8.5m-2.5 0a2.5 1 0 0 0 5 0M8 2a2.5 2.5 0 1 0 0 5a2.5 2.5 0 0 0 0-5',
  lamps: 'M6 11.5c0-2-2-2.5-2-5.2a4 4 0 0 1 8 0c0 2.7-2 3.2-2 5.2zM6.3 14h3.4',
  turntable: 'M13.5 8a5.5 5.5 0 1 1-1.7-4M13.8 1.5v3h-3',
  view: 'M1.3 8c3.6-5.7 9.8-5.7 13.4 0c-3.6 5.7-9.8 5.7-13.4 0M8 6a2 2 0 1 0 0 4a2 2 0 0 0 0-4',
  picture: 'M2 3h12v10H2zM2 11l3.5-3.5l3 3l2-2L14 12M10.5 5.5h.01',
  film: 'M1.5 4h9v8h-9zM10.5 7l4-2.3v6.6l-4-2.3',
};

/** @param {keyof typeof ICONS} name */
function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 16 16');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}

/** @param {keyof typeof ICONS} name @param {string} label @param {string} title */
export function barButton(name, label, title) {
  const button = make('button', { title, className: 'tool', id: `tool-${name}` }, icon(name), make('span', { textContent: label }));
  button.setAttribute('aria-label', label);
  return button;
}

/** A button that opens a sheet; one sheet is open at a time. `changed(open)` is called as it opens or closes.
 * @param {HTMLButtonElement} button @param {HTMLElement} sheet @param {(open: boolean) => void} [changed] */
export function opens(button, sheet, changed = () => {}) {
  sheet.popover = 'auto';  // the browser closes it, by Escape and by a click elsewhere
  sheet.classList.add('sheet');
  sheet.setAttribute('role', 'dialog');
  sheet.setAttribute('aria-label', button.getAttribute('aria-label') ?? '');
  button.popoverTargetElement = sheet;
  sheet.addEventListener('toggle', (event) => {
    const open = /** @type {ToggleEvent} */ (event).newState === 'open';
    button.setAttribute('aria-expanded', String(open));
    changed(open);
    if (!open) return;
    const { left, top } = button.getBoundingClientRect();
    const right = button.closest('main')?.getBoundingClientRect().right ?? innerWidth;
    Object.assign(sheet.style, { left: `${Math.max(8, Math.min(left, right - sheet.offsetWidth - 8))}px`, bottom: `${innerHeight - top + 8}px` });
  });
}

let fields = 0;

/** A row: a label, and what it is of.
 * @param {string} label @param {HTMLElement} field @param {(HTMLElement | string)[]} others */
export function row(label, field, ...others) {
  field.id ||= `field-${++fields}`;
  return make('div', { className: 'row' }, make('label', { textContent: label, htmlFor: field.id }), field, ...others);
}

/** A row with a slider, whose value stands beside it.
 * @param {{ label: string, min: number, max: number, step: number, value: number, unit?: string, id?: string }} settings
 * @param {(value: number) => void} changed */
export function slider({ label, min, max, step, value, unit = '', id = '' }, changed) {
  const shown = make('output');
  const field = make('input', { type: 'range', min, max, step, id });
  const fill = () => { shown.textContent = `${field.value}${unit}`; };
  field.value = String(value);
  field.addEventListener('input', () => { fill(); changed(Number(field.value)); });
  fill();
  return row(label, field, shown);
}

/** A row with a box to tick.
 * @param {string} label @param {boolean} on @param {(on: boolean) => void} changed @param {string} [id] */
export function tick(label, on, changed, id = '') {
  const field = make('input', { type: 'checkbox', checked: on, id });
  field.addEventListener('change', () => changed(field.checked));
  return row(label, field);
}

/** A list of choices: value → text.
 * @param {Record<string, string>} choices @param {string} id */
export function choice(choices, id) {
  return make('select', { id }, ...Object.entries(choices).map(([value, text]) => new Option(text, value)));
}
