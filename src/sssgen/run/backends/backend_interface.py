"""The interface of all back ends: calls, drawings, and the errors of drivers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy.typing as npt

from sssgen.ir.spans import Span
from sssgen.ir.types import Type
from sssgen.lang.source_lines import source_line
from sssgen.pipeline.compiler import Compiled
from sssgen.run.compilers import Message
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.targets.descriptor import Target
from sssgen.targets.reflection_record import Reflection
from sssgen.targets.runtime.numpy_textures import Texture

Array: TypeAlias = npt.NDArray[Any]


class Text(NamedTuple):
    """Emitted text, and the sources of its lines: line → `file:line:column`, as the reflection's source map has it."""

    text: str
    origin: Mapping[int, str] = {}


def file_text(compiled: Compiled, reflection: Reflection, name: str) -> Text:
    """One of the files of a compiled material."""
    places = reflection["source_map"].get(name, {})
    return Text(compiled.files[name], {int(line): place for line, place in places.items()})


class Call(NamedTuple):
    """One function applied to arrays of lanes; an argument for a texture is the texture's name.

    Values have components on the first axes and lanes on the last, as in `numpy_values`: a float is
    (lanes,), a vec3 (3, lanes), a mat3 (3, 3, lanes) column by column.
    """

    function: str
    params: tuple[Type, ...]
    result: Type
    args: tuple[Any, ...]


class Backend(ABC):
    """Runs the text of one target."""

    name: str
    target: Target
    unsupported_types: frozenset[str] = frozenset()
    """Sampler types of the target for which this back end cannot create textures."""

    @abstractmethod
    def device(self) -> str:
        """The driver's description of the device, for reports."""

    @abstractmethod
    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        """The results of the calls to functions of `text`, all over the same number of lanes; 0 where a call discards.

        Raises SssgenError where the driver refuses the text or gives up.
        """


class Stage(NamedTuple):
    """One stage of a program: its text and its entry point."""

    text: Text
    entry: str = "main"


class Place(NamedTuple):
    """Where WebGPU binds a resource; the other languages bind by name."""

    group: int
    binding: int
    sampler: int = -1
    """The binding of a texture's sampler; -1 where it has none."""


class Block(NamedTuple):
    """The bytes of a uniform block."""

    data: bytes
    place: Place


class Bound(NamedTuple):
    """A texture, or an array (height, width, 4) of uint32 that is read texel by texel."""

    data: Texture | Array
    place: Place


ATTRIBUTES = {
    "position": (0, 3), "normal": (3, 3), "tangent": (6, 4), "uv": (10, 2), "uv2": (12, 2), "color": (14, 4),
}  # fmt: skip
"""A vertex's attributes: the first of its numbers, and how many."""
VERTEX_SIZE = 18
"""The numbers of a vertex."""


class Drawing(NamedTuple):
    """One draw: a program, its resources, and the picture that it fills, four 32-bit components a pixel."""

    size: tuple[int, int]
    """Width and height."""
    fragment: Stage
    vertex: Stage | None = None
    """None: one triangle that covers the picture. In WGSL both stages may have the same text."""
    floats: bool = False
    """Whether the picture is of float32; else of uint32."""
    textures: Mapping[str, Bound] = {}
    blocks: Mapping[str, Block] = {}
    values: Mapping[str, Array] = {}
    """Uniforms outside of blocks (GLSL): numbers by name, matrices column by column."""
    vertices: Array | None = None
    """(count, numbers of a vertex) float32."""
    triangles: Array | None = None
    """(count, 3) uint32."""
    attributes: Mapping[str, tuple[int, int]] = ATTRIBUTES
    """By the name in the text: the first of its numbers, and how many; in HLSL by semantic, in WGSL location after
    location. Those of ATTRIBUTES are position, normal, tangent with its handedness, uv, second uv, colour."""


def refusal(backend: str, text: Text, messages: Sequence[Message]) -> SssgenError:
    """The driver's messages about emitted text, at the technique's own lines."""
    reported = [message for message in messages if message.severity == "error"] or list(messages)
    lines = text.text.splitlines()
    return SssgenError([_diagnostic(backend, text, lines, message) for message in reported[:8]])


def _diagnostic(backend: str, text: Text, lines: list[str], message: Message) -> Diagnostic:
    emitted = lines[message.line - 1].strip() if 0 < message.line <= len(lines) else ""
    hint = f"line {message.line} of what was emitted: {emitted}" if emitted else ""
    file, line, column = (*text.origin.get(message.line, ":0:0").rsplit(":", 2),)
    span = Span(file, int(line), int(column), int(line), int(column) + 1)
    return Diagnostic("error", f"{backend}: {message.text}", span, hint, source_line(span) if file else "")


def backend_failure(backend: str, problem: str, hint: str = "") -> SssgenError:
    """The error of a back end that failed for a reason outside of the text: a lost device, too little memory."""
    return SssgenError([Diagnostic("error", f"{backend}: {problem}", hint=hint)])
