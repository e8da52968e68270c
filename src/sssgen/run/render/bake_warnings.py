"""Warnings that a scene is not quite the one of a baked texture.

The picture has the medium of its baked light: the section [medium] is for charts, and for the next bake. A baked
thickness is for light from outside.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from sssgen.material import baked
from sssgen.material.baked import BakeFile
from sssgen.material.model import Material
from sssgen.run.render import baked_body
from sssgen.run.render.scene_values import texture_file
from sssgen.scene.measured.measured_scene import medium_of
from sssgen.scene.measured.media import Medium
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic
from sssgen.targets.reflection_record import Reflection

THICKNESS = ("thickness", "transmittance")
"""The kinds of bakes of a body's thickness."""
QUANTITIES = ("extinction", "albedo", "anisotropy", "ior", "roughness")
"""What the JSON of baked light states of its medium; so are the attributes of `Medium` called."""


def bake_warnings(scene: Scene, material: Material, reflection: Reflection) -> list[Diagnostic]:
    """Warnings for the first baked texture of another medium, and for lamps inside a body with a baked thickness.

    Raises SssgenError for a faulty [medium].
    """
    files = [file for texture in reflection["textures"] if (file := texture_file(scene, material, texture))]
    bakes = {file: bake for file in files if (bake := baked.read_bake_file(file)) is not None}
    return [*_of_lamps(scene, bakes), *(_of_medium(scene, bakes) if "medium" in scene.measured else [])]


def _of_lamps(scene: Scene, bakes: Mapping[str, BakeFile]) -> list[Diagnostic]:
    thickness = [file for file, bake in bakes.items() if bake.kind in THICKNESS and "mesh" in bake.facts]
    if scene.geometry is None or not thickness:
        return []
    document = scene.document
    inside = baked_body.lights_inside(scene.geometry, scene.lights)
    spans = [document.place("light", number - 1).value for number in inside]
    name = os.path.basename(thickness[0])
    message = f"this light is inside the body, and '{name}' has the thickness for light from outside"
    hint = "move it out, or use a technique that knows the way of the light, such as back_face_thickness"
    return [Diagnostic("warning", message, span, hint, document.reporter.line(span)) for span in spans]


def _of_medium(scene: Scene, bakes: Mapping[str, BakeFile]) -> list[Diagnostic]:
    for file, described in bakes.items():
        facts = described.facts.get("medium") if described.kind == "fluence" else None
        if not isinstance(facts, dict):
            continue
        medium, document = medium_of(scene), scene.document
        document.reporter.check()
        assert medium is not None
        if differences := _differences(facts, medium):
            span = document.place("medium").value
            message = f"'{os.path.basename(file)}' is baked for another medium: {', '.join(differences)}"
            hint = "the picture has that of the bake: bake again, or write that medium here"
            return [Diagnostic("warning", message, span, hint, document.reporter.line(span))]
    return []


def _differences(facts: Mapping[str, object], medium: Medium) -> list[str]:
    """For each quantity that differs, its name and both values."""
    differences = []
    for quantity in QUANTITIES:
        there, here = facts.get(quantity), getattr(medium, quantity)
        if isinstance(there, int | float | list) and not baked.is_same(there, here):
            differences.append(f"{quantity} {baked.text(there)} and not {baked.text(here)}")
    return differences
