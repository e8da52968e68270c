// The VS Code side: it starts `sssgen lsp`, and `sssgen preview` for the command "Open preview".
// All knowledge of techniques and materials is in the language server.

"use strict";

const { spawn } = require("node:child_process");
const path = require("node:path");
const vscode = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");

const FILES = "**/*.{sss,toml,glsl,frag,vert}";
const START_LIMIT = 60_000; // milliseconds that a preview has to show its address

let client;
const previews = new Map(); // file → its running preview, and the address of the page

/** The command of the setting; a path with folders is searched in the first folder of the workspace. */
function command() {
  const name = vscode.workspace.getConfiguration("sssgen").get("path") || "sssgen";
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
  return folder && /[\\/]/.test(name) && !path.isAbsolute(name) ? path.join(folder, name) : name;
}

async function start() {
  client = new LanguageClient(
    "sssgen",
    "sssgen",
    { command: command(), args: ["lsp"], transport: TransportKind.stdio },
    {
      documentSelector: [{ scheme: "file", pattern: FILES }],
      synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher(FILES) },
    },
  );
  try {
    await client.start();
  } catch (error) {
    const hint = "install it with `pip install 'sssgen-shaders[lsp]'`, or set sssgen.path";
    vscode.window.showErrorMessage(`${command()} lsp does not start: ${hint} (${error.message})`);
  }
}

async function restart() {
  await client?.stop().catch(() => undefined);
  await start();
}

/** Starts the preview of the file that is shown, or shows the one that runs. */
async function preview() {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.uri.scheme !== "file") {
    vscode.window.showErrorMessage("open a material, a scene, a technique or a shader first");
    return;
  }
  await document.save();
  const file = document.uri.fsPath;
  if (!previews.has(file)) {
    try {
      previews.set(file, await served(file));
    } catch (error) {
      vscode.window.showErrorMessage(`sssgen preview ${path.basename(file)}: ${error.message}`);
      return;
    }
  }
  const address = await vscode.env.asExternalUri(vscode.Uri.parse(previews.get(file).address));
  vscode.env.openExternal(address);
  const stop = "Stop it";
  const chosen = await vscode.window.showInformationMessage(`${path.basename(file)} is shown at ${address}`, stop);
  if (chosen === stop) {
    previews.get(file)?.process.kill();
  }
}

/** The process of a preview and its address, once it has printed that. */
function served(file) {
  return new Promise((resolve, reject) => {
    const server = spawn(command(), ["preview", file, "--no-browser"], { cwd: path.dirname(file) });
    let output = "";
    const limit = setTimeout(() => {
      server.kill();
      reject(new Error(`no address within ${START_LIMIT / 1000} s`));
    }, START_LIMIT);
    const read = (data) => {
      output += data;
      const address = /http:\/\/127\.0\.0\.1:\d+\/\S*/.exec(output)?.[0];
      if (address) {
        clearTimeout(limit);
        resolve({ process: server, address });
      }
    };
    server.stdout.on("data", read);
    server.stderr.on("data", read);
    server.on("error", reject);
    server.on("exit", () => {
      clearTimeout(limit);
      previews.delete(file);
      reject(new Error(output.trim() || "it ended at once"));
    });
  });
}

exports.activate = async (context) => {
  context.subscriptions.push(
    vscode.commands.registerCommand("sssgen.preview", preview),
    vscode.commands.registerCommand("sssgen.restart", restart),
    vscode.workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("sssgen.path") && restart()),
  );
  await start();
};

exports.deactivate = async () => {
  for (const { process } of previews.values()) {
    process.kill();
  }
  await client?.stop().catch(() => undefined);
};
