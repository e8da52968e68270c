"""One completion."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple


class Item(NamedTuple):
    """A text that can be written at a place."""

    label: str
    kind: str
    """technique, parameter, texture, function, constant, type, keyword, section, value or file."""
    detail: str = ""
    doc: str = ""
    text: str = ""
    """What is inserted, if it is not the label."""
    rank: int = 0
    """Lower ones are shown first; among equals, the order of the list holds."""


def items_of(labels: Iterable[str], kind: str, rank: int = 0) -> list[Item]:
    """Items without explanations."""
    return [Item(label, kind, rank=rank) for label in labels]
