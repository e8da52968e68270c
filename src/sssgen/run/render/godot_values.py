"""A scene in Godot: the camera, the lights and the values of a material, as a user of the engine sets them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sssgen.run.backends import Array
from sssgen.run.backends.godot_drawing import Godot, View
from sssgen.run.render import pixel_mesh
from sssgen.run.render.shell_values import Shell, bound_texture
from sssgen.scene.pictures.images import encode_srgb
from sssgen.targets.reflection_record import Reflection


def shade(
    text: str, reflection: Reflection, shell: Shell, godot: Godot, size: tuple[int, int], points: Array | None
) -> Array:
    """The picture of a shader's text, (height, width, 4), row 0 at the bottom. `points` as in `shade`.

    Raises SssgenError where Godot refuses the shader.
    """
    triangles = None if points is None else pixel_mesh.triangles(size, shell.front)
    view = view_of(shell, size, points, triangles)
    picture = godot.draw(text, view, values_of(reflection, shell), textures_of(reflection, shell, godot.encodes))
    if reflection["alpha_mode"] == "mask":  # Forward+ leaves traces of alpha beside what is discarded
        picture[..., 3] = picture[..., 3] > 0.5
    return picture[::-1]


def view_of(shell: Shell, size: tuple[int, int], points: Array | None, triangles: Array | None) -> View:
    """The camera of a shell's matrix, its lights and its body. Ambient light is left out."""
    rows = shell.view_projection[[0, 1, 3], :3]
    right, up, forward = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    camera = np.eye(4)
    camera[:3, 0], camera[:3, 1], camera[:3, 2], camera[:3, 3] = right, up, -forward, shell.camera_position
    slope = np.linalg.norm(rows[2]) / np.linalg.norm(rows[1])  # also of a matrix that is scaled
    field_of_view = 2.0 * math.degrees(math.atan(float(slope)))
    lights = [
        _light(position, color) for position, color in zip(shell.light_positions, shell.light_colors, strict=True)
    ]
    return View(size, camera, field_of_view, lights, shell.model, points, triangles)


def _light(position: Array, color: Array) -> dict[str, Any]:
    energy = max(float(color.max()), 1e-9)
    kind = "place" if position[3] else "towards"
    return {kind: [*map(float, position[:3])], "color": [*map(float, color / energy)], "energy": energy}


def values_of(reflection: Reflection, shell: Shell) -> dict[str, Any]:
    """The scene's parameters, colours in sRGB as in the inspector; the others have the shader's own defaults."""
    values = {}
    parameters = shell.unplaced(reflection["uniforms"])
    for uniform in reflection["uniforms"]:
        numbers = parameters.get(uniform["source_name"])
        if numbers is not None:
            plain = np.asarray(numbers, np.float64).ravel()
            if uniform["color"]:
                plain = np.concatenate([encode_srgb(plain[:3]), plain[3:]])
            kind = "color" if uniform["color"] else uniform["type"]
            values[uniform["name"]] = {"kind": kind, "value": [*map(float, plain)]}
    return values


def textures_of(reflection: Reflection, shell: Shell, encodes: bool) -> dict[str, Array]:
    """The scene's textures; the others have the shader's own defaults. `encodes`: colours are passed in sRGB."""
    textures: dict[str, Array] = {}
    for entry in reflection["textures"]:
        if entry["source_name"] in shell.textures or entry["source_name"] in shell.screens:
            texels = np.array(bound_texture(entry, shell, top_first=True).levels[0], np.float32)
            if encodes and entry["color_space"] == "sRGB":
                texels[..., :3] = encode_srgb(texels[..., :3].astype(np.float64))
            textures[entry["name"]] = texels
    return textures
