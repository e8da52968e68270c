"""Runs the renderer feature for URP on stand-ins of Unity's objects, and draws its commands with the emitted shader.

The feature is compiled with mono. The stand-in of the command buffer keeps the commands as rows; they are drawn in
OpenGL, whose clip space the stand-in has, too. Unity's world is left-handed: all places here are mirrored in z.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import pytest

from folders import ROOT
from sssgen.run.backends import Array, Bound, Drawing, Place, Stage, Text
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.backends.unity_program import UnityProgram
from sssgen.run.render import unity_values
from sssgen.run.render.shell_values import Shell
from sssgen.targets import registry
from sssgen.targets.javascript_runtime import runtime_text
from sssgen.targets.runtime.numpy_textures import Texture

STAND_INS = ROOT / "tests/run/unity_csharp"
VERSIONS = {
    "URP 12": (),
    "URP 14": ("UNITY_2022_2_OR_NEWER",),
    "URP 17": ("UNITY_2022_2_OR_NEWER", "UNITY_2023_2_OR_NEWER", "UNITY_6000_0_OR_NEWER"),
    "URP 17, Compatibility Mode": (
        "UNITY_2022_2_OR_NEWER",
        "UNITY_2023_2_OR_NEWER",
        "UNITY_6000_0_OR_NEWER",
        "URP_COMPATIBILITY_MODE",
    ),
}
"""The symbols that Unity defines, by version."""
MIRROR = np.diag([1.0, 1.0, -1.0, 1.0])
_PASS = re.compile(r"^        Pass \{\n(.*?)^        \}\n", re.DOTALL | re.MULTILINE)
_TAG = re.compile(r'"(\w+)" = "([^"]*)"')


class Lamp(NamedTuple):
    """A light in this project's world; `towards`: the direction towards a directional light, or where a spot points."""

    kind: str
    place: Sequence[float] = (0.0, 0.0, 0.0)
    towards: Sequence[float] = (0.0, 0.0, 1.0)
    color: Sequence[float] = (1.0, 1.0, 1.0)
    spot_angle: float = 30.0
    reach: float = 1e4


class Frame(NamedTuple):
    """What the feature did in one frame."""

    commands: list[list[str]]
    values: list[dict[str, str]]
    """For each body property → its value as text."""
    warnings: list[str]
    lent: int
    """The temporary textures that are not given back at the end."""

    def matrix(self, name: str) -> Array:
        """A matrix of the first body, for places of this project's world."""
        numbers = np.array(self.values[0][name].split(), np.float64)
        return numbers.reshape(4, 4) @ MIRROR


def mono() -> tuple[str, str]:
    """The compiler and the runtime; skips the test without them, and fails it where CI is set."""
    programs = shutil.which("mcs"), shutil.which("mono")
    if programs[0] is None or programs[1] is None:
        reason = "mcs and mono are missing (Debian: mono-mcs)"
        pytest.fail(reason) if os.environ.get("CI", "") not in ("", "0", "false") else pytest.skip(reason)
    return programs[0], programs[1]


def runtime_of(name: str) -> str:
    """A C# file as `emit` writes it for URP."""
    target = registry.load("unity-urp")
    (file,) = (file for file in target.files["shader"] if file.name == name)
    return runtime_text(file.sources, target.folder)


def compile_feature(version: str, folder: Path) -> Path:
    """The program that runs the feature on the stand-ins, as a version of Unity compiles it; a warning is an error."""
    program = folder / "frame.exe"
    symbols = [f"-define:{symbol}" for symbol in VERSIONS[version]]
    feature = folder / "SssgenPasses.cs"
    feature.write_text(runtime_of(feature.name), encoding="utf-8")
    sources = map(str, [*sorted(STAND_INS.glob("*.cs")), feature])
    call = [mono()[0], "-langversion:latest", "-warnaserror", *symbols, f"-out:{program}", *sources]
    done = subprocess.run(call, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return program


def passes_of(shader: str) -> list[tuple[str, dict[str, str]]]:
    """The text and the tags of each pass of a .shader file."""
    return [(text, dict(_TAG.findall(text.split("Tags", 1)[1].split("}")[0]))) for text in _PASS.findall(shader)]


def run_feature(
    program: Path, shader: str, boxes: Sequence[tuple[Array, Array]], lamps: Sequence[Lamp], eye: tuple[Array, Array],
    size: tuple[int, int], given: str = "",
) -> Frame:  # fmt: skip
    """A frame with a body in each box, seen from `eye`: its place, and the matrix from world to clip space.

    `given` is a texture that the materials have already.
    """
    rows: list[list[Any]] = [["pass", *sum(tags.items(), ())] for _, tags in passes_of(shader)]
    rows += [["tag", *tag] for tag in _TAG.findall(shader.partition("SubShader")[2].partition("Pass {")[0])]
    for lamp in lamps:
        ahead = lamp.towards if lamp.kind == "Spot" else np.negative(lamp.towards)
        place, ahead = _mirrored(lamp.place), _mirrored(ahead / np.linalg.norm(ahead))
        rows.append(["light", lamp.kind, *place, *ahead, *lamp.color, lamp.spot_angle, lamp.reach])
    rows += [["body", given, *_mirrored((low + high) / 2), *(high - low)] for low, high in boxes]
    place, matrix = eye
    view = _view(place, matrix)
    projection = matrix @ np.linalg.inv(view)
    rows.append(["camera", "", *size, *_mirrored(place), *(view @ MIRROR).ravel(), *projection.ravel()])
    text = "\n".join("\t".join(map(str, row)) for row in rows) + "\n"
    done = subprocess.run(
        [mono()[1], str(program)], input=text, capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    written = [line.split("\t") for line in done.stdout.splitlines()]
    values: list[dict[str, str]] = [{} for _ in boxes]
    for _, body, name, value in (row for row in written if row[0] == "value"):
        values[int(body)][name] = value
    (lent,) = (int(row[1]) for row in written if row[0] == "lent")
    warnings = [row[1] for row in written if row[0] == "warning"]
    return Frame([row for row in written if row[0] not in ("value", "warning", "lent")], values, warnings, lent)


def _view(place: Array, matrix: Array) -> Array:
    """World to view space of an eye whose `matrix` goes to clip space; how it is turned about its axis is free."""
    ahead = matrix[3, :3]
    right = np.cross(ahead, np.roll(ahead, 1))
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = right, np.cross(right, ahead), -ahead
    view[:3, 3] = -view[:3, :3] @ place
    return view


def _mirrored(place: Sequence[float] | Array) -> Array:
    return MIRROR[:3, :3] @ np.asarray(place, np.float64)


class Replay(UnityProgram):
    """Draws the commands of a frame into pictures, with the passes of the emitted shader."""

    def __init__(self, machine: UnityHLSL, shader: str) -> None:
        super().__init__(machine.name, machine.target.name, "dxc")
        head, _, rest = shader.partition("        Pass {\n")
        tail = rest[rest.rindex("    }\n    FallBack") :]
        self.passes: list[tuple[str, Stage, Stage] | None] = []
        self.modes: list[str] = []
        for text, tags in passes_of(shader):
            alone = Text(f"{head}        Pass {{\n{text}        }}\n{tail}")
            self.modes.append(tags["LightMode"])
            if not tags["LightMode"].startswith("Sssgen"):
                self.passes.append(None)
                continue
            stages = (machine.forward(alone, stage, ("_ADDITIONAL_LIGHTS=1",)) for stage in ("vertex", "fragment"))
            self.passes.append((text, *stages))
        self.pictures: dict[str, tuple[Any, Any]] = {}
        self.state: dict[str, Any] = {}

    def pictures_of(
        self, frame: Frame, mesh: tuple[Array, Array], lights: Mapping[str, Array] = MappingProxyType({})
    ) -> dict[str, Array]:
        """Number of a texture → (rows, columns, 4), row 0 at v = 0. `lights` are what URP says of them."""
        vertices, triangles = mesh
        values = unity_values._engine(Shell(np.eye(4), np.zeros(3)), (1, 1)) | dict(lights)
        bound: dict[str, Bound] = {}

        def draw(number: int) -> None:
            drawn = self.passes[number]
            assert drawn is not None
            self.state["pass"], vertex, fragment = drawn
            self.draw(Drawing((1, 1), fragment, vertex, True, bound, {}, values, vertices, triangles))

        for word, *rest in frame.commands:
            numbers = " ".join(rest).split()
            if word in ("target", "copy"):
                self._make(numbers[:6])
                self.state["frame"] = self.pictures[numbers[0]][0]
                self.state["viewport"] = (0, 0, *map(int, numbers[1:3]))
            if word == "copy":
                self._make(numbers[6:])
                with self.context:
                    self.pictures[numbers[6]][1].write(self.pictures[numbers[0]][1].read())
            elif word == "clear":
                self._clear(numbers)
            elif word == "viewport":
                self.state["viewport"] = tuple(int(float(number)) for number in numbers)
            elif word == "set":
                values[numbers[0]] = _as_columns(np.array(numbers[1:], np.float64))
            elif word == "texture":
                bound[numbers[0]] = Bound(Texture(self._read(numbers[1])), Place(0, 0))
            elif word == "draw" and numbers[1] == "1":  # the stand-in's first material is none
                draw(int(numbers[2]))
            elif word == "bodies":
                draw(self.modes.index(numbers[0]))
        return {number: self._read(number) for number in self.pictures}

    def _make(self, numbers: Sequence[str]) -> None:
        number, width, height, kind, filtering, wrapping = numbers
        assert filtering in ("Point", "Bilinear") and wrapping == "Clamp"
        if number not in self.pictures:
            size = int(width), int(height)
            with self.context:
                texture = self.context.texture(size, 4 if kind == "ARGBFloat" else 1, dtype="f4")
                depth = self.context.depth_renderbuffer(size)
                self.pictures[number] = self.context.framebuffer([texture], depth), texture

    def _clear(self, numbers: Sequence[str]) -> None:
        depth, color, *value = numbers
        assert depth == "True"
        with self.context:
            frame = self.state["frame"]
            frame.color_mask = (color == "True",) * 4
            frame.clear(*map(float, value), depth=1.0)

    def _read(self, number: str) -> Array:
        texture = self.pictures[number][1]
        with self.context:
            data = np.frombuffer(texture.read(), np.float32).reshape(texture.height, texture.width, texture.components)
        return np.concatenate([data] * 4, axis=2) if texture.components == 1 else data

    def upload(self, data: Any) -> Any:
        texels = np.ascontiguousarray(data.levels[0], np.float32)
        texture = self.context.texture(data.size(), 4, texels.tobytes(), dtype="f4")
        texture.filter = (self.context.NEAREST, self.context.NEAREST)
        return texture

    def fill(self, program: Any, drawing: Drawing) -> Array:
        """Draws as the pass says: it keeps the nearest, and Unity's front faces are clockwise."""
        context, frame, kept = self.context, self.state["frame"], []

        def keep(resource: Any) -> Any:
            kept.append(resource)
            return resource

        self.bind_uniforms(program, drawing.textures, drawing.values, keep)
        self.bind_blocks(program, drawing.blocks, keep)
        array = keep(self.vertex_array(program, drawing, keep))
        channels, side = (
            match[1] if (match := re.search(rf"{word} (\w+)", self.state["pass"])) else usual
            for word, usual in (("ColorMask", "RGBA"), ("Cull", "Back"))
        )
        frame.color_mask = tuple(name in channels for name in "RGBA")
        frame.use()
        context.viewport = self.state["viewport"]
        context.enable_only(context.DEPTH_TEST | context.CULL_FACE)
        context.front_face, context.cull_face, context.depth_func = "cw", side.lower(), "<="
        array.render(context.TRIANGLES)
        context.front_face, context.cull_face = "ccw", "back"
        for resource in kept:
            resource.release()
        return np.zeros(0)


def full_floats(program: UnityProgram, texture: Texture) -> Any:
    """A texture as the feature makes it; this back end rounds others to halves."""
    if texture.dim == "Cube":  # of Unity's own headers
        return type(program).texels(program, texture)
    create = {"2D": program.context.texture, "3D": program.context.texture3d}[texture.dim]
    return create(texture.size(), 4, np.ascontiguousarray(texture.levels[0], np.float32).tobytes(), dtype="f4")


def _as_columns(numbers: Array) -> Array:
    """A value as `UnityProgram` sets it: a matrix, which Unity writes row by row, as its columns."""
    return numbers.reshape(4, 4).T if numbers.size == 16 else numbers


def mirrored(mesh: tuple[Array, Array]) -> tuple[Array, Array]:
    """A mesh in Unity's world, where a front face has its corners clockwise, as the camera shows it."""
    vertices, triangles = mesh
    turned = vertices.copy()
    turned[:, [2, 5, 8]] *= -1.0
    return turned, np.ascontiguousarray(triangles[:, ::-1])


def texture_numbers(values: dict[str, str]) -> dict[str, str]:
    """The texture properties of a body, and the numbers of their pictures."""
    return {name: value.split()[0] for name, value in values.items() if value.endswith("Clamp")}
