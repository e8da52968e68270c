// Pictures of a stage in a size of their own: drawn in that size, with all triangles and passes, while the page shows the last one.

import * as THREE from 'three';
import { make } from './elements.js';
import { deviceOf } from './renderer.js';

/** @typedef {{ width: number, height: number, transparent: boolean }} Format */

const MOST = 4096;  // texels of a picture's side: float pictures of passes are as large

/** The largest side of a picture that a renderer draws.
 * @param {import('./renderer.js').Renderer} renderer */
export function largestSide(renderer) {
  const device = deviceOf(renderer);
  if (device) return Math.min(MOST, device.limits.maxTextureDimension2D);
  const gl = /** @type {WebGL2RenderingContext} */ (renderer.getContext());
  return Math.min(MOST, ...[gl.MAX_TEXTURE_SIZE, gl.MAX_RENDERBUFFER_SIZE].map((name) => gl.getParameter(name)), ...gl.getParameter(gl.MAX_VIEWPORT_DIMS));
}

/** A stage that draws in another size, from `start()` to `end()`. */
export class Offscreen {
  /** @param {import('./stage.js').Stage} stage @param {Format} format */
  constructor(stage, format) {
    this.stage = stage;
    this.format = format;
    this.canvas = new OffscreenCanvas(format.width, format.height);
    this.cover = make('canvas', { className: 'cover' });
    this.angle = stage.angle;
  }

  async start() {
    const { stage, cover, format: { width, height, transparent } } = this;
    await stage.drafts.hold();
    const shown = stage.renderer.domElement;
    Object.assign(cover, { width: shown.width, height: shown.height });
    stage.frame();
    cover.getContext('2d')?.drawImage(shown, 0, 0);
    stage.root.append(cover);
    this.background = stage.scene.background;
    if (transparent) stage.scene.background = null;
    stage.size(width, height);
    stage.renderer.setPixelRatio(1);
    stage.mesh.geometry = stage.bodies[0];
    const { width: drawn, height: high } = stage.renderer.getDrawingBufferSize(new THREE.Vector2());
    if (shown.width !== width || shown.height !== height || drawn !== width || high !== height) {
      this.end();
      throw new Error(`this browser does not draw ${width} × ${height} pixels`);
    }
  }

  /** The picture with the body turned by an angle more, in radians. The canvas is that of all frames.
   * @param {number} angle */
  frame(angle = 0) {
    const { stage, canvas, format: { width, height, transparent } } = this;
    const context = canvas.getContext('2d');
    if (!context) throw new Error('this browser has no canvas for the picture');
    stage.turn(this.angle + angle);
    stage.frame(false);
    context.clearRect(0, 0, width, height);
    if (!transparent) {
      const shades = context.createLinearGradient(0, height, 0, 0);
      stage.shades.forEach((style, index, all) => shades.addColorStop(index / Math.max(all.length - 1, 1), style));
      context.fillStyle = shades;
      context.fillRect(0, 0, width, height);
    }
    context.drawImage(stage.renderer.domElement, 0, 0);  // in the same task: afterwards the browser clears it
    return canvas;
  }

  end() {
    const { stage, cover } = this;
    stage.turn(this.angle);
    stage.scene.background = this.background ?? null;
    stage.drafts.release();
    stage.fit();
    cover.remove();
  }
}
