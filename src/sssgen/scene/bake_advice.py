"""What to do for the baked textures of a function, for a material in a scene."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np

from sssgen.material.bake_commands import bake_command, parameter_words
from sssgen.material.model import Material
from sssgen.material.requirements import BakedFunction
from sssgen.scene.geometry import Mesh
from sssgen.scene.geometry_base import unit
from sssgen.scene.scene import Scene
from sssgen.support.installed_files import copy_hint, is_installed
from sssgen.support.paths import posix, shell_word


def advice(function: BakedFunction, material: Material, scene: Scene, given: Mapping[str, str], in_scene: bool) -> str:
    """What to do for the baked textures of a function, with a command to copy.

    `given` are the files that are named already, in the scene or else in the material.
    """
    bake, file = function.bake, scene.document.reporter.file if in_scene else material.file
    section = "[textures]" if in_scene else f"the stage {function.stage.technique.name}"
    place = f"{section} of {posix(os.path.basename(file))}"
    installed, words = is_installed(file), _words(material, scene)
    # of an example that names its files, a copy has them: nothing is written beside the example
    copied = installed and bool(given)
    if copied and words["scene"]:
        words["scene"] = shell_word(os.path.basename(scene.document.reporter.file))
    command = bake_command(function, material.name, given, words, "" if installed else os.path.dirname(file))
    if bake is None or command is None:
        lines = ", ".join(f'{texture.name} = "FILE"' for texture in function.textures if texture.name not in given)
        return f"sssgen bake makes no such texture: paint it{f', and write {lines} in {place}' if lines else ''}"
    lines = ", ".join(f'{name} = "{one}"' for name, one in command.files.items() if name not in given)
    needs_medium = "{scene}" in bake.arguments and "medium" not in scene.measured
    steps = (
        copy_hint(file) if copied else "",
        "write [medium] in the scene" if needs_medium else "",
        f"run `{command.text}`"
        + (" in its folder" if copied else "")
        + (f" with your own in place of {' and '.join(command.own)}" if command.own else ""),
        f"write {lines} in {place}" if lines else "",
    )
    return ", then ".join(filter(None, steps))


def _words(material: Material, scene: Scene) -> dict[str, str]:
    """Placeholder → its text for this material and scene; '' where they have none."""
    geometry, file = scene.geometry, scene.document.reporter.file
    to_object, scale = (np.eye(4), 1.0) if geometry is None else (geometry.to_object(), geometry.scale)
    towards = [to_object[:3, :3] @ np.array(light.direction) for light in scene.lights if light.direction is not None]
    words = {
        "mesh": shell_word(geometry.path) if isinstance(geometry, Mesh) else "",
        "scene": shell_word(file) if is_scene(scene, material) else "",
        "light": ",".join(f"{x:.4g}" for x in unit(towards[0][None])[0]) if towards else "",
    }
    return parameter_words(material, scale) | words


def is_scene(scene: Scene, material: Material) -> bool:
    """Whether the scene has a file of its own, and is not the plain one of a material."""
    return os.path.abspath(scene.document.reporter.file) != os.path.abspath(material.file)
