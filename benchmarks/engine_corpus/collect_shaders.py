"""Makes a corpus of the shaders that engines of the web compile in a browser.

    python benchmarks/engine_corpus/collect_shaders.py FOLDER [--engine NAME …]

Installs the engines from npm (`PACKAGES`) into FOLDER/packages, bundles the pages of this folder with esbuild, opens
each in a headless Chromium with `tools/dump_shaders.js` in front of it, and writes the programs that the engine links
to FOLDER/shaders/ENGINE/NAME.vert and NAME.frag, with `programs.json`. WebGL runs on the CPU. Nothing of the engines is
part of this project.
"""

from __future__ import annotations

import argparse
import json
import mimetypes
import queue
import shutil
import subprocess
import sys
import threading
from collections.abc import Sequence
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from sssgen.run.backends.browser_page import WEBGL, Page
from sssgen.run.machine_parts import chromium

HERE = Path(__file__).resolve().parent
DUMP = HERE.parent.parent / "tools" / "dump_shaders.js"
PACKAGES = {
    "three": "0.187.0", "postprocessing": "6.39.6",
    "@babylonjs/core": "9.34.0", "@babylonjs/materials": "9.34.0",
    "playcanvas": "2.23.3", "pixi.js": "8.22.0",
    "regl": "2.1.1", "regl-line2d": "3.1.4", "regl-scatter2d": "3.4.0", "regl-error2d": "2.0.12",
    "maplibre-gl": "6.17.0", "cesium": "1.145.0", "esbuild": "0.28.2",
}  # fmt: skip
"""The packages of npm and their versions; esbuild makes one file of a page and what it imports."""
ENGINES = ("three", "three_nodes", "postprocessing", "babylon", "playcanvas", "pixi", "regl", "maplibre", "cesium")
"""The pages, which are files of this folder."""
SECONDS = 90.0
"""How long a page may be silent: a step may compile several large programs."""
INDEXED = {
    "three_passes": "three/examples/jsm/postprocessing",
    "three_shaders": "three/examples/jsm/shaders",
    "three_objects": "three/examples/jsm/objects",
}
"""Modules that export every file of a folder, as a namespace of the file's name. WebGPU's files are left out."""
_HTML = (
    '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><body>'
    '<script src="/dump_shaders.js"></script><script type="module" src="/bundles/{engine}.js"></script>'
)


def install(folder: Path) -> Path:
    """The folder of npm's packages, filled where a version is missing."""
    packages = folder / "packages"
    wanted = [f"{name}@{version}" for name, version in PACKAGES.items()]
    marker = packages / "installed.json"
    if not marker.is_file() or json.loads(marker.read_text("utf-8")) != wanted:
        packages.mkdir(parents=True, exist_ok=True)
        command = ["npm", "install", "--no-audit", "--no-fund", "--loglevel=error", *wanted]
        subprocess.run(command, cwd=packages, check=True)
        marker.write_text(json.dumps(wanted), "utf-8")
    return packages / "node_modules"


def bundle(engine: str, modules: Path, folder: Path) -> None:
    """Writes FOLDER/bundles/ENGINE.js."""
    pages = folder / "bundles" / "pages"
    pages.mkdir(parents=True, exist_ok=True)
    for file in HERE.glob("*.js"):
        shutil.copy(file, pages)
    for name, source in INDEXED.items():
        files = [file.stem for file in sorted((modules / source).glob("*.js")) if "Mesh" not in file.stem]
        lines = [f"export * as {stem} from '{source}/{stem}.js';" for stem in files]
        (pages / f"{name}.js").write_text("\n".join(lines) + "\n", "utf-8")
    command = [
        str(modules / ".bin" / "esbuild"), str(pages / f"{engine}.js"), "--bundle", "--format=esm", "--log-level=error",
        f"--outfile={folder / 'bundles' / engine}.js", "--loader:.glsl=text", "--define:global=globalThis",
        *(f"--alias:{name}={pages / name}.js" for name in INDEXED),
    ]  # fmt: skip
    environment = {"NODE_PATH": str(modules), "PATH": "/usr/local/bin:/usr/bin:/bin"}
    subprocess.run(command, check=True, env=environment)


class Answers(ThreadingHTTPServer):
    """Serves the pages and the files of a folder, and collects what the pages post."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.messages = folder, queue.Queue[dict[str, Any]]()
        super().__init__(("127.0.0.1", 0), _Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()


class _Handler(BaseHTTPRequestHandler):
    server: Answers

    def do_GET(self) -> None:
        path = self.path.partition("?")[0].lstrip("/")
        if path in ENGINES:
            return self.answer(_HTML.format(engine=path).encode(), "text/html")
        file = DUMP if path == DUMP.name else (self.server.folder / path).resolve()
        if not (file == DUMP or file.is_relative_to(self.server.folder)) or not file.is_file():
            return self.send_error(404)
        kind = "text/javascript" if file.suffix in (".js", ".mjs") else mimetypes.guess_type(file.name)[0]
        return self.answer(file.read_bytes(), kind or "application/octet-stream")

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.messages.put(json.loads(body))
        self.answer(b"", "text/plain")

    def answer(self, body: bytes, kind: str) -> None:
        self.send_response(200)
        for name, value in (("Content-Type", kind), ("Content-Length", str(len(body)))):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *arguments: object) -> None:
        """The pages report their errors themselves."""


def collect(engine: str, server: Answers) -> list[dict[str, Any]]:
    """The programs that the page of an engine links. Prints the steps that failed."""
    url = f"http://127.0.0.1:{server.server_address[1]}/{engine}"
    go = f"new WebSocket(location.href.replace('http:', 'ws:')).onopen = () => location.replace('{url}')"
    programs: list[dict[str, Any]] = []
    message: dict[str, Any] = {"step": "no step"}
    page = Page(chromium(), "swiftshader", go, WEBGL)
    try:
        while True:
            message = server.messages.get(timeout=SECONDS)
            programs += message["programs"]
            if message.get("done"):
                break
            if "error" in message:
                print(f"{engine}, {message['step']}: {message['error']}", file=sys.stderr)
    except queue.Empty:
        print(f"{engine}: silent for {SECONDS:g} seconds after '{message['step']}'", file=sys.stderr)
    finally:
        page.close()
    return programs


def write(programs: Sequence[dict[str, Any]], folder: Path) -> None:
    """Writes the programs of an engine in place of those of an earlier run."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for program in programs:
        for stage, suffix in (("vertex", "vert"), ("fragment", "frag")):
            (folder / f"{program['name']}.{suffix}").write_text(program.pop(stage), "utf-8")
    (folder / "programs.json").write_text(json.dumps(programs, indent=1), "utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("FOLDER", type=Path)
    parser.add_argument("--engine", action="append", choices=ENGINES)
    options = parser.parse_args()
    folder = options.FOLDER.resolve()
    modules = install(folder)
    server = Answers(folder)
    for engine in options.engine or ENGINES:
        bundle(engine, modules, folder)
        programs = collect(engine, server)
        write(programs, folder / "shaders" / engine)
        print(f"{engine}: {len(programs)} programs")


if __name__ == "__main__":
    main()
