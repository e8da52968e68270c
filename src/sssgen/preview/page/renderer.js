// The renderers of three.js.

import * as THREE from 'three';
import { WebGPURenderer } from 'three/webgpu';

/** @typedef {THREE.WebGLRenderer | WebGPURenderer} Renderer */

/** Asked for at once: a browser takes long to answer. */
const adapter = navigator.gpu?.requestAdapter().catch(() => null);

/** A renderer that has started: `webgl` (WebGLRenderer), `webgpu`, or `webgl2`, which is WebGPURenderer without WebGPU.
 * @param {string} kind @param {HTMLCanvasElement} canvas @returns {Promise<Renderer>} */
export async function rendererOf(kind, canvas) {
  const options = { canvas, antialias: true, alpha: true };
  if (kind === 'webgl') return new THREE.WebGLRenderer(options);
  if (kind === 'webgpu' && !await adapter) throw new Error('this browser has no WebGPU adapter');
  const renderer = new WebGPURenderer({ ...options, forceWebGL: kind === 'webgl2' });
  await renderer.init();
  if (kind === 'webgpu' && !deviceOf(renderer)) throw new Error('this browser has no WebGPU adapter');
  return renderer;
}

/** The device of WebGPU; null where WebGL draws.
 * @param {Renderer} renderer @returns {GPUDevice | null} */
export function deviceOf(renderer) {
  const backend = renderer instanceof WebGPURenderer ? renderer.backend : null;
  return backend && 'device' in backend ? /** @type {GPUDevice} */ (backend.device) : null;
}
