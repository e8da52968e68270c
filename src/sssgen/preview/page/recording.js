// A turn of the body as frames, each drawn by itself: so that the n-th shows the time n / rate, however long it takes to draw.

import { zipSync } from 'three/addons/libs/fflate.module.js';
import { webmOf } from './webm.js';

const CODECS = ['vp09.00.51.08', 'vp8'];
const BITS = 0.2;  // of a pixel of a frame
const SECONDS_TO_KEY = 1;
const WAITING = 8;  // frames that wait for the encoder

/** @typedef {{ width: number, height: number, rate: number, count: number }} Film */
/** @typedef {{ add(canvas: OffscreenCanvas, index: number): Promise<void>, blob(): Promise<Blob>, name: string }} Writer */

/** Frames as a WebM film, by the browser's encoder; null where it has none for this size. Each frame has its own time.
 * @param {Film} film @returns {Promise<Writer | null>} */
export async function filmWriter({ width, height, rate, count }) {
  const settings = { width, height, framerate: rate, bitrate: Math.round(BITS * width * height * rate) };
  const codec = await codecFor(settings);
  if (!codec) return null;
  /** @type {import('./webm.js').Block[]} */
  const blocks = [];
  /** @type {Error | null} */
  let fault = null;
  const encoder = new VideoEncoder({
    output(chunk) {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      blocks.push({ data, time: chunk.timestamp / 1e6, key: chunk.type === 'key' });
    },
    error(reason) { fault = reason; },
  });
  encoder.configure({ ...settings, codec, latencyMode: 'quality' });
  return {
    name: 'webm',
    async add(canvas, index) {
      if (fault) throw fault;
      const time = (/** @type {number} */ number) => Math.round(1e6 * number / rate);
      const frame = new VideoFrame(canvas, { timestamp: time(index), duration: time(index + 1) - time(index), alpha: 'discard' });
      encoder.encode(frame, { keyFrame: index % Math.round(SECONDS_TO_KEY * rate) === 0 });
      frame.close();
      while (encoder.encodeQueueSize > WAITING && !fault) await new Promise((done) => setTimeout(done, 5));
    },
    async blob() {
      await encoder.flush();
      encoder.close();
      if (fault) throw fault;
      return new Blob([webmOf(blocks, { width, height, rate, count, codec: codec.startsWith('vp09') ? 'V_VP9' : 'V_VP8' })], { type: 'video/webm' });
    },
  };
}

/** @param {{ width: number, height: number, framerate: number, bitrate: number }} settings */
async function codecFor(settings) {
  if (!('VideoEncoder' in globalThis)) return '';
  for (const codec of CODECS) {
    const answer = await VideoEncoder.isConfigSupported({ ...settings, codec }).catch(() => null);
    if (answer?.supported) return codec;
  }
  return '';
}

/** Frames as PNG files in a zip.
 * @returns {Writer} */
export function framesWriter() {
  /** @type {Record<string, Uint8Array>} */
  const files = {};
  return {
    name: 'zip',
    async add(canvas, index) {
      files[`${String(index).padStart(4, '0')}.png`] = new Uint8Array(await (await canvas.convertToBlob()).arrayBuffer());
    },
    async blob() { return new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (zipSync(files, { level: 0 }))], { type: 'application/zip' }); },
  };
}
