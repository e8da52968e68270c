"""Volumes as DDS files, with the DX10 header, one level.

Sources: Microsoft, "Programming Guide for DDS", the pages DDS_HEADER, DDS_HEADER_DXT10 and "DDS File Layout for Volume
Textures".
"""

from __future__ import annotations

from typing import Any

import numpy.typing as npt

from sssgen.scene.pictures.volumes import (
    DDPF_FOURCC,
    DDS_HEADER,
    DDS_HEADER_DX10,
    DDS_TEXTURE3D,
    DDSD_DEPTH,
    Encoding,
)

_DDSD_CAPS, _DDSD_HEIGHT, _DDSD_WIDTH, _DDSD_PITCH, _DDSD_PIXELFORMAT = 0x1, 0x2, 0x4, 0x8, 0x1000
_DDSCAPS_COMPLEX, _DDSCAPS_TEXTURE = 0x8, 0x1000
_DDSCAPS2_VOLUME = 0x200000


def dds_bytes(texels: npt.NDArray[Any], encoding: Encoding) -> bytes:
    """The file of (depth, height, width[, channels]) texels of that encoding; the first is at coordinates 0."""
    depth, height, width = texels.shape[:3]
    flags = _DDSD_CAPS | _DDSD_HEIGHT | _DDSD_WIDTH | _DDSD_PITCH | _DDSD_PIXELFORMAT | DDSD_DEPTH
    pitch = width * encoding.channels * encoding.dtype.itemsize
    pixel_format = (32, DDPF_FOURCC, b"DX10", 0, 0, 0, 0, 0)  # the format itself is in the second header
    capabilities = (_DDSCAPS_TEXTURE | _DDSCAPS_COMPLEX, _DDSCAPS2_VOLUME, 0, 0)
    head = DDS_HEADER.pack(b"DDS ", 124, flags, height, width, pitch, depth, 1, *pixel_format, *capabilities)
    return head + DDS_HEADER_DX10.pack(encoding.dxgi, DDS_TEXTURE3D, 0, 1, 0) + texels.tobytes()
