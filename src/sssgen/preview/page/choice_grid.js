// A grid of choices with small pictures or colours. It needs no server: the list of presets has all that it shows.

import * as THREE from 'three';
import { make } from './elements.js';

/** @typedef {{ name: string, title?: string, doc: string, color: number[], size_mm?: number, depth_mm?: number }} Choice
 *   `color` is linear. */
/** @typedef {{ sheet: string, presets: Choice[] }} PresetList  As presets/preset_list.py has it: `sheet` is a picture with a square for each. */

/** The style of a linear colour. @param {number[]} color */
export const styleOf = (color) => `#${new THREE.Color().fromArray(color.map((part) => Math.min(Math.max(part, 0), 1))).getHexString()}`;

/** The grid below `root`; `chosen(choice)` is called for a click, and the choice stays marked. */
export class ChoiceGrid {
  /** @param {HTMLElement} root @param {(choice: Choice) => void} chosen */
  constructor(root, chosen) {
    this.root = root;
    this.chosen = chosen;
    root.classList.add('choices');
  }

  /** @param {PresetList} list */
  showPresets({ sheet, presets }) {
    this.show(presets, (picture, index) => {
      const share = presets.length > 1 ? 100 * index / (presets.length - 1) : 0;
      Object.assign(picture.style, { backgroundImage: `url(${sheet})`, backgroundSize: `${100 * presets.length}% 100%`, backgroundPosition: `${share}% 0` });
    });
  }

  /** @param {Choice[]} choices @param {(picture: HTMLElement, index: number) => void} [decorate]  of the square that has the colour */
  show(choices, decorate) {
    this.root.replaceChildren(...choices.map((choice, index) => {
      const picture = make('span', { className: 'picture' });
      picture.style.backgroundColor = styleOf(choice.color);
      decorate?.(picture, index);
      const button = make('button', { className: 'choice', title: choice.doc }, picture, make('span', { textContent: choice.title ?? choice.name }));
      button.dataset.name = choice.name;
      button.addEventListener('click', () => { this.mark(choice.name); this.chosen(choice); });
      return button;
    }));
  }

  /** @param {string} name */
  mark(name) {
    for (const button of this.root.querySelectorAll('button')) button.setAttribute('aria-pressed', String(button.dataset.name === name));
  }
}
