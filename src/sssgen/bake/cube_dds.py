"""Cube maps with levels as DDS files, with the DX10 header, in half floats.

Sources: Microsoft, "Programming Guide for DDS", the pages DDS_HEADER, DDS_HEADER_DXT10 and "DDS File Layout for Cubic
Environment Maps": the faces +x, -x, +y, -y, +z, -z, each with all its levels.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy.typing as npt

from sssgen.scene.pictures.volumes import DDPF_FOURCC, DDS_HEADER, DDS_HEADER_DX10

_FLAGS = 0x1 | 0x2 | 0x4 | 0x8 | 0x1000 | 0x20000
"""DDSD_CAPS, _HEIGHT, _WIDTH, _PITCH, _PIXELFORMAT, _MIPMAPCOUNT."""
_CAPS, _CAPS_2 = 0x8 | 0x1000 | 0x400000, 0x200 | 0xFC00
"""DDSCAPS_COMPLEX, _TEXTURE, _MIPMAP; DDSCAPS2_CUBEMAP with all faces."""
_RGBA16F, _TEXTURE2D, _TEXTURECUBE = 10, 3, 0x4
_TEXEL = 8


def cube_bytes(levels: Sequence[npt.NDArray[Any]]) -> bytes:
    """The file of levels (6, side, side, 4), the first row of a face at t = 0."""
    side = levels[0].shape[1]
    pixel_format = (32, DDPF_FOURCC, b"DX10", 0, 0, 0, 0, 0)
    head = DDS_HEADER.pack(
        b"DDS ", 124, _FLAGS, side, side, side * _TEXEL, 0, len(levels), *pixel_format, _CAPS, _CAPS_2, 0, 0
    )
    faces = [level[face].astype("<f2").tobytes() for face in range(6) for level in levels]
    return head + DDS_HEADER_DX10.pack(_RGBA16F, _TEXTURE2D, _TEXTURECUBE, 1, 0) + b"".join(faces)
