"""Files of volumes: they follow the formats' specifications, are read back, and faulty ones are refused."""

from __future__ import annotations

import io
import struct
import tracemalloc
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from sssgen.bake.slice_sheet import columns_and_rows
from sssgen.bake.volume_files import FORMATS, encode_volume, layout
from sssgen.scene.pictures import images
from sssgen.scene.pictures.volumes import read
from sssgen.support.diagnostics import SssgenError
from sssgen.version import VERSION

TYPES = ["uint8", "uint16", "float16", "float32"]
SIZES = [(1, 1, 1), (3, 5, 7), (4, 2, 6), (1, 9, 2)]
ONE = {"uint8": 255, "uint16": 65535, "float16": 1, "float32": 1}

# From enum DXGI_FORMAT (dxgiformat.h) and enum VkFormat (vulkan_core.h)
DXGI = {"uint8": 61, "uint16": 56, "float16": 54, "float32": 41}
VULKAN = {"uint8": 9, "uint16": 70, "float16": 76, "float32": 100}


pytestmark = pytest.mark.usefixtures("in_folder")


def volume(size: tuple[int, int, int], dtype: str) -> npt.NDArray[Any]:
    """Texels that are all over the type's range, and no two neighbours alike."""
    noise = np.random.default_rng(3).random(size)
    return (noise * ONE[dtype]).astype(dtype) if dtype.startswith("u") else (2.0 * noise - 1.0).astype(dtype)


def file_of(texels: npt.NDArray[Any], format: str) -> bytes:
    return encode_volume(texels, format)


def read_bytes(data: bytes, format: str) -> npt.NDArray[np.float64]:
    path = "some" + FORMATS[format]
    Path(path).write_bytes(data)
    return read(path, path)


def words(data: bytes, at: int, count: int) -> list[int]:
    return list(struct.unpack_from(f"<{count}I", data, at))


@pytest.mark.parametrize("format", ["dds", "ktx2"])
@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("size", SIZES)
def test_written_files_are_read_back(size: tuple[int, int, int], dtype: str, format: str) -> None:
    texels = volume(size, dtype)
    expected = texels.astype(np.float64)[..., None] / ONE[dtype]
    assert np.array_equal(read_bytes(file_of(texels, format), format), expected)


@pytest.mark.parametrize("dtype", TYPES)
def test_dds_follows_microsofts_specification(dtype: str) -> None:
    texels = volume((3, 5, 7), dtype)
    data = file_of(texels, "dds")
    assert data[:4] == b"DDS "
    # CAPS, HEIGHT, WIDTH, PITCH, PIXELFORMAT and DEPTH; then height, width, the pitch in bytes, depth, levels
    flags = 0x1 | 0x2 | 0x4 | 0x8 | 0x1000 | 0x800000
    assert words(data, 4, 7) == [124, flags, 5, 7, 7 * texels.itemsize, 3, 1]
    assert data[32:76] == bytes(44)
    assert words(data, 76, 2) == [32, 0x4] and data[84:88] == b"DX10" and words(data, 88, 5) == [0] * 5
    assert words(data, 108, 5) == [0x8 | 0x1000, 0x200000, 0, 0, 0]  # COMPLEX and TEXTURE; VOLUME
    assert words(data, 128, 5) == [DXGI[dtype], 4, 0, 1, 0]  # TEXTURE3D, one element
    assert data[148:] == texels.astype(texels.dtype.newbyteorder("<")).tobytes()


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("size", SIZES)
def test_ktx2_follows_khronos_specification(size: tuple[int, int, int], dtype: str) -> None:
    texels = volume(size, dtype)
    depth, height, width = size
    data = file_of(texels, "ktx2")
    assert data[:12] == bytes([0xAB, 0x4B, 0x54, 0x58, 0x20, 0x32, 0x30, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A])
    assert words(data, 12, 9) == [VULKAN[dtype], texels.itemsize, width, height, depth, 0, 1, 1, 0]
    descriptor_at, descriptor_length, keys_at, keys_length, *_ = words(data, 48, 4)
    assert data[64:80] == bytes(16)  # no global data of a supercompression
    offset, length, uncompressed = struct.unpack_from("<3Q", data, 80)
    assert descriptor_at == 104 and keys_at == 104 + descriptor_length
    assert offset % 4 == 0 and offset >= keys_at + keys_length
    assert data[keys_at + keys_length : offset] == bytes(offset - keys_at - keys_length)
    assert length == uncompressed == texels.nbytes == len(data) - offset
    assert data[offset:] == texels.astype(texels.dtype.newbyteorder("<")).tobytes()


@pytest.mark.parametrize("dtype", TYPES)
def test_the_data_format_descriptor_describes_a_texel(dtype: str) -> None:
    data = file_of(volume((3, 5, 7), dtype), "ktx2")
    bits = 8 * np.dtype(dtype).itemsize
    descriptor = data[104 : 104 + words(data, 52, 1)[0]]
    assert words(descriptor, 0, 2) == [len(descriptor), 0]  # Khronos's, basic
    assert struct.unpack_from("<2H", descriptor, 8) == (2, len(descriptor) - 4)  # version 1.3
    assert list(descriptor[12:16]) == [1, 0, 1, 0]  # RGBSDA, no primaries, linear, straight
    assert list(descriptor[16:28]) == [0] * 4 + [bits // 8] + [0] * 7  # texel blocks of one texel, one plane
    offset, last, channel, position, *bounds = struct.unpack_from("<HBBI2I", descriptor, 28)
    assert (offset, last, position, len(descriptor)) == (0, bits - 1, 0, 44)
    if dtype.startswith("f"):
        assert channel == 0x80 | 0x40  # float, signed, red
        assert struct.unpack_from("<2f", descriptor, 36) == (-1.0, 1.0)
    else:
        assert channel == 0 and bounds == [0, 2**bits - 1]


def test_the_keys_are_sorted_ended_and_filled_up() -> None:
    data = file_of(volume((1, 1, 1), "uint8"), "ktx2")
    at, length = words(data, 56, 2)
    end, pairs = at + length, []
    while at < end:
        size = words(data, at, 1)[0]
        key, value, rest = data[at + 4 : at + 4 + size].split(b"\0")
        assert rest == b""
        pairs.append((key.decode(), value.decode()))
        at += 4 + -(-size // 4) * 4
    assert at == end
    assert pairs == [("KTXorientation", "ruo"), ("KTXwriter", f"sssgen {VERSION}")]


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("size", SIZES)
def test_a_sheet_follows_its_layout(size: tuple[int, int, int], dtype: str) -> None:
    pytest.importorskip("OpenEXR", reason="OpenEXR is missing: pip install -e '.[render]'")
    texels = volume(size, dtype)
    Path("sheet.exr").write_bytes(file_of(texels, "exr-slices"))
    picture = images.read("sheet.exr")
    description = layout(texels, "exr-slices")
    columns, rows = description["columns"], description["rows"]
    depth, height, width = size
    assert picture.shape == (rows * height, columns * width, 1) and columns * rows == depth
    for (z, y, x), texel in np.ndenumerate(texels):
        row = (z // columns) * height + height - 1 - y
        assert picture[row, (z % columns) * width + x, 0] == np.float32(texel) / np.float32(ONE[dtype])


def test_a_sheet_is_nearly_square_and_full() -> None:
    assert columns_and_rows(64, 64, 64) == (8, 8)
    assert columns_and_rows(32, 64, 64) == (8, 4)
    assert columns_and_rows(12, 10, 40) == (2, 6)
    assert columns_and_rows(127, 32, 128) == (1, 127)
    with pytest.raises(SssgenError, match="257 slices of 128 × 128 texels do not fit"):
        columns_and_rows(257, 128, 128)
    with pytest.raises(SssgenError, match="do not fit"):
        encode_volume(np.zeros((1, 1, 16385), np.uint8), "exr-slices")


@pytest.mark.parametrize("dtype", TYPES)
def test_raw_data_follows_its_layout(dtype: str) -> None:
    texels = volume((3, 5, 7), dtype)
    description = layout(texels, "raw+json")
    assert description["axes"] == ["z", "y", "x"] and description["byte_order"] == "little"
    stored = np.frombuffer(file_of(texels, "raw+json"), np.dtype(description["dtype"]).newbyteorder("<"))
    assert np.array_equal(stored.reshape([description["size"][axis] for axis in description["axes"]]), texels)
    assert description["one"] == ONE[dtype]


@pytest.mark.parametrize("dtype", TYPES)
def test_npy_is_numpys(dtype: str) -> None:
    texels = volume((3, 5, 7), dtype)
    stored = np.load(io.BytesIO(file_of(texels, "npy")))
    assert stored.dtype == texels.dtype and np.array_equal(stored[..., 0], texels)


def test_the_layouts_name_the_containers_formats() -> None:
    texels = volume((3, 5, 7), "float16")
    common = {"encoding": "r16f", "size": {"x": 7, "y": 5, "z": 3}, "one": 1}
    dds = {"format": "dds", "pixel_format": "DXGI_FORMAT_R16_FLOAT"}
    ktx2 = {"format": "ktx2", "pixel_format": "VK_FORMAT_R16_SFLOAT", "orientation": "ruo"}
    assert layout(texels, "dds") == common | dds
    assert layout(texels, "ktx2") == common | ktx2


@pytest.mark.parametrize("format", ["npy", "dds", "ktx2", "raw+json"])
def test_memory_order_and_byte_order_leave_no_trace(format: str) -> None:
    texels = volume((3, 5, 7), "uint16")
    big = np.asfortranarray(texels.astype(">u2"))
    assert file_of(big, format) == file_of(texels, format)


def test_unsupported_volumes_are_not_written() -> None:
    with pytest.raises(SssgenError, match="did you mean 'ktx2'"):
        encode_volume(volume((1, 1, 1), "uint8"), "ktx")
    with pytest.raises(SssgenError, match="texels of type int32"):
        encode_volume(np.zeros((2, 2, 2), np.int32), "dds")
    for shape in [(2, 2), (2, 2, 2, 1), (0, 2, 2)]:
        with pytest.raises(SssgenError, match="is not a volume"):
            layout(np.zeros(shape, np.uint8), "dds")


FAULTS: list[tuple[str, int, bytes, str]] = [
    ("dds", 0, b"DDX ", "not a DDS file"),
    ("dds", 4, struct.pack("<I", 100), "header is faulty"),
    ("dds", 84, b"DXT1", "no DX10 header"),
    ("dds", 128, struct.pack("<I", 80), "DXGI format 80 is not supported"),  # BC4
    ("dds", 132, struct.pack("<I", 3), "not a volume"),
    ("dds", 140, struct.pack("<I", 2), "array"),
    ("dds", 24, struct.pack("<I", 0), "empty"),
    ("dds", 24, struct.pack("<I", 4), "truncated"),
    ("ktx2", 5, b"11", "not a KTX 2"),
    ("ktx2", 12, struct.pack("<I", 139), "VkFormat 139 is not supported"),  # BC4
    ("ktx2", 28, struct.pack("<I", 0), "not a volume"),
    ("ktx2", 32, struct.pack("<I", 2), "array"),
    ("ktx2", 36, struct.pack("<I", 6), "not a volume"),
    ("ktx2", 44, struct.pack("<I", 2), "supercompressed"),
    ("ktx2", 28, struct.pack("<I", 4), "level index"),
    ("ktx2", 80, struct.pack("<Q", 0), "level index"),
    ("ktx2", 80, struct.pack("<Q", 2**64 - 1), "truncated"),
]


@pytest.mark.parametrize(("format", "at", "bytes_", "message"), FAULTS)
def test_a_faulty_file_is_refused(format: str, at: int, bytes_: bytes, message: str) -> None:
    data = file_of(volume((3, 5, 7), "uint16"), format)
    with pytest.raises(SssgenError, match=message):
        read_bytes(data[:at] + bytes_ + data[at + len(bytes_) :], format)


def test_sizes_in_headers_are_checked() -> None:
    dds = bytearray(file_of(volume((1, 1, 1), "float32"), "dds"))
    ktx2 = bytearray(file_of(volume((1, 1, 1), "float32"), "ktx2"))
    for at in (12, 16, 24):
        struct.pack_into("<I", dds, at, 2048)
    struct.pack_into("<3I", ktx2, 20, 2048, 2048, 2048)
    struct.pack_into("<2Q", ktx2, 88, 4 * 2048**3, 4 * 2048**3)
    tracemalloc.start()
    try:
        for data, format in [(dds, "dds"), (ktx2, "ktx2")]:
            with pytest.raises(SssgenError, match="2048 × 2048 × 2048 texels are 34359738368 bytes"):
                read_bytes(bytes(data), format)
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("format", ["dds", "ktx2"])
def test_any_bytes_are_read_or_refused(format: str) -> None:
    good = file_of(volume((3, 5, 7), "float16"), format)
    header = len(good) - 3 * 5 * 7 * 2
    rng = np.random.default_rng(11)
    refused = 0
    for _ in range(400):
        data = bytearray(good)
        for at in rng.integers(0, header, rng.integers(0, 4)):
            data[at] = rng.integers(0, 256)
        if rng.random() < 0.4:
            del data[rng.integers(0, len(data)) :]
        try:
            assert read_bytes(bytes(data), format).ndim == 4
        except SssgenError:
            refused += 1
    assert 100 < refused < 400


def test_a_signalling_nan_is_nan_and_no_warning() -> None:
    data = file_of(volume((1, 1, 1), "float32"), "dds")[:148] + struct.pack("<I", 0x7F800001)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isnan(read_bytes(data, "dds")).all()


def test_level_0_is_read_where_there_are_several() -> None:
    texels = volume((2, 2, 2), "uint8")
    expected = texels[..., None] / 255.0
    dds = bytearray(file_of(texels, "dds") + b"\x07")
    struct.pack_into("<I", dds, 28, 2)
    assert np.array_equal(read_bytes(bytes(dds), "dds"), expected)
    head = bytearray(file_of(texels, "ktx2")[:80])
    struct.pack_into("<I", head, 40, 2)
    index = struct.pack("<6Q", 132, 8, 8, 128, 1, 1)
    ktx2 = bytes(head) + index + b"\x07\0\0\0" + texels.tobytes()  # the smaller level comes first
    assert np.array_equal(read_bytes(ktx2, "ktx2"), expected)


def test_four_channels_are_read() -> None:
    texels = volume((2, 3, 8), "uint8")
    dds, ktx2 = bytearray(file_of(texels, "dds")), bytearray(file_of(texels, "ktx2"))
    struct.pack_into("<I", dds, 16, 2)
    struct.pack_into("<I", dds, 128, 28)  # DXGI_FORMAT_R8G8B8A8_UNORM
    struct.pack_into("<3I", ktx2, 12, 37, 1, 2)  # VK_FORMAT_R8G8B8A8_UNORM
    for data, format in [(dds, "dds"), (ktx2, "ktx2")]:
        assert np.array_equal(read_bytes(bytes(data), format), texels.reshape(2, 3, 2, 4) / 255.0)


def test_files_that_are_not_volumes_are_refused() -> None:
    with pytest.raises(SssgenError, match="cannot find the volume"):
        read("nothing.dds", "nothing.dds")
    Path("body.vdb").write_bytes(b"")
    with pytest.raises(SssgenError, match="not a volume file's suffix"):
        read("body.vdb", "body.vdb")
    with pytest.raises(SssgenError, match="not a KTX 2"):
        read_bytes(b"", "ktx2")
