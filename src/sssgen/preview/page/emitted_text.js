// The panel with the emitted text of a target: changed lines are marked, and each line has its source.

import { make } from './elements.js';

/** The numbers of the lines, from 0, that a text has and the one before it had not: those outside a common subsequence.
 * @param {string[]} before @param {string[]} after */
export function changedLines(before, after) {
  let from = 0;
  while (from < before.length && from < after.length && before[from] === after[from]) from += 1;
  let [old, end] = [before.length, after.length];
  while (old > from && end > from && before[old - 1] === after[end - 1]) { old -= 1; end -= 1; }
  const [rows, columns] = [old - from, end - from];
  const all = Array.from({ length: columns }, (_, index) => from + index);
  if (rows * columns > 4e6) return new Set(all);
  const width = columns + 1;
  const common = new Uint16Array((rows + 1) * width);
  for (let row = rows - 1; row >= 0; row--) {
    for (let column = columns - 1; column >= 0; column--) {
      common[row * width + column] = before[from + row] === after[from + column]
        ? common[(row + 1) * width + column + 1] + 1
        : Math.max(common[(row + 1) * width + column], common[row * width + column + 1]);
    }
  }
  const changed = new Set(all);
  for (let row = 0, column = 0; row < rows && column < columns;) {
    if (before[from + row] === after[from + column]) { changed.delete(from + column); row += 1; column += 1; }
    else if (common[(row + 1) * width + column] >= common[row * width + column + 1]) row += 1;
    else column += 1;
  }
  return changed;
}

/** `file:line:column` in parts; null for ''. */
const placeOf = (/** @type {string} */ span) => {
  const parts = /^(.*):(\d+):\d+$/.exec(span);
  return parts && { name: parts[1], line: Number(parts[2]) };
};

/** The panel; `ask` sends a question to Python. */
export class EmittedText {
  /** @type {import('../page_messages.js').TextMessage} */
  message;  // the last one
  /** @type {{ name: string, line: number } | null} */
  goal = null;  // the source that was asked for

  /** @param {HTMLElement} root @param {(question: object) => void} ask */
  constructor(root, ask) {
    this.root = root;
    this.ask = ask;
    /** @type {Map<string, string[]>} */
    this.before = new Map();  // form and file → lines
    /** @type {Map<string, Set<number>>} */
    this.changed = new Map();  // form and file → numbers of lines, from 0
    this.target = make('select', { id: 'text-target', title: 'the target' });
    this.form = make('select', { id: 'text-form' }, new Option('whole shader', 'shader'), new Option('functions', 'functions'));
    this.file = make('select', { id: 'text-file', title: 'the file' });
    this.copy = make('button', { id: 'text-copy', textContent: 'Copy', onclick: () => this.copied() });
    this.lines = make('div', { className: 'lines', id: 'text-lines' });
    this.source = make('div', { className: 'source', id: 'text-source', hidden: true });
    this.target.addEventListener('change', () => this.renew());
    this.form.addEventListener('change', () => this.renew());
    this.file.addEventListener('change', () => this.draw());
    root.append(make('div', { className: 'row' }, this.target, this.form, this.file, this.copy), this.lines, this.source);
  }

  get open() { return !this.root.hidden; }

  /** @param {boolean} open */
  toggle(open) {
    this.root.hidden = !open;
    this.before.clear();
    if (open) this.renew();
  }

  /** Asks for the text again: at the start, for another target, and after each new picture. */
  renew() {
    if (this.open) this.ask({ kind: 'text', target: this.target.value, form: this.form.value });
  }

  /** An answer of Python.
   * @param {import('../page_messages.js').TextMessage | import('../page_messages.js').SourceMessage} message */
  heard(message) {
    if (message.kind === 'source') this.showSource(message);
    else this.show(message);
  }

  /** @param {import('../page_messages.js').TextMessage} message */
  show(message) {
    this.message = message;
    this.target.replaceChildren(...message.targets.map((name) => new Option(name, name)));
    this.target.value = message.target;
    const chosen = this.file.value;
    this.file.replaceChildren(...message.files.map(({ name }) => new Option(name, name)));
    if (message.files.some(({ name }) => name === chosen)) this.file.value = chosen;
    this.file.hidden = message.files.length < 2;
    for (const { name, text } of message.files) {
      const [key, lines] = [`${message.form} ${name}`, text.split('\n')];
      const before = this.before.get(key);
      if (before?.join('\n') === text) continue;  // the marks of the last change stay
      this.changed.set(key, before ? changedLines(before, lines) : new Set());
      this.before.set(key, lines);
    }
    this.draw();
  }

  /** The lines of the chosen file. */
  draw() {
    const { error, files } = this.message;
    const file = files.find(({ name }) => name === this.file.value);
    this.copy.disabled = !file;
    if (!file) { this.lines.replaceChildren(make('pre', { className: 'note', textContent: error })); return; }
    let last = '';
    const changed = this.changed.get(`${this.message.form} ${file.name}`);
    this.lines.replaceChildren(...file.text.replace(/\n$/, '').split('\n').map((text, index) => {
      const span = file.sources[index + 1] ?? '';
      const place = placeOf(span);
      const named = place ? `${place.name.split('/').pop()}:${place.line}` : '';
      const link = make('a', { className: 'from', textContent: named === last ? '' : named, title: span });
      if (named) last = named;
      const row = make('div', { className: changed?.has(index) ? 'line new' : 'line' }, make('span', { className: 'number', textContent: index + 1 }), make('code', { textContent: text }), link);
      if (place) row.addEventListener('click', () => this.follow(row, place));
      row.classList.toggle('linked', Boolean(place));
      return row;
    }));
    this.lines.querySelector('.new')?.scrollIntoView({ block: 'center' });
  }

  /** Asks for the source of a line.
   * @param {HTMLElement} row @param {{ name: string, line: number }} place */
  follow(row, place) {
    if (getSelection()?.toString()) return;
    this.lines.querySelector('.chosen')?.classList.remove('chosen');
    row.classList.add('chosen');
    this.goal = place;
    this.ask({ kind: 'source', name: place.name });
  }

  /** @param {import('../page_messages.js').SourceMessage} message */
  showSource({ name, text, note }) {
    if (name !== this.goal?.name) return;
    const { line: number } = this.goal;
    const head = make('div', { className: 'row' }, make('strong', { textContent: note ? name : `${name}:${number}` }),
      make('button', { textContent: '×', title: 'close', onclick: () => { this.source.hidden = true; } }));
    const lines = note ? [make('pre', { className: 'note', textContent: note })] : text.replace(/\n$/, '').split('\n').map((line, index) => make('div', { className: index + 1 === number ? 'line chosen' : 'line' },
      make('span', { className: 'number', textContent: index + 1 }), make('code', { textContent: line })));
    this.source.replaceChildren(head, ...lines);
    this.source.hidden = false;
    this.source.querySelector('.chosen')?.scrollIntoView({ block: 'center' });
  }

  async copied() {
    const file = this.message.files.find(({ name }) => name === this.file.value);
    if (!file) return;
    await navigator.clipboard.writeText(file.text);
    this.copy.textContent = 'Copied';
    setTimeout(() => { this.copy.textContent = 'Copy'; }, 1500);
  }
}
