"""The warning that a scene's section [medium] is not the medium of its baked light.

The picture has the medium of the bake. The section is for charts, and for the next bake.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from sssgen.material import baked
from sssgen.material.model import Material
from sssgen.run.render.scene_values import texture_file
from sssgen.scene.measured.measured_scene import medium_of
from sssgen.scene.measured.media import Medium
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic
from sssgen.targets.reflection_record import Reflection

QUANTITIES = ("extinction", "albedo", "anisotropy", "ior", "roughness")
"""What the JSON of baked light states of its medium; so are the attributes of `Medium` called."""


def medium_warnings(scene: Scene, material: Material, reflection: Reflection) -> list[Diagnostic]:
    """A warning for the first baked texture of another medium. Raises SssgenError for a faulty [medium]."""
    files = [texture_file(scene, material, texture) for texture in reflection["textures"]]
    for file in filter(None, files if "medium" in scene.measured else []):
        described = baked.read_bake_file(file)
        facts = described.facts.get("medium") if described is not None and described.kind == "fluence" else None
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
