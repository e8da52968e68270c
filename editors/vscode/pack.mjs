// Packs the extension: node pack.mjs FOLDER FILE.vsix, in a copy of this folder beside its node_modules (make vscode).
// The client is bundled into one file, and the licences of all that is in it stand beside it.

import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { build } from "esbuild";
import { createVSIX } from "@vscode/vsce";

const [folder, packagePath] = process.argv.slice(2).map((place) => resolve(place));

const { metafile } = await build({
  absWorkingDir: folder,
  entryPoints: ["extension.js"],
  outfile: "dist/extension.js",
  bundle: true,
  minify: true,
  platform: "node",
  format: "cjs",
  target: "node20",
  external: ["vscode"],
  metafile: true,
  logLevel: "warning",
});

const packages = new Set(
  Object.keys(metafile.inputs).flatMap((file) => /.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(file) ?? []),
);
const licences = [...packages].sort().map((place) => {
  const own = join(folder, place);
  const { name, version, license } = JSON.parse(readFileSync(join(own, "package.json"), "utf8"));
  const file = readdirSync(own).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) {
    throw new Error(`${name} ${version} has no file with its licence`);
  }
  return `${name} ${version} (${license})\n\n${readFileSync(join(own, file), "utf8").trim()}\n`;
});
writeFileSync(join(folder, "dist", "LICENSES.txt"), licences.join("\n" + "-".repeat(80) + "\n\n"));

await createVSIX({ cwd: folder, packagePath, dependencies: false, allowMissingRepository: true });
