"""The scene in which a material is shown that is named alone: the one beside it, or a plain one."""

from __future__ import annotations

import dataclasses
import json
import os

from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.scene.mesh import Mesh
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import load, parse_scene
from sssgen.scene.scene_reader import is_material

_PLAIN_SCENE = """material = {material}
background = [[0.10, 0.11, 0.13], [0.20, 0.22, 0.26]]
ambient = [0.12, 0.13, 0.15]
[camera]
position = [0.0, 0.5, 4.2]
field_of_view = 35.0
[[light]]
direction = [-0.6, 0.5, -0.6]
color = [3.0, 2.8, 2.6]
[[light]]
direction = [0.7, 0.6, 0.5]
color = [0.6, 0.65, 0.7]
"""
"""The larger light stands behind the body, as light that comes through is what the materials are about."""

BALL = '[geometry]\nkind = "ball"\n'


def scene_of(name: str) -> Scene:
    """The scene that a name or a path stands for: a scene, or a material in the scene beside it or in a plain one.

    Raises SssgenError.
    """
    if not (name.endswith(".toml") and os.path.isfile(name) and is_material(name)):
        return load(name)  # its errors name what there is
    material = load_material(name)
    return _scene_beside(material, name) or _plain_scene(material)


def _scene_beside(material: Material, path: str) -> Scene | None:
    """The scene in the material's folder, if it is a scene of this material."""
    beside = os.path.join(os.path.dirname(path), "scene.toml")
    if not os.path.isfile(beside):
        return None
    scene = load(beside)
    if not scene.material or load_material(scene.material).name != material.name:
        return None
    return dataclasses.replace(scene, material=os.path.abspath(path))


def mesh_beside(material: Material) -> str:
    """The mesh file of the scene beside a material, or '' where it has none. Raises SssgenError."""
    scene = _scene_beside(material, material.file)
    return scene.geometry.path if scene is not None and isinstance(scene.geometry, Mesh) else ""


def _plain_scene(material: Material) -> Scene:
    """A ball in front of a plain background; a material that makes its own rays has no body."""
    return plain_scene(material, "" if material.makes_rays else BALL)


def plain_scene(material: Material, geometry: str) -> Scene:
    """The plain scene with a body, the section [geometry] or nothing. Raises SssgenError for a faulty one."""
    text = _PLAIN_SCENE.format(material=json.dumps(os.path.abspath(material.file), ensure_ascii=False))
    return parse_scene(text + geometry, material.file)
