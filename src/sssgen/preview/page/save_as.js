// The dialog that saves a material under another name, in a new folder.

import { dialogOf } from './dialog.js';
import { make } from './elements.js';

export class SaveAs {
  /** `ask` asks which files are there already, `save` writes the copy.
   * @param {{ ask: (question: object) => void, save: (name: string, replace: boolean) => void }} page */
  constructor(page) {
    this.page = page;
    this.replaces = '';  // the name for which it was confirmed that files are replaced
    this.name = make('input', { type: 'text', id: 'save-as-name', spellcheck: false, required: true });
    this.note = make('p', { className: 'about' });
    this.button = make('button', { className: 'main', textContent: 'Save', id: 'save-as-save' });
    const form = make('form', { method: 'dialog' }, make('label', {}, 'Name ', this.name), this.note, make('div', { className: 'settings' }, this.button));
    form.addEventListener('submit', (event) => { event.preventDefault(); this.submit(); });
    this.name.addEventListener('input', () => this.explain());
    this.dialog = dialogOf('save-as-dialog', 'Save as', form);
  }

  /** @param {string} name  of the material as it is now */
  open(name) {
    this.name.value = `my_${name}`;
    this.explain();
    this.dialog.showModal();
    this.name.select();
  }

  explain() {
    this.replaces = '';
    this.button.textContent = 'Save';
    const name = this.name.value.trim();
    this.note.classList.remove('warning');
    this.note.textContent = `Writes the folder ${name}/ where sssgen preview was started: the material, its scene and their files. The preview then follows the copy.`;
  }

  submit() {
    const name = this.name.value.trim();
    if (this.replaces === name) this.save(name, true);
    else this.page.ask({ kind: 'existing', name });
  }

  /** The files that are there already.
   * @param {{ name: string, files: string[] }} answer */
  heard({ name, files }) {
    if (!files.length) { this.save(name, false); return; }
    this.replaces = name;
    this.note.classList.add('warning');
    this.note.textContent = `${name}/ has these files already, with another content: ${files.join(', ')}.`;
    this.button.textContent = 'Replace them';
  }

  /** Shows why Python refuses the name; returns whether the dialog is open.
   * @param {string} reason */
  refuse(reason) {
    if (!this.dialog.open) return false;
    this.note.classList.add('warning');
    this.note.textContent = reason;
    return true;
  }

  /** @param {string} name @param {boolean} replace */
  save(name, replace) {
    this.dialog.close();
    this.page.save(name, replace);
  }
}
