"""The texture files that a material names and that are not beside it, or that are not of the mesh beside them."""

from __future__ import annotations

import os

from sssgen.material.bake_commands import bake_command, parameter_words
from sssgen.material.baked import other_mesh
from sssgen.material.model import Material
from sssgen.material.requirements import needed_textures
from sssgen.support.diagnostics import Diagnostic
from sssgen.support.file_memo import note
from sssgen.support.paths import posix


def missing_files(material: Material) -> list[Diagnostic]:
    """A warning for each missing file, at its place in the material, with the command that bakes it where one does; and
    for each bake of another mesh than the one beside it."""
    warnings: dict[str, Diagnostic] = {}
    folder = os.path.dirname(material.file)
    for stage, names, function in needed_textures(material.stages):
        given = {name: stage.textures[name] for name in names if name in stage.textures}
        for name, file in given.items():
            path = os.path.join(folder, file)
            note(path)
            span = dict(stage.texture_spans).get(name, stage.span)
            if os.path.isfile(path):
                if mesh := other_mesh(path):
                    message = f"'{file}' is baked for another '{mesh}' than the one beside it"
                    warnings.setdefault(file, Diagnostic("warning", message, span, "bake it again for this mesh"))
                continue
            command = function and bake_command(function, material.name, given, parameter_words(material), folder)
            place = f"it is searched for next to the material, in {posix(folder or '.')}"
            hint = f"run `{command.text}`" if command else place
            message = f"cannot find the file '{file}' of the texture '{name}': the shader needs it"
            warnings.setdefault(file, Diagnostic("warning", message, span, hint))
    return list(warnings.values())
