"""The command that bakes the textures of a function, and what to do for each texture that a picture needs."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import NamedTuple

from sssgen.material.model import Material
from sssgen.material.requirements import BakedFunction, needed_textures, read_uniforms
from sssgen.support.paths import shell_word

_PLACEHOLDER = re.compile(r"\{(\w+)\}")
_NAME = "{name}"
_NUMPY, _RAW, _ENCODED = ".npy", ".raw", " --format raw+json --encode r16f"
"""The endings of volumes for sssgen and for engines and pages, which read no NumPy arrays."""


class BakeCommand(NamedTuple):
    """A command of `sssgen bake`."""

    text: str
    """To copy"""
    files: Mapping[str, str]
    """Texture → its file"""
    own: tuple[str, ...]
    """The words in capitals, which the user replaces"""


def bake_command(
    function: BakedFunction, material: str, given: Mapping[str, str], words: Mapping[str, str], folder: str = ""
) -> BakeCommand | None:
    """The command for the textures of a function; None where sssgen bakes no such textures.

    `material` is its name, and `given` are the files that are named already, which lie in `folder`. `words` replace
    placeholders; one without a word is written in capitals.
    """
    names, bake = [texture.name for texture in function.textures], function.bake
    if bake is None or len(bake.files) != len(names):
        return None
    head, output = bake.arguments.rsplit(" ", 1)
    prefix = _prefix(dict(zip(names, bake.files, strict=True)), given) or f"{material}_{head.split()[0]}"
    path = given[names[0]] if len(names) == 1 and given else output.replace(_NAME, prefix)
    own = tuple(word.upper() for word in _PLACEHOLDER.findall(head) if not words.get(word))
    arguments = _PLACEHOLDER.sub(lambda match: words.get(match[1]) or match[1].upper(), head)
    files = {name: one.replace(_NAME, prefix) for name, one in zip(names, bake.files, strict=True)}
    return BakeCommand(f"sssgen bake {arguments} {shell_word(os.path.join(folder, path))}", files, own)


def parameter_words(material: Material, scale: float = 1.0) -> dict[str, str]:
    """Parameter → its value in a command, for a mesh that is drawn `scale` times as large."""
    words: dict[str, str] = {}
    for stage in material.stages:
        for uniform in read_uniforms(stage):
            value = stage.values.get(uniform.name, uniform.default)
            if len(value) == 1:
                is_length = dict(uniform.hints).get("unit") == ("m",)
                words.setdefault(uniform.name, f"{value[0] / scale if is_length else value[0]:.4g}")
    return words


def needs(material: Material) -> dict[tuple[str, str], tuple[str, str]]:
    """What to do for each texture that a picture needs, and its file or '', by its technique and its name there."""
    result: dict[tuple[str, str], tuple[str, str]] = {}
    for stage, names, function in needed_textures(material.stages):
        given = {name: stage.textures[name] for name in names if name in stage.textures}
        command = function and bake_command(function, material.name, given, parameter_words(material))
        files = {**(command.files if command else {}), **given}
        if command and command.text.endswith(_NUMPY):
            files = {name: file.removesuffix(_NUMPY) + _RAW for name, file in files.items()}
            command = command._replace(text=command.text.removesuffix(_NUMPY) + _RAW + _ENCODED)
        origin = f"`{command.text}` makes" if command else "the material names"
        for name in names:
            how = f"load {files[name]}, which {origin}" if name in files else "paint it"
            result.setdefault((stage.technique.name, name), (how, files.get(name, "")))
    return result


def _prefix(files: Mapping[str, str], given: Mapping[str, str]) -> str:
    """The beginning of the names of files that are named already; '' where none shows it."""
    for name, file in given.items():
        if match := re.fullmatch(re.escape(files[name]).replace(re.escape(_NAME), "(.+)"), file):
            return match[1]
    return ""
