"""Chains that are measured: stages as a material's text, and the emitted NumPy functions run on a scene's points.

A point of a chart is a material like any other: what is measured is what is emitted.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends import Array
from sssgen.ir.types import BY_NAME, Matrix, Vector, kind_of
from sssgen.material.material_loading import parse_material
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled, compile
from sssgen.targets.numpy_textures import Texture
from sssgen.targets.numpy_values import grid, precision

NAME = "measured"


class Stage(NamedTuple):
    """One stage of a chain, as a material file has it."""

    section: str
    technique: str
    values: tuple[tuple[str, object], ...] = ()
    """The parameters that it gives"""
    fixed: tuple[str, ...] = ()
    """Those of them that are folded into the text"""
    bind: tuple[tuple[str, str], ...] = ()
    """Slot → function"""


def material_text(name: str, stages: Sequence[Stage], title: str = "", doc: str = "") -> str:
    """The material file of a chain."""
    lines = ["[material]", f"name = {_value(name)}"]
    lines += [f"title = {_value(title)}"] if title else []
    lines += [f"doc = {_value(doc)}"] if doc else []
    for stage in stages:
        lines += ["", f"[[{stage.section}]]", f"technique = {_value(stage.technique)}"]
        if stage.bind:
            lines.append(f"bind = {{ {', '.join(f'{slot} = {_value(to)}' for slot, to in stage.bind)} }}")
        for key, value in stage.values:
            shown = _value(value)
            lines.append(f"{key} = {{ value = {shown}, fixed = true }}" if key in stage.fixed else f"{key} = {shown}")
    return "\n".join(lines) + "\n"


def _value(value: Any) -> str:
    """A value in TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", " ")
        return f'"{escaped}"'
    if isinstance(value, int | np.integer):
        return str(int(value))
    if isinstance(value, float | np.floating):
        shown = f"{float(value):.6g}"
        return shown if any(mark in shown for mark in ".en") else f"{shown}.0"
    return f"[{', '.join(_value(part) for part in value)}]"


class Chain:
    """A material whose emitted functions are run on points."""

    def __init__(self, material: Material, dtype: Any = np.float64) -> None:
        """In float64 it is the oracle; in float32 what a GPU computes."""
        self.material, self.dtype = material, dtype
        self.compiled: Compiled = compile(material, "numpy")
        self.reflection = self.compiled.reflection
        (text,) = [text for name, text in self.compiled.files.items() if name.endswith(".py")]
        self.names: dict[str, Any] = {}
        with precision(dtype):
            exec(text, self.names)
        self.uniforms = self.reflection["uniforms"]

    def set(self, values: Mapping[str, Any], textures: Mapping[str, Texture]) -> None:
        """Gives parameters and textures by the names that techniques have for them; others keep their values.

        `depth 1` is a depth whose unit is "1", that is in texture coordinates; `depth` is every other. A parameter is a
        number, its components, or these with lanes last; a matrix goes column by column.
        """
        for uniform in self.uniforms:
            own = uniform["technique_name"]
            given = values.get(f"{own} {uniform['unit']}", values.get(own))
            if given is not None:
                self.names[uniform["name"]] = _shaped(uniform["type"], given, self.dtype)
        for texture in self.reflection["textures"]:
            given = textures.get(texture["technique_name"])
            if given is not None:
                self.names[texture["name"]] = given

    def reads(self, texture: str) -> bool:
        """Whether the chain reads a texture, by its technique's name for it."""
        return any(one["technique_name"] == texture for one in self.reflection["textures"])

    def run(self, inputs: Mapping[str, Array], lights: Iterable[Mapping[str, Array]]) -> list[Array]:
        """For each light what comes through, as a factor on its colour: (3, n) in linear light.

        What the surface gives off by itself is in the first.
        """
        entries = self.reflection["entries"]
        count = inputs["P"].shape[-1]
        inputs = self._cast(inputs)
        found = []
        with precision(self.dtype), grid(1, count), np.errstate(all="ignore"):

            def call(kind: str, given: Mapping[str, Array], *first: Any) -> Any:
                return self.names[entries[kind]["function"]](*first, *(given[name] for name in entries[kind]["inputs"]))

            surface = call("surface", inputs) if "surface" in entries else None
            given_off = vars(surface).get("emission", 0.0) if surface is not None else 0.0
            for number, light in enumerate(lights):
                first = [surface] if surface is not None else []
                through = (
                    call("translucency", {**inputs, **self._cast(light)}, *first) if "translucency" in entries else 0.0
                )
                value = through + given_off if number == 0 else through
                found.append(np.array(np.broadcast_to(value, (3, count)), np.float64))
        return found

    def _cast(self, values: Mapping[str, Array]) -> dict[str, Array]:
        return {name: np.asarray(value, self.dtype) for name, value in values.items()}

    def surface(self, inputs: Mapping[str, Array], field: str) -> Array:
        """A field of the surface, (k, n)."""
        entry = self.reflection["entries"]["surface"]
        count = inputs["P"].shape[-1]
        inputs = self._cast(inputs)
        with precision(self.dtype), grid(1, count), np.errstate(all="ignore"):
            made = self.names[entry["function"]](*(inputs[name] for name in entry["inputs"]))
            value = np.asarray(getattr(made, field), np.float64)
        return np.array(np.broadcast_to(value, (len(np.atleast_2d(value)), count)))


def _shaped(type_name: str, given: Any, dtype: Any) -> Any:
    """A value as the emitted module wants it: components first, lanes last."""
    type_ = BY_NAME[type_name.partition("[")[0]]
    kind = dtype if kind_of(type_) == "float" else np.int32
    value = np.asarray(given, kind)
    if isinstance(type_, Matrix):
        return value.reshape(type_.size, type_.size, -1)
    if isinstance(type_, Vector):
        return value.reshape(type_.size, -1)
    return value


def material_of(stages: Sequence[Stage], folder: str, name: str = NAME) -> Material:
    """The material of a chain; files that it names lie in `folder`. Raises SssgenError."""
    return parse_material(material_text(name, stages), os.path.join(folder, f"{name}.toml"))
