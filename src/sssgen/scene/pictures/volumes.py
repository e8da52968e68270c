"""Reads level 0 of uncompressed volumes (3-D textures) from DDS and KTX 2.0 files, as arrays.

Sources: Microsoft, "Programming Guide for DDS" (DDS_HEADER, DDS_HEADER_DXT10); Khronos, "KTX File Format
Specification", version 2.0.
"""

from __future__ import annotations

import os
import struct
from typing import Any, BinaryIO, NamedTuple

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.support.diagnostics import failure

SUFFIXES = (".dds", ".ktx2")


class Encoding(NamedTuple):
    """A format of stored texels. `dtype` is the type of a channel; `unit` is the stored number that means 1.0."""

    name: str
    dtype: np.dtype[Any]
    channels: int
    unit: int
    dxgi: int
    dxgi_name: str
    vulkan: int
    vulkan_name: str


ENCODINGS = (
    Encoding("r8", np.dtype("u1"), 1, 255, 61, "DXGI_FORMAT_R8_UNORM", 9, "VK_FORMAT_R8_UNORM"),
    Encoding("r16", np.dtype("<u2"), 1, 65535, 56, "DXGI_FORMAT_R16_UNORM", 70, "VK_FORMAT_R16_UNORM"),
    Encoding("r16f", np.dtype("<f2"), 1, 1, 54, "DXGI_FORMAT_R16_FLOAT", 76, "VK_FORMAT_R16_SFLOAT"),
    Encoding("r32f", np.dtype("<f4"), 1, 1, 41, "DXGI_FORMAT_R32_FLOAT", 100, "VK_FORMAT_R32_SFLOAT"),
    Encoding("rgba8", np.dtype("u1"), 4, 255, 28, "DXGI_FORMAT_R8G8B8A8_UNORM", 37, "VK_FORMAT_R8G8B8A8_UNORM"),
)
"""The supported formats, with the numbers of `enum DXGI_FORMAT` and `enum VkFormat`."""

DDS_HEADER = struct.Struct("<4s 7I 44x 2I 4s 5I 4I 4x")
"""Magic; size, flags, height, width, pitch, depth, levels; the pixel format's size, flags, FourCC, bits and masks;
four words of capabilities."""

DDS_HEADER_DX10 = struct.Struct("<5I")
"""The format, the resource's dimension, flags, the array's size, further flags."""

DDSD_DEPTH = 0x800000
DDPF_FOURCC = 0x4
DDS_TEXTURE3D = 4

KTX2_IDENTIFIER = b"\xabKTX 20\xbb\r\n\x1a\n"

KTX2_HEADER = struct.Struct("<12s 9I 4I 2Q")
"""Identifier; format, type's size, width, height, depth, layers, faces, levels, supercompression; offsets and sizes of
the data format descriptor, the key/value data and the supercompression's data."""

KTX2_LEVEL = struct.Struct("<3Q")
"""A level's offset, size and uncompressed size in bytes."""

_READABLE = "supported: R8, R16, R16F, R32F and RGBA8, uncompressed"


def read(path: str, shown: str) -> Array:
    """The volume in a .dds or .ktx2 file, (depth, height, width, channels) = z, y, x ascending; channels are 1 or 4.

    The first texel is the one at texture coordinates 0, regardless of the orientation of the axes that the file states.
    Floats are unchanged, unsigned integers are scaled to 0..1. `shown` is the path for messages. Raises SssgenError for
    a file that is missing, truncated, faulty, not a volume, an array, compressed, or of an encoding that is not in
    ENCODINGS.
    """
    if not os.path.isfile(path):
        raise failure("cannot find the volume", "", shown)
    reader = {".dds": _read_dds, ".ktx2": _read_ktx2}.get(os.path.splitext(path)[1].lower())
    if reader is None:
        raise failure("this is not a volume file's suffix", "volumes end in .dds, .ktx2", shown)
    try:
        with open(path, "rb") as file:
            return reader(file, shown)
    except OSError as error:
        raise failure(f"cannot read the volume: {error.strerror or error}", "", shown) from None
    except MemoryError:
        raise failure("the volume is too large to read", "make it smaller", shown) from None


def _read_dds(file: BinaryIO, shown: str) -> Array:
    head = _header(file, DDS_HEADER, b"DDS ", "DDS", shown)
    _, size, flags, height, width, _, depth, _, format_size, format_flags, four_cc, *_ = head
    if (size, format_size) != (124, 32):
        raise failure("the DDS header is faulty: its sizes are wrong", "export it again", shown)
    if not format_flags & DDPF_FOURCC or four_cc != b"DX10":
        hint = f"save it uncompressed, with a DX10 header; {_READABLE}"
        raise failure("this DDS file has no DX10 header, so it is an old or a compressed one", hint, shown)
    dxgi, dimension, _, array_size, _ = _unpack(file, DDS_HEADER_DX10, shown)
    if dimension != DDS_TEXTURE3D or not flags & DDSD_DEPTH:
        raise failure("this DDS file is not a volume", "save a 3-D texture: not a 2-D one, not a cube", shown)
    if array_size != 1:
        raise failure("this DDS file holds an array of textures", "save one volume", shown)
    encoding = next((encoding for encoding in ENCODINGS if encoding.dxgi == dxgi), None)
    if encoding is None:
        raise failure(f"DXGI format {dxgi} is not supported", _READABLE, shown)
    return _texels(file, DDS_HEADER.size + DDS_HEADER_DX10.size, encoding, (depth, height, width), shown)


def _read_ktx2(file: BinaryIO, shown: str) -> Array:
    head = _header(file, KTX2_HEADER, KTX2_IDENTIFIER, "KTX 2.0", shown)
    _, vulkan, _, width, height, depth, layers, faces, levels, supercompression, *_ = head
    if supercompression != 0:
        raise failure("this KTX file is supercompressed", "save it without supercompression", shown)
    encoding = next((encoding for encoding in ENCODINGS if encoding.vulkan == vulkan), None)
    if encoding is None:
        raise failure(f"VkFormat {vulkan} is not supported", _READABLE, shown)
    if depth == 0 or height == 0 or faces != 1:
        raise failure("this KTX file is not a volume", "save a 3-D texture: not a 2-D one, not a cube", shown)
    if layers != 0:
        raise failure("this KTX file holds an array of textures", "save one volume", shown)
    offset, length, _ = _unpack(file, KTX2_LEVEL, shown)
    texel = encoding.channels * encoding.dtype.itemsize
    if length != depth * height * width * texel or offset < KTX2_HEADER.size + max(1, levels) * KTX2_LEVEL.size:
        raise failure("the KTX file's level index is faulty", "export it again", shown)
    return _texels(file, offset, encoding, (depth, height, width), shown)


def _header(file: BinaryIO, form: struct.Struct, magic: bytes, kind: str, shown: str) -> tuple[Any, ...]:
    """The fields of the header that a file begins with."""
    if file.read(len(magic)) != magic:
        raise failure(f"this is not a {kind} file", "convert it; a new name is not enough", shown)
    file.seek(0)
    return _unpack(file, form, shown)


def _unpack(file: BinaryIO, form: struct.Struct, shown: str) -> tuple[Any, ...]:
    data = file.read(form.size)
    if len(data) < form.size:
        raise failure("the file is truncated in its header", "export it again", shown)
    return form.unpack(data)


def _texels(file: BinaryIO, offset: int, encoding: Encoding, size: tuple[int, int, int], shown: str) -> Array:
    """The texels at an offset in a file; `size` is (depth, height, width) from the header, not validated yet."""
    if 0 in size:
        raise failure("the volume is empty", "", shown)
    depth, height, width = size
    length = depth * height * width * encoding.channels * encoding.dtype.itemsize
    available = os.fstat(file.fileno()).st_size - offset
    if length > available:  # checked before so much memory is allocated
        message = (
            f"the file is truncated: {width} × {height} × {depth} texels are {length} bytes, it has {max(available, 0)}"
        )
        raise failure(message, "export it again", shown)
    file.seek(offset)
    stored = np.frombuffer(file.read(length), encoding.dtype).reshape(*size, encoding.channels)
    with np.errstate(invalid="ignore"):  # NaN stays NaN, also a signalling one
        texels = stored.astype(np.float64)
    if encoding.unit != 1:
        texels /= encoding.unit
    return texels
