// The page: draws a scene with an engine in WebGL 2, and, once its programs are translated, the same draws in WebGPU.

import { record } from 'record';
import { replay } from 'replay';
import { ENGINE, SCENES, draw } from 'scenes';

const SIZE = [256, 192];
const complaints = [];
for (const level of ['error', 'warn']) {
  const print = console[level];
  console[level] = (...parts) => {
    complaints.push(parts.map(String).join(' '));
    print(...parts);
  };
}

let recording;
async function original(name) {
  const canvas = Object.assign(document.createElement('canvas'), { width: SIZE[0], height: SIZE[1] });
  const gl = canvas.getContext('webgl2', { antialias: false, alpha: true, preserveDrawingBuffer: true });
  recording = record(gl);
  await draw(name, canvas, gl);
  const picture = new Uint8Array(SIZE[0] * SIZE[1] * 4);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.readPixels(0, 0, ...SIZE, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  return picture;
}

let device;
async function copied(programs) {
  if (!device) {
    const adapter = await navigator.gpu.requestAdapter();
    const wanted = ['float32-filterable', 'depth32float-stencil8'].filter((feature) => adapter.features.has(feature));
    const { maxInterStageShaderVariables, maxSampledTexturesPerShaderStage, maxSamplersPerShaderStage } = adapter.limits;
    device = await adapter.requestDevice({ requiredFeatures: wanted, requiredLimits: { maxInterStageShaderVariables, maxSampledTexturesPerShaderStage, maxSamplersPerShaderStage } });
    device.onuncapturederror = ({ error }) => complaints.push(error.message);
  }
  return replay(device, recording, programs);
}

const socket = new WebSocket(location.href.replace('http:', 'ws:'));
socket.binaryType = 'arraybuffer';
socket.onclose = () => window.close();
const say = (answer, bytes = new ArrayBuffer(0)) => {
  socket.send(JSON.stringify(answer));
  socket.send(bytes);
};
socket.onopen = () => say({ engine: ENGINE, scenes: Object.keys(SCENES), size: SIZE });
socket.onmessage = async ({ data }) => {
  if (typeof data !== 'string') return;
  const { scene, programs } = JSON.parse(data);
  complaints.length = 0;
  try {
    const picture = scene ? await original(scene) : await copied(programs);
    await device?.queue.onSubmittedWorkDone();
    const facts = scene ? { programs: recording.programs.map(({ vertex, fragment }) => ({ vertex, fragment })), draws: recording.commands.filter(({ kind }) => kind === 'draw').length } : {};
    say({ ...facts, complaints: [...complaints] }, picture.buffer);
  } catch (error) {
    say({ error: `${error.name}: ${error.message}`, stack: error.stack, complaints: [...complaints] });
  }
};
