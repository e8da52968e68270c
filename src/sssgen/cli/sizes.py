"""Sizes and counts as arguments: `512`, `640x480`, `8,6`."""

from __future__ import annotations

from sssgen.support.diagnostics import failure


def picture_size(text: str) -> tuple[int, int]:
    """A picture's width and height. Raises SssgenError."""
    from sssgen.scene.pictures.images import LARGEST_SIDE

    size = pair(text, "size")
    if not all(1 <= side <= LARGEST_SIDE for side in size):
        raise failure(f"'{text}' is not a size", f"N or WIDTHxHEIGHT in texels, each from 1 to {LARGEST_SIDE}")
    return size


def pair(text: str, name: str) -> tuple[int, int]:
    numbers = whole_numbers(text, name)
    if len(numbers) > 2:
        raise failure(f"'{text}' is not a {name}", "one or two whole numbers")
    return numbers[0], numbers[-1]


def whole_numbers(text: str, name: str) -> list[int]:
    """Whole numbers, separated by commas or crosses. Raises SssgenError."""
    parts = text.replace("x", ",").replace("×", ",").split(",")
    if not all(part.isdecimal() and len(part) < 10 for part in parts):
        raise failure(f"'{text}' is not a {name}", "whole numbers, separated by commas or x")
    return [int(part) for part in parts]
