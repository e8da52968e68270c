// Files from the user's disk: dropped on the page or chosen by a button.

import { make } from './elements.js';

export const MESHES = ['.glb', '.obj', '.ply', '.stl'];
export const PICTURES = ['.png', '.jpg', '.jpeg', '.exr'];

export const suffixOf = (/** @type {File} */ file) => (/\.[^.]+$/.exec(file.name)?.[0] ?? '').toLowerCase();

/** Calls `chosen(file)` for a file that the user picks after a click on the button.
 * @param {HTMLButtonElement} button @param {string[]} suffixes @param {(file: File) => void} chosen */
export function onChoice(button, suffixes, chosen) {
  const field = make('input', { type: 'file', accept: suffixes.join(','), hidden: true });
  field.addEventListener('change', () => { if (field.files?.[0]) chosen(field.files[0]); field.value = ''; });
  button.addEventListener('click', () => field.click());
  button.after(field);
}

/** Calls `chosen(file)` for a file that is dropped on the element, which is marked while one is held above it.
 * @param {HTMLElement} element @param {(file: File) => void} chosen */
export function onDrop(element, chosen) {
  const holds = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes('Files');
  for (const kind of /** @type {const} */ (['dragenter', 'dragover'])) element.addEventListener(kind, (event) => {
    if (!holds(event)) return;
    event.preventDefault();
    event.stopPropagation();
    element.classList.add('target');
  });
  element.addEventListener('dragleave', (event) => {
    if (!element.contains(/** @type {Node | null} */ (event.relatedTarget))) element.classList.remove('target');
  });
  element.addEventListener('drop', (event) => {
    if (!holds(event)) return;
    event.preventDefault();
    event.stopPropagation();
    element.classList.remove('target');
    document.body.classList.remove('target');
    if (event.dataTransfer?.files[0]) chosen(event.dataTransfer.files[0]);
  });
}

/** The reason why a file cannot be used, or ''; `limit` is in bytes.
 * @param {File} file @param {string[]} suffixes @param {number} limit */
export function refusal(file, suffixes, limit) {
  if (!suffixes.includes(suffixOf(file))) return `${file.name}: only ${suffixes.join(', ')} can be used here.`;
  if (file.size > limit) return `${file.name} has ${Math.ceil(file.size / 2 ** 20)} MiB; at most ${limit / 2 ** 20} MiB are read.`;
  return '';
}
