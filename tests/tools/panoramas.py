"""Panoramas as the bytes of files, for tests."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np


def hdr_bytes(texels: Any) -> bytes:
    """A Radiance picture without compression; `texels` are (height, width, 3), row 0 at the top."""
    height, width = texels.shape[:2]
    mantissa, exponent = np.frexp(texels.max(axis=2))
    scale = np.where(texels.max(axis=2) > 0.0, mantissa * 256.0 / np.maximum(texels.max(axis=2), 1e-30), 0.0)
    rgb = np.minimum(texels * scale[..., None], 255.0).astype(np.uint8)
    rows = np.concatenate([rgb, (exponent + 128).astype(np.uint8)[..., None]], axis=2)
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode() + rows.tobytes()


def exr_bytes(texels: Any) -> bytes:
    """An OpenEXR picture of half floats without compression; `texels` are as above."""
    height, width = texels.shape[:2]

    def attribute(name: str, kind: str, value: bytes) -> bytes:
        return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value

    channels = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for name in "BGR") + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<2i", 20000630, 2) + b"".join(
        [
            attribute("channels", "chlist", channels),
            attribute("compression", "compression", b"\0"),
            attribute("dataWindow", "box2i", window),
            attribute("displayWindow", "box2i", window),
            attribute("lineOrder", "lineOrder", b"\0"),
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
            attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
            attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)),
            b"\0",
        ]
    )
    size = 3 * 2 * width
    starts = [len(head) + 8 * height + (8 + size) * row for row in range(height)]
    lines = [struct.pack("<2i", row, size) + texels[row, :, ::-1].T.astype("<f2").tobytes() for row in range(height)]
    return head + struct.pack(f"<{height}Q", *starts) + b"".join(lines)
