"""The values that an engine in a page gets for an emitted module: its material's properties, textures, and lights."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.render import pixel_mesh
from sssgen.run.render.shell_values import Shell, bound_texture
from sssgen.run.render.unity_values import screen_triangle


def shade(
    compiled: Compiled,
    shell: Shell,
    page: EnginePage,
    size: tuple[int, int],
    points: Array | None,
    properties: Mapping[str, Any] | None = None,
    tangents: bool = True,
) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom. `points` are `pixel_mesh.vertices`, or None: the screen.

    `properties` are those of the engine's own material. Without `tangents` the mesh has none.
    """
    reflection = compiled.reflection
    upright = np.linalg.det(shell.model[:3, :3]) > 0.0  # engines turn the faces of a mirrored body
    vertices = screen_triangle(shell) if points is None else points
    if points is None and page.engine.v_down:
        vertices[:, 11] = 1.0 - vertices[:, 11]
    triangles = [[0, 1, 2]] if points is None else pixel_mesh.triangles(size, shell.front == upright)
    parameters = shell.unplaced(reflection["uniforms"])
    values = {
        uniform["property"]: _value(parameters[uniform["source_name"]])
        for uniform in reflection["uniforms"]
        if uniform["source_name"] in parameters
    }
    if any("time" in entry["inputs"] for entry in reflection["entries"].values()):
        values["time"] = shell.time
    top_first = page.renderer.top_first
    textures = {texture["property"]: bound_texture(texture, shell, top_first) for texture in reflection["textures"]}
    return page.draw(
        EngineDrawing(
            modules_of(compiled), size, vertices, triangles, shell.view_projection,
            shell.camera_position, shell.model, shell.light_positions, shell.light_colors, shell.ambient, values,
            textures, properties or {}, tangents,
        )
    )  # fmt: skip


def modules_of(compiled: Compiled) -> dict[str, str]:
    """The material's module, and the runtime that it imports."""
    return {name: text for name, text in compiled.files.items() if name.endswith((".js", ".mjs"))}


def _value(numbers: Any) -> Any:
    """A number, or a list."""
    listed = [float(number) for number in numbers]
    return listed if len(listed) > 1 else listed[0]
