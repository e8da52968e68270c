// The emitted text of a target, its lines that an edit has changed marked.

import { colored } from './highlight.js';
import { make } from './preview/elements.js';
import { changedLines } from './preview/emitted_text.js';

/** @typedef {import('./editor.js').Files} Files */

export class EmittedText {
  /** @param {HTMLElement} parts @param {HTMLElement} root */
  constructor(parts, root) {
    this.parts = parts;
    this.root = root;
    /** @type {Files} */
    this.files = {};
    /** @type {Files} */
    this.before = {};
    this.open = '';
    this.refused = '';
  }

  /** Shows files (name → text), or why there are none. With `compared`, lines that were not there are marked.
   * @param {Files} files @param {string} refused @param {boolean} compared */
  show(files, refused, compared) {
    if (Object.keys(files).length) {
      const same = JSON.stringify(files) === JSON.stringify(this.files);  // an edit of a comment keeps the marks
      if (!compared) this.before = {}; else if (!same) this.before = this.files;
      this.files = files;
    }
    const names = Object.keys(this.files);
    const reflection = (/** @type {string} */ name) => name.endsWith('.reflection.json');
    if (!names.includes(this.open)) {
      const texts = names.filter((name) => !reflection(name));
      this.open = texts.sort((one, other) => this.files[other].length - this.files[one].length)[0] ?? '';  // the fragment shader
    }
    this.refused = refused;
    this.draw();
  }

  draw() {
    this.root.classList.toggle('refused', Boolean(this.refused));
    this.parts.replaceChildren(...(this.refused ? [] : Object.keys(this.files)).map((name) => {
      const tab = make('button', { textContent: name.endsWith('.reflection.json') ? 'reflection' : name });
      tab.setAttribute('aria-selected', String(name === this.open));
      tab.addEventListener('click', () => { this.open = name; this.draw(); });
      return tab;
    }));
    if (this.refused) { this.root.textContent = this.refused; return; }
    const text = this.files[this.open] ?? '';
    const lines = text.replace(/\n$/, '').split('\n');
    const old = this.before[this.open];
    const marked = old === undefined ? new Set() : changedLines(old.split('\n'), lines);
    const html = colored(text.replace(/\n$/, ''), this.open).split('\n');
    let left = '';  // a comment over several lines is closed at the end of each, and opened again
    this.root.innerHTML = html.map((line, index) => {
      const whole = left + line;
      const opened = whole.lastIndexOf('<span');
      left = opened > whole.lastIndexOf('</span>') ? whole.slice(opened, whole.indexOf('>', opened) + 1) : '';
      return `<span class="line${marked.has(index) ? ' new' : ''}">${whole}${left ? '</span>' : ''}</span>`;
    }).join('');
  }

  get text() { return this.files[this.open] ?? ''; }
}
