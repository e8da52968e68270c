"""A whole Unity program, already preprocessed, drawn in OpenGL.

The engine sets its variables by name, in any constant buffer. So does this: a drawing's `values` are written to the
offsets that spirv-cross reports for the compiled stages.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from math import prod
from typing import Any

import numpy as np

from sssgen.run.backends.backend_interface import Array, Block, Bound, Drawing, Place, Stage, refusal
from sssgen.run.backends.hlsl_spirv import HLSL, compile_spirv, cross_compile
from sssgen.run.compilers import Message
from sssgen.run.compilers import unity_compiler as unity
from sssgen.targets.runtime.numpy_textures import Texture

_BINDING = re.compile(r"layout\(binding = \d+(?:, )?")
"""Each stage has its own numbers, and a block of both must not differ: moderngl assigns new ones."""
_SAMPLER = re.compile(r"^(?:layout\([^)]*\) )?uniform sampler(2D|3D|Cube) (\w+);", re.MULTILINE)
_KINDS: dict[str, Any] = {"i": np.int32, "u": np.uint32, "b": np.uint32}
"""By a type's first letter; else float."""


class UnityProgram(HLSL):
    """Draws with uniforms by name. Numbers that nothing sets are 0, textures black."""

    def draw(self, drawing: Drawing) -> Array:
        assert drawing.vertex is not None
        blocks: dict[str, Block] = {}
        textures = dict(drawing.textures)
        for stage, kind in ((drawing.vertex, "vertex"), (drawing.fragment, "fragment")):
            blocks |= _blocks(json.loads(self.spirv_cross(stage, kind, "--reflect")), drawing.values)
            for dim, name in _SAMPLER.findall(self.glsl(stage, kind)):
                if not self.owner(name, textures):
                    textures[name] = Bound(black(dim), Place(0, 0))
        return super().draw(drawing._replace(blocks=blocks, textures=textures, values={}))

    def glsl(self, stage: Stage, kind: str) -> str:
        text = self.spirv_cross(stage, kind)
        return _BINDING.sub("layout(", text).replace("layout() ", "")

    def messages(self, log: str) -> list[Message]:
        return [unity.locate(message, "forward pass") for message in super().messages(log)]

    def spirv_cross(self, stage: Stage, kind: str, *options: str) -> str:
        """The output of spirv-cross for a stage: GLSL, or another language with `options`."""
        origin = stage.text._replace(text="")  # messages have lines of the .shader file
        module, log = compile_spirv(_align(stage.text.text), stage.entry, kind, self.compiler)
        if not module:
            raise refusal(self.name, origin, self.messages(log))
        text, log = cross_compile(module, *options)
        if not text:
            raise refusal(self.name, origin, [Message("error", 0, 0, log)])
        return text


def _align(text: str) -> str:
    """The program with the material's members in the order of their sizes, the largest first.

    As emitted they follow HLSL's packing, where a float3 may follow a float. GLSL has no such layout, so
    spirv-cross refuses it. Members are set by name, so their order is free here.
    """

    def ordered(match: re.Match[str]) -> str:
        members = re.findall(r"[^;]*;", match[2])
        return match[1] + "".join(sorted(members, key=_size, reverse=True)) + match[3]

    return re.sub(r"(cbuffer\s+UnityPerMaterial\s*\{)([^{}]*;)(\s*\})", ordered, text)


def _size(member: str) -> int:
    """The sort key of a member: matrices and arrays, then vectors, then scalars."""
    kind = re.search(r"\b(?:float|half|int|uint|bool)(\d?)(x\d)?\b", member)
    return 5 if "[" in member or (kind and kind[2]) else int(kind[1] or 1) if kind else 1


def black(dim: str) -> Texture:
    """One black texel of a "2D", "3D" or "Cube" texture."""
    shape = {"2D": (1, 1, 4), "3D": (1, 1, 1, 4), "Cube": (6, 1, 1, 4)}[dim]
    return Texture(np.zeros(shape), dim=dim)


def _blocks(reflected: Mapping[str, Any], values: Mapping[str, Array]) -> dict[str, Block]:
    """The bytes of a stage's uniform blocks, by the names that they have in GLSL."""
    blocks = {}
    for block in reflected.get("ubos", []):
        data = np.zeros(-(-block["block_size"] // 16) * 4, np.uint32)
        for member in reflected["types"][block["type"]]["members"]:
            if member["name"] in values:
                _place(data, member, np.atleast_2d(values[member["name"]]))
        blocks[re.sub(r"[^A-Za-z0-9]+", "_", block["name"])] = Block(data.tobytes(), Place(0, 0))
    return blocks


def _place(data: Array, member: Mapping[str, Any], vectors: Array) -> None:
    """Writes a value's vectors, (count, numbers): an array's elements, a matrix's columns, each at its stride.

    HLSL's float4x4 is stored by columns. In SPIR-V it is its transpose, which is why it is called row-major there.
    """
    kind = member["type"]
    size = int(kind[-1]) if kind[-1].isdigit() else 1
    columns = size if kind.startswith("mat") else 1
    numbers = np.ascontiguousarray(vectors[:, :size], _KINDS.get(kind[0], np.float32)).view(np.uint32)
    for index, vector in enumerate(numbers[: prod(member.get("array", [1])) * columns]):
        element, column = divmod(index, columns)
        start = member["offset"] + element * member.get("array_stride", 0) + column * member.get("matrix_stride", 0)
        data[start // 4 : start // 4 + len(vector)] = vector
