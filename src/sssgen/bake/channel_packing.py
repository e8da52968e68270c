"""Packs channels of several pictures into one texture, which engines sample once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.scene.pictures import images
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix
from sssgen.support.progress import Progress, silent

Array: TypeAlias = npt.NDArray[np.float64]

_NAMES = {1: "r", 2: "ra", 3: "rgb", 4: "rgba"}
"""Number of channels → their names."""


class Source(NamedTuple):
    """The source of a channel: a picture's channel, or a constant if there is no picture."""

    file: str = ""
    channel: str = ""
    """r, g, b, a or 0..3; '' is the first"""
    inverted: bool = False
    """Whether the value is 1 minus the channel"""
    constant: float = 0.0
    """0..1"""


def parse(text: str) -> Source:
    """A source from the command line: FILE, FILE:CHANNEL, 1-FILE, 1-FILE:CHANNEL, or a number from 0 to 1.

    CHANNEL is r, g, b, a or an index from 0; the default is the first channel. 1-FILE is 1 minus
    it; a file whose name begins with `1-` is written ./1-FILE. Raises SssgenError for any other text.
    """
    try:
        constant = float(text)
    except ValueError:
        pass
    else:
        if not 0.0 <= constant <= 1.0:
            raise failure(f"a channel cannot be filled with {text}", "a number from 0 to 1")
        return Source(constant=constant)
    inverted = text.startswith("1-")
    file, colon, channel = text.removeprefix("1-").rpartition(":")
    if not colon or set("./\\") & set(channel):  # a drive's colon, as in C:\ice.png
        file, channel = text.removeprefix("1-"), ""
    elif channel.lower() not in tuple("rgba0123"):
        raise failure(f"'{channel}' is not a channel", "r, g, b or a, or 0 to 3", posix(file))
    if not file:
        raise failure(f"'{text}' names no picture", "FILE, FILE:CHANNEL, 1-FILE, or a number from 0 to 1")
    return Source(file, channel.lower(), inverted)


def load(sources: Sequence[Source | None], progress: Progress = silent) -> list[Array | float | None]:
    """The channels of sources, each (height, width) as stored, or a number; None stays None.

    Raises SssgenError for pictures that cannot be read, and for a channel that a picture does not have.
    """
    files = sorted({source.file for source in sources if source is not None and source.file})
    pictures = {}
    for index, file in enumerate(files):
        progress(index, len(files), f"reading {file}")
        pictures[file] = images.upright(file)
    return [None if source is None else _channel(source, pictures) for source in sources]


def _channel(source: Source, pictures: Mapping[str, Array]) -> Array | float:
    if not source.file:
        return source.constant
    picture, shown = pictures[source.file], posix(source.file)
    names = _NAMES[picture.shape[-1]]
    index = int(source.channel) if source.channel.isdigit() else names.find(source.channel)  # 0 for ''
    if not 0 <= index < len(names):
        raise failure(f"the picture has no channel {source.channel}", f"it has {', '.join(names)}", shown)
    values: Array = picture[..., index]
    return 1.0 - values if source.inverted else values


def pack(channels: Sequence[Array | float | None]) -> Array:
    """Up to four channels in one texture, (height, width, 1, 3 or 4): arrays (height, width), or constants.

    None is 0 if another channel follows. Two channels become three, the third 0, because picture files store two as
    gray and alpha. Raises SssgenError for different sizes, no array at all, or more than four channels.
    """
    if len(channels) > 4:
        raise failure(f"{len(channels)} channels do not fit in a texture", "four at most")
    sized = {name: values for name, values in zip("rgba", channels, strict=False) if isinstance(values, np.ndarray)}
    if not sized:
        raise failure("no picture to pack", "at least one channel needs a picture, which determines the size")
    (first, array), *remaining = sized.items()
    for name, other in remaining:
        if other.shape != array.shape:
            hint = f"{first} is {_size(array)}, {name} is {_size(other)}"
            raise failure("pictures of different sizes do not fit in a texture", hint)
    count = max(index for index, values in enumerate(channels, start=1) if values is not None)
    texture = np.zeros((*array.shape, 3 if count == 2 else count))
    for index, values in enumerate(channels[:count]):
        texture[..., index] = 0.0 if values is None else values
    return texture


def _size(array: Array) -> str:
    return f"{array.shape[1]} x {array.shape[0]}"
