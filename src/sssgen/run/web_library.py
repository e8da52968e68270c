"""What pages with three.js import: the bundle that `make setup` makes and the wheel has, or else npm's own files, which
are fetched once where npm is installed."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from sssgen.run.machine_parts import node_modules
from sssgen.support import cache
from sssgen.support.diagnostics import failure
from sssgen.support.installation import npm_hint
from sssgen.support.paths import PACKAGE, folder

BUNDLE = "library.js"
NPM = {
    "three": "three/build/three.module.js",
    "three/webgpu": "three/build/three.webgpu.js",
    "three/tsl": "three/build/three.tsl.js",
    "three/addons/controls/OrbitControls.js": "three/examples/jsm/controls/OrbitControls.js",
    "three/addons/loaders/GLTFLoader.js": "three/examples/jsm/loaders/GLTFLoader.js",
    "three/addons/loaders/HDRLoader.js": "three/examples/jsm/loaders/HDRLoader.js",
    "three/addons/loaders/EXRLoader.js": "three/examples/jsm/loaders/EXRLoader.js",
    "three/addons/environments/RoomEnvironment.js": "three/examples/jsm/environments/RoomEnvironment.js",
    "three/addons/libs/fflate.module.js": "three/examples/jsm/libs/fflate.module.js",
}
"""What the page imports → the file among npm's packages. `library_bundle.js` exports the same."""
VERSION = "0.187.0"
"""Of three.js, as in the Makefile."""
FETCH_SECONDS = 60
"""Until npm is stopped."""
NETWORK = f"https://cdn.jsdelivr.net/npm/three@{VERSION}"
"""Where browsers load three.js from, without files of it."""
_IMPORTED_BY_THESE = (
    "three/build/three.core.js",
    "three/examples/jsm/utils/BufferGeometryUtils.js",
    "three/examples/jsm/utils/SkeletonUtils.js",
)


class Library(NamedTuple):
    """The files of the page's libraries."""

    imports: dict[str, str]
    """The name in an `import` → the file, as the page asks for it."""
    files: dict[str, Path]
    """The file, as the page asks for it → its path."""

    def import_map(self) -> str:
        """The import map of the page, for files in its folder `library`."""
        return json.dumps({"imports": {name: f"./library/{file}" for name, file in self.imports.items()}}, indent=2)


def network_import_map() -> str:
    """An import map whose files a browser loads from a public mirror of npm."""
    addresses = {name: file.replace("three", NETWORK, 1) for name, file in NPM.items()}
    return json.dumps({"imports": addresses}, indent=2)


def bundle() -> Path:
    """Where the bundle is: in an installed wheel, or in a checkout's build folder."""
    packaged = Path(PACKAGE, "_data", "preview", BUNDLE)
    return packaged if packaged.is_file() else folder("build") / "preview" / BUNDLE


def library() -> Library:
    """The bundle, or npm's files where it is not made or $SSSGEN_NODE_MODULES is set. Raises SssgenError."""
    file, configured = bundle(), os.environ.get("SSSGEN_NODE_MODULES")
    if file.is_file() and not configured:
        return Library(dict.fromkeys(NPM, BUNDLE), {BUNDLE: file})
    if not (files := _files_of(node_modules())) and not configured:
        files = _files_of(_fetched())
    if not files:
        raise failure("the page needs the npm package three", npm_hint("three"))
    return Library(dict(NPM), files)


def _files_of(packages: Path) -> dict[str, Path]:
    """The files of the page in a folder that npm filled; none where one is missing."""
    files = {file: packages / file for file in (*NPM.values(), *_IMPORTED_BY_THESE)}
    return files if all(path.is_file() for path in files.values()) else {}


def _fetched() -> Path:
    """The folder of the packages that npm fetches into the cache, once. Without npm or a network it stays empty."""
    folder = Path(cache.folder(), f"three@{VERSION}")
    npm = shutil.which("npm")
    if folder.is_dir() or not npm or not cache.folder():
        return folder / "node_modules"
    print(f"npm fetches three.js {VERSION}, once", file=sys.stderr, flush=True)
    with tempfile.TemporaryDirectory(dir=cache.folder()) as temporary:
        made = os.path.join(temporary, "three")
        options = ("--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error", "--fetch-retries=0")
        command = (npm, "install", "--prefix", made, *options, f"three@{VERSION}")
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=True, timeout=FETCH_SECONDS)
            os.rename(made, folder)  # another process finds the whole folder or none
    return folder / "node_modules"
