"""Baked volumes of one or four channels as files, in formats that engines and tools read."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.bake.dds import dds_bytes
from sssgen.bake.ktx2 import ORIENTATION, ktx2_bytes
from sssgen.bake.slice_sheet import columns_and_rows, sheet
from sssgen.scene.pictures import images
from sssgen.scene.pictures.volumes import ENCODINGS, Encoding
from sssgen.support.diagnostics import did_you_mean, failure

FORMATS = {"npy": ".npy", "dds": ".dds", "ktx2": ".ktx2", "exr-slices": ".exr", "raw+json": ".raw"}
"""Format → file name suffix."""


def encode_volume(texels: npt.NDArray[Any], format: str) -> bytes:
    """The file of a volume; texels are little-endian.

    `texels` is (depth, height, width) = z, y, x ascending, with a fourth axis for four channels; uint8 and uint16 are
    normalised to 0..1, float16 and float32 are stored unchanged. For `raw+json` the caller writes the JSON, with
    `layout`. Raises SssgenError for an unknown format, another type or shape, and a volume that is too large for a
    sheet of slices.
    """
    encoding = _encoding(texels, format)
    texels = np.ascontiguousarray(texels, encoding.dtype)
    match format:
        case "dds":
            return dds_bytes(texels, encoding)
        case "ktx2":
            return ktx2_bytes(texels, encoding)
        case "exr-slices":
            if texels.ndim == 4:
                raise failure("a sheet of slices has one channel", "use npy, dds, ktx2 or raw+json")
            return images.exr_bytes(sheet(texels)[..., None] / np.float32(encoding.unit))
        case "npy":
            buffer = io.BytesIO()
            np.save(buffer, texels if texels.ndim == 4 else texels[..., None], allow_pickle=False)
            return buffer.getvalue()
        case _:
            return texels.tobytes()


def layout(texels: npt.NDArray[Any], format: str) -> dict[str, object]:
    """The description of a file of `encode_volume` for its readers, as values for JSON.

    `size` is in texels; `one` is the stored number for 1.0. Raises SssgenError as `encode_volume` does.
    """
    encoding = _encoding(texels, format)
    depth, height, width = texels.shape[:3]
    common = {"format": format, "encoding": encoding.name, "size": {"x": width, "y": height, "z": depth}}
    return common | _details(texels, encoding, format)


def _encoding(texels: npt.NDArray[Any], format: str) -> Encoding:
    """Checks the arguments; returns the texels' encoding."""
    if format not in FORMATS:
        hint = did_you_mean(format, FORMATS) or f"there are {', '.join(FORMATS)}"
        raise failure(f"'{format}' is not a format of volumes", hint)
    if texels.ndim not in (3, 4) or texels.shape[3:] not in ((), (4,)) or 0 in texels.shape:
        raise failure(
            f"an array of shape {texels.shape} is not a volume", "(depth, height, width), or (depth, height, width, 4)"
        )
    dtype = texels.dtype.newbyteorder("<")
    channels = texels.shape[3] if texels.ndim == 4 else 1
    encoding = next(
        (encoding for encoding in ENCODINGS if encoding.dtype == dtype and encoding.channels == channels), None
    )
    if encoding is None:
        plural = "" if channels == 1 else "s"
        message = f"texels of type {texels.dtype} with {channels} channel{plural} have no file format"
        raise failure(message, "use one of uint8, uint16, float16 or float32, or four of uint8")
    return encoding


def _details(texels: npt.NDArray[Any], encoding: Encoding, format: str) -> dict[str, object]:
    """The entries of `layout` that depend on the format."""
    match format:
        case "dds":
            return {"pixel_format": encoding.dxgi_name, "one": encoding.unit}
        case "ktx2":
            return {"pixel_format": encoding.vulkan_name, "orientation": ORIENTATION, "one": encoding.unit}
        case "exr-slices":
            columns, rows = columns_and_rows(*texels.shape[:3])
            return {
                "dtype": "float32",
                "channel": "Y",
                "columns": columns,
                "rows": rows,
                "order": "z ascends from the top left, left to right, then downwards",
                "slice_rows": "y descends: the top row of a slice is the largest y",
                "one": 1,
            }
        case _:
            return {
                "dtype": encoding.dtype.name,
                "byte_order": "little",
                "axes": ["z", "y", "x", "channel"] if format == "npy" or texels.ndim == 4 else ["z", "y", "x"],
                "order": "x is fastest, then y, then z; all ascend",
                "one": encoding.unit,
            }
