// Compiles the playground's Python in the Pyodide that will run it: node precompile.mjs PYODIDE STAGE OUT
//
// STAGE has app/ and examples/. OUT gets app.zip (compiled modules, data, caches for each example) and
// stdlib.zip (compiled, without what a shader never needs). Only the same Pyodide can load either.

import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [pyodide, stage, out] = process.argv.slice(2).map((argument) => path.resolve(argument));
const { loadPyodide } = await import(pathToFileURL(path.join(pyodide, 'pyodide.mjs')).href);
try {
  const python = await loadPyodide({ indexURL: pyodide });
  for (const [name, root] of Object.entries({ stage, out })) {
    python.FS.mkdir(`/${name}`);
    python.FS.mount(python.FS.filesystems.NODEFS, { root }, `/${name}`);
  }
  python.FS.writeFile('/stdlib.zip', fs.readFileSync(path.join(pyodide, 'python_stdlib.zip')));
  python.runPython(fs.readFileSync(new URL('./precompile.py', import.meta.url), 'utf8'));
} catch (error) {  // thrown on, Node.js would print the whole of Pyodide's source with it
  console.error(String(error.message ?? error));
  process.exit(1);
}
