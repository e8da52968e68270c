"""Writes baked textures and their JSON files atomically."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.bake.bake_facts import BakeFacts
from sssgen.bake.volume_files import FORMATS, encode_volume, layout
from sssgen.material import baked
from sssgen.scene.light_response import SUFFIX, checksum
from sssgen.scene.pictures import images
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.file_writer import check_file, check_names, write_files
from sssgen.support.installed_files import is_installed, refusal
from sssgen.support.paths import posix
from sssgen.version import VERSION

PICTURES = images.SUFFIXES


def volume_format(path: str, format: str | None) -> str:
    """The format of a volume's file: `format`, or the format of the path's suffix. Commands check it before the work.

    Raises SssgenError for an unknown format, and for a path that cannot be written.
    """
    _check_place(path)
    suffix = os.path.splitext(path)[1].lower()
    if format is None:
        formats = [name for name, ending in FORMATS.items() if ending == suffix]
        if not formats:
            hint = did_you_mean(suffix, FORMATS.values()) or f"end it in {', '.join(FORMATS.values())}"
            raise failure(f"'{suffix}' is not the suffix of a volume file", f"{hint}, or name a --format", posix(path))
        return formats[0]
    if format not in FORMATS:
        raise failure(f"unknown format '{format}'", did_you_mean(format, FORMATS) or f"one of: {', '.join(FORMATS)}")
    if suffix != FORMATS[format]:
        raise failure(f"a file of the format {format} ends in {FORMATS[format]}", "", posix(path))
    return format


def check_response_path(path: str) -> None:
    """Raises SssgenError for a path that no response of a body can have. Commands call it before the work."""
    _check_place(path)
    suffix = os.path.splitext(path)[1]
    if suffix.lower() != SUFFIX:
        raise failure(f"'{suffix}' is not the suffix of a response's file", f"end it in {SUFFIX}", posix(path))


def write_response(path: str, data: bytes, facts: BakeFacts) -> list[str]:
    """Writes the response of a body to light, and its JSON; returns the paths."""
    folder, name = os.path.split(path)
    return [written.path for written in write_files(folder, response_files(name, data, facts))]


def response_files(name: str, data: bytes, facts: BakeFacts) -> dict[str, str | bytes]:
    """The file of a response, and its JSON, by their names."""
    about = {"name": os.path.basename(name), "bytes": len(data), "adler32": checksum(data)}
    return {name: data, **_json_beside(name, {**facts, "file": about})}


def write_volume(path: str, texels: npt.NDArray[Any], format: str, facts: BakeFacts) -> list[str]:
    """Writes a volume and its JSON; returns the paths."""
    return _write(
        path,
        encode_volume(texels, format),
        {**facts, "file": {"name": os.path.basename(path), **layout(texels, format)}},
    )


def picture_suffix(path: str, allowed: tuple[str, ...] = PICTURES) -> str:
    """The suffix of a picture's path. Commands check it before the work.

    Raises SssgenError for a suffix that is not in `allowed`, and for a path that cannot be written.
    """
    _check_place(path)
    suffix = images.check_suffix(path)
    if suffix not in allowed:
        raise failure(f"the output cannot have the format '{suffix}'", f"end it in {' or '.join(allowed)}", posix(path))
    return suffix


def write_picture(
    path: str,
    values: npt.NDArray[np.float64],
    facts: BakeFacts,
    bits: int = 16,
    beside: Mapping[str, str] | None = None,
) -> list[str]:
    """Writes a picture (h, w) or (h, w, channels), row 0 at the top, its JSON, and more files `beside` it.

    .png: values 0..1, with `bits` bits. .exr: float32. .npy: float32 with row 0 at the bottom, as sssgen reads arrays.
    Returns the paths.
    """
    suffix = picture_suffix(path)
    layers = values if values.ndim == 3 else values[..., None]
    if suffix == ".npy":
        buffer = io.BytesIO()
        np.save(buffer, np.flipud(layers).astype("<f4"), allow_pickle=False)
        data, encoding = buffer.getvalue(), "r32f"
    elif suffix == ".exr":
        data, encoding = images.exr_bytes(layers), "r32f"
    else:
        data, encoding = images.png_bytes(layers, bits), f"unorm{bits}"  # the error is at most half a step
    height, width = layers.shape[:2]
    about = {
        "name": os.path.basename(path), "size": {"x": width, "y": height}, "channels": layers.shape[2],
        "encoding": encoding,
    }  # fmt: skip
    return _write(path, data, {**facts, "file": about}, beside)


def check_cube_path(path: str) -> None:
    """Raises SssgenError for a path that no cube map can have. Commands call it before the work."""
    _check_place(path)
    suffix = os.path.splitext(path)[1]
    if suffix.lower() != ".dds":
        raise failure(f"'{suffix}' is not the suffix of a cube map's file", "end it in .dds", posix(path))


def write_cubes(path: str, cubes: Mapping[str, bytes], facts: BakeFacts) -> list[str]:
    """Writes cube maps, by what follows the name of `path`, and one JSON file; returns the paths."""
    check_cube_path(path)
    stem, suffix = os.path.splitext(path)
    folder, name = os.path.split(stem)
    files: dict[str, str | bytes] = {f"{name}{ending}{suffix}": data for ending, data in cubes.items()}
    return [written.path for written in write_files(folder, {**files, **_json_beside(f"{name}{suffix}", facts)})]


def check_apart(path: str, sources: Iterable[str]) -> None:
    """Raises SssgenError if an output, at the path or next to it, is one of the sources."""
    for written in (path, baked.sidecar(path), mesh_beside(path)):
        for source in sources:
            if os.path.exists(written) and os.path.exists(source) and os.path.samefile(written, source):
                raise failure("this would overwrite a source file", "name another file with -o", posix(written))


def mesh_beside(path: str) -> str:
    """The path of a mesh with new texture coordinates for a map."""
    return f"{path}.obj"


def _check_place(path: str) -> None:
    """Raises SssgenError if the path, or that of its JSON, is a folder or comes with sssgen, or a parent is a file."""
    check_names([os.path.basename(path)])
    if is_installed(path):
        raise refusal(path)
    for file in (path, baked.sidecar(path)):
        check_file(file)


def _write(path: str, data: bytes, facts: Mapping[str, object], beside: Mapping[str, str] | None = None) -> list[str]:
    folder, name = os.path.split(path)
    files: dict[str, str | bytes] = {name: data, **_json_beside(name, facts), **(beside or {})}
    return [written.path for written in write_files(folder, files)]


def _json_beside(name: str, facts: Mapping[str, object]) -> dict[str, str]:
    """The JSON file of a texture's file, with its text."""
    content = {"format": baked.FORMAT, "made_by": f"sssgen {VERSION}", **facts}
    lines = [f" {json.dumps(key)}: {json.dumps(value)}" for key, value in content.items()]
    return {baked.sidecar(name): "{\n" + ",\n".join(lines) + "\n}\n"}
