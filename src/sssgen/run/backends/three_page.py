"""three.js in a page: WebGLRenderer, WebGPURenderer, and WebGPURenderer's WebGL 2 fallback."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from sssgen.run.backends.browser_page import WEBGL, WEBGPU
from sssgen.run.backends.engine_page import Engine, Renderer
from sssgen.support.installation import npm_hint

_IMPORTED = {"three": "three.module.js", "three/webgpu": "three.webgpu.js", "three/tsl": "three.tsl.js"}


def _modules(packages: Path) -> Mapping[str, Path]:
    """What a page imports; the first file of each imports others of the package."""
    build = packages / "three" / "build"
    modules = {name: build / file for name, file in _IMPORTED.items()}
    return modules | {file.name: file for file in build.glob("three.*.js") if file not in modules.values()}


_RENDERERS = {"webgpu": Renderer(WEBGPU, gpu=True, top_first=True), "webgl2": Renderer(WEBGL)}
_INSTALL = f"npm package three: {npm_hint('three')}"

THREE = Engine(
    "threejs", "three.js", _INSTALL, _modules, "three_page.js", {"webgl": Renderer(WEBGL), **_RENDERERS}
)  # fmt: skip
TSL = Engine("tsl", "three.js", _INSTALL, _modules, "tsl_page.js", _RENDERERS)
