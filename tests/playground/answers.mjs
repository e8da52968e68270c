// Answers requests in the Pyodide of a built playground: node answers.mjs PYODIDE STDLIB APP REQUESTS OUT
//
// STDLIB and APP are the unpacked zip files of the page, REQUESTS has a list of requests as JSON.

import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [pyodide, stdlib, app, requests, out] = process.argv.slice(2).map((argument) => path.resolve(argument));
const { loadPyodide } = await import(pathToFileURL(path.join(pyodide, 'pyodide.mjs')));
try {
  const python = await loadPyodide({ indexURL: pyodide, stdLibURL: stdlib, env: { SSSGEN_CACHE: '/cache', HOME: '/home/pyodide' } });
  python.unpackArchive(new Uint8Array(fs.readFileSync(app)), 'zip', { extractDir: '/' });
  python.runPython('import sys\nsys.path[:] = ["/app", *(path for path in sys.path if not path.endswith("-packages"))]');
  const session = python.pyimport('playground_session');
  session.age('/app', '/examples');
  const answers = JSON.parse(fs.readFileSync(requests, 'utf8')).map((request) => JSON.parse(session.answer(JSON.stringify(request))));
  const modules = python.runPython('import json, sys\njson.dumps(sorted(sys.modules))');
  fs.writeFileSync(out, JSON.stringify({ answers, modules: JSON.parse(modules) }));
} catch (error) {  // thrown on, Node.js would print the whole of Pyodide's source with it
  console.error(String(error.message ?? error));
  process.exit(1);
}
