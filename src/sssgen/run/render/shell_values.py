"""The values that the shells need (docs/templates.md), in the form of each language: uniforms by name, or blocks.

An emitted shader is drawn unchanged; the reflection describes what differs between materials.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sssgen.ir.types import BY_NAME, column_size, kind_of
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array, Block, Bound, Drawing, Place, Stage, file_text
from sssgen.run.evaluate.evaluation import default_texture
from sssgen.targets.reflection_record import BlockMember, Reflection, TextureBinding, TextureRecord, UniformRecord
from sssgen.targets.runtime.numpy_textures import Texture

LIGHTS = 4
"""The number of lights of a shell."""

_CAMERA, _LIGHTS, _OBJECT = Place(0, 0), Place(0, 1), Place(2, 0)
_MATERIAL_GROUP = 1


@dataclass(frozen=True)
class Shell:
    """The values of a shell for one picture; matrices multiply column vectors."""

    view_projection: Array
    camera_position: tuple[float, float, float]
    time: float = 0.0
    """Seconds."""
    ambient: tuple[float, float, float] = (0.0, 0.0, 0.0)
    light_positions: Array = field(default_factory=lambda: np.zeros((0, 4)))
    """(lights, 4): w = 1 a point, w = 0 the direction towards the light."""
    light_colors: Array = field(default_factory=lambda: np.zeros((0, 3)))
    model: Array = field(default_factory=lambda: np.eye(4))
    parameters: Mapping[str, Sequence[float]] = field(default_factory=dict)
    """The material's uniforms by the name in the reflection's `source_name`; the others have their defaults."""
    textures: Mapping[str, Texture] = field(default_factory=dict)
    """Likewise; a missing texture is one texel of its default."""
    screens: Mapping[str, Texture] = field(default_factory=dict)
    """Likewise, textures that cover the screen; row 0 is at the bottom."""
    front: bool = True
    """Whether front faces are drawn, otherwise back faces."""

    def unplaced(self, uniforms: Sequence[UniformRecord]) -> dict[str, Sequence[float]]:
        """The parameters for a host that places those with the hint `placed` itself, by its object's matrix."""
        values = dict(self.parameters)
        for name in (uniform["source_name"] for uniform in uniforms if uniform["placed"]):
            if len(own := values.get(name, ())) == 16:
                values[name] = (np.array(own).reshape(4, 4).T @ self.model).T.ravel().tolist()
            elif own:
                values[name] = [own[0] / float(np.cbrt(abs(np.linalg.det(self.model[:3, :3]))))]
        return values


def inverse(matrix: Array) -> Array:
    """The inverse; 0 for a singular matrix, the value of a uniform that is not set."""
    try:
        result: Array = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        result = np.zeros_like(matrix)
    return result


def drawing(
    compiled: Compiled, shell: Shell, size: tuple[int, int], vertices: Array | None, triangles: Array | None
) -> Drawing:
    """The draw of an emitted shader, in float32. A raymarched material has no vertices."""
    reflection = compiled.reflection
    vertex, fragment = _stages(compiled, reflection)
    parameters = {
        uniform["name"]: np.asarray(shell.parameters.get(uniform["source_name"], uniform["default"]))
        for uniform in reflection["uniforms"]
    }
    return Drawing(
        size, fragment, vertex, floats=True, textures=textures(reflection, shell),
        blocks=_blocks(reflection, shell, parameters),
        values=_values(shell) | parameters, vertices=vertices, triangles=triangles,
    )  # fmt: skip


def _stages(compiled: Compiled, reflection: Reflection) -> tuple[Stage, Stage]:
    """The vertex and the fragment stage."""
    stages: dict[str, Stage] = {}
    for file in reflection["files"]:
        text = file_text(compiled, reflection, file["name"])
        for stage, entry in file["stages"].items():
            stages[stage] = Stage(text, entry or "main")
    return stages["vertex"], stages["fragment"]


def textures(reflection: Reflection, shell: Shell) -> dict[str, Bound]:
    """The material's textures, by the names in its text."""
    top_first = reflection["conventions"].get("framebuffer_y") == "down"
    return {
        texture["name"]: Bound(bound_texture(texture, shell, top_first), _texture_place(texture.get("binding", {})))
        for texture in reflection["textures"]
    }


def bound_texture(texture: TextureRecord, shell: Shell, top_first: bool = False) -> Texture:
    """The texture for an entry of the reflection; `top_first`: the first row of the framebuffer is at the top."""
    name = texture["source_name"]
    if (screen := shell.screens.get(name)) is not None:
        texels = screen.levels[0]
        return Texture(texels[::-1] if top_first else texels, screen.filter, screen.wrap)
    return shell.textures.get(name) or default_texture(texture["type"], texture["default"])


def _texture_place(binding: TextureBinding) -> Place:
    if "group" not in binding:  # bound by name
        return Place(0, 0)
    return Place(int(binding["group"]), int(binding["texture"]), int(binding["sampler"]))


def _values(shell: Shell) -> dict[str, Array]:
    """Every loose uniform of the GLSL shells."""
    positions, colors = lights_of(shell)
    return {
        "model": shell.model.T,
        "inverse_model": inverse(shell.model).T,
        "view_projection": shell.view_projection.T,
        "inverse_view_projection": inverse(shell.view_projection).T,
        "camera_position": np.array(shell.camera_position),
        "time": np.array(shell.time),
        "ambient_color": np.array(shell.ambient),
        "light_count": np.array(len(shell.light_positions)),
        "light_positions": positions,
        "light_colors": colors[:, :3],
    }


def _blocks(reflection: Reflection, shell: Shell, parameters: Mapping[str, Array]) -> dict[str, Block]:
    """The uniform blocks of the HLSL and WGSL shells."""
    values = _values(shell)
    positions, colors = lights_of(shell)
    camera = ("view_projection", "inverse_view_projection", "camera_position", "time")
    lights = np.concatenate([shell.ambient, [0.0], positions.ravel(), colors.ravel()]).astype(np.float32)
    lights[3] = np.array(len(shell.light_positions), np.int32).view(np.float32)
    blocks = {
        "Camera": Block(_floats(*(values[name] for name in camera)), _CAMERA),
        "Lights": Block(lights.tobytes(), _LIGHTS),
        "Object": Block(_floats(values["model"], values["inverse_model"]), _OBJECT),
    }
    if size := reflection["uniform_block_size"]:
        block = material_block(size, reflection["uniforms"], parameters)
        blocks["Material"] = Block(block, Place(_MATERIAL_GROUP, 0))
    return blocks


def lights_of(shell: Shell) -> tuple[Array, Array]:
    positions, colors = np.zeros((LIGHTS, 4)), np.zeros((LIGHTS, 4))
    positions[: len(shell.light_positions)] = shell.light_positions
    colors[: len(shell.light_colors), :3] = shell.light_colors
    return positions, colors


def _floats(*values: Array) -> bytes:
    return b"".join(np.ascontiguousarray(value, np.float32).tobytes() for value in values)


_DTYPES: dict[str, Any] = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.uint32}


def material_block(size: int, uniforms: Sequence[BlockMember], values: Mapping[str, Array]) -> bytes:
    """A block of `size` bytes: each uniform's numbers at its offset, columns and elements 16 bytes apart."""
    block = np.zeros(size // 4, np.uint32)
    for uniform in uniforms:
        type_ = BY_NAME[uniform["type"].partition("[")[0]]
        count = column_size(type_)
        rows = np.asarray(values[uniform["name"]]).astype(_DTYPES[kind_of(type_)]).reshape(-1, count)
        for number, row in enumerate(rows):
            start = uniform["offset"] // 4 + 4 * number
            block[start : start + count] = np.ascontiguousarray(row).view(np.uint32)
    return block.tobytes()
