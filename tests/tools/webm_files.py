"""Reads the WebM files that a browser's frames are in (RFC 8794, RFC 9559), for tests."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

SEGMENT, INFO, SCALE, DURATION = 0x18538067, 0x1549A966, 0x2AD7B1, 0x4489
TRACKS, TRACK, VIDEO, WIDTH, HEIGHT = 0x1654AE6B, 0xAE, 0xE0, 0xB0, 0xBA
CLUSTER, CLUSTER_TIME, BLOCK = 0x1F43B675, 0xE7, 0xA3
PARENTS = {SEGMENT, INFO, TRACKS, TRACK, VIDEO, CLUSTER}


class Webm(NamedTuple):
    """What a file says of its frames."""

    width: int
    height: int
    duration: float
    """Milliseconds"""
    times: list[int]
    """Of each frame, in milliseconds"""


def elements(data: bytes) -> Iterator[tuple[int, bytes]]:
    """The elements of a file in their order, without those that contain others."""
    at = 0
    while at < len(data):
        length = 9 - data[at].bit_length()
        name, at = int.from_bytes(data[at : at + length], "big"), at + length
        length = 9 - data[at].bit_length()
        size, at = int.from_bytes(data[at : at + length], "big") & ((1 << (7 * length)) - 1), at + length
        content, at = data[at : at + size], at + size
        if name in PARENTS:
            yield from elements(content)
        else:
            yield name, content


def read_webm(data: bytes) -> Webm:
    values: dict[int, bytes] = {}
    times, start = [], 0
    for name, content in elements(data):
        if name == CLUSTER_TIME:
            start = int.from_bytes(content, "big")
        elif name == BLOCK:
            times.append(start + struct.unpack(">h", content[1:3])[0])
        values[name] = content
    assert int.from_bytes(values[SCALE], "big") == 1_000_000
    width, height = (int.from_bytes(values[name], "big") for name in (WIDTH, HEIGHT))
    return Webm(width, height, struct.unpack(">d", values[DURATION])[0], times)
