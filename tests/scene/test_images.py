"""Picture files: written files are read back unchanged, other files are refused. Also tests the camera."""

from __future__ import annotations

import signal
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sssgen.scene.camera import Camera
from sssgen.scene.pictures import png16
from sssgen.scene.pictures.images import encode_srgb, png_bytes, read, write_exr, write_png
from sssgen.support.diagnostics import SssgenError
from sssgen.support.extras import need

Image = pytest.importorskip("PIL.Image", reason="Pillow is missing: pip install -e '.[render]'")
pytest.importorskip("OpenEXR", reason="OpenEXR is missing: pip install -e '.[render]'")

RAMP = np.linspace(0.0, 1.0, 5 * 7 * 4).reshape(5, 7, 4)


pytestmark = pytest.mark.usefixtures("in_folder")


def png(
    width: int, height: int, depth: int, color: int, rows: bytes, *chunks: tuple[bytes, bytes], interlaced: int = 0
) -> bytes:
    """A PNG with these rows, each after its filter byte."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, interlaced)
    parts = [(b"IHDR", head), *chunks, (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_written_files_are_read_back(channels: int) -> None:
    picture = RAMP[..., :channels]
    write_png("out/ramp.png", picture)
    assert np.array_equal(read("out/ramp.png"), np.rint(picture * 255) / 255)
    write_exr("out/ramp.exr", 100.0 * picture - 3.0)
    assert np.array_equal(read("out/ramp.exr"), (100.0 * picture - 3.0).astype(np.float32))
    assert [path.name for path in sorted(Path("out").iterdir())] == ["ramp.exr", "ramp.png"]


def test_row_0_is_at_the_top() -> None:
    Path("two.png").write_bytes(png(1, 2, 8, 0, bytes([0, 255, 0, 51])))
    assert read("two.png").tolist() == [[[1.0]], [[0.2]]]


def test_the_kinds_of_png() -> None:
    Path("gray16.png").write_bytes(png(2, 1, 16, 0, struct.pack(">BHH", 0, 257, 65535)))
    assert read("gray16.png").tolist() == [[[257 / 65535], [1.0]]]
    Path("bits.png").write_bytes(png(2, 1, 1, 0, bytes([0, 0b01000000])))
    assert read("bits.png").tolist() == [[[0.0], [1.0]]]
    colors = (b"PLTE", bytes([255, 0, 0, 0, 0, 255]))
    Path("indexed.png").write_bytes(png(2, 1, 8, 3, bytes([0, 1, 0]), colors))
    assert read("indexed.png").tolist() == [[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]]
    Path("glass.png").write_bytes(png(2, 1, 8, 3, bytes([0, 1, 0]), colors, (b"tRNS", bytes([0]))))
    assert read("glass.png").tolist() == [[[0.0, 0.0, 1.0, 1.0], [1.0, 0.0, 0.0, 0.0]]]


def test_written_values_are_clamped_and_rounded() -> None:
    write_png("odd.png", np.array([[-1.0, 2.0, np.nan, 0.4999 / 255, 0.5001 / 255, np.inf]]))
    assert (read("odd.png")[0, :, 0] * 255).tolist() == [0, 255, 0, 0, 1, 255]


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_sixteen_bits_per_channel(channels: int) -> None:
    picture = np.random.default_rng(channels).random((9, 5, channels))
    write_png("deep.png", picture, bits=16)
    assert np.array_equal(read("deep.png"), np.rint(picture * 65535) / 65535)
    with Image.open("deep.png") as image:  # Pillow keeps the upper 8 bits of colours
        high = np.asarray(image).reshape(9, 5, -1)[..., -1]
    assert np.array_equal(high, np.rint(picture[..., -1] * 65535).astype(np.uint16) >> (0 if channels == 1 else 8))


def filtered(picture: Any, filters: list[int]) -> bytes:
    """The rows of a picture with 16 bits per channel, each encoded with its filter (PNG standard, 9.2)."""
    height, width, channels = picture.shape
    samples = picture.astype(">u2").view(np.uint8).reshape(height, width, 2 * channels).astype(int)
    around = np.pad(samples, ((1, 0), (1, 0), (0, 0)))
    left, above, corner = around[1:, :-1], around[:-1, 1:], around[:-1, :-1]
    guess = left + above - corner
    paeth = np.empty_like(samples)
    for at in np.ndindex(samples.shape):
        paeth[at] = min((left[at], above[at], corner[at]), key=lambda value, at=at: abs(guess[at] - value))
    of_filter = [0 * samples, left, above, (left + above) // 2, paeth]
    stored = [(samples[row] - of_filter[kind][row]) % 256 for row, kind in enumerate(filters)]
    return b"".join(bytes([kind]) + row.astype(np.uint8).tobytes() for kind, row in zip(filters, stored, strict=True))


@pytest.mark.parametrize(("channels", "color"), [(2, 4), (3, 2), (4, 6)])
@pytest.mark.parametrize(("height", "width"), [(12, 7), (1, 9), (9, 1), (5, 16)])
def test_every_filter_of_a_deep_png_is_undone(height: int, width: int, channels: int, color: int) -> None:
    random = np.random.default_rng(height)
    picture = random.integers(0, 65536, (height, width, channels), np.uint16)
    picture[: height // 2] //= 7  # small values, whose sums do not overflow
    rows = filtered(picture, [row * 7 % 5 for row in range(height)])
    Path("filtered.png").write_bytes(png(width, height, 16, color, rows))
    assert np.array_equal(read("filtered.png"), picture / 65535)
    with Image.open("filtered.png") as image:
        assert np.array_equal(np.asarray(image)[..., -1], picture[..., -1] >> 8)


def test_a_transparent_colour_of_a_deep_png() -> None:
    rows = struct.pack(">BHHHHHH", 0, 1, 2, 3, 1, 2, 4)
    Path("key.png").write_bytes(png(2, 1, 16, 2, rows, (b"tRNS", struct.pack(">HHH", 1, 2, 3))))
    assert (read("key.png") * 65535).round().tolist() == [[[1, 2, 3, 0], [1, 2, 4, 65535]]]


def test_unsupported_deep_pngs_are_refused() -> None:
    row = struct.pack(">BHHH", 0, 1, 2, 3)
    Path("woven.png").write_bytes(png(1, 1, 16, 2, row, interlaced=1))
    assert "interlaced" in error_of("woven.png")
    Path("short.png").write_bytes(png(1, 2, 16, 2, row))
    assert "fewer pixels" in error_of("short.png")
    Path("filter.png").write_bytes(png(1, 1, 16, 2, b"\5" + row[1:]))
    assert "filter 5" in error_of("filter.png")
    whole = png_bytes(np.random.default_rng(1).random((20, 20, 3)), bits=16)
    packed = whole.index(b"IDAT") + 4
    for altered in (whole[:packed] + b"\0" + whole[packed + 1 :], whole[: len(whole) // 2], whole[:-12]):
        Path("altered.png").write_bytes(altered)
        assert "faulty" in error_of("altered.png")
        with pytest.raises(ValueError, match=r"truncated|checksum"):
            png16.decode(altered)
    with pytest.raises(ValueError, match="not a PNG"):
        png16.decode(b"P6" + whole)
    with pytest.raises(ValueError, match="colour type 3"):
        png16.decode(png(1, 1, 8, 3, b"\0\0"))
    with pytest.raises(ValueError, match="decompressed"):  # its checksum is correct
        png16.decode(png(1, 1, 16, 2, row, (b"IDAT", b"not packed")))
    with pytest.raises(SssgenError, match="12 bits per channel"):
        png_bytes(RAMP, bits=12)


@pytest.mark.parametrize(
    ("array", "expected"),
    [
        (np.array([[0.5, 7.0]], np.float32), [[[0.5], [7.0]]]),
        (np.array([[[255, 51]]], np.uint8), [[[1.0, 0.2]]]),
        (np.array([[[[65535]]]], np.uint16), [[[[1.0]]]]),
        (np.array([[True]]), [[[1.0]]]),
    ],
)
def test_numpy_files(array: Any, expected: Any) -> None:
    np.save("map.npy", array)
    assert read("map.npy").tolist() == expected


def test_srgb_at_the_values_of_the_standard() -> None:
    assert encode_srgb([0.0, 0.0031308, 0.21404114, 1.0]) == pytest.approx([0.0, 0.040449936, 0.5, 1.0], abs=1e-7)
    assert encode_srgb([-1.0, 9.0]) == pytest.approx([0.0, 1.0], abs=1e-12)


def error_of(path: str) -> str:
    with pytest.raises(SssgenError) as caught:
        read(path)
    return str(caught.value)


def test_files_that_are_not_pictures_are_refused() -> None:
    for name in ("none.png", "none.exr", "none.npy"):
        assert "cannot find the picture" in error_of(name)
        assert name in error_of(name)
    Path("folder.png").mkdir()
    assert "this is a folder" in error_of("folder.png")
    assert "not a picture file's suffix" in error_of("map.jpg")
    assert "did you mean '.png'" in error_of("map.pngg")
    for name in ("text.png", "text.exr", "text.npy"):
        Path(name).write_text("hello " * 100, encoding="utf-8")
        assert f"--> {name}" in error_of(name)
        Path(name).write_bytes(b"")
        assert f"--> {name}" in error_of(name)


@pytest.mark.parametrize("suffix", ["png", "exr", "npy"])
def test_files_that_end_early(suffix: str) -> None:
    noise = np.random.default_rng(1).random((40, 40, 3))
    write = {"png": write_png, "exr": write_exr, "npy": np.save}[suffix]
    write(f"whole.{suffix}", noise)  # type: ignore[operator]
    data = Path(f"whole.{suffix}").read_bytes()
    for part in (9, len(data) // 2, len(data) - 20):
        Path(f"part.{suffix}").write_bytes(data[:part])
        if (suffix, part) != ("png", len(data) - 20):  # a file that lacks only its last bytes may be readable
            assert "part" in error_of(f"part.{suffix}")


def test_unsupported_pictures_are_refused() -> None:
    Path("huge.png").write_bytes(png(30000, 30000, 8, 0, b""))
    assert "too large" in error_of("huge.png")
    np.save("objects.npy", np.array([[None]]), allow_pickle=True)
    assert "not a NumPy array" in error_of("objects.npy")
    np.save("whole.npy", np.array([[1, 2]]))
    assert "int64" in error_of("whole.npy")
    for shape in [(3,), (2, 2, 5), (1, 1, 1, 1, 1)]:
        np.save("shape.npy", np.zeros(shape))
        assert "is not a texture" in error_of("shape.npy")
    np.save("empty.npy", np.zeros((0, 3)))
    assert "empty" in error_of("empty.npy")


def test_pictures_that_cannot_be_written() -> None:
    Path("file").write_text("mine", encoding="utf-8")
    for write, name in ((write_png, "a.png"), (write_exr, "a.exr")):
        with pytest.raises(SssgenError, match="a file has the name of the folder"):
            write(f"file/{name}", RAMP)
        with pytest.raises(SssgenError, match="must end in"):
            write("a.npy", RAMP)
        with pytest.raises(SssgenError, match="is not a picture"):
            write(name, np.zeros((2, 2, 5)))
    assert Path("file").read_text(encoding="utf-8") == "mine"


# The camera

CAMERAS = [
    Camera((0.0, 0.6, 3.4), (0.0, 0.0, 0.0), 40.0),
    Camera((-2.0, 5.0, 1.0), (3.0, 1.0, -7.0), 75.0, 0.01, 50.0),
    Camera((1.0, 4.0, 2.0), (1.0, -3.0, 2.0), 30.0),
    Camera((1.0, -4.0, 2.0), (1.0, 3.0, 2.0), 30.0),
]


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("zero_to_one", [False, True])
def test_rays_project_to_their_pixels(camera: Camera, zero_to_one: bool) -> None:
    width, height = 13, 8
    origin, directions = camera.rays(width, height)
    points = origin + directions * np.linspace(0.5, 40.0, width * height)[:, None]
    clip = np.c_[points, np.ones(len(points))] @ camera.view_projection(width / height, zero_to_one).T
    pixel = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * [width, height]
    rows, columns = np.divmod(np.arange(width * height), width)
    assert np.abs(pixel - np.stack([columns + 0.5, rows + 0.5], axis=1)).max() < 1e-9
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize("camera", CAMERAS)
def test_near_and_far_are_the_ends_of_the_depth_range(camera: Camera) -> None:
    _, _, forward = camera.axes()
    for zero_to_one, ends in ((False, (-1.0, 1.0)), (True, (0.0, 1.0))):
        for distance, depth in zip((camera.near, camera.far), ends, strict=True):
            clip = camera.view_projection(1.5, zero_to_one) @ [*(camera.position + distance * forward), 1.0]
            assert clip[3] == pytest.approx(distance)
            assert clip[2] / clip[3] == pytest.approx(depth, abs=1e-9)


def test_the_picture_is_upright_and_not_mirrored() -> None:
    right, up, forward = CAMERAS[0].axes()
    assert right.tolist() == [1.0, 0.0, 0.0]
    assert up[1] > 0.9
    assert forward[2] < -0.9
    down, above = CAMERAS[2].axes(), CAMERAS[3].axes()
    assert down[0].tolist() == above[0].tolist() == [1.0, 0.0, 0.0]
    assert down[1].tolist() == [0.0, 0.0, -1.0]
    assert above[1].tolist() == [0.0, 0.0, 1.0]


def test_interrupts_wait_for_imports(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A package that catches every exception during its import does not suppress Ctrl-C."""
    (tmp_path / "swallows.py").write_text(
        "import signal\ntry:\n    signal.raise_signal(signal.SIGINT)\nexcept BaseException:\n    pass\n",
        encoding="utf-8",
    )
    monkeypatch.syspath_prepend(tmp_path)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            need("swallows")
    finally:
        signal.signal(signal.SIGINT, before)
