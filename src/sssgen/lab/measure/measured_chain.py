"""Measured chains: the emitted NumPy functions of a material, run on a scene's points.

A point of a chart is an ordinary material, so the measured code is the emitted code.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.ir.types import BY_NAME, Matrix, Vector, kind_of
from sssgen.material.material_loading import parse_material
from sssgen.material.material_text import MaterialSection, material_text
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled, compile
from sssgen.run.backends import Array
from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.runtime.numpy_values import grid, precision

NAME = "measured"


class Chain:
    """A material whose emitted NumPy functions run on points."""

    def __init__(self, material: Material, dtype: Any = np.float64) -> None:
        """float64 gives reference values, float32 the precision of a GPU."""
        self.material, self.dtype = material, dtype
        self.compiled: Compiled = compile(material, "numpy")
        self.reflection = self.compiled.reflection
        (text,) = [text for name, text in self.compiled.files.items() if name.endswith(".py")]
        self.names: dict[str, Any] = {}
        with precision(dtype):
            exec(text, self.names)
        self.uniforms = self.reflection["uniforms"]

    def set(self, values: Mapping[str, Any], textures: Mapping[str, Texture]) -> None:
        """Sets parameters and textures, by their names in techniques; others keep their values.

        The name may include the unit: `depth 1` is a depth in texture coordinates, and `depth` is any other. A value
        is a number, its components, or its components with lanes last; a matrix is in column order.
        """
        for uniform in self.uniforms:
            name = uniform["technique_name"]
            value = values.get(f"{name} {uniform['unit']}", values.get(name))
            if value is not None:
                self.names[uniform["name"]] = _reshape(uniform["type"], value, self.dtype)
        for texture in self.reflection["textures"]:
            if (data := textures.get(texture["technique_name"])) is not None:
                self.names[texture["name"]] = data

    def reads(self, texture: str) -> bool:
        """Whether the chain reads a texture, by its name in the technique."""
        return any(declared["technique_name"] == texture for declared in self.reflection["textures"])

    def run(self, inputs: Mapping[str, Array], lights: Iterable[Mapping[str, Array]]) -> list[Array]:
        """The transmitted light of each light, as a factor of its colour: (3, n) in linear light.

        The first one includes the surface's emission.
        """
        entries = self.reflection["entries"]
        count = inputs["P"].shape[-1]
        inputs = self._cast(inputs)
        results = []
        with precision(self.dtype), grid(1, count), np.errstate(all="ignore"):

            def call(kind: str, values: Mapping[str, Array], *first: Any) -> Any:
                return self.names[entries[kind]["function"]](
                    *first, *(values[name] for name in entries[kind]["inputs"])
                )

            surface = call("surface", inputs) if "surface" in entries else None
            emission = vars(surface).get("emission", 0.0) if surface is not None else 0.0
            for index, light in enumerate(lights):
                first = [surface] if surface is not None else []
                through = (
                    call("translucency", {**inputs, **self._cast(light)}, *first) if "translucency" in entries else 0.0
                )
                value = through + emission if index == 0 else through
                results.append(np.array(np.broadcast_to(value, (3, count)), np.float64))
        return results

    def _cast(self, values: Mapping[str, Array]) -> dict[str, Array]:
        return {name: np.asarray(value, self.dtype) for name, value in values.items()}

    def surface(self, inputs: Mapping[str, Array], field: str) -> Array:
        """A field of the surface, (k, n)."""
        entry = self.reflection["entries"]["surface"]
        count = inputs["P"].shape[-1]
        inputs = self._cast(inputs)
        with precision(self.dtype), grid(1, count), np.errstate(all="ignore"):
            surface = self.names[entry["function"]](*(inputs[name] for name in entry["inputs"]))
            value = np.asarray(getattr(surface, field), np.float64)
        return np.array(np.broadcast_to(value, (len(np.atleast_2d(value)), count)))


def _reshape(type_name: str, data: Any, dtype: Any) -> Any:
    """A value in the emitted module's layout: components first, lanes last."""
    type_ = BY_NAME[type_name.partition("[")[0]]
    kind = dtype if kind_of(type_) == "float" else np.int32
    value = np.asarray(data, kind)
    if isinstance(type_, Matrix):
        return value.reshape(type_.columns, type_.rows, -1)
    if isinstance(type_, Vector):
        return value.reshape(type_.size, -1)
    return value


def material_of(stages: Sequence[MaterialSection], folder: str, name: str = NAME) -> Material:
    """The material of a chain; paths in it are relative to `folder`. Raises SssgenError.

    It is measured light by light: an environment is a number of lights.
    """
    return parse_material(
        material_text(name, stages, settings={"surroundings": False}), os.path.join(folder, f"{name}.toml")
    )
