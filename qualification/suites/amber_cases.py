"""The GraphicsFuzz cases of VK-GL-CTS: files `*.amber`, as their owner publishes them.

The programs are SPIR-V; a comment before most has the GLSL that it was made of, which is what is read here. Commands
give the buffers, the size of the picture and what is expected of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from qualification.suites.outcomes import SuiteFormatError

_TYPE = re.compile(r"(?:mat(?P<columns>\d)x(?P<rows>\d)|vec(?P<size>\d))?<?(?P<kind>float|u?int32)>?(?:\[\])?")
_KINDS: dict[str, type] = {"float": np.float32, "int32": np.int32, "uint32": np.uint32}
_TEST = re.compile(r"^\[test\]$", re.MULTILINE)
ASSEMBLY = "; assembly"
"""The first line of a text that is SPIR-V, for want of a comment"""
PUSH = "push_constant"
"""The place of constants that need no binding."""


class Pipeline(NamedTuple):
    """A program with what is bound to it, and how it runs."""

    stages: dict[str, str]
    """`vertex`, `fragment` or `compute` → GLSL or ASSEMBLY; '' for a vertex shader that passes positions on"""
    size: tuple[int, int]
    """Of its picture"""
    target: str
    """The buffer that it draws into"""
    bound: dict[str, str]
    """`0:1` for a set and a binding, or PUSH → the name of a buffer; a texture is a buffer of another pipeline"""
    run: tuple[str, ...] = ()
    """`DRAW_RECT` and its numbers, or the numbers of workgroups"""


class Expectation(NamedTuple):
    """What a buffer has to be."""

    buffer: str
    compare: str
    """`EQ_RGBA`, `EQ_RGB`, `EQ` or `EQ_HISTOGRAM_EMD_BUFFER`"""
    place: tuple[int, ...]
    """x, y, width and height in a picture; the byte in another buffer"""
    values: tuple[float, ...]
    """The color or number; the tolerance of a histogram"""
    other: str = ""
    """The buffer with the same histogram"""


class Case(NamedTuple):
    """A file."""

    name: str
    pipelines: tuple[Pipeline, ...]
    """In the order of their runs"""
    buffers: dict[str, bytes]
    types: dict[str, str]
    """Of the numbers in a buffer"""
    expects: tuple[Expectation, ...]


def read(path: Path) -> Case:
    """The case of a file."""
    text = path.read_text("utf-8")
    return _script(path.stem, text) if _TEST.search(text) else _commands(path.stem, text)


def _commands(name: str, text: str) -> Case:
    lines = iter(text.splitlines())
    comment: list[str] = []
    source = ""
    shaders: dict[str, tuple[str, str]] = {}
    pipelines: dict[str, Pipeline] = {}
    buffers: dict[str, bytes] = {}
    types: dict[str, str] = {}
    expects = []
    for line in lines:
        if line.startswith("#"):
            comment.append(line[1:].removeprefix(" "))
            continue
        source = _glsl(comment) or source
        comment = []
        match line.split():
            case ["SHADER", stage, shader, "PASSTHROUGH"]:
                shaders[shader] = stage, ""
            case ["SHADER", stage, shader, kind, *_]:
                body = "\n".join([*_block(lines), ""])
                shaders[shader] = stage, (source or f"{ASSEMBLY}\n{body}") if kind == "SPIRV-ASM" else body
                source = ""
            case ["BUFFER", buffer, "DATA_TYPE", type_, *words, "DATA"]:
                types[buffer] = type_
                buffers[buffer] = packed(type_, "STD140" in words, " ".join(_block(lines)).split())
            case ["PIPELINE", _, pipeline]:
                pipelines[pipeline] = _pipeline(_block(lines), shaders)
            case ["RUN", pipeline, *words]:
                ran = pipelines.pop(pipeline)
                pipelines[pipeline] = ran._replace(run=tuple(words))
            case ["EXPECT", *words]:
                expects.append(_expectation(words))
    ran_ones = tuple(pipeline for pipeline in pipelines.values() if pipeline.run)
    return Case(name, ran_ones, buffers, types, tuple(expects))


def _block(lines: Iterator[str]) -> list[str]:
    """The lines up to `END`."""
    return [line for line in iter(lambda: next(lines), "END") if line is not None]


def _glsl(lines: list[str]) -> str:
    """The part of a comment that is GLSL: from its version on; '' where there is none."""
    start = next((index for index, line in enumerate(lines) if line.startswith("#version")), len(lines))
    return "\n".join([*lines[start:], ""]) if lines[start:] else ""


def _pipeline(lines: list[str], shaders: Mapping[str, tuple[str, str]]) -> Pipeline:
    stages, bound, size, target = {}, {}, (0, 0), ""
    for line in lines:
        match line.split():
            case ["ATTACH", shader, *_]:
                stages[shaders[shader][0]] = shaders[shader][1]
            case ["FRAMEBUFFER_SIZE", width, height]:
                size = int(width), int(height)
            case ["BIND", "BUFFER", buffer, "AS", "color", *_]:
                target = buffer
            case ["BIND", "BUFFER", buffer, "AS", kind] if kind == PUSH:
                bound[PUSH] = buffer
            case ["BIND", "BUFFER", buffer, "AS", *_, "DESCRIPTOR_SET", group, "BINDING", binding]:
                bound[f"{group}:{binding}"] = buffer
    return Pipeline(stages, size, target, bound)


def _expectation(words: list[str]) -> Expectation:
    match words:
        case [buffer, "EQ_HISTOGRAM_EMD_BUFFER", other, "TOLERANCE", tolerance]:
            return Expectation(buffer, words[1], (), (float(tolerance),), other)
        case [buffer, "IDX", x, y, "SIZE", width, height, compare, *values]:
            return Expectation(buffer, compare, tuple(map(int, (x, y, width, height))), tuple(map(float, values)))
        case [buffer, "IDX", place, compare, *values]:
            return Expectation(buffer, compare, (int(place),), tuple(map(float, values)))
    raise SuiteFormatError(f"EXPECT {' '.join(words)}")


def packed(type_: str, std140: bool, numbers: list[str]) -> bytes:
    """The bytes of a buffer's numbers."""
    match = _TYPE.fullmatch(type_)
    if match is None:
        raise SuiteFormatError(f"DATA_TYPE {type_}")
    rows, columns = int(match["rows"] or match["size"] or 1), int(match["columns"] or 1)
    dtype = _KINDS[match["kind"]]
    whole = dtype is not np.float32
    lines = np.array([int(number) % 2**32 if whole else float(number) for number in numbers])
    lines = lines.astype(np.uint32 if whole else dtype).view(dtype).reshape(-1, rows)
    step = 4 if std140 and (columns > 1 or type_.endswith("[]")) else {3: 4}.get(rows, rows)
    data: Any = np.zeros((len(lines), step), dtype)
    data[:, :rows] = lines
    return bytes(data.tobytes())


def _script(name: str, text: str) -> Case:
    """A file in the format of VkRunner: a compute shader, and commands behind `[test]`."""
    head, test = _TEST.split(text, 1)
    comment = [line[1:].removeprefix(" ") for line in head.split("\n[", 1)[0].splitlines() if line.startswith("#")]
    bound, buffers, expects, run = {}, dict[str, bytes](), [], ()
    for line in test.splitlines():
        match line.split():
            case ["uniform", "ubo", place, type_, "0", *numbers]:
                bound[place] = place
                buffers[place] = packed(re.sub(r"(\d)$", r"\1<float>", type_), True, numbers)
            case ["ssbo", binding, "subdata", type_, start, *numbers]:
                place = bound[f"0:{binding}"] = f"0:{binding}"
                buffers[place] = buffers.get(place, b"")[: int(start)] + packed(f"{type_}32", False, numbers)
            case ["compute", *groups]:
                run = tuple(groups)
            case ["probe", "ssbo", _, binding, at, "==", number]:
                expects.append(Expectation(f"0:{binding}", "EQ", (int(at),), (float(number),)))
    return Case(name, (Pipeline({"compute": _glsl(comment)}, (0, 0), "", bound, run),), buffers, {}, tuple(expects))
