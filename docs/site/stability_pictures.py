"""The pictures of docs/stability.md that show a published technique beside the one to use instead.

A folder of docs/stability/ has a scene with two materials, as published and mended; the picture has the folder's name.
What only the published material has is what the picture shows, if it is a baseline.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from menu import ROOT
from sssgen.material import library

FOLDER = "docs/stability"
PAGE = "docs/stability.md"


class Comparison(NamedTuple):
    """A picture of the page."""

    file: str
    """In the repository."""
    shown: str
    """What is to be seen, for readers who cannot see it."""
    caption: str
    """The text below the picture on the page."""


def comparisons_of(technique: str) -> list[Comparison]:
    """The pictures that show what is wrong with a published technique."""
    if not library.load(technique).baseline:
        return []
    page = (ROOT / PAGE).read_text(encoding="utf-8")
    found = []
    for material in sorted((ROOT / FOLDER).glob("*/published.toml")):
        if technique in _techniques(material) - _techniques(material.with_name("mended.toml")):
            place = f"{material.parent.relative_to(ROOT / 'docs').as_posix()}.png"
            text = re.search(rf"!\[([^\]]*)\]\({re.escape(place)}\)\n\n(.*?)\n\n", page, re.DOTALL)
            if text is not None:
                found.append(Comparison(f"docs/{place}", text[1], " ".join(text[2].split())))
    return found


def _techniques(material: Path) -> set[str]:
    return set(_named(tomllib.loads(material.read_text(encoding="utf-8"))))


def _named(content: Mapping[str, Any]) -> list[str]:
    stages = [stage for value in content.values() for stage in (value if isinstance(value, list) else [value])]
    return [stage["technique"] for stage in stages if isinstance(stage, dict) and "technique" in stage]
