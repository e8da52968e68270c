"""The engines of the web: three.js, Babylon.js and PlayCanvas, each with its renderers for WebGL and WebGPU."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from sssgen.run.backends.browser_page import WEBGL, WEBGPU
from sssgen.run.backends.engine_page import Engine, Renderer
from sssgen.support.installation import npm_hint

_THREE = {"three": "three.module.js", "three/webgpu": "three.webgpu.js", "three/tsl": "three.tsl.js"}


def _three_modules(packages: Path) -> Mapping[str, Path]:
    """What a page imports; the first file of each imports others of the package."""
    build = packages / "three" / "build"
    modules = {name: build / file for name, file in _THREE.items()}
    return modules | {file.name: file for file in build.glob("three.*.js") if file not in modules.values()}


def _babylon_modules(packages: Path) -> Mapping[str, Path]:
    """The bundle, under the names of all the files that it has."""
    listed = Path(__file__).with_name("babylon_bundle.js").read_text(encoding="utf-8")
    return dict.fromkeys(re.findall(r"'(@babylonjs/.*)'", listed), packages.parent / "babylon.js")


def _playcanvas_modules(packages: Path) -> Mapping[str, Path]:
    return {"playcanvas": packages / "playcanvas" / "build" / "playcanvas.mjs"}


_WEBGL, _WEBGPU = Renderer(WEBGL), Renderer(WEBGPU, gpu=True, top_first=True)
_NODES = {"webgpu": _WEBGPU, "webgl2": _WEBGL}
"""The renderers of three.js that build shaders of nodes: WebGPURenderer, and its WebGL 2 fallback."""
_INSTALL_THREE = f"npm package three: {npm_hint('three')}"

THREE = Engine(
    "threejs",
    "three.js",
    _INSTALL_THREE,
    _three_modules,
    "three_page.js",
    {"webgl": _WEBGL, **_NODES},
)
TSL = Engine("tsl", "three.js", _INSTALL_THREE, _three_modules, "tsl_page.js", _NODES)
BABYLON = Engine(
    "babylonjs", "Babylon.js", "npm package @babylonjs/core, bundled: make setup, in a checkout", _babylon_modules,
    "babylon_page.js",
    {"webgl": _WEBGL, "webgpu": Renderer(WEBGPU, gpu=True)},
)  # fmt: skip
PLAYCANVAS = Engine(
    "playcanvas", "PlayCanvas", f"npm package playcanvas: {npm_hint('playcanvas')}", _playcanvas_modules,
    "playcanvas_page.js",
    {"webgl2": _WEBGL, "webgpu": _WEBGPU},
    v_down=True,
)  # fmt: skip
