"""The scene of a technique that is named alone: the smallest material that shows it, on a body that fits its slots."""

from __future__ import annotations

import dataclasses
import functools
import json
import os
import tempfile

from sssgen.material import library
from sssgen.material.material_loading import examples, load_material
from sssgen.material.material_text import material_text
from sssgen.material.model import Material
from sssgen.scene.preview_scene import BALL, plain_scene
from sssgen.scene.scene import Light, Scene
from sssgen.support.file_writer import write_files

_EVEN = Light(None, (0.0, 0.6, 0.8), (1.0, 1.0, 1.0))
"""The light under which a quantity is the grey, so that white is a quantity of 2."""
SUFFIX = ".sss"
SAVES = "this is a material of the preview's own: change the defaults in the technique's file, or write a material"


def is_technique(name: str) -> bool:
    """Whether a name is that of a technique: a file, or one of the library unless an example has the name."""
    return name.lower().endswith(SUFFIX) or (name in library.index() and name not in examples())


def scene_of_technique(name: str) -> tuple[Scene, Material]:
    """The scene and the material that show a technique. Raises SssgenError."""
    from sssgen.lab.measure.technique_chain import BODY, chain_of, reference_to

    technique = library.load(name)
    stages = chain_of(technique)
    folder, file = os.path.abspath(_temporary_folder().name), f"{technique.name}.toml"
    write_files(folder, {file: material_text(technique.name, stages)})
    material = load_material(os.path.join(folder, file))
    if technique.role == "distance":
        return plain_scene(material, _function(reference_to(technique))), material
    in_slots = {to for stage in stages for _, to in stage.bind}
    scene = plain_scene(material, _function(BODY) if BODY in in_slots else BALL)
    if technique.role in ("thickness", "conversion"):
        scene = dataclasses.replace(scene, lights=(_EVEN,), ambient=(0.0, 0.0, 0.0), exposure=0.5)
    elif technique.role == "translucency":
        scene = dataclasses.replace(scene, exposure=0.25)
    return scene, material


def _function(name: str) -> str:
    return f'[geometry]\nkind = "distance"\ntechnique = {json.dumps(name, ensure_ascii=False)}\n'


@functools.cache
def _temporary_folder() -> tempfile.TemporaryDirectory[str]:
    """The folder of these materials, with the pictures that they read; it is removed at the end of the process."""
    from sssgen.lab.measure.technique_chain import write_pictures

    folder = tempfile.TemporaryDirectory(prefix="sssgen_preview_")
    write_pictures(folder.name)
    return folder
