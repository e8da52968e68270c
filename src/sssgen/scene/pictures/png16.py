"""PNG with 16 bits per channel: of these Pillow can write only gray ones, and reads colour ones with 8 bits.

Portable Network Graphics (PNG) Specification, Second Edition, ISO/IEC 15948:2004.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Picture16: TypeAlias = npt.NDArray[np.uint16]

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}
"""The number of channels → the standard's colour type."""
_UP = 2
"""The filter that stores the difference from the row above."""


def encode(picture: Picture16) -> bytes:
    """A picture, (height, width, 1 to 4), as a PNG file."""
    height, width, channels = picture.shape
    rows = picture.astype(">u2").view(np.uint8).reshape(height, -1)
    filtered = np.full((height, 1 + rows.shape[1]), _UP, np.uint8)
    filtered[0, 1:] = rows[0]
    np.subtract(rows[1:], rows[:-1], out=filtered[1:, 1:])  # modulo 256, as the standard requires
    head = struct.pack(">IIBBBBB", width, height, 16, _COLOR_TYPES[channels], 0, 0, 0)
    parts = [(b"IHDR", head), (b"IDAT", zlib.compress(filtered.tobytes())), (b"IEND", b"")]
    return _SIGNATURE + b"".join(_chunk(kind, data) for kind, data in parts)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def decode(data: bytes) -> Picture16:
    """The picture in a PNG file of 16 bits per channel, (height, width, 1 to 4).

    A colour that the file declares transparent becomes an alpha channel, 0 or 65535. Raises ValueError, with a message
    for users, if the file is truncated, altered, interlaced, or of another depth.
    """
    chunks = list(_chunks(data))
    width, height, depth, color_type, _, _, interlaced = struct.unpack(">IIBBBBB", chunks[0][1])
    channels = {number: count for count, number in _COLOR_TYPES.items()}.get(color_type)
    if depth != 16 or channels is None:
        raise ValueError(f"it has {depth} bits per channel and colour type {color_type}")
    if not width or not height:
        raise ValueError("it has no pixels")
    if interlaced:
        raise ValueError("it is interlaced, which is not supported with 16 bits per channel")
    size = height * (1 + width * channels * 2)
    try:
        compressed = b"".join(part for kind, part in chunks if kind == b"IDAT")
        filtered = zlib.decompressobj().decompress(compressed, size)
    except zlib.error as error:
        raise ValueError(f"its pixels cannot be decompressed ({error})") from None
    if len(filtered) < size:
        raise ValueError("it has fewer pixels than its header states")
    picture = _unfilter(np.frombuffer(filtered, np.uint8).reshape(height, -1), channels * 2).view(">u2")
    picture = picture.reshape(height, width, channels).astype(np.uint16)
    for kind, part in chunks:
        if kind == b"tRNS" and channels in (1, 3) and len(part) == 2 * channels:
            opaque = (picture != np.frombuffer(part, ">u2")).any(axis=-1, keepdims=True)
            picture = np.concatenate([picture, np.where(opaque, 65535, 0).astype(np.uint16)], axis=-1)
    return picture


def _chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """The kinds and contents of a file's chunks, IHDR first, up to IEND."""
    if not data.startswith(_SIGNATURE):
        raise ValueError("it is not a PNG")
    offset, kind = len(_SIGNATURE), b""
    while kind != b"IEND":
        length, previous = int.from_bytes(data[offset : offset + 4], "big"), kind
        kind, part = data[offset + 4 : offset + 8], data[offset + 8 : offset + 8 + length]
        if len(data) < offset + 12 + length:
            raise ValueError("it is truncated")
        if data[offset + 8 + length : offset + 12 + length] != struct.pack(">I", zlib.crc32(kind + part)):
            raise ValueError(f"the checksum of its chunk {kind.decode('latin-1')} is wrong")
        if not previous and (kind, length) != (b"IHDR", 13):
            raise ValueError("it has no header")
        yield kind, part
        offset += 12 + length


def _unfilter(filtered: npt.NDArray[np.uint8], pixel: int) -> npt.NDArray[np.uint8]:
    """The bytes (height, width x pixel) of filtered rows, each after the byte that names its filter.

    A pixel depends on those to its left, above, and above left; so all pixels of an anti-diagonal are decoded at once.
    In an array with a border of zeros above and to the left, flattened, they are evenly spaced.
    """
    height, width = len(filtered), (filtered.shape[1] - 1) // pixel
    if filtered[:, 0].max() > 4:
        raise ValueError(f"it has a row with the unknown filter {filtered[:, 0].max()}")
    bordered = np.zeros((height + 1, width + 1, pixel), np.uint8)
    bordered[1:, 1:] = filtered[:, 1:].reshape(height, width, pixel)
    flat = bordered.reshape(-1, pixel)
    filters = filtered[:, :1]
    for diagonal in range(height + width - 1):
        top, bottom = max(0, diagonal - width + 1), min(height - 1, diagonal)
        first, count = (top + 1) * (width + 1) + diagonal - top + 1, bottom - top + 1

        def spaced(start: int, count: int = count) -> npt.NDArray[np.uint8]:
            return flat[start : start + (count - 1) * width + 1 : width]

        left, above, corner = (spaced(first - back).astype(np.int16) for back in (1, width + 1, width + 2))
        kinds = filters[top : bottom + 1]
        predicted = np.select(
            [kinds == 1, kinds == _UP, kinds == 3, kinds == 4],
            [left, above, (left + above) >> 1, _paeth(left, above, corner)],
            np.int16(0),
        )
        pixels = spaced(first)
        pixels += predicted.astype(np.uint8)  # modulo 256
    return np.ascontiguousarray(bordered[1:, 1:]).reshape(height, -1)


def _paeth(
    left: npt.NDArray[np.int16], above: npt.NDArray[np.int16], corner: npt.NDArray[np.int16]
) -> npt.NDArray[np.int16]:
    """The one of the three that is nearest to left + above - corner; the first one in a tie."""
    to_left, to_above = np.abs(above - corner), np.abs(left - corner)
    to_corner = np.abs(left + above - 2 * corner)
    other = np.where(to_above <= to_corner, above, corner)
    return np.where((to_left <= to_above) & (to_left <= to_corner), left, other)
