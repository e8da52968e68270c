"""The shell in NumPy: does what an emitted shader's entry points do with a material's functions.

The numpy target emits only the functions; a picture also needs the vertex stage and the loop over the lights.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.harness.backends import VERTEX_SIZE, Array
from sssgen.harness.evaluate.evaluation import shape_of
from sssgen.harness.render.shell_values import Shell, bound_texture, inverse
from sssgen.ir.types import BY_NAME, kind_of
from sssgen.pipeline.compiler import Compiled
from sssgen.targets.runtime.numpy_values import grid, precision

BAND = 1 << 16
"""The approximate number of pixels that are shaded at once."""

_DTYPES: dict[str, Any] = {"float": np.float64, "int": np.int32, "uint": np.uint32, "bool": np.bool_}


def shade(compiled: Compiled, shell: Shell, size: tuple[int, int], points: Array | None, dtype: str) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom. `points` are `pixel_mesh.vertices`, or None: the screen."""
    names = _namespace(compiled, shell, dtype)
    two_sided = compiled.reflection["two_sided"]
    width, height = size
    rows = max(2, BAND // width // 2 * 2)
    bands = []
    for start in range(0, height, rows):
        count = min(rows, height - start)
        with precision(dtype), grid(count, width):
            inputs = _inputs(shell, size, points, slice(start, start + count), dtype, two_sided)
            bands.append(_main(compiled.reflection, names, inputs, shell, dtype).reshape(4, count, width))
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


def _inputs(
    shell: Shell, size: tuple[int, int], points: Array | None, rows: slice, dtype: str, two_sided: bool
) -> dict[str, Any]:
    """The chain's inputs that do not depend on a light, components first."""
    width, height = size
    eye = np.array(shell.camera_position)[:, None]
    inputs: dict[str, Any] = {"time": np.array(shell.time)}
    if points is None:
        x, y = np.meshgrid(np.arange(width), np.arange(rows.start, rows.stop))
        uv = np.stack([(x.ravel() + 0.5) / width, (y.ravel() + 0.5) / height])
        far = inverse(shell.view_projection) @ np.stack([*(2.0 * uv - 1.0), np.ones(x.size), np.ones(x.size)])
        inputs |= {
            "uv": uv,
            "screen_uv": uv,
            "ray_origin": np.broadcast_to(eye, (3, x.size)),
            "P": np.broadcast_to(eye, (3, x.size)),
        }
        inputs |= {"ray_direction": _unit(far[:3] - eye * far[3])}
    else:
        data = points.reshape(height, width, VERTEX_SIZE)[rows].reshape(-1, VERTEX_SIZE).T.astype(np.float64)
        model, world_to_object = shell.model, inverse(shell.model)
        position = model[:3, :3] @ data[0:3] + model[:3, 3:]
        normal, tangent = _unit(world_to_object[:3, :3].T @ data[3:6]), _unit(model[:3, :3] @ data[6:9])
        handedness = data[9] * np.sign(np.linalg.det(model[:3, :3]))
        inputs |= {"uv": data[10:12], "P": position, "V": _unit(eye - position), "N": normal, "T": tangent}
        inputs |= {"uv2": data[12:14], "vertex_color": data[14:18]}
        inputs |= {"B": np.cross(normal, tangent, axis=0) * handedness}
        if two_sided and not shell.front:
            inputs["N"] = normal = -normal
        inputs |= {"P_object": data[0:3], "V_object": _unit(world_to_object[:3, :3] @ inputs["V"])}
        inputs |= {"N_object": _unit(model[:3, :3].T @ normal)}
        clip = shell.view_projection @ np.concatenate([position, np.ones((1, position.shape[1]))])
        inputs |= {"screen_uv": 0.5 * clip[:2] / clip[3] + 0.5, "eye_distance": np.linalg.norm(eye - position, axis=0)}
    return {name: value.astype(dtype) for name, value in inputs.items()}


def _unit(v: Array) -> Array:
    """The shells' `unit_vector`, in float64, because small squares underflow in half precision."""
    wide = v.astype(np.float64)
    square = (wide * wide).sum(axis=0)
    result: Array = np.where(square > 1e-30, wide / np.sqrt(np.maximum(square, 1e-30)), 0.0)
    return result.astype(v.dtype)


def _light(shell: Shell, number: int, surface_position: Array, dtype: str) -> dict[str, Any]:
    """The inputs of one light."""
    position, color = shell.light_positions[number].astype(dtype), shell.light_colors[number].astype(dtype)
    to_light = position[:3, None] - surface_position * position[3]
    squared = np.maximum((to_light * to_light).sum(axis=0), np.asarray(1e-4, dtype))
    towards = to_light / np.sqrt(squared)
    falloff = 1.0 + (1.0 / squared - 1.0) * position[3]
    world_to_object = inverse(shell.model)[:3, :3].astype(dtype)
    return {
        "L": towards, "light_color": color[:, None] * falloff, "L_object": _unit(world_to_object @ towards),
        "light_nearness": position[3] / np.sqrt(squared),
    }  # fmt: skip


def _main(
    reflection: Mapping[str, Any], names: Mapping[str, Any], inputs: dict[str, Any], shell: Shell, dtype: str
) -> Array:
    """The fragment stage over all lanes: (4, lanes)."""
    entries = reflection["entries"]

    def call(kind: str) -> Any:
        passed = [param["input"] for param in entries[kind]["params"] if "input" in param]
        return names[entries[kind]["function"]](*(inputs[name] for name in passed))

    lanes = inputs["uv"].shape[-1]
    if "color" in entries:
        if len(shell.light_positions):
            inputs |= _light(shell, 0, inputs["P"], dtype)
        shown = np.array(np.broadcast_to(call("color"), (4, lanes)))
        return np.where(shown[3] < 0.5, 0.0, shown) if reflection["alpha_mode"] == "mask" else shown
    surface = call("surface") if "surface" in entries else None
    fields = vars(surface) if surface is not None else {}
    if "normal" in fields:
        x, y, z = fields["normal"]
        side = 1.0 if shell.front or not reflection["two_sided"] else -1.0
        inputs["N"] = _unit(side * (inputs["T"] * x + inputs["B"] * y) + inputs["N"] * z)
    color: Any = np.array(shell.ambient, dtype)[:, None] * fields.get("albedo", 1.0) * fields.get("occlusion", 1.0)
    color = np.broadcast_to(color + fields.get("emission", 0.0), (3, lanes))
    inputs["surface"] = surface
    for number in range(min(len(shell.light_positions), 4)):
        inputs |= _light(shell, number, inputs["P"], dtype)
        if "lighting" in entries:
            share = call("shadow") if number == 0 and "shadow" in entries else 1.0
            color = color + share * call("lighting")
        if "translucency" in entries:
            color = color + call("translucency") * inputs["light_color"]
    if "environment" in entries:
        color = color + call("environment")
    for kind in ("tone_mapping", "output"):
        if kind in entries:
            inputs["color"] = np.broadcast_to(color, (3, lanes))
            color = call(kind)
    alpha = np.broadcast_to(np.asarray(fields.get("alpha", 1.0)), (1, lanes))
    if reflection["alpha_mode"] == "mask":
        color, alpha = np.where(alpha < 0.5, 0.0, color), np.where(alpha < 0.5, 0.0, alpha)
    return np.concatenate([np.broadcast_to(color, (3, lanes)), alpha]).astype(dtype)
