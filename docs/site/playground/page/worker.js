// Python in a thread of its own: it starts Pyodide, and answers one request after the other.

import { loadPyodide } from './python/pyodide.mjs';
import { unpacked } from './packed.js';

const HOME = new URL('./python/', import.meta.url).href;

async function start() {
  const library = unpacked(`${HOME}app.zip`);
  const standard = URL.createObjectURL(new Blob([await unpacked(`${HOME}stdlib.zip`)]));
  const python = await loadPyodide({ indexURL: HOME, stdLibURL: standard, env: { SSSGEN_CACHE: '/cache', HOME: '/home/pyodide' } });
  URL.revokeObjectURL(standard);
  postMessage({ kind: 'started' });
  python.unpackArchive(await library, 'zip', { extractDir: '/' });
  python.runPython('import sys\nsys.path[:] = ["/app", *(path for path in sys.path if not path.endswith("-packages"))]');
  const session = python.pyimport('playground_session');
  session.age('/app', '/examples');
  postMessage({ kind: 'ready' });
  return session;
}

const session = start();
session.catch((error) => postMessage({ kind: 'failed', text: String(error.message ?? error) }));
let warmed = false;

addEventListener('message', async ({ data }) => {
  const python = await session;
  try {
    postMessage({ kind: 'answer', number: data.number, answer: JSON.parse(python.answer(JSON.stringify(data.request))) });
  } catch (error) {
    postMessage({ kind: 'answer', number: data.number, answer: null, fault: String(error.message ?? error) });
  }
  if (!warmed) {
    warmed = true;
    setTimeout(() => python.warm(), 300);
  }
});
