"""Warnings of pictures that are bound to a texture of another kind: colours as numbers, normals as colours."""

from __future__ import annotations

import os
from collections.abc import Iterator

import numpy as np

from sssgen.ir.spans import Span
from sssgen.material import baked
from sssgen.material.model import Material
from sssgen.run.render.scene_values import texture_file
from sssgen.scene.arrays import Array
from sssgen.scene.pictures import images
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic
from sssgen.targets.reflection_record import Reflection, TextureRecord

TEXELS = 256
"""About so many texels along a side are looked at."""
COLOURED = 0.03
"""The mean difference of two channels above which a picture has colours."""


def texture_warnings(scene: Scene, material: Material, reflection: Reflection) -> list[Diagnostic]:
    """The warnings for the pictures of a scene and its material; bakes say themselves what they are."""
    return list(_warnings(scene, material, reflection))


def _warnings(scene: Scene, material: Material, reflection: Reflection) -> Iterator[Diagnostic]:
    for texture in reflection["textures"]:
        file = texture_file(scene, material, texture)
        if not file or texture["type"] != "sampler2D" or baked.read_bake_file(file) is not None:
            continue
        if fault := _fault(images.read(file), texture):
            message, hint = fault
            span, reporter = _span(scene, material, texture), scene.document.reporter
            message = message.format(file=f"'{os.path.basename(file)}'", name=f"'{texture['source_name']}'")
            line = reporter.line(span) if span.file == reporter.file else ""
            yield Diagnostic("warning", message, span, hint, line)


def _fault(picture: Array, texture: TextureRecord) -> tuple[str, str] | None:
    """What is wrong with a picture for a texture, and what to do."""
    height, width, channels = picture.shape
    texels = picture[:: max(1, height // TEXELS), :: max(1, width // TEXELS)].reshape(-1, channels)
    if texture["holds"] and channels >= 3 and np.abs(np.diff(texels[:, :3], axis=1)).mean() > COLOURED:
        message = "{file} has colours, and {name} takes one number: its red channel is read alone"
        return message, "bind a grey picture; the thickness of a glTF file is in its green channel"
    if texture["default"] == "bump" and not _are_normals(texels):
        return "{file} is no normal map, and {name} takes one", "bind it to a texture of colours or numbers"
    if texture["color_space"] == "sRGB" and _are_normals(texels):
        return "{file} is a normal map, and {name} takes colours", "bind it to normal_texture"
    return None


def _are_normals(texels: Array) -> bool:
    """Whether most texels are unit vectors that look away from the surface."""
    if texels.shape[1] < 3:
        return False
    vectors = 2.0 * texels[:, :3] - 1.0
    are_unit = np.abs(np.linalg.norm(vectors, axis=1) - 1.0) < 0.1
    return bool((are_unit & (vectors[:, 2] > 0.0)).mean() > 0.8)


def _span(scene: Scene, material: Material, texture: TextureRecord) -> Span:
    """Where the picture is named."""
    if (name := texture["source_name"]) in scene.textures:
        return scene.document.place("textures", name).value
    stage = next(stage for stage in material.stages if stage.technique.name == texture["technique"])
    return dict(stage.texture_spans).get(texture["technique_name"], stage.span)
