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
from sssgen.pipeline.compiler import Compiled, compile
from sssgen.preview.body_triangles import body_triangles
from sssgen.support.diagnostics import failure
from sssgen.support.file_memo import CachedResult, remembered
from sssgen.targets.runtime.numpy_textures import Texture

TARGET = "threejs"

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

    head = {
        "name": material.name,
        "title": material.title,
        "shape": shape,
        "shapes": ["", *SHAPES],
        "module": next(text for name, text in compiled.files.items() if name.endswith(".js")),
        "body": piece(_body(geometry)),
        "model": geometry.to_world().T.ravel().tolist(),
        "controls": _controls(compiled, shell, scene),
        "textures": _textures(compiled, shell, piece),
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
        "two_sided": compiled.reflection["two_sided"],
        "cost": {kind: entry["cost"] for kind, entry in compiled.reflection["entries"].items() if "cost" in entry},
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


def _controls(compiled: Compiled, shell: Shell, scene: Scene) -> list[dict[str, Any]]:
    """The parameters that a person may change, with what a control needs to know."""
    return [
        {
            "property": uniform["property"],
            "technique": uniform["technique"],
            "name": uniform["technique_name"],
            "label": uniform["source_name"],
            "doc": uniform["doc"],
            "type": uniform["type"],
            "range": uniform["range"],
            "unit": uniform["unit"],
            "color": uniform["color"],
            "default": [float(number) for number in uniform["default"]],
            "value": [float(number) for number in shell.parameters.get(uniform["source_name"], uniform["default"])],
            "drawn": uniform["drawn"],
            "in_scene": uniform["source_name"] in scene.parameters,
        }
        for uniform in compiled.reflection["uniforms"]
    ]


def _textures(compiled: Compiled, shell: Shell, piece: Any) -> list[dict[str, Any]]:
    """The textures; those that the page draws itself have no texels."""
    rows = []
    for texture in compiled.reflection["textures"]:
        row = {"property": texture["property"], "doc": texture["doc"], "drawn": texture["drawn"] or ""}
        bound = shell.textures.get(texture["source_name"])
        if bound is not None and texture["drawn"] not in DRAWN_BY_PAGE:
            row["texels"] = _texels(bound, piece)
        rows.append(row)
    return rows


def _texels(texture: Texture, piece: Any) -> dict[str, Any]:
    levels = [
        {"size": texture.size(number), "data": piece(np.ascontiguousarray(level, "<f2").tobytes())}
        for number, level in enumerate(texture.levels)
    ]
    return {"dim": texture.dim, "filter": texture.filter, "wrap": texture.wrap, "levels": levels}
