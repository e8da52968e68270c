"""Babylon.js in a page: its WebGL 2 engine and its WebGPU engine."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from sssgen.run.backends.browser_page import WEBGL, WEBGPU
from sssgen.run.backends.engine_page import Engine, Renderer


def _modules(packages: Path) -> Mapping[str, Path]:
    """The bundle, under the names of all the files that it has."""
    listed = Path(__file__).with_name("babylon_bundle.js").read_text(encoding="utf-8")
    bundle = packages.parent / "babylon.js"
    return dict.fromkeys(re.findall(r"'(@babylonjs/.*)'", listed), bundle)


BABYLON = Engine(
    "babylonjs", "Babylon.js", "npm package @babylonjs/core, bundled: make setup, in a checkout", _modules,
    "babylon_page.js",
    {"webgl": Renderer(WEBGL), "webgpu": Renderer(WEBGPU, gpu=True)},
)  # fmt: skip
