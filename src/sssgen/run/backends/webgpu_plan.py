"""A drawing in terms of WebGPU: plain data, which both `wgpu` and a page in a browser execute."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.backends.backend_interface import Array, Bound, Drawing
from sssgen.targets.runtime.numpy_textures import Texture

_WRAP = {"repeat": "repeat", "clamp": "clamp-to-edge", "mirror": "mirror-repeat"}


class Level(NamedTuple):
    """One level of a texture: its size and its texels, row after row."""

    size: tuple[int, int, int]
    data: bytes


class TexturePlan(NamedTuple):
    """A texture and where it is bound; `sampler` is -1 where it is read texel by texel."""

    group: int
    binding: int
    sampler: int
    format: str
    bytes_per_texel: int
    dimension: str
    """Of the texture: 2d or 3d."""
    view: str
    """Of the view: 2d, 3d, cube, 2d-array or cube-array."""
    filter: str
    between: str
    """The filter between levels."""
    wrap: str
    levels: list[Level]
    compare: str = ""
    """How its sampler compares; '' where it does not."""


class BlockPlan(NamedTuple):
    """A uniform block and where it is bound."""

    group: int
    binding: int
    data: bytes


class Plan(NamedTuple):
    """One draw into a picture of 16 bytes a pixel."""

    code: str
    vertex: str
    fragment: str
    format: str
    width: int
    height: int
    textures: list[TexturePlan]
    blocks: list[BlockPlan]
    vertices: bytes
    triangles: bytes
    """Indices as uint32; empty: three vertices without buffers."""
    vertex_code: str = ""
    """The text of the vertex stage; '': `code` has both."""
    attributes: Sequence[Mapping[str, Any]] = ()
    """A program may read fewer."""
    stride: int = 0
    """Bytes of a vertex."""


def plan(drawing: Drawing) -> Plan:
    """The plan of a drawing."""
    assert drawing.vertex is not None
    triangles = drawing.triangles
    code, vertex_code = drawing.fragment.text.text, drawing.vertex.text.text
    return Plan(
        code,
        drawing.vertex.entry,
        drawing.fragment.entry,
        "rgba32float" if drawing.floats else "rgba32uint",
        *drawing.size,
        [texture_plan(bound) for bound in drawing.textures.values()],
        [BlockPlan(block.place.group, block.place.binding, block.data) for block in drawing.blocks.values()],
        b"" if drawing.vertices is None else np.ascontiguousarray(drawing.vertices, np.float32).tobytes(),
        b"" if triangles is None else np.ascontiguousarray(triangles, np.uint32).tobytes(),
        "" if vertex_code == code else vertex_code,
        [
            {"format": f"float32x{size}" if size > 1 else "float32", "offset": 4 * first, "shaderLocation": location}
            for location, (first, size) in enumerate(drawing.attributes.values())
        ],
        4 * sum(size for _, size in drawing.attributes.values()),
    )


def texture_plan(bound: Bound) -> TexturePlan:
    """What WebGPU makes of a texture."""
    data, place = bound.data, bound.place
    if not isinstance(data, Texture):
        size = data.shape[1], data.shape[0], 1
        level = Level(size, np.ascontiguousarray(data, np.uint32).tobytes())
        return TexturePlan(
            place.group, place.binding, -1, "rgba32uint", 16, "2d", "2d", "nearest", "nearest", "repeat", [level]
        )
    format, bytes_per_texel = _FORMATS["depth" if data.compare else data.kind]
    levels = []
    for texels in data.levels:
        size = texels.shape[-2], texels.shape[-3], int(np.prod(texels.shape[:-3]))
        levels.append(Level(size, _bytes(texels, format)))
    dimension = "3d" if data.dim == "3D" else "2d"
    view = data.dim.lower() + ("-array" if data.layers else "")
    between = "nearest" if data.kind in ("int", "uint") and not data.compare else "linear"
    filter = data.filter if between == "linear" else between
    wrap, compare = _WRAP[data.wrap], "less-equal" if data.compare else ""
    return TexturePlan(
        place.group, place.binding, place.sampler, format, bytes_per_texel, dimension, view, filter, between, wrap,
        levels, compare,
    )  # fmt: skip


_FORMATS = {
    "float": ("rgba16float", 8), "int": ("rgba32sint", 16), "uint": ("rgba32uint", 16), "depth": ("depth16unorm", 2),
}  # fmt: skip
"""Kind of texels → the format, and its bytes per texel. Other depth formats cannot be written."""
_SAMPLED = {"rgba16float": "float", "rgba32sint": "sint", "rgba32uint": "uint", "depth16unorm": "depth"}


def _bytes(texels: Array, format: str) -> bytes:
    if format == "depth16unorm":
        return np.rint(texels[..., 0].astype(np.float64) * 65535.0).astype(np.uint16).tobytes()
    return np.ascontiguousarray(texels, np.float16 if format == "rgba16float" else None).tobytes()


def layout_entries(plan: Plan) -> dict[int, list[dict[str, Any]]]:
    """Group → the entries of its bind group layout. They are explicit, as `auto` drops unread resources."""
    groups: dict[int, list[dict[str, Any]]] = {}
    both, fragment = 3, 2
    for block in plan.blocks:
        entry = {"binding": block.binding, "visibility": both, "buffer": {"type": "uniform"}}
        groups.setdefault(block.group, []).append(entry)
    for texture in plan.textures:
        reads = {"sample_type": _SAMPLED[texture.format], "view_dimension": texture.view}
        resources = groups.setdefault(texture.group, [])
        resources.append({"binding": texture.binding, "visibility": fragment, "texture": reads})
        if texture.sampler >= 0:
            filters = "filtering" if texture.between == "linear" else "non-filtering"
            sampler = {"type": "comparison" if texture.compare else filters}
            resources.append({"binding": texture.sampler, "visibility": fragment, "sampler": sampler})
    return groups
