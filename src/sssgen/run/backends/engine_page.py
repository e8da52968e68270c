"""An engine of the web in a headless Chromium or Chrome: draws a mesh with an emitted ES module, lit by the engine.

An engine is its package of npm, a script that draws (it imports what all share, `engine_page.js`), and its renderers.
$SSSGEN_CHROMIUM and $SSSGEN_BROWSER_ADAPTER are as in `browser`.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.backends.backend_interface import ATTRIBUTES, VERTEX_SIZE, Array, backend_failure
from sssgen.run.backends.browser_page import START, LostError, Page
from sssgen.run.compilers import CompilerMissing
from sssgen.run.machine_parts import chromium, node_modules
from sssgen.targets.runtime.numpy_textures import Texture

SECONDS = 120.0
"""How long a draw may take."""


class Renderer(NamedTuple):
    """One way in which an engine draws."""

    switches: Sequence[str]
    """The browser's: WEBGL or WEBGPU of `browser_page`."""
    gpu: bool = False
    """Whether it is WebGPU: depth in clip space is from 0 to 1, not from -1."""
    top_first: bool = False
    """Whether the first row of a render target is at the top."""


class Engine(NamedTuple):
    """One engine of the web."""

    target: str
    """The target whose modules it draws."""
    title: str
    install: str
    """How to get it, where it is missing."""
    modules: Callable[[Path], Mapping[str, Path]]
    """What scripts import, name → file, in the folder of npm's packages; files that are missing: the engine is."""
    script: str
    """Its file: beside this one, or an absolute path."""
    renderers: Mapping[str, Renderer]
    v_down: bool = False
    """Whether v is 0 at the top of the engine's own meshes."""


class EngineDrawing(NamedTuple):
    """What to draw: an emitted module, and the values of its material's properties."""

    modules: Mapping[str, str]
    """File name → text: the module of the material, and those that it imports."""
    size: tuple[int, int]
    vertices: Array
    """(n, `VERTEX_SIZE`), as in `Drawing`, in object space."""
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
    """Of the engine's own material; a number for a colour is its components'."""
    tangents: bool = True


class EnginePage:
    """One renderer of an engine in a page of its own."""

    def __init__(self, engine: Engine, renderer: str, seconds: float = SECONDS) -> None:
        """Raises CompilerMissing without a browser, and without the engine."""
        self.engine, self.name, self.renderer, self.seconds = engine, renderer, engine.renderers[renderer], seconds
        program, modules = chromium(), engine.modules(node_modules())
        if not program:
            raise CompilerMissing("chromium (Debian: chromium · elsewhere: Chrome; or set SSSGEN_CHROMIUM)")
        if not modules or not all(file.is_file() for file in modules.values()):
            raise CompilerMissing(f"{engine.title} ({engine.install})")
        self.program, self.modules = program, modules
        try:
            self._start()
        except LostError as reason:
            raise CompilerMissing(f"chromium that starts: {program} {reason}") from None

    def _start(self) -> None:
        adapter = os.environ.get("SSSGEN_BROWSER_ADAPTER", "swiftshader")
        script = (Path(__file__).parent / self.engine.script).read_text(encoding="utf-8")
        modules = {**self.modules, "./engine_page.js": Path(__file__).with_name("engine_page.js")}
        self.page = Page(self.program, adapter, script, self.renderer.switches, modules)
        facts, _ = self.page.receive(START)
        self.version = str(facts["version"])

    def restart(self) -> None:
        """A new page. An engine reports errors of a shader late: the next draw does not receive the last one's."""
        self.page.close()
        try:
            self._start()
        except LostError as reason:
            raise backend_failure(self.engine.target, f"the browser {reason}") from None

    def draw(self, drawing: EngineDrawing) -> Array:
        """The picture in linear light, (height, width, 4) float32, row 0 at the bottom. Raises SssgenError."""
        head, data = _pack(drawing, self.name, self.renderer)
        return self.ask(head, data, drawing.size)

    def ask(self, head: str, data: bytes, size: tuple[int, int], dtype: Any = np.float32) -> Array:
        """The picture for a plan, (height, width, 4), row 0 at the bottom; `size` is width and height.

        Raises SssgenError.
        """
        try:
            self.page.send(head, data, self.seconds)
            answer, picture = self.page.receive(self.seconds)
        except LostError as reason:
            raise backend_failure(self.engine.target, f"the browser {reason}") from None
        if "error" in answer or answer["complaints"]:
            said = "; ".join([answer.get("error", ""), *answer["complaints"]]).strip("; ")
            if answer["complaints"]:
                self.restart()
            raise backend_failure(self.engine.target, said)
        width, height = size
        rows = np.frombuffer(bytearray(picture), dtype).reshape(height, answer["stride"] // 4)
        result = rows[:, : width * 4].reshape(height, width, 4)
        return result[::-1] if self.renderer.top_first else result


class Bytes:
    """The bytes that follow a plan; the plan has `{at, size}` in place of each piece."""

    def __init__(self) -> None:
        self.pieces: list[bytes] = []

    def piece(self, values: Array, dtype: Any) -> dict[str, int]:
        """Adds numbers; each piece begins at a multiple of 8 bytes."""
        data = np.ascontiguousarray(values, dtype).tobytes()
        start, size = sum(map(len, self.pieces)), len(data)
        self.pieces.append(data + bytes(-size % 8))
        return {"at": start, "size": size}

    def data(self) -> bytes:
        """All pieces."""
        return b"".join(self.pieces)


def _pack(drawing: EngineDrawing, name: str, renderer: Renderer) -> tuple[str, bytes]:
    """The drawing as JSON, with `{at, size}` in place of each piece of the bytes, and the bytes."""
    bytes_ = Bytes()
    piece = bytes_.piece
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
    view = _view(drawing.eye)
    projection = drawing.view_projection @ np.linalg.inv(view)
    if renderer.gpu:
        projection = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0.5, 0.5], [0, 0, 0, 1]]) @ projection
    plan = {
        "modules": dict(drawing.modules), "renderer": name, "width": drawing.size[0], "height": drawing.size[1],
        "vertices": piece(drawing.vertices, np.float32), "vertexSize": VERTEX_SIZE, "attributes": ATTRIBUTES,
        "triangles": piece(np.asarray(drawing.triangles), np.uint32),
        "view": view.T.ravel().tolist(), "projection": projection.T.ravel().tolist(), "eye": list(drawing.eye),
        "model": drawing.model.T.ravel().tolist(), "lights": lights, "ambient": list(drawing.ambient),
        "values": dict(drawing.values), "properties": dict(drawing.properties), "textures": textures,
        "withoutTangents": not drawing.tangents,
    }  # fmt: skip
    return json.dumps(plan), bytes_.data()


def _view(eye: Sequence[float]) -> Array:
    """World to view space, turned against the scene, so that the two spaces differ."""
    turned = np.eye(4)
    for angle, (a, b) in ((0.2, (0, 1)), (-0.7, (2, 0)), (0.4, (1, 2))):
        turn = np.eye(4)
        turn[a, a] = turn[b, b] = np.cos(angle)
        turn[b, a], turn[a, b] = np.sin(angle), -np.sin(angle)
        turned = turn @ turned
    moved = np.eye(4)
    moved[:3, 3] = -np.asarray(eye)
    result: Array = turned @ moved
    return result
