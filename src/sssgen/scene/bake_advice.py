"""The command that bakes the textures of a function for a material in a scene, and the names of its files."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping

import numpy as np

from sssgen.material.model import Material
from sssgen.material.requirements import BakedFunction, read_uniforms
from sssgen.scene.geometry import Mesh
from sssgen.scene.geometry_base import unit
from sssgen.scene.scene import Scene
from sssgen.support.installed_files import is_installed
from sssgen.support.paths import posix, shell_word

_PLACEHOLDER = re.compile(r"\{(\w+)\}")
_NAME = "{name}"


def advice(function: BakedFunction, material: Material, scene: Scene, given: Mapping[str, str], in_scene: bool) -> str:
    """What to do for the baked textures of a function, with a command to copy.

    `given` are the files that are named already, in the scene or else in the material.
    """
    names, bake = [texture.name for texture in function.textures], function.bake
    file = scene.document.reporter.file if in_scene else material.file
    section = "[textures]" if in_scene else f"the stage {function.stage.technique.name}"
    place = f"{section} of {posix(os.path.basename(file))}"
    if bake is None or len(bake.files) != len(names):
        lines = ", ".join(f'{name} = "FILE"' for name in names if name not in given)
        return f"sssgen bake makes no such texture: paint it{f', and write {lines} in {place}' if lines else ''}"
    head, output = bake.arguments.rsplit(" ", 1)
    kind = head.split()[0]
    prefix = _prefix(dict(zip(names, bake.files, strict=True)), given) or f"{material.name}_{kind}"
    path = given[names[0]] if len(names) == 1 and given else output.replace(_NAME, prefix)
    folder = "" if is_installed(file) else os.path.dirname(file)
    words = _words(material, scene)
    own = [word.upper() for word in _PLACEHOLDER.findall(head) if not words.get(word)]
    command = _PLACEHOLDER.sub(lambda match: words.get(match[1]) or match[1].upper(), head)
    lines = ", ".join(
        f'{name} = "{one.replace(_NAME, prefix)}"'
        for name, one in zip(names, bake.files, strict=True)
        if name not in given
    )
    needs_medium = "{scene}" in head and "medium" not in scene.measured
    steps = (
        "write [medium] in the scene" if needs_medium else "",
        f"run `sssgen bake {command} {shell_word(os.path.join(folder, path))}`"
        + (f" with your own in place of {' and '.join(own)}" if own else ""),
        f"write {lines} in {place}" if lines else "",
    )
    return ", then ".join(filter(None, steps))


def _prefix(files: Mapping[str, str], given: Mapping[str, str]) -> str:
    """The beginning of the names of files that are named already; '' where none shows it."""
    for name, file in given.items():
        if match := re.fullmatch(re.escape(files[name]).replace(re.escape(_NAME), "(.+)"), file):
            return match[1]
    return ""


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
    for stage in material.stages:
        for uniform in read_uniforms(stage):
            value = stage.values.get(uniform.name, uniform.default)
            if len(value) == 1:
                is_length = dict(uniform.hints).get("unit") == ("m",)
                words.setdefault(uniform.name, f"{value[0] / scale if is_length else value[0]:.4g}")
    return words


def is_scene(scene: Scene, material: Material) -> bool:
    """Whether the scene has a file of its own, and is not the plain one of a material."""
    return os.path.abspath(scene.document.reporter.file) != os.path.abspath(material.file)
