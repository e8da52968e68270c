"""The values of Metal's shells: blocks as Swift's and C++'s structs of simd vectors lay them out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.ir.types import BY_NAME, column_size, kind_of
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import VERTEX_SIZE, Array, Text, file_text
from sssgen.run.backends.metal_backend import MetalOnCpu
from sssgen.run.render.shell_values import LIGHTS, Shell, bound_texture, inverse
from sssgen.targets.reflection_record import Reflection

_DTYPES: dict[str, Any] = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.uint8}


def shade(compiled: Compiled, shell: Shell, backend: MetalOnCpu, size: tuple[int, int], points: Array | None) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom."""
    reflection = compiled.reflection
    text: Text = file_text(compiled, reflection, reflection["files"][0]["name"])
    textures = {texture["name"]: bound_texture(texture, shell, True) for texture in reflection["textures"]}
    if points is not None:
        points = points.reshape(size[1], size[0], VERTEX_SIZE)[::-1]
    return backend.shade(text, blocks(reflection, shell), textures, points, size, shell.front)[::-1]


def blocks(reflection: Reflection, shell: Shell) -> dict[str, bytes]:
    """The bytes of each struct of the shell."""
    positions, colors = np.zeros((LIGHTS, 4)), np.zeros((LIGHTS, 4))
    positions[: len(shell.light_positions)] = shell.light_positions
    colors[: len(shell.light_colors), :3] = shell.light_colors
    matrices = shell.view_projection.T, inverse(shell.view_projection).T
    count = np.array([len(shell.light_positions), 0, 0, 0], np.int32).tobytes()
    return {
        "Camera": _floats(*matrices, (*shell.camera_position, 0.0), (shell.time, 0.0, 0.0, 0.0)),
        "Lights": _floats((*shell.ambient, 0.0)) + count + _floats(positions, colors),
        "Object": _floats(shell.model.T, inverse(shell.model).T),
        "Material": material_block(reflection, shell.parameters),
    }


def material_block(reflection: Reflection, parameters: Mapping[str, Any]) -> bytes:
    """The bytes of the struct Material: each vector and each column of a matrix at its place."""
    block = bytearray(reflection["uniform_block_size"] or 0)
    for uniform in reflection["uniforms"]:
        type_ = BY_NAME[uniform["type"].partition("[")[0]]
        size = column_size(type_)
        values = np.asarray(parameters.get(uniform["source_name"], uniform["default"]))
        rows = values.astype(_DTYPES[kind_of(type_)]).reshape(-1, size)
        stride = rows.itemsize * (4 if size == 3 else size)
        for number, row in enumerate(rows):
            start = uniform["offset"] + stride * number
            block[start : start + row.nbytes] = row.tobytes()
    return bytes(block)


def _floats(*values: Any) -> bytes:
    return b"".join(np.ascontiguousarray(value, np.float32).tobytes() for value in values)
