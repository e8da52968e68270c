"""What is left to do with a picked material: bake its textures, and look at it."""

from __future__ import annotations

import os

from sssgen.material.model import Material
from sssgen.material.requirements import baked_functions
from sssgen.scene.bake_advice import advice
from sssgen.scene.example_scenes import measured_scenes
from sssgen.scene.scene_loading import load
from sssgen.support.paths import shell_word


def bakes(material: Material, scene: str) -> list[str]:
    """What to do for each baked texture of the material, with the command; `scene` is as on the command line."""
    path = measured_scenes().get(scene, scene)
    drawn = load(path, draws=False)
    steps = [advice(function, material, drawn, {}, in_scene=False) for function in baked_functions(material.stages)]
    return list(dict.fromkeys(steps))


def next_step(folder: str, name: str) -> str:
    """What to do next: look at the material in the folder, or write it."""
    if not folder:
        return "the same command with --emit out --target wgsl writes the material, its shader and its picture"
    return f"sssgen preview {shell_word(os.path.join(folder, f'{name}.toml'))}"
