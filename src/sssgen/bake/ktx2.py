"""Volumes as KTX 2.0 files: one level, no supercompression, a basic data format descriptor.

Sources: Khronos, "KTX File Format Specification", version 2.0; "Khronos Data Format Specification", version 1.3,
chapter 5 (the basic descriptor).
"""

from __future__ import annotations

import math
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.scene.pictures.volumes import KTX2_HEADER, KTX2_IDENTIFIER, KTX2_LEVEL, Encoding
from sssgen.version import VERSION

ORIENTATION = "ruo"
"""x to the right, y up, z out of the screen: the axes ascend, and object space is right-handed, with y up.

`rui` would be the same for a left-handed space; the specification recommends that writers use `rdi` or `ruo`.
"""

_MODEL_RGBSDA, _PRIMARIES_UNSPECIFIED, _TRANSFER_LINEAR = 1, 0, 1
_SAMPLE_FLOAT, _SAMPLE_SIGNED = 0x80, 0x40
_CHANNELS = (0, 1, 2, 15)
"""The numbers of red, green, blue and alpha."""
_DESCRIPTOR_VERSION = 2


def ktx2_bytes(texels: npt.NDArray[Any], encoding: Encoding) -> bytes:
    """The file of (depth, height, width[, channels]) texels of that encoding; the first is at coordinates 0."""
    depth, height, width = texels.shape[:3]
    texel = encoding.channels * encoding.dtype.itemsize
    descriptor = _descriptor(encoding)
    keys = _key_values({"KTXorientation": ORIENTATION, "KTXwriter": f"sssgen {VERSION}"})
    descriptor_at = KTX2_HEADER.size + KTX2_LEVEL.size
    keys_at = descriptor_at + len(descriptor)
    end = keys_at + len(keys)
    padding = -end % math.lcm(texel, 4)
    form = (
        encoding.vulkan,
        encoding.dtype.itemsize,
        width,
        height,
        depth,
        0,
        1,
        1,
        0,
    )  # layers, faces, levels, supercompression
    head = KTX2_HEADER.pack(KTX2_IDENTIFIER, *form, descriptor_at, len(descriptor), keys_at, len(keys), 0, 0)
    level = KTX2_LEVEL.pack(end + padding, texels.nbytes, texels.nbytes)
    return head + level + descriptor + keys + bytes(padding) + texels.tobytes()


def _descriptor(encoding: Encoding) -> bytes:
    """The data format descriptor of red, or of red to alpha; the numbers are no colours, so there are no primaries."""
    bits = 8 * encoding.dtype.itemsize
    if np.issubdtype(encoding.dtype, np.floating):
        flags, bounds = _SAMPLE_FLOAT | _SAMPLE_SIGNED, struct.pack("<2f", -1.0, 1.0)
    else:
        flags, bounds = 0, struct.pack("<2I", 0, encoding.unit)
    samples = b"".join(
        struct.pack("<HBB4x", index * bits, bits - 1, flags | channel) + bounds
        for index, channel in enumerate(_CHANNELS[: encoding.channels])
    )
    colors = struct.pack("<4B", _MODEL_RGBSDA, _PRIMARIES_UNSPECIFIED, _TRANSFER_LINEAR, 0)
    planes = struct.pack(
        "<4B8B", 0, 0, 0, 0, encoding.channels * encoding.dtype.itemsize, 0, 0, 0, 0, 0, 0, 0
    )  # blocks of 1 × 1 × 1 texel
    block = struct.pack("<IHH", 0, _DESCRIPTOR_VERSION, 8 + len(colors) + len(planes) + len(samples))
    block += colors + planes + samples
    return struct.pack("<I", 4 + len(block)) + block


def _key_values(texts: dict[str, str]) -> bytes:
    """Key and value pairs, sorted by key, each padded to 4 bytes."""
    data = b""
    for key in sorted(texts):
        pair = f"{key}\0{texts[key]}\0".encode()
        data += struct.pack("<I", len(pair)) + pair + bytes(-len(pair) % 4)
    return data
