"""Reads an open file with the front end of the command line; what it said when it was last right is kept."""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from sssgen.editor.documents import GLSL, MATERIAL, SCENE, TECHNIQUE, Document
from sssgen.ir.nodes import Function, Module
from sssgen.lang.assumption_comments import AssumedInput
from sssgen.lang.loader import load_file
from sssgen.lang.plain_glsl import AUTO, load_glsl
from sssgen.material import library
from sssgen.material.library import ROLES, Technique, folder_of, load_path
from sssgen.material.material_loading import parse_material
from sssgen.material.model import Material
from sssgen.scene import scene_parameters
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.file_memo import noted_files
from sssgen.support.paths import source_name, stem
from sssgen.support.text_files import read_text

_ROLE = re.compile(r"^[\s/*]*role[ \t]*:", re.MULTILINE)


class Analysis(NamedTuple):
    """What a file says. What is None could not be read."""

    diagnostics: tuple[Diagnostic, ...] = ()
    files: tuple[str, ...] = ()
    """The paths that were read or searched for."""
    module: Module | None = None
    technique: Technique | None = None
    material: Material | None = None
    scene: Scene | None = None
    assumed: tuple[AssumedInput, ...] = ()
    """What comments of plain GLSL assume of inputs."""


def analyse(document: Document, before: Analysis | None = None) -> Analysis:
    """Reads a document whose text `support.unsaved` keeps; where it is wrong, what was read `before` remains."""
    read = {TECHNIQUE: _technique, GLSL: _glsl, MATERIAL: _material, SCENE: _scene}.get(document.kind)
    if read is None:
        return Analysis()

    def result() -> Analysis:
        try:
            return read(document)
        except SssgenError as error:
            return (before or Analysis())._replace(diagnostics=tuple(error.diagnostics))
        except RecursionError:
            return (before or Analysis())._replace(
                diagnostics=(Diagnostic("error", "the text is nested too deeply to be read"),)
            )

    with noted_files() as files:
        analysis = result()
    return analysis._replace(files=tuple(files))


def own_names(document: Document) -> tuple[str, ...]:
    """The names that messages may have for a document."""
    return (document.display_name, source_name(document.path), os.path.basename(document.path))


def function_around(document: Document, module: Module, line: int) -> Function | None:
    """The function of a document around a line from 0: the last one that begins at it or before it."""
    own = own_names(document)
    functions = [function for function in module.functions if function.span.file in own]
    before = [function for function in functions if function.span.line <= line + 1]
    return max(before, key=lambda function: function.span.line, default=None)


def _technique(document: Document) -> Analysis:
    module = load_file(document.path, (library.TECHNIQUES,))
    name = stem(document.path)
    has_function = any(function.name == name and function.body is not None for function in module.functions)
    if _ROLE.search(document.text) or (folder_of(document.path) in ROLES and has_function):
        technique = load_path(document.path)
        return Analysis(module=technique.module, technique=technique)
    return Analysis(module=module)


def _glsl(document: Document) -> Analysis:
    loaded = load_glsl(document.path, document.display_name, entry=AUTO, assumptions=True)
    return Analysis(tuple(loaded.warnings), module=loaded.module, assumed=tuple(loaded.assumed))


def _material(document: Document) -> Analysis:
    text = read_text(document.path, document.display_name)
    return Analysis(material=parse_material(text, document.path))


def _scene(document: Document) -> Analysis:
    scene = parse_scene(read_text(document.path, document.display_name), document.path)
    material = scene_parameters.material_of(scene)
    if material is not None:
        scene_parameters.check(scene, material)
    return Analysis(material=material, scene=scene)
