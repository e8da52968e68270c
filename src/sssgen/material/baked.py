"""The JSON file next to a baked texture: its quantity, and the parameters that belong to it."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler
from sssgen.material import library
from sssgen.support import cache
from sssgen.support.diagnostics import failure
from sssgen.support.file_memo import note
from sssgen.support.paths import posix

FORMAT = 1
"""The version of the JSON format."""
MAX_BYTES = 2**20
INDEX = "ior"
"""The parameter for the refractive index of a medium."""
MEDIUM = ("extinction", "scattering_albedo", "mean_free_path", INDEX)
"""The parameters of techniques that state the medium of a bake."""
SAME = 0.01
"""The relative difference up to which two values of a medium are the same."""
LARGEST = 1e30
"""Larger than any number of a bake."""
UNITS = "materials use metres: scale the mesh to a few units"
"""The hint if a baked length is outside a parameter's range."""


ParameterValue = float | list[float]
"""A number, or the components of a vector or a matrix; a matrix column by column."""
Numbers = float | Sequence[float]
"""A number, or the components of a vector."""


class BakeFile(NamedTuple):
    """The content of the JSON file next to a baked texture."""

    kind: str
    """distance, thickness, transmittance, depth, cells, normal or packed"""
    holds: str
    """The quantity type of its numbers; "" if they have none"""
    parameters: Mapping[str, ParameterValue]
    """The parameters of techniques that it needs, by name: TOML values, in the body's object space"""
    settings: Mapping[str, object]
    """How an engine imports it; see `targets.texture_import`"""
    facts: Mapping[str, object]
    """The whole content of the file; only the parts above are checked"""


def sidecar(path: str) -> str:
    """The path of a texture's JSON file."""
    return f"{path}.json"


def read_bake_file(path: str) -> BakeFile | None:
    """The content of a texture's JSON file; None if there is no such file. Raises SssgenError for an invalid one."""
    file = sidecar(path)
    note(file)
    if not os.path.isfile(file):
        return None
    from sssgen.support import json_source  # loads `json`, which few materials need

    shown = posix(file)
    try:
        with open(file, "rb") as opened:
            data = json_source.parse(opened.read(MAX_BYTES + 1)[:MAX_BYTES].decode("utf-8"), shown)
    except (OSError, UnicodeDecodeError) as error:
        raise failure(f"cannot read the baked data: {error}", "bake it again", shown) from None
    if not isinstance(data, dict) or not isinstance(data.get("kind"), str):
        return None  # another program's JSON
    if data.get("format") != FORMAT:
        raise failure(f"the format is not {FORMAT}", "bake it again", shown)
    parameters, settings = data.get("parameters", {}), data.get("import", {})
    if not isinstance(parameters, dict) or not isinstance(settings, dict):
        raise failure("'parameters' and 'import' are tables", "bake it again", shown)
    for name, value in parameters.items():
        numbers = value if isinstance(value, list) else [value]
        if not all(isinstance(number, int | float) and abs(number) < LARGEST for number in numbers):
            raise failure(f"'parameters': '{name}' must be a number or a list of numbers", "bake it again", shown)
    return BakeFile(data["kind"], str(data.get("holds") or ""), parameters, settings, data)


def mesh_key(content: bytes) -> str:
    """The entry `key` of the body of a JSON file, for a mesh with this content: that of `scene.body_identity.key`."""
    return cache.digest(repr(("Mesh", [], cache.digest(content))).encode())[:16]


def other_mesh(path: str) -> str:
    """The name of a mesh beside a baked texture, where it is no longer the one that was baked; else ''."""
    described = read_bake_file(path)
    body = described.facts.get("body") if described is not None else None
    if not isinstance(body, dict) or not isinstance(name := body.get("name"), str) or name.endswith(".sss"):
        return ""
    mesh = os.path.join(os.path.dirname(path), name)
    note(mesh)
    try:
        with open(mesh, "rb") as file:
            return "" if mesh_key(file.read()) == body.get("key") else name
    except OSError:  # it may be elsewhere
        return ""


def check(baked_texture: BakeFile, uniform: Uniform, name: str) -> None:
    """Raises SssgenError if a texture's uniform takes another quantity, dimension or part of a bake."""
    assert isinstance(uniform.type, Sampler)
    made_for = baked_texture.facts.get("texture", uniform.name)
    if made_for != uniform.name:
        raise failure(
            f"'{name}' is baked as '{made_for}', and not as '{uniform.name}'", "bind the file to that texture"
        )
    quantity = uniform.quantity
    if quantity and baked_texture.holds != quantity:
        holds = baked_texture.holds or f"no quantity: it is a {baked_texture.kind} texture"
        raise failure(f"'{name}' holds {holds}, and '{uniform.name}' takes {quantity}", _readers(baked_texture.holds))
    dimension = baked_texture.settings.get("dimension", uniform.type.dim)
    if dimension != uniform.type.dim:
        raise failure(f"'{name}' is a {dimension} texture, and '{uniform.name}' is {uniform.type.dim}")
    hints = dict(uniform.hints)
    is_normal, is_color = "normal_map" in hints, "source_color" in hints
    if (is_color and baked_texture.kind != "packed") or is_normal != (baked_texture.kind == "normal"):
        takes = "normals" if is_normal else "colours" if is_color else "other numbers"
        raise failure(f"'{name}' is a {baked_texture.kind} texture, and '{uniform.name}' takes {takes}")
    if is_normal and baked_texture.facts.get("green") == "directx":
        raise failure(f"the green channel of '{name}' points down, as in DirectX", "bake it with --green opengl")
    if "repeat_disable" in hints and not quantity and baked_texture.holds:
        raise failure(
            f"'{name}' holds {baked_texture.holds}, and '{uniform.name}' takes an image of the body from one view"
        )


def check_boundary(baked_texture: BakeFile, parameters: Collection[str], matched: bool, name: str) -> None:
    """Raises SssgenError if light is baked with a refracting surface and the technique, with these parameters, has no
    refractive index, or the reverse, unless it is for a matched boundary, too: then the unscattered light counts twice,
    or not at all.
    """
    if baked_texture.kind != "fluence" or INDEX not in baked_texture.parameters:
        return
    index, refracts = baked_texture.parameters[INDEX], INDEX in parameters
    if refracts != (index != 1.0) and not (matched and index == 1.0):
        does = "refracts" if refracts else "does not refract"
        technique = baked_texture.facts.get("technique", "")
        hint = f"use {technique}" if technique else "use the technique for this boundary"
        raise failure(f"'{name}' is baked with the refractive index {index:g}, and the technique {does}", hint)


def check_medium(baked_texture: BakeFile, values: Mapping[str, tuple[float, ...]], name: str) -> None:
    """Raises SssgenError if a material's values, by their names in its technique, are not the medium of baked light."""
    if baked_texture.kind != "fluence":
        return
    for parameter in MEDIUM:
        raw, own = baked_texture.parameters.get(parameter), values.get(parameter)
        if raw is not None and own is not None and not is_same(raw, own):
            raise failure(
                f"'{name}' is baked for the {parameter} {text(raw)}, and the material has {text(own)}",
                f"leave {parameter} out: it comes with the bake; or bake again with this medium",
            )


def is_same(a: Numbers, b: Numbers) -> bool:
    """Whether two values of a medium are the same but for rounding."""
    x, y = _components(a), _components(b)
    return len(x) == len(y) and all(abs(p - q) <= SAME * max(abs(p), abs(q)) for p, q in zip(x, y, strict=True))


def text(value: Numbers) -> str:
    """A number, or a vector as `(1, 2, 3)`, for messages."""
    numbers = [f"{component:.4g}" for component in _components(value)]
    return numbers[0] if len(numbers) == 1 else f"({', '.join(numbers)})"


def _components(value: Numbers) -> Sequence[float]:
    return (value,) if isinstance(value, int | float) else value


def _readers(quantity: str) -> str:
    """A hint with the techniques that take a texture of a quantity."""
    if not quantity:
        return "sssgen bake thickness makes a map of a quantity"
    techniques = [library.load(name) for name in library.index()]
    reading = [
        technique.name for technique in techniques if any(_takes(uniform, quantity) for uniform in technique.uniforms)
    ]
    if not reading:
        return "bake it again"
    return f"{quantity} is read by {' and '.join(reading)}; a conversion makes another quantity of it"


def _takes(uniform: Uniform, quantity: str) -> bool:
    return isinstance(uniform.type, Sampler) and uniform.quantity == quantity
