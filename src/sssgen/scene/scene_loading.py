"""Loads scenes: from a TOML file, from a TOML text, or an example by its name."""

from __future__ import annotations

import os
from dataclasses import replace

from sssgen.material.material_loading import examples, preset_hint
from sssgen.scene.scene import Scene
from sssgen.scene.scene_reader import read_scene
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text, refuse_folder, refuse_other_kinds
from sssgen.support.toml_source import parse


def load(path: str | os.PathLike[str], draws: bool = True) -> Scene:
    """The scene of a TOML file, or of an example by its name.

    A missing picture is an error unless nothing `draws` the scene. Raises SssgenError with all errors.
    """
    text = os.fspath(path)
    if not text.endswith(".toml") and "/" not in text and "\\" not in text and not os.path.isfile(text):
        names = examples()
        if text not in names:
            refuse_folder(text, (".toml",), "scene.toml")
            hint = f"give a path that ends in .toml, or one of: {', '.join(names)}"
            raise failure(f"unknown scene '{text}'", preset_hint(text) or did_you_mean(text, names) or hint)
        path = os.path.join(os.path.dirname(names[text]), "scene.toml")
    refuse_other_kinds(path)
    return parse_scene(read_text(os.fspath(path), posix(path)), path, draws)


def bodies_of(scene: Scene) -> list[Scene]:
    """A scene for each of a scene's `bodies`, with the picture, the camera, the lights and the surroundings of `scene`.

    Raises SssgenError for a faulty file, and for one with several bodies itself.
    """
    shared = {
        name: getattr(scene, name)
        for name in (
            "size", "samples", "time", "background", "ambient", "exposure", "camera", "lights", "shell", "folder",
            "shows_environment",
        )
    }  # fmt: skip
    environment = {"environment": scene.measured["environment"]} if "environment" in scene.measured else {}
    result = []
    for path in scene.bodies:
        body = load(path)
        if not body.material or body.geometry is None:
            raise failure("this scene has no body of its own", "add material and [geometry]", posix(path))
        own = {key: value for key, value in body.measured.items() if key != "environment"}
        result.append(replace(body, measured=own | environment, **shared))
    return result


def parse_scene(text: str, path: str | os.PathLike[str], draws: bool = True) -> Scene:
    """The scene that a TOML text describes; files that it names are searched for next to `path`. Raises SssgenError."""
    return read_scene(parse(text, posix(path)), os.path.dirname(os.fspath(path)), draws)
