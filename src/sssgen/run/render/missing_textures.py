"""The textures that a picture needs and lacks: those that are baked from a body, and files that are not there."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence

from sssgen.ir.nodes import Span
from sssgen.material.model import Material, TechniqueUse
from sssgen.material.requirements import needed_textures
from sssgen.scene.bake_advice import advice, is_scene
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.paths import posix
from sssgen.targets.reflection_record import Reflection


class MissingTextures(SssgenError):
    """A material and a scene are right, but a file has not been made yet."""


def missing_textures(
    scene: Scene, material: Material, reflection: Reflection, bound: Collection[str]
) -> list[Diagnostic]:
    """An error for each function whose baked textures are missing, and for each other picture that a stage names and
    that is not there; `bound` are the textures that there are, by their names in the scene.
    """
    lacking = {
        (texture["technique"], texture["technique_name"])
        for texture in reflection["textures"]
        if texture["source_name"] not in bound
    }
    errors = []
    for stage, names, function in needed_textures(material.stages):
        missing = [name for name in names if (stage.technique.name, name) in lacking]
        lacking -= {(stage.technique.name, name) for name in missing}
        given = {name: stage.textures[name] for name in missing if name in stage.textures}
        if missing and function is not None:
            *others, last = [f"'{name}'" for name in missing]
            shown = f"textures {', '.join(others)} and {last}" if others else f"texture {last}"
            about = f"{function.name} reads the {shown}, baked from the body, and there is no file"
            hint = advice(function, material, scene, given, is_scene(scene, material) and not given)
            errors.append(Diagnostic("error", about, _span(stage, names), hint))
        elif missing:
            about = f"cannot find the file '{given[names[0]]}' of the texture '{names[0]}'"
            hint = f"it is searched for next to the material, in {posix(os.path.dirname(material.file) or '.')}"
            errors.append(Diagnostic("error", about, _span(stage, names), hint))
    return errors


def _span(stage: TechniqueUse, names: Sequence[str]) -> Span:
    """The place of the first file that a stage names, or that of the stage."""
    return next((span for name, span in stage.texture_spans if name in names), stage.span)
