// Prints the report of Khronos' validator about a glTF file as JSON: node gltf_validator.mjs FILE, with NODE_PATH set.
import { createRequire } from "node:module";
import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";

const require = createRequire(join(process.env.NODE_PATH, "index.js"));
const { validateBytes } = require("gltf-validator");
const file = process.argv[2];
const read = (name) => readFile(join(dirname(file), decodeURIComponent(name))).then((data) => new Uint8Array(data));
const report = await validateBytes(new Uint8Array(await readFile(file)), { externalResourceFunction: read });
console.log(JSON.stringify(report.issues));
