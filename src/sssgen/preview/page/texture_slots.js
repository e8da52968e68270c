// The texture slots of a material: a thumbnail each, and a picture of the user's in its place.

import * as THREE from 'three';
import { PICTURES, onChoice, onDrop, refusal } from './chosen_files.js';
import { make } from './elements.js';

const SIDE = 36;

/** @typedef {import('../page_messages.js').Slot} Slot */

/** The slots below `root`; `chosen(row, file)` is called with a file, or with null for the material's own. */
export class TextureSlots {
  /** @param {HTMLElement} root @param {import('../page_messages.js').PieceOf} pieceOf
   * @param {(row: Slot, file: File | null) => void} chosen @param {(text: string) => void} complain */
  constructor(root, pieceOf, chosen, complain) {
    this.root = root;
    this.pieceOf = pieceOf;
    this.chosen = chosen;
    this.complain = complain;
  }

  /** @param {Slot[]} textures @param {number} limit  of a file, in bytes */
  show(textures, limit) {
    const rows = textures.filter((row) => !row.page_draws);
    this.root.replaceChildren(...(rows.length ? [make('h2', { textContent: 'textures' })] : []), ...rows.map((row) => this.row(row, limit)));
  }

  /** @param {Slot} row @param {number} limit */
  row(row, limit) {
    const takes = row.type === 'sampler2D';
    const size = row.texels ? row.texels.levels[0].size.join(' × ') : 'none';
    const element = make('div', { className: 'row slot', title: `${row.doc} (${row.technique})` });
    element.dataset.property = row.property;
    element.classList.toggle('changed', Boolean(row.chosen));
    const label = make('label', { textContent: row.source_name.replaceAll('_', ' ') });
    const what = make('span', { className: 'file', textContent: row.chosen || size, title: row.chosen ? size : '' });
    element.append(label, make('span', { className: 'vector' }, ...(takes ? [this.button(row, element, limit)] : []), what));
    const undo = make('button', { className: 'undo', textContent: '↺', title: "the material's own" });
    undo.addEventListener('click', () => this.chosen(row, null));
    element.append(undo);
    return element;
  }

  /** @param {Slot} row @param {HTMLElement} element @param {number} limit */
  button(row, element, limit) {
    const canvas = make('canvas', { width: SIDE, height: SIDE });
    const button = make('button', { className: 'thumbnail', title: 'Choose a PNG, JPEG or EXR, or drop one here' }, canvas);
    const use = (/** @type {File} */ file) => {
      const reason = refusal(file, PICTURES, limit);
      this.complain(reason);
      if (!reason) this.chosen(row, file);
    };
    queueMicrotask(() => onChoice(button, PICTURES, use));
    onDrop(element, use);
    if (row.texels) this.draw(canvas, row.texels, row.color);
    else { button.textContent = '+'; button.classList.add('empty'); }
    return button;
  }

  /** The picture in small, from the level that is just larger.
   * @param {HTMLCanvasElement} canvas @param {import('../page_messages.js').Texels} texels @param {boolean} encoded */
  async draw(canvas, { levels }, encoded) {
    const level = levels.findLast(({ size }) => Math.min(...size) >= SIDE) ?? levels[0];
    const [width, height] = level.size;
    const texels = new Uint16Array(await this.pieceOf(level.data));
    const image = new ImageData(SIDE, SIDE);
    const color = new THREE.Color();
    for (let y = 0; y < SIDE; y++) {
      for (let x = 0; x < SIDE; x++) {
        const from = 4 * (Math.floor((SIDE - 0.5 - y) * height / SIDE) * width + Math.floor((x + 0.5) * width / SIDE));
        const [r, g, b] = [0, 1, 2].map((channel) => THREE.DataUtils.fromHalfFloat(texels[from + channel]));
        color.setRGB(r, g, b);
        if (encoded) color.convertLinearToSRGB();
        image.data.set([255 * color.r, 255 * color.g, 255 * color.b, 255], 4 * (y * SIDE + x));
      }
    }
    canvas.getContext('2d')?.putImageData(image, 0, 0);
  }
}
