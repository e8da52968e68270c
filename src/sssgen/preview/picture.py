"""What a page shows of a material: the emitted three.js module, the body, the values and the textures of its scene."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.render.scene_values import shell_of
from sssgen.harness.render.shell_values import Shell
from sssgen.harness.scenes.geometry import Ball, Box, Geometry, Slab
from sssgen.harness.scenes.scene import Scene
from sssgen.ir.drawn import BACK_FACES, DISTANT, LIGHT
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.pipeline.compiler import compile
from sssgen.preview.body_triangles import body_triangles
from sssgen.preview.emitted_head import TARGET, emitted_head
from sssgen.support.diagnostics import failure
from sssgen.support.file_memo import CachedResult, remembered
from sssgen.targets.runtime.numpy_textures import Texture

SHAPES: Mapping[str, Geometry] = {
    "ball": Ball(radius=1.0),
    "cube": Box(size=(1.5, 1.5, 1.5)),
    "sheet": Slab(width=2.2, height=2.2, thickness=0.06),
}
"""The bodies that a material is shown on besides its own."""

DRAWN_BY_PAGE = (BACK_FACES, LIGHT, DISTANT)
"""The textures that the page draws for each frame; the others are made once, for the scene's own light."""


class Picture(NamedTuple):
    """A picture as the page gets it."""

    head: dict[str, Any]
    """JSON: the module, the controls, the textures, the lights, the camera; what is large is named by its digest."""
    pieces: dict[str, bytes]
    """Digest → triangles or texels."""
    material: Material


def picture_of(scene: Scene, shape: str = "") -> Picture:
    """The picture of a scene, on its own body or on one of `SHAPES`. Raises SssgenError."""
    material = load_material(scene.material)
    compiled = compile(material, TARGET)
    geometry = SHAPES[shape] if shape else scene.geometry
    if geometry is None:
        raise failure(
            f"{material.name} makes its own rays: it is a flat picture, not a material of a body",
            "sssgen render draws it",
        )
    scene = dataclasses.replace(scene, geometry=geometry)
    shell = shell_of(scene, material, _without_views(compiled.reflection))
    pieces: dict[str, bytes] = {}

    def piece(data: bytes) -> str:
        digest = hashlib.sha256(data).hexdigest()[:32]
        pieces[digest] = data
        return digest

    head = emitted_head(material, compiled, shell.parameters, scene.parameters)
    head |= {
        "shape": shape,
        "shapes": ["", *SHAPES],
        "body": piece(_body(geometry)),
        "model": geometry.to_world().T.ravel().tolist(),
        "textures": [_with_texels(row, shell, piece) for row in head["textures"]],
        "lights": [
            {"position": position.tolist(), "color": color.tolist()}
            for position, color in zip(shell.light_positions, shell.light_colors, strict=True)
        ],
        "ambient": list(shell.ambient),
        "background": [list(color) for color in scene.background],
        "exposure": scene.exposure,
        "shadows": "shadow" in scene.shell,
        "tone_mapping": scene.shell.get("tone_mapping", ""),
        "camera": {
            "position": list(scene.camera.position),
            "target": list(scene.camera.target),
            "field_of_view": scene.camera.field_of_view,
        },
    }
    return Picture(head, pieces, material)


def _without_views(reflection: Mapping[str, Any]) -> dict[str, Any]:
    """The reflection without the textures that the page draws, so that nothing else draws them."""
    textures = [texture for texture in reflection["textures"] if texture["drawn"] not in DRAWN_BY_PAGE]
    return {**reflection, "textures": textures}


def _body(geometry: Geometry) -> bytes:
    """The packed triangles; those of the last bodies are kept until a file of theirs changes."""
    return remembered(_bodies, repr(geometry), lambda: body_triangles(geometry).packed())


_bodies: dict[str, CachedResult] = {}


def _with_texels(row: Mapping[str, Any], shell: Shell, piece: Any) -> dict[str, Any]:
    """The row of a texture with its texels; one that the page draws itself has none."""
    bound = shell.textures.get(row["source_name"])
    return (
        {**row, "texels": _texels(bound, piece)} if bound is not None and row["drawn"] not in DRAWN_BY_PAGE else {**row}
    )


def _texels(texture: Texture, piece: Any) -> dict[str, Any]:
    levels = [
        {"size": texture.size(number), "data": piece(np.ascontiguousarray(level, "<f2").tobytes())}
        for number, level in enumerate(texture.levels)
    ]
    return {"dim": texture.dim, "filter": texture.filter, "wrap": texture.wrap, "levels": levels}
