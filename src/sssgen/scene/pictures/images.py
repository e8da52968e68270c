"""Reads and writes picture files, as arrays with row 0 at the top, as in the files."""

from __future__ import annotations

import io
import os
import tempfile
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array
from sssgen.scene.pictures import png16, volumes
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.extras import need
from sssgen.support.file_memo import note
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix
from sssgen.support.text_files import refuse_folder

SUFFIXES = (".png", ".exr", ".npy")
"""The suffixes of pictures; an .npy may also be a volume."""
LARGEST_SIDE = 16384
"""The largest width and height that engines support, in texels."""
TEXTURES = (*SUFFIXES, *volumes.SUFFIXES)
"""The suffixes of textures."""

_ONE_AS_INTEGER = {np.dtype(np.uint8): 255.0, np.dtype(np.uint16): 65535.0}
"""The integer that means 1.0, by the type of the stored numbers."""


def read(path: str | os.PathLike[str]) -> Array:
    """The picture in a file, (height, width, channels), row 0 at the top; channels are 1 to 4.

    .png: one frame, up to 16 bits a channel; values 0..1 as stored, without colour conversion. .exr: as stored,
    which is linear light; R, G, B, A, or Y alone. .npy: an array of 2 to 4 axes, (height, width),
    (height, width, channels) or, for 3-D textures, (depth, height, width, channels); floats unchanged, uint8
    and uint16 as in a PNG. .dds and .ktx2: volumes, see `volumes.read`. Raises SssgenError for a file that is missing,
    faulty, or of another kind.
    """
    note(path)
    shown = posix(path)
    refuse_folder(path, TEXTURES)
    suffix = check_suffix(path, TEXTURES)
    if not os.path.isfile(path):
        raise failure("cannot find the picture", "", shown)
    reader = {".png": _read_png, ".exr": _read_exr, ".npy": _read_npy}.get(suffix, volumes.read)
    picture = reader(os.fspath(path), shown)
    if 0 in picture.shape:
        raise failure("the picture is empty", "", shown)
    return picture


def upright(path: str | os.PathLike[str]) -> Array:
    """The picture in a file, (height, width, channels), row 0 at the top: an .npy, whose row 0 is at v = 0, is flipped.

    Raises SssgenError for a volume, and as `read` does.
    """
    picture = read(path)
    if picture.ndim != 3:
        raise failure("this is a 3-D texture", "name a picture", posix(path))
    return np.flipud(picture) if check_suffix(path, TEXTURES) == ".npy" else picture


def check_suffix(path: str | os.PathLike[str], suffixes: tuple[str, ...] = SUFFIXES) -> str:
    """A picture file's suffix. Raises SssgenError for any that is not in `suffixes`."""
    suffix = os.path.splitext(os.fspath(path))[1].lower()
    if suffix not in suffixes:
        hint = did_you_mean(suffix, suffixes) or f"pictures end in {', '.join(suffixes)}"
        raise failure(f"'{suffix}' is not a picture file's suffix", hint, posix(path))
    return suffix


def encoded(path: str | os.PathLike[str]) -> Array:
    """A picture file's colours, (height, width, 3), encoded: linear ones (.exr, .npy) are encoded first."""
    picture = read(path)
    color = picture[..., :3] if picture.shape[-1] >= 3 else picture[..., :1].repeat(3, axis=-1)
    return color if check_suffix(path) == ".png" else encode_srgb(color)


def encode_srgb(linear: npt.ArrayLike) -> Array:
    """Linear light, clamped to 0..1, as encoded sRGB 0..1 (IEC 61966-2-1)."""
    light = np.clip(np.asarray(linear, np.float64), 0.0, 1.0)
    encoded: Array = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return encoded


def decode_srgb(encoded: npt.ArrayLike) -> Array:
    """Encoded sRGB as linear light (IEC 61966-2-1); values outside 0..1 are clamped."""
    stored = np.clip(np.asarray(encoded, np.float64), 0.0, 1.0)
    linear: Array = np.where(stored <= 0.04045, stored / 12.92, ((stored + 0.055) / 1.055) ** 2.4)
    return linear


def png_bytes(color: npt.ArrayLike, bits: int = 8, level: int = 6) -> bytes:
    """An encoded picture, (height, width) or (height, width, 1 to 4), as a PNG file of 8 or 16 bits per channel.

    Values are clamped to 0..1 and rounded, and NaN becomes 0. `level`, 1 to 9, is that of the compression of 8 bits:
    1 is several times as fast as 6. Raises SssgenError for another shape or depth.
    """
    if bits not in (8, 16):
        raise failure(f"a PNG cannot have {bits} bits per channel", "8 or 16")
    unit = np.clip(_picture(color), 0.0, 1.0)
    unit[np.isnan(unit)] = 0.0
    if bits == 16:
        return png16.encode(np.rint(unit * 65535.0).astype(np.uint16))
    bytes_ = np.rint(unit * 255.0).astype(np.uint8)
    buffer = io.BytesIO()
    pillow = need("PIL.Image", "pillow")
    pillow.fromarray(bytes_[..., 0] if bytes_.shape[-1] == 1 else bytes_).save(buffer, "PNG", compress_level=level)
    return buffer.getvalue()


def exr_bytes(linear: npt.ArrayLike) -> bytes:
    """Linear light, (height, width) or (height, width, 1 to 4), as an OpenEXR file of 32-bit floats.

    One channel is written as Y, two as Y and A. Raises SssgenError for another shape.
    """
    array = _picture(linear)
    exr = need("OpenEXR")
    names = {1: "Y", 2: "YA", 3: "RGB", 4: "RGBA"}[array.shape[-1]]
    channels = {name: np.ascontiguousarray(array[..., index], np.float32) for index, name in enumerate(names)}
    header = {"compression": exr.ZIP_COMPRESSION, "type": exr.scanlineimage}
    with tempfile.TemporaryDirectory() as folder:  # the package can only write files
        temporary = os.path.join(folder, "picture.exr")
        exr.File(header, channels).write(temporary)
        with open(temporary, "rb") as file:
            return file.read()


def write_png(path: str | os.PathLike[str], color: npt.ArrayLike, bits: int = 8) -> None:
    """Writes the bytes of `png_bytes` atomically.

    Raises SssgenError for another suffix than .png, if the system refuses, and as `png_bytes` does.
    """
    _require_suffix(path, ".png")
    _write(path, png_bytes(color, bits))


def write_exr(path: str | os.PathLike[str], linear: npt.ArrayLike) -> None:
    """Writes the bytes of `exr_bytes` atomically.

    Raises SssgenError for another suffix than .exr, if the system refuses, and as `exr_bytes` does.
    """
    _require_suffix(path, ".exr")
    _write(path, exr_bytes(linear))


def _require_suffix(path: str | os.PathLike[str], suffix: str) -> None:
    if check_suffix(path) != suffix:
        raise failure(f"the file's name must end in {suffix}", "", posix(path))


def _picture(values: npt.ArrayLike) -> Array:
    """The values to write, as (height, width, channels)."""
    array = np.asarray(values, np.float64)
    array = array[..., None] if array.ndim == 2 else array
    if array.ndim != 3 or 0 in array.shape or array.shape[-1] > 4:
        raise failure(f"an array of shape {array.shape} is not a picture", "(height, width, 1 to 4)")
    return array


def _write(path: str | os.PathLike[str], data: bytes) -> None:
    folder, name = os.path.split(os.fspath(path))
    write_files(folder, {name: data})


def _read_png(path: str, shown: str) -> Array:
    pillow = need("PIL.Image", "pillow")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", pillow.DecompressionBombWarning)
            with pillow.open(path, formats=["PNG"]) as image:
                image.verify()  # finds wrong checksums and truncation, which loading ignores
            with pillow.open(path, formats=["PNG"]) as image:
                frames = getattr(image, "n_frames", 1)
                deep = image.mode in ("RGB", "RGBA", "LA") and _depth(path) == 16
                if not deep:  # Pillow would silently halve the bits
                    image.load()
    except (pillow.DecompressionBombError, pillow.DecompressionBombWarning, MemoryError):
        raise failure("the picture is too large to read", "make it smaller", shown) from None
    except pillow.UnidentifiedImageError:
        raise failure("this is not a PNG picture", "convert it to PNG; a new name is not enough", shown) from None
    except (OSError, SyntaxError, ValueError) as error:
        raise failure(f"the picture is faulty: {error}", "export it again", shown) from None
    if frames > 1:
        raise failure("this picture is animated: it has several frames", "save one of them", shown)
    if deep:
        return _read_deep_png(path, shown)
    has_alpha = "A" in image.mode or "transparency" in image.info
    if image.mode in ("P", "PA", "RGB"):
        image = image.convert("RGBA" if has_alpha else "RGB")
    elif image.mode in ("1", "L"):
        image = image.convert("LA" if has_alpha else "L")
    return _as_unit(np.asarray(image), shown)


def _read_deep_png(path: str, shown: str) -> Array:
    try:
        with open(path, "rb") as file:
            return _as_unit(png16.decode(file.read()), shown)
    except ValueError as error:
        raise failure(f"the picture is faulty: {error}", "export it again, without interlacing", shown) from None


def _depth(path: str) -> int:
    """The bits per channel of a PNG: byte 24, in its IHDR chunk."""
    with open(path, "rb") as file:
        return file.read(25)[24]


def _read_exr(path: str, shown: str) -> Array:
    exr = need("OpenEXR")
    try:
        with exr.File(path, separate_channels=True) as file:
            channels = {name: np.asarray(channel.pixels) for name, channel in file.channels().items()}
    except (RuntimeError, ValueError, TypeError, MemoryError):  # the messages state only the file
        raise failure("this is not an OpenEXR picture, or a faulty one", "export it again", shown) from None
    for names in ("RGBA", "RGB", "YA", "Y"):
        if set(names) <= channels.keys():
            parts = [channels[name] for name in names]
            break
    else:
        if len(channels) != 1:
            hint = "write R, G, B (and A), or one channel"
            raise failure(f"the meaning of the channels {', '.join(sorted(channels))} is unknown", hint, shown)
        parts = list(channels.values())
    if len({part.shape for part in parts}) > 1 or parts[0].ndim != 2:
        raise failure("the channels have different sizes", "write them without subsampling", shown)
    return np.stack(parts, axis=-1).astype(np.float64)


def _read_npy(path: str, shown: str) -> Array:
    try:
        with open(path, "rb") as file:
            array = np.load(file, allow_pickle=False)
    except Exception as error:  # NumPy reads the header with Python's tokenizer, which raises exceptions of many types
        raise failure(f"this is not a NumPy array: {error}", "write it with numpy.save", shown) from None
    if not isinstance(array, np.ndarray):  # a renamed .npz
        raise failure("this file holds several arrays", "write one, with numpy.save", shown)
    array = array[..., None] if array.ndim == 2 else array
    if array.ndim not in (3, 4) or array.shape[-1] > 4:
        hint = "(height, width), (height, width, 1 to 4) or (depth, height, width, 1 to 4)"
        raise failure(f"an array of shape {array.shape} is not a texture", hint, shown)
    return _as_unit(array, shown)


def _as_unit(array: npt.NDArray[Any], shown: str) -> Array:
    """Stored numbers as float64, unsigned integers scaled to 0..1, with an axis of channels."""
    array = array[..., None] if array.ndim == 2 else array
    if array.dtype == np.bool_ or np.issubdtype(array.dtype, np.floating):
        return array.astype(np.float64)
    if array.dtype not in _ONE_AS_INTEGER:
        raise failure(f"a texture cannot hold numbers of type {array.dtype}", "use float32, uint8 or uint16", shown)
    return array / _ONE_AS_INTEGER[array.dtype]
