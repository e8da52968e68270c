"""Draws with the NumPy target: does what an emitted vertex shader does, and calls the function of the fragments."""

from __future__ import annotations

from typing import Any

import numpy as np

from sssgen.ir.types import BY_NAME, kind_of
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import VERTEX_SIZE, Array
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.run.render.shell_values import Shell, bound_texture, inverse, lights_of
from sssgen.targets.runtime.numpy_values import grid, precision

BAND = 1 << 16
"""The approximate number of pixels that are shaded at once."""

_DTYPES: dict[str, Any] = {"float": np.float64, "int": np.int32, "uint": np.uint32, "bool": np.bool_}


def shade(compiled: Compiled, shell: Shell, size: tuple[int, int], points: Array | None, dtype: str) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom. `points` are `pixel_mesh.vertices`, or None: the screen."""
    names = _namespace(compiled, shell, dtype)
    shade_fragment = names[compiled.reflection["shell"]["function"]]
    width, height = size
    rows = max(2, BAND // width // 2 * 2)
    bands = []
    for start in range(0, height, rows):
        count = min(rows, height - start)
        with precision(dtype), grid(count, width):
            inputs = _inputs(shell, size, points, slice(start, start + count), dtype)
            shown = shade_fragment(*(inputs[name] for name in compiled.reflection["shell"]["inputs"]))
            shown = shown[0] if isinstance(shown, tuple) else shown  # the second is where fragments are discarded
            bands.append(np.broadcast_to(shown, (4, count * width)).reshape(4, count, width))
    return np.moveaxis(np.concatenate(bands, axis=1), 0, -1)


def _namespace(compiled: Compiled, shell: Shell, dtype: str) -> dict[str, Any]:
    """The names that the emitted text defines; parameters and textures of the shell replace the defaults."""
    (text,) = [text for name, text in compiled.files.items() if name.endswith(".py")]
    names: dict[str, Any] = {}
    with precision(dtype):
        exec(compile(text, f"<{compiled.reflection['material']}>", "exec"), names)
    for uniform in compiled.reflection["uniforms"]:
        parameter = shell.parameters.get(uniform["source_name"])
        if parameter is not None:
            base, _, length = uniform["type"].partition("[")
            type_ = BY_NAME[base]
            size = shape_of(type_)
            kind = dtype if kind_of(type_) == "float" else _DTYPES[kind_of(type_)]
            value = np.asarray(parameter).reshape(*([-1] if length else []), *size, 1).astype(kind)
            names[uniform["name"]] = value if size or length else value[0]
    for texture in compiled.reflection["textures"]:
        names[texture["name"]] = bound_texture(texture, shell)
    return names


def _inputs(shell: Shell, size: tuple[int, int], points: Array | None, rows: slice, dtype: str) -> dict[str, Any]:
    """What the shell's function reads, components first."""
    width, height = size
    positions, colors = lights_of(shell)
    inputs: dict[str, Any] = {
        "time": np.array(shell.time), "camera_position": np.array(shell.camera_position)[:, None],
        "model": shell.model.T[..., None], "inverse_model": inverse(shell.model).T[..., None],
        "ambient_color": np.array(shell.ambient)[:, None], "light_positions": positions[..., None],
        "light_colors": colors[..., None],
    }  # fmt: skip
    if points is None:
        x, y = np.meshgrid(np.arange(width), np.arange(rows.start, rows.stop))
        uv = np.stack([(x.ravel() + 0.5) / width, (y.ravel() + 0.5) / height])
        eye = inputs["camera_position"]
        far = inverse(shell.view_projection) @ np.stack([*(2.0 * uv - 1.0), np.ones(x.size), np.ones(x.size)])
        place = np.broadcast_to(eye, (3, x.size))
        inputs |= {"uv": uv, "screen_uv": uv, "P": place, "ray": far[:3] - eye * far[3]}
    else:
        data = points.reshape(height, width, VERTEX_SIZE)[rows].reshape(-1, VERTEX_SIZE).T.astype(np.float64)
        model = shell.model
        position = model[:3, :3] @ data[0:3] + model[:3, 3:]
        tangent = [*(model[:3, :3] @ data[6:9]), data[9] * np.sign(np.linalg.det(model[:3, :3]))]
        clip = shell.view_projection @ np.concatenate([position, np.ones((1, position.shape[1]))])
        inputs |= {"P": position, "vertex_normal": inverse(model)[:3, :3].T @ data[3:6]}
        inputs |= {"vertex_tangent": np.stack(tangent), "uv": data[10:12], "uv2": data[12:14]}
        inputs |= {"vertex_color": data[14:18], "screen_uv": 0.5 * clip[:2] / clip[3] + 0.5}
    inputs = {name: value.astype(dtype) for name, value in inputs.items()}
    return inputs | {"light_count": np.int32(len(shell.light_positions)), "front_facing": np.bool_(shell.front)}
