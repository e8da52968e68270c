"""Pictures without a body, of one triangle: a material that makes its own rays, or plain GLSL."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from sssgen.material.model import Material
from sssgen.pipeline.compiler import compile
from sssgen.preview.emitted_head import Slot
from sssgen.preview.flat_head import TARGET, plain_head, raymarched_head
from sssgen.preview.picture import Choices, Picture, Pieces, missing_text, texels_of
from sssgen.run.evaluate import input_files
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render.scene_values import shell_of
from sssgen.scene.scene import Scene
from sssgen.targets.runtime.numpy_textures import Texture


def plain_picture(path: str, choices: Choices) -> Picture:
    """The picture of plain GLSL. Raises SssgenError as `plain_head` does."""
    pieces = Pieces()
    head = plain_head(path, choices.guards)
    head["textures"] = [_fill_slot(row, choices, pieces) for row in head["textures"]]
    return Picture(head, pieces.data, None)


def raymarched_picture(scene: Scene, material: Material, choices: Choices) -> Picture:
    """The picture of a material that makes its own rays. Raises SssgenError."""
    compiled = compile(material, TARGET, guards=choices.guards)
    shell = shell_of(scene, material, compiled.reflection)
    pieces = Pieces()
    head = raymarched_head(material, compiled, shell.parameters, scene.parameters)
    head["textures"] = [
        {**row, "chosen": "", "texels": texels_of(shell.textures[row["source_name"]], pieces.add)}
        for row in head["textures"]
        if row["source_name"] in shell.textures
    ]
    head["flat"] |= {"start": scene.time, "plays": False}
    head["missing"] = missing_text(scene, material, compiled.reflection, shell)
    head |= {"background": [list(color) for color in scene.background], "exposure": scene.exposure}
    return Picture(head, pieces.data, material, shell.parameters)


def _fill_slot(row: Slot, choices: Choices, pieces: Pieces) -> Slot:
    """A texture of plain GLSL with its texels: the chosen picture, or a checker."""
    file = choices.textures.get(row["property"], "")
    values = input_files.texture(file) if file else Texture(_checker())
    return {**row, "chosen": os.path.basename(file), "texels": texels_of(half(values), pieces.add)}


def _checker() -> Any:
    rows, columns = np.indices((64, 64)) // 8
    return np.where(((rows + columns) % 2 == 0)[..., None], [0.75, 0.75, 0.75], [0.35, 0.35, 0.35])
