// The files: tabs, and a text field over a coloured copy of its text, so that typing, undo and selection are the browser's.

import { colored } from './highlight.js';
import { make } from './preview/elements.js';

/** @typedef {Record<string, string>} Files  Name → text. */
/** @typedef {{ file: string, line: number, column: number, end_line: number, end_column: number }} Diagnostic */

export class Editor {
  /** `changed()` is called for each edit.
   * @param {HTMLElement} tabs @param {HTMLElement} root @param {() => void} changed */
  constructor(tabs, root, changed) {
    this.tabs = tabs;
    this.changed = changed;
    /** @type {Files} */
    this.files = {};
    /** @type {Files} */
    this.first = {};
    this.open = '';
    /** @type {(Diagnostic & { name: string })[]} */
    this.faults = [];
    this.field = make('textarea', { spellcheck: false, autocomplete: 'off', wrap: 'off' });
    this.field.setAttribute('aria-label', 'The text of the file');
    this.copy = make('pre', { ariaHidden: 'true' });
    this.numbers = make('div', { className: 'numbers', ariaHidden: 'true' });
    this.scroll = make('div', { className: 'code' }, make('div', { className: 'sheet' }, this.numbers, this.copy, this.field));
    root.replaceChildren(this.scroll);
    this.field.addEventListener('input', () => this.edited());
    this.field.addEventListener('keydown', (event) => this.key(event));
  }

  /** Shows files (name → text); `first` are the texts that they began with.
   * @param {Files} files @param {Files} first @param {string} open */
  show(files, first, open) {
    Object.assign(this, { files: { ...files }, first, faults: [] });
    this.select(open in files ? open : Object.keys(files)[0]);
  }

  /** @param {string} name */
  select(name) {
    this.open = name;
    this.field.value = this.files[name];
    this.scroll.scrollTop = this.scroll.scrollLeft = 0;
    this.draw();
  }

  edited() {
    this.files[this.open] = this.field.value;
    this.faults = this.faults.filter((fault) => fault.name !== this.open);
    this.draw();
    this.changed();
  }

  /** The places of errors: diagnostics as the language server has them, with the path of the file.
   * @param {Diagnostic[]} diagnostics */
  mark(diagnostics) {
    const before = this.faults.length;
    this.faults = diagnostics.filter((one) => one.line).map((one) => ({ ...one, name: one.file.split('/').at(-1) ?? '' }));
    if (before || this.faults.length) this.draw();
  }

  draw() {
    const text = this.files[this.open];
    const lines = text.split('\n');
    const starts = [0];
    for (const line of lines) starts.push(starts[starts.length - 1] + line.length + 1);
    const at = (/** @type {number} */ line, /** @type {number} */ column) => Math.min((starts[line - 1] ?? text.length) + column - 1, text.length);
    const places = this.faults.filter((fault) => fault.name === this.open)
      .map((fault) => { const from = at(fault.line, fault.column); return [from, Math.max(at(fault.end_line, fault.end_column), from + 1)]; });
    this.copy.innerHTML = `${colored(text, this.open, places)}\n`;
    this.numbers.textContent = lines.map((_, index) => index + 1).join('\n');
    this.tabs.replaceChildren(...Object.keys(this.files).map((name) => {
      const tab = make('button', { textContent: name, onclick: () => this.select(name) });
      tab.setAttribute('aria-selected', String(name === this.open));
      tab.classList.toggle('faulty', this.faults.some((fault) => fault.name === name));
      tab.classList.toggle('changed', this.files[name] !== this.first[name]);
      return tab;
    }));
  }

  /** Tab indents; Escape, then Tab, leaves the field.
   * @param {KeyboardEvent} event */
  key(event) {
    if (event.key === 'Escape') this.field.blur();
    if (event.key !== 'Tab' || event.shiftKey || event.ctrlKey || event.altKey) return;
    event.preventDefault();
    document.execCommand('insertText', false, '    ');  // the only way that keeps the browser's undo
  }
}
