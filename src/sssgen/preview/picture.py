"""What a page shows of a material: the emitted three.js module, the body, the values and the textures of its scene."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from sssgen.material.model import Material
from sssgen.material.requirements import bodies
from sssgen.pipeline.compiler import compile
from sssgen.preview.bodies import OWN_MESH, SHAPES, fit, frame, packed_triangles
from sssgen.preview.emitted_head import DRAWN_BY_PAGE, TARGET, Slot, emitted_head
from sssgen.preview.mesh_notes import mesh_notes
from sssgen.run.render.missing_textures import missing_textures
from sssgen.run.render.scene_values import environment_of, shell_of
from sssgen.run.render.shell_values import Shell
from sssgen.scene.environment import Environment
from sssgen.scene.geometry import Mesh
from sssgen.scene.scene import Picture as PictureFile
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import failure
from sssgen.targets.reflection_record import Reflection
from sssgen.targets.runtime.numpy_textures import Texture


class Picture(NamedTuple):
    """A picture as the page gets it."""

    head: dict[str, Any]
    """JSON: the module, the controls, the textures, the lights, the camera; what is large is named by its digest."""
    pieces: dict[str, bytes]
    """Digest → triangles or texels."""
    material: Material | None
    """None for plain GLSL"""
    values: Mapping[str, Sequence[float]] = MappingProxyType({})
    """The parameters that the scene gives, those of baked files among them."""


class Pieces:
    """What is large in a picture, by its digest."""

    def __init__(self) -> None:
        self.data: dict[str, bytes] = {}

    def add(self, data: bytes) -> str:
        """The digest of a piece."""
        digest = _digest(data)
        self.data[digest] = data
        return digest


class Choices(NamedTuple):
    """What a person chose on the page; it is in no file."""

    shape: str = ""
    """"" for the scene's own body, one of `SHAPES`, or `OWN_MESH`"""
    mesh: Mesh | None = None
    guards: str = "auto"
    textures: Mapping[str, str] = MappingProxyType({})
    """A texture's property → its file"""


def picture_of(scene: Scene, material: Material, choices: Choices) -> Picture:
    """The picture of a material in a scene. Raises SssgenError."""
    compiled = compile(material, TARGET, guards=choices.guards, standalone=True)
    if scene.geometry is None:
        raise failure(f"{material.name} makes its own rays: it is a flat picture, not a material of a body")
    scene = on_shape(scene, choices)
    named = {texture["property"]: texture["source_name"] for texture in compiled.reflection["textures"]}
    textures = dict(scene.textures)
    for name, file in choices.textures.items():
        if name in named:  # it continues at its edges as the scene's own does
            textures[named[name]] = PictureFile(file, getattr(scene.textures.get(named[name]), "wrap", ""))
    drawn = dataclasses.replace(scene, textures=textures)
    reflection = _without_views(compiled.reflection)
    shell = shell_of(drawn, material, reflection)
    pieces = Pieces()
    assert scene.geometry is not None  # `on_shape` keeps one
    head = emitted_head(material, compiled, shell.unplaced(compiled.reflection["uniforms"]), scene.parameters)
    head |= {
        "shape": choices.shape,
        "shapes": ["", *SHAPES, *([OWN_MESH] if choices.mesh is not None else [])],
        "saves": "",
        "note": _note(material, choices.shape),
        "warnings": mesh_notes(scene, material),
        "missing": missing_text(drawn, material, reflection, shell),
        "mesh": os.path.basename(choices.mesh.path) if choices.mesh is not None else "",
        "body": pieces.add(packed_triangles(scene.geometry)),
        "model": scene.geometry.to_world().T.ravel().tolist(),
        "textures": [_with_texels(row, shell, choices, pieces) for row in head["textures"]],
        "lights": [
            {"position": position.tolist(), "color": color.tolist()}
            for position, color in zip(shell.light_positions, shell.light_colors, strict=True)
        ],
        "ambient": list(shell.ambient),
        "environment": _environment(scene, pieces),
        "background": [list(color) for color in scene.background],
        "exposure": scene.exposure,
        "shadows": "shadow" in scene.shell,
        "tone_mapping": scene.shell.get("tone_mapping", ""),
        "camera": _camera(scene, choices.shape),
    }
    return Picture(head, pieces.data, material, shell.parameters)


def _environment(scene: Scene, pieces: Pieces) -> dict[str, Any] | None:
    """The texels of the scene's [environment]; None without one."""
    environment = environment_of(scene)
    if environment is None:
        return None
    return texels_of(_panorama(environment), pieces.add)


@functools.lru_cache(4)
def _panorama(environment: Environment) -> Texture:
    """The light from each direction, from below: three.js shows a white matte plane in it as it is, as sssgen does."""
    light = environment.values()[::-1]
    return Texture(np.concatenate([light, np.ones((*light.shape[:2], 1))], axis=-1), "linear", "repeat")


def missing_text(scene: Scene, material: Material, reflection: Reflection, shell: Shell) -> str:
    """What a person must do for the textures that are missing, in place of a picture; '' where there are all."""
    errors = missing_textures(scene, material, reflection, shell.textures)
    return "\n\n".join(error.render() for error in errors)


def _note(material: Material, shape: str) -> str:
    """What a person must know of a material on another shape than its own; '' for nothing."""
    own = bodies(material.stages) if shape else []
    return f"It is made for the body of {', '.join(own)}: on this shape the light inside is wrong." if own else ""


def on_shape(scene: Scene, choices: Choices) -> Scene:
    """The scene with the chosen body, which is as large as its own."""
    shape = choices.mesh if choices.shape == OWN_MESH else SHAPES.get(choices.shape)
    if shape is None or scene.geometry is None:
        return scene
    return dataclasses.replace(scene, geometry=fit(shape, scene.geometry))


def _camera(scene: Scene, shape: str) -> dict[str, Any]:
    """The scene's camera; for another body than the scene's, the eye is where it sees the whole of it."""
    position, target = list(scene.camera.position), list(scene.camera.target)
    if shape and scene.geometry is not None:
        towards = np.subtract(position, target)
        position, target = frame(scene.geometry, towards, scene.camera.field_of_view)
    return {"position": position, "target": target, "field_of_view": scene.camera.field_of_view}


def _without_views(reflection: Reflection) -> Reflection:
    """The reflection without the passes that the page runs, so that nothing else runs them."""
    return {**reflection, "passes": [drawn for drawn in reflection["passes"] if drawn["name"] not in DRAWN_BY_PAGE]}


def _with_texels(row: Slot, shell: Shell, choices: Choices, pieces: Pieces) -> Slot:
    """The row of a texture with its texels; one that the page draws itself has none."""
    row = {**row, "chosen": os.path.basename(choices.textures.get(row["property"], ""))}
    bound = shell.textures.get(row["source_name"])
    return {**row, "texels": texels_of(bound, pieces.add)} if bound is not None and not row["page_draws"] else row


def texels_of(texture: Texture, piece: Callable[[bytes], str]) -> dict[str, Any]:
    """A texture for the page: its levels as pieces."""
    levels = [{"size": texture.size(number), "data": piece(data)} for number, data in enumerate(_levels(texture))]
    return {"dim": texture.dim, "filter": texture.filter, "wrap": texture.wrap, "levels": levels}


@functools.lru_cache(16)
def _levels(texture: Texture) -> list[bytes]:
    """The texels of each level, in float16."""
    return [np.ascontiguousarray(level, "<f2").tobytes() for level in texture.levels]


@functools.lru_cache(64)
def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:32]
