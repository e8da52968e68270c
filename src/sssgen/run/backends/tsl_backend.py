"""TSL: functions of an emitted module, run by three.js in a headless Chromium, in WebGPU or in its WebGL 2 fallback."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.ir.types import Matrix, Type, column_size, kind_of, spell
from sssgen.run.backends import call_program as programs
from sssgen.run.backends.backend_interface import Array, Backend, Call, Text
from sssgen.run.backends.engine_page import Bytes, EnginePage
from sssgen.run.backends.web_engines import TSL
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture


class TslBackend(Backend):
    """One renderer of three.js, which makes a shader of nodes."""

    def __init__(self, name: str, target: str, renderer: str) -> None:
        self.name = name
        self.target = registry.load(target)
        self.page = EnginePage(TSL, renderer)

    def device(self) -> str:
        return f"three.js {self.page.version} in Chromium, {self.page.name}"

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        lanes = max(np.shape(arg)[-1] for call in calls for arg in call.args if not isinstance(arg, str))
        grid = programs.grid(lanes)
        bytes_ = Bytes()
        rows: list[Array] = []
        plans: list[dict[str, Any]] = []
        slots = 0
        for call in calls:
            args: list[dict[str, Any]] = []
            for type_, arg in zip(call.params, call.args, strict=True):
                if isinstance(arg, str):
                    args.append({"texture": arg})
                    continue
                own = programs.rows_of(type_, np.asarray(arg), grid)
                places = [(len(rows) + index) * grid.rows for index in range(len(own))]
                args.append({**_shape(type_), "rows": places})
                rows += own
            columns = call.result.columns if isinstance(call.result, Matrix) else 1
            plans.append(
                {"function": call.function, "args": args, "slot": slots, "columns": columns, **_shape(call.result)}
            )
            slots += columns
        used = {arg for call in calls for arg in call.args if isinstance(arg, str)}
        data = np.concatenate(rows) if rows else np.zeros((grid.rows * grid.width, 4), np.uint32)
        plan = {
            "modules": {"module.js": text.text}, "renderer": self.page.name,
            "width": grid.width, "height": slots * grid.rows,
            "rows": grid.rows, "data": bytes_.piece(data, np.uint32), "calls": plans,
            "textures": {name: _texture(one, bytes_) for name, one in (textures or {}).items() if name in used},
        }  # fmt: skip
        picture = self.page.ask(json.dumps(plan), bytes_.data(), (grid.width, slots * grid.rows), np.uint32)
        layout = programs.Layout(lanes, grid, [(plan["slot"], plan["columns"]) for plan in plans])
        return programs.results(calls, layout, picture)


def _shape(type_: Type) -> dict[str, Any]:
    """A type as the page reads and writes it: by columns."""
    return {"type": spell(type_), "kind": kind_of(type_), "size": column_size(type_)}


def _texture(texture: Texture, bytes_: Bytes) -> dict[str, Any]:
    numbers = {"float": np.float32, "int": np.int32, "uint": np.uint32}[texture.kind]
    return {
        "dim": texture.dim, "kind": texture.kind, "compare": texture.compare,
        "layers": len(texture.levels[0]) if texture.layers else 0, "filter": texture.filter, "wrap": texture.wrap,
        "levels": [
            {"size": texture.size(number), "data": bytes_.piece(level, numbers)}
            for number, level in enumerate(texture.levels)
        ],
    }  # fmt: skip
