// Dialogs above the page.

import { make } from './elements.js';

/** A dialog with a title; Escape, its cross and a click beside it close it.
 * @param {string} id @param {string} title @param {(Node | string)[]} content */
export function dialogOf(id, title, ...content) {
  const cross = make('button', { className: 'cross', textContent: '✕', title: 'Close' });
  const dialog = make('dialog', { id }, make('header', {}, make('h2', { textContent: title }), cross), ...content);
  cross.addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => { if (event.target === dialog) dialog.close(); });
  document.body.append(dialog);
  return dialog;
}
