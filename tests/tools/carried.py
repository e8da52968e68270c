"""The targets that can carry a material: some engines lack a kind of texture, which is an error of its own class."""

from __future__ import annotations

import os

import sssgen
from sssgen.material.model import Material
from sssgen.support.diagnostics import UnsupportedError


def carries(target: str, material: Material | str | os.PathLike[str]) -> bool:
    """Whether the target can express the material."""
    try:
        sssgen.compile(material, target)
    except UnsupportedError:
        return False
    return True


def carrying(material: Material | str | os.PathLike[str]) -> list[str]:
    """The targets that can express the material."""
    return [target for target in sssgen.all_targets() if carries(target, material)]
