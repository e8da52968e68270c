"""The pictures that a material names, with the names that its shader has for them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from sssgen.material.model import Material
from sssgen.targets.reflection_record import ImportSettings, Reflection


class BoundTexture(NamedTuple):
    """A texture of a shader with its picture."""

    name: str
    """In the shader, or the property of the material that has it"""
    file: str
    """Beside the material"""
    settings: ImportSettings


def bound_textures(material: Material, reflection: Reflection) -> list[BoundTexture]:
    """The textures of a material whose pictures are files, and which the program does not draw."""
    given: Mapping[tuple[str, str], str] = {
        (stage.technique.name, name): file for stage in material.stages for name, file in stage.textures.items()
    }
    return [
        BoundTexture(texture.get("property", texture["name"]), file, texture["import"])
        for texture in reflection["textures"]
        if texture["drawn"] is None and (file := given.get((texture["technique"], texture["technique_name"])))
    ]
