"""Inputs from files: numbers in JSON, textures as pictures or arrays."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.run.evaluate.probes import Subject
from sssgen.scene.pictures import images
from sssgen.support import json_source
from sssgen.support.diagnostics import failure
from sssgen.support.text_files import MAX_BYTES, refuse_special
from sssgen.targets.runtime.numpy_textures import Texture


def bindings(texts: Sequence[str]) -> dict[str, str]:
    """`SLOT=FUNCTION` texts as slot → function. Raises SssgenError."""
    functions: dict[str, str] = {}
    for text in texts:
        slot, equals, function = text.partition("=")
        if not (equals and slot and function):
            raise failure(f"'{text}' is not a binding", "--bind SLOT=FUNCTION or SLOT=FILE:FUNCTION")
        if slot in functions:
            raise failure(f"'{slot}' is bound twice")
        functions[slot] = function
    return functions


def read(path: str, subject: Subject) -> dict[str, Any]:
    """The inputs of a JSON file, or of the standard input for `-`.

    They are name → number, list or, for a texture, a `Texture` from a file next to it.

    A texture is `"wood.png"`, or `{"file": "wood.png", "wrap": "clamp", "filter": "nearest"}`; the colours of a
    .png for a uniform with the hint `source_color` are decoded from sRGB. Raises SssgenError with the position.
    """
    file = Path(path)
    try:
        if path == "-":
            text = sys.stdin.buffer.read(MAX_BYTES).decode("utf-8")
        else:
            refuse_special(path, path)
            text = file.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise failure("the inputs are not UTF-8 text", "numbers by name, in JSON", path) from None
    except OSError as error:
        raise failure(f"cannot read the inputs: {error.strerror}", file=path) from None
    except ValueError:
        raise failure("this is not a valid file name", file=path) from None
    data = json_source.parse(text, path)
    if not isinstance(data, dict):
        raise failure("the inputs are not a JSON object", 'for instance {"N": [[0, 0, 1]], "power": 4.0}', path)
    colors = {name for name, uniform in subject.uniforms.items() if "source_color" in dict(uniform.hints)}
    return {
        name: _texture(name, value, file, name in colors) if isinstance(value, str | dict) else value
        for name, value in data.items()
    }


def _texture(name: str, raw: str | dict[str, Any], beside: Path, srgb: bool) -> Texture:
    keys = {"file", "wrap", "filter"}
    options = {"file": raw} if isinstance(raw, str) else raw
    if (
        "file" not in options
        or options.keys() - keys
        or not all(isinstance(option, str) for option in options.values())
    ):
        raise failure(
            f"texture '{name}'has an unknown form",
            'a file name, or {"file": …, "wrap": …, "filter": …}',
            str(beside),
        )
    path, wrap, filter = str(beside.parent / options["file"]), options.get("wrap", "repeat"), options.get("filter")
    return texture(path, wrap, filter or "linear", srgb)


def texture(path: str, wrap: str = "repeat", filter: str = "linear", srgb: bool = False) -> Texture:
    """A texture from a file; the lowest row of a .png or .exr is at v = 0, the first one of others. Raises SssgenError.

    With `srgb` the colours of a .png are decoded to linear light, as an engine's sRGB textures are. A grey .png, and
    any grey picture of colours, has three equal channels, as in engines.
    """
    data = images.read(path)
    if data.shape[-1] < 3 and (srgb or path.lower().endswith(".png")):
        data = np.concatenate([np.repeat(data[..., :1], 3, axis=-1), data[..., 1:]], axis=-1)
    if srgb and path.lower().endswith(".png"):
        data = np.concatenate([images.decode_srgb(data[..., :3]), data[..., 3:]], axis=-1)
    picture = path.lower().endswith((".png", ".exr"))
    try:
        return Texture(np.flipud(data) if picture else data[..., None] if data.ndim == 2 else data, filter, wrap)
    except ValueError as error:
        raise failure(f"this is not a texture: {error}", "(height, width, channels), in 3-D (depth, …)", path) from None
