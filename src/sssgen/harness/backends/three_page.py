"""three.js in a headless Chromium or Chrome: draws a mesh with an emitted module, in each of three's renderers.

The renderers are `webgl` (WebGLRenderer), `webgpu` (WebGPURenderer) and `webgl2` (WebGPURenderer's fallback). The
lights are three's. $SSSGEN_CHROMIUM and $SSSGEN_BROWSER_ADAPTER are as in `browser`.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends.backend_interface import Array, backend_failure
from sssgen.harness.backends.browser_page import START, WEBGL, WEBGPU, LostError, Page, find
from sssgen.harness.compilers import CompilerMissing
from sssgen.support.paths import folder
from sssgen.targets.runtime.numpy_textures import Texture

RENDERERS = {"webgl": WEBGL, "webgpu": WEBGPU, "webgl2": WEBGL}
"""Each renderer with the browser's switches."""
SECONDS = 120.0
"""How long a draw may take."""
_MODULES = {"three": "three.module.js", "three/webgpu": "three.webgpu.js", "three/tsl": "three.tsl.js"}
"""What a page imports; the first file of each imports others of the package."""


class ThreeDrawing(NamedTuple):
    """What to draw: an emitted module, and the values of its material's properties."""

    module: str
    size: tuple[int, int]
    vertices: Array
    """(n, 12): position, normal, tangent with handedness and uv, in object space."""
    triangles: Any
    view_projection: Array
    """World to clip space, depth from -1 to 1."""
    eye: Sequence[float]
    model: Array
    light_positions: Array = np.zeros((0, 4))
    light_colors: Array = np.zeros((0, 3))
    ambient: Sequence[float] = ()
    values: Mapping[str, Any] = {}
    textures: Mapping[str, Texture] = {}
    properties: Mapping[str, Any] = {}
    """Of three's own material; a number for a colour is its components'."""
    tangents: bool = True


class Three:
    """One renderer in a page of its own."""

    def __init__(self, renderer: str, seconds: float = SECONDS) -> None:
        """Raises CompilerMissing without a browser, and without three.js."""
        self.renderer, self.seconds = renderer, seconds
        self.top_first = renderer == "webgpu"
        program, package = find(), folder("build") / "node" / "node_modules" / "three" / "build"
        if not program:
            raise CompilerMissing("chromium (Debian: chromium · elsewhere: Chrome; or set SSSGEN_CHROMIUM)")
        if not package.is_dir():
            raise CompilerMissing("three.js (npm package three: make setup)")
        modules = {name: package / file for name, file in _MODULES.items()}
        modules |= {file.name: file for file in package.glob("three.*.js") if file not in modules.values()}
        adapter = os.environ.get("SSSGEN_BROWSER_ADAPTER", "swiftshader")
        script = Path(__file__).with_name("three_page.js").read_text(encoding="utf-8")
        try:
            self.page = Page(program, adapter, script, RENDERERS[renderer], modules)
            facts, _ = self.page.receive(START)
        except LostError as reason:
            raise CompilerMissing(f"chromium that starts: {program} {reason}") from None
        self.version = str(facts["version"])

    def draw(self, drawing: ThreeDrawing) -> Array:
        """The picture in linear light, (height, width, 4) float32, row 0 at the bottom. Raises SssgenError."""
        head, data = _packed(drawing, self.renderer)
        try:
            self.page.send(head, data, self.seconds)
            answer, picture = self.page.receive(self.seconds)
        except LostError as reason:
            raise backend_failure("threejs", f"the browser {reason}") from None
        if "error" in answer or answer["complaints"]:
            raise backend_failure("threejs", "; ".join([answer.get("error", ""), *answer["complaints"]]).strip("; "))
        width, height = drawing.size
        rows = np.frombuffer(bytearray(picture), np.float32).reshape(height, answer["stride"] // 4)
        result = rows[:, : width * 4].reshape(height, width, 4)
        return result[::-1] if answer["topFirst"] else result


def _packed(drawing: ThreeDrawing, renderer: str) -> tuple[str, bytes]:
    """The drawing as JSON, with `{at, size}` in place of each piece of the bytes, and the bytes."""
    pieces: list[bytes] = []

    def piece(values: Array, dtype: Any) -> dict[str, int]:
        data = np.ascontiguousarray(values, dtype).tobytes()
        data += bytes(-len(data) % 8)
        pieces.append(data)
        return {"at": sum(map(len, pieces)) - len(data), "size": values.size * np.dtype(dtype).itemsize}

    textures = {
        name: {
            "dim": texture.dim, "size": texture.size(), "filter": texture.filter, "wrap": texture.wrap,
            "levels": [
                {"size": texture.size(number), "data": piece(level, np.float16)}
                for number, level in enumerate(texture.levels)
            ],
        }
        for name, texture in drawing.textures.items()
    }  # fmt: skip
    lights = [
        {"position": position.tolist(), "color": color.tolist()}
        for position, color in zip(drawing.light_positions, drawing.light_colors, strict=True)
    ]
    plan = {
        "module": drawing.module, "renderer": renderer, "width": drawing.size[0], "height": drawing.size[1],
        "vertices": piece(drawing.vertices, np.float32), "triangles": piece(np.asarray(drawing.triangles), np.uint32),
        "viewProjection": drawing.view_projection.T.ravel().tolist(), "eye": list(drawing.eye),
        "model": drawing.model.T.ravel().tolist(), "lights": lights, "ambient": list(drawing.ambient),
        "values": dict(drawing.values), "properties": dict(drawing.properties), "textures": textures,
        "withoutTangents": not drawing.tangents,
    }  # fmt: skip
    return json.dumps(plan), b"".join(pieces)
