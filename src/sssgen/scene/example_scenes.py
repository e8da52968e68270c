"""The scenes that come with the project, by name, without loading them."""

from __future__ import annotations

import itertools
import os

from sssgen.material.material_loading import examples
from sssgen.support.paths import place, posix, stem
from sssgen.support.text_files import read_text


def drawn_scenes() -> dict[str, str]:
    """The scene of each example material: name → path."""
    paths = {name: os.path.join(os.path.dirname(material), "scene.toml") for name, material in examples().items()}
    return {name: path for name, path in paths.items() if os.path.isfile(path)}


def measured_scenes() -> dict[str, str]:
    """The scenes of examples/lab: name → path."""
    folder = os.path.join(place("examples"), "lab")
    return {stem(name): os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith(".toml")}


def all_scenes() -> dict[str, str]:
    """Both: name → path."""
    return {**measured_scenes(), **drawn_scenes()}


def summary(path: str) -> str:
    """The first sentence of the comment at the beginning of a scene's file."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), read_text(path, posix(path)).split("\n"))
    sentence, end, _ = " ".join(line.lstrip("# ") for line in lines).partition(". ")
    return sentence + end.rstrip()
