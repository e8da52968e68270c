"""Pictures, arrays and meshes with wrong headers, or that would fill the memory: refused by name."""

from __future__ import annotations

import json
import struct
import zlib
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from front_ends import FRONT_ENDS, survives
from watchdog import roomy

ROOM = 1024
"""The mebibytes that reading may take."""


def chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(width: int, height: int, depth: int = 8, color: int = 2, rows: bytes = b"", extra: bytes = b"") -> bytes:
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + extra + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def saved(mode: str, kind: str, **options: object) -> bytes:
    file = BytesIO()
    Image.new(mode, (4, 4)).save(file, kind, **options)
    return file.getvalue()


GOOD = png(2, 2, rows=b"\0" * 14)
BOMB = b"a\0\0" + zlib.compress(b"\0" * (1 << 27))
MOVES = saved("RGB", "PNG", save_all=True, append_images=[Image.new("RGB", (4, 4), (9, 9, 9))])
PICTURES = {
    "nothing": b"",
    "a text": b"hello\n" * 10,
    "a signature alone": GOOD[:8],
    "no width": png(0, 4),
    "no height": png(4, 0),
    "no rows": png(4, 4),
    "too few rows": png(4, 4, rows=b"\0" * 20),
    "cut": GOOD[:-20],
    "a wrong sum of the head": GOOD[:29] + b"\0\0\0\0" + GOOD[33:],
    "a wrong sum of the rows": GOOD[:-13] + b"\0" + GOOD[-12:],
    "a bomb": png(30_000, 30_000, rows=b"\0" * 1000),
    "a bomb below Pillow's own limit": png(13_000, 13_000, rows=b"\0" * 1000),
    "the largest there can be": png(2**31 - 1, 2**31 - 1),
    "a palette of 16 bits": png(2, 2, 16, 3, b"\0" * 10),
    "an unknown depth": png(2, 2, 3, 2, b"\0" * 20),
    "an unknown kind of colour": png(2, 2, 8, 5, b"\0" * 20),
    "too few rows of 16 bits": png(2, 2, 16, 2, b"\0" * 25),
    "a text that is a bomb": png(2, 2, rows=b"\0" * 14, extra=chunk(b"zTXt", BOMB)),
    "a profile that is a bomb": png(2, 2, rows=b"\0" * 14, extra=chunk(b"iCCP", BOMB)),
    "a chunk beyond the end": GOOD[:8] + struct.pack(">I", 0xFFFFFFFF) + b"IHDR",
    "one that moves": MOVES,
    "a JPEG for print": saved("CMYK", "JPEG"),
    "a GIF": saved("P", "GIF"),
    "a TIFF": saved("CMYK", "TIFF"),
    "a BMP": saved("RGB", "BMP"),
    "an SVG": b"<svg/>",
}  # fmt: skip


def npy(header: bytes, content: bytes = b"") -> bytes:
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(header) + 1) + header + b"\n" + content


def described(descr: str, shape: str) -> bytes:
    return f"{{'descr':{descr},'fortran_order':False,'shape':{shape}}}".encode()


ARRAYS = {
    "nothing": b"",
    "far too many numbers": npy(described("'<f8'", "(1000000, 1000000, 3)")),
    "too many numbers": npy(described("'<f8'", "(100000, 10000, 3)")),
    "a shape beyond all": npy(described("'<f8'", f"({'9' * 40},)")),
    "a shape below 0": npy(described("'<f8'", "(-1, 2, 3)")),
    "a shape of parts": npy(described("'<f8'", "(1.5, 2)")),
    "many axes": npy(described("'<f4'", f"({'1, ' * 70})"), b"0000"),
    "objects": npy(described("'O'", "(1, 1)")),
    "a pickle": b"\x80\4K\1.",
    "an archive": b"PK\3\4" + b"0" * 50,
    "records": npy(described("[('a', '<f4')]", "(1, 1)"), b"0000"),
    "texts": npy(described("'U4'", "(1, 1)"), b"0" * 16),
    "complex numbers": npy(described("'c8'", "(1, 1)"), b"0" * 8),
    "dates": npy(described("'M8[s]'", "(1, 1)"), b"0" * 8),
    "an unknown type": npy(described("'zork'", "(1, 1)"), b"0" * 8),
    "deep brackets": npy(b"(" * 5000),
    "an open bracket": npy(b"{'descr': ("),
    "a long head": npy(b"{" + b" " * 60_000),
    "a head beyond the end": b"\x93NUMPY\3\0" + b"\xff" * 4,
    "another version": b"\x93NUMPY\x09\0" + b"\0" * 20,
}


def exr(width: int, height: int) -> bytes:
    """A picture whose header has another size."""
    good = FRONT_ENDS["exr"].seeds()[0]
    index = good.index(b"\0\x10\0\0\0", good.index(b"dataWindow")) + 5
    return good[:index] + struct.pack("<4i", 0, 0, width, height) + good[index + 16 :]


def glb(tree: dict[str, object]) -> bytes:
    text = json.dumps({"asset": {"version": "2.0"}, **tree}).encode()
    text += b" " * (-len(text) % 4)
    return b"glTF" + struct.pack("<III", 2, 20 + len(text), len(text)) + b"JSON" + text


SCENE: dict[str, object] = {"scene": 0, "scenes": [{"nodes": [0]}]}
PLY = "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
PLY += "property list uchar int vertex_indices\nend_header\n"
CORNERS = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
MESHES = {
    "nothing.obj": b"",
    "no corner of that number.obj": CORNERS + b"f 1 2 999999999\n",
    "no corner before.obj": b"v 0 0 0\nf -5 -6 -7\n",
    "corners of four numbers.obj": b"v 0 0 0 1 2\nv 1 0\nv 0 1 0 1\nf 1 2 3\n",
    "no numbers.obj": b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "too far.obj": b"v 1e308 0 0\nv -1e308 0 0\nv 0 1e308 0\nf 1 2 3\n",
    "no area.obj": b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
    "too many.stl": b"\0" * 80 + b"\xff\xff\xff\x7f" + b"\0" * 50,
    "too many.ply": PLY.format("ascii", 999_999_999).encode() + b"0 0 0\n",
    "too many bytes.ply": PLY.format("binary_little_endian", 2_000_000_000).encode() + b"0000",
    "no tree.glb": b"glTF\2\0\0\0" + b"\xff" * 40,
    "a file beside.glb": glb({**SCENE, "buffers": [{"uri": "/etc/passwd", "byteLength": 4}], "nodes": [{"mesh": 0}]}),
    "a cycle.glb": glb({**SCENE, "nodes": [{"children": [1]}, {"children": [0]}]}),
    "too many.glb": glb(
        {
            **SCENE,
            "accessors": [{"componentType": 5126, "count": 2_000_000_000, "type": "VEC3"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "nodes": [{"mesh": 0}],
        }
    ),
}


@pytest.mark.parametrize("title", PICTURES)
def test_wrong_pictures(title: str, tmp_path: Path) -> None:
    with roomy(ROOM):
        assert not survives(FRONT_ENDS["png"], PICTURES[title], tmp_path)


def test_the_valid_picture_is_read(tmp_path: Path) -> None:
    assert survives(FRONT_ENDS["png"], GOOD, tmp_path)


@pytest.mark.parametrize("title", ARRAYS)
def test_wrong_arrays(title: str, tmp_path: Path) -> None:
    with roomy(ROOM):
        assert not survives(FRONT_ENDS["npy"], ARRAYS[title], tmp_path)


def test_the_valid_array_is_read(tmp_path: Path) -> None:
    assert survives(FRONT_ENDS["npy"], npy(described("'<f4'", "(1, 1)"), b"0000"), tmp_path)


SIZES = [(1 << 20, 1 << 20), (30_000, 30_000), (100_000, 3), (-5, -5), (2**31 - 1, 2**31 - 1)]


@pytest.mark.parametrize("size", SIZES)
def test_wrong_sizes_of_exr(size: tuple[int, int], tmp_path: Path) -> None:
    with roomy(ROOM):
        assert not survives(FRONT_ENDS["exr"], exr(*size), tmp_path)


@pytest.mark.filterwarnings("ignore")  # trimesh's readers compute with any numbers
@pytest.mark.parametrize("title", MESHES)
def test_wrong_meshes(title: str, tmp_path: Path) -> None:
    with roomy(ROOM):
        assert not survives(FRONT_ENDS[title.rpartition(".")[2]], MESHES[title], tmp_path)


def test_the_largest_coordinates_do_not_overflow(tmp_path: Path) -> None:
    """The largest coordinates there may be overflow nowhere: a warning would be an error here."""
    far = np.array([[1e9, 0, 0], [-1e9, 0, 0], [0, 1e9, -1e9]])
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in far)
    assert survives(FRONT_ENDS["obj"], (corners + "vt 1e9 0\nvt 0 1\nvt 1 1e9\nf 1/1 2/2 3/3\n").encode(), tmp_path)
