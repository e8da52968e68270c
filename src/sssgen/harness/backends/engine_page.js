// What the pages of all engines share: plans come through a WebSocket, and pictures go back. The engine's own script is in
// front of this one; it has `VERSION` and `async function draw(plan, piece)`, which returns the floats.
//
// A message pair each way: a text of JSON, then bytes. In a plan, `{at, size}` stands for a piece of its bytes. When the
// connection ends, the page closes, and with it the browser.

const complaints = [];
for (const level of ['error', 'warn']) {
  const print = console[level];
  console[level] = (...parts) => {
    complaints.push(parts.map(String).join(' '));
    print(...parts);
  };
}

addEventListener('unhandledrejection', ({ reason }) => complaints.push(`${reason?.stack ?? reason}`));

// Without a GPU, Chromium loses the device when a canvas with WebGPU is shown: a texture stands in for it.
if (globalThis.GPUCanvasContext) {
  GPUCanvasContext.prototype.configure = function (configuration) {
    this.configuration = configuration;
  };
  GPUCanvasContext.prototype.getCurrentTexture = function () {
    const { device, format, usage = GPUTextureUsage.RENDER_ATTACHMENT } = this.configuration;
    this.shown ??= device.createTexture({ size: [this.canvas.width, this.canvas.height], format, usage });
    return this.shown;
  };
}

// The picture of a plan: its rows are `stride` bytes apart.
async function drawn(plan, piece) {
  complaints.length = 0;
  const start = performance.now();
  const pixels = await draw(plan, piece);
  const drew = (performance.now() - start) / 1000;
  return [{ stride: pixels.byteLength / plan.height, drew, complaints: [...complaints] }, pixels.slice().buffer];
}

const urlOf = (text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
const runtimes = new Map(); // text → URL: all materials import the same one

// The first of some modules (file name → text), which imports the others.
async function imported(modules) {
  let [text] = Object.values(modules);
  for (const [name, runtime] of Object.entries(modules).slice(1)) {
    if (!runtimes.has(runtime)) runtimes.set(runtime, urlOf(runtime));
    text = text.replace(`'./${name}'`, `'${runtimes.get(runtime)}'`);
  }
  const url = urlOf(text);
  const module = await import(url);
  URL.revokeObjectURL(url);
  return module;
}

const floats = (bytes) => new Float32Array(bytes.slice().buffer);
const indices = (bytes) => new Uint32Array(bytes.slice().buffer);
const halves = (bytes) => new Uint16Array(bytes.slice().buffer);

const socket = new WebSocket(location.href.replace('http:', 'ws:'));
socket.binaryType = 'arraybuffer';
socket.onclose = () => window.close();

function say(answer, bytes = new ArrayBuffer(0)) {
  socket.send(JSON.stringify(answer));
  socket.send(bytes);
}

let plan;
socket.onmessage = async ({ data }) => {
  if (typeof data === 'string') {
    plan = JSON.parse(data);
    return;
  }
  const bytes = new Uint8Array(data);
  try {
    say(...(await drawn(plan, ({ at, size }) => bytes.subarray(at, at + size))));
  } catch (error) {
    say({ error: `${error.name}: ${error.message}`, complaints: [...complaints], stack: error.stack });
  }
};
socket.onopen = () => say({ version: VERSION });
