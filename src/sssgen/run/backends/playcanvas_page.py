"""PlayCanvas in a page: WebGL 2 and WebGPU."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from sssgen.run.backends.browser_page import WEBGL, WEBGPU
from sssgen.run.backends.engine_page import Engine, Renderer
from sssgen.support.installation import npm_hint


def _modules(packages: Path) -> Mapping[str, Path]:
    return {"playcanvas": packages / "playcanvas" / "build" / "playcanvas.mjs"}


PLAYCANVAS = Engine(
    "playcanvas", "PlayCanvas", f"npm package playcanvas: {npm_hint('playcanvas')}", _modules, "playcanvas_page.js",
    {"webgl2": Renderer(WEBGL), "webgpu": Renderer(WEBGPU, gpu=True, top_first=True)},
    v_down=True,
)  # fmt: skip
