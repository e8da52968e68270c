"""The sources in emitted files: language, stages and entry points by the file name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import cast

from sssgen.run.compilers import Source, Stage
from sssgen.targets import descriptor, registry

_SAMPLERS = " ".join(f"precision highp sampler{dim};" for dim in ("2D", "3D", "Cube", "2DArray"))
"""Which the engine's shader has above the functions."""
_OTHER_STAGE = {"vertex": "fragment", "fragment": "vertex"}


def sources(files: Mapping[str, str]) -> list[Source]:
    """The sources in `files` (file name → text), by the file names in the targets' descriptors.

    A file with several entry points gives one source each, a GLSL stage has the other stage as `companion`, a file that
    includes another one has that, and a .shader file is one source. Files of no target (a reflection) are left out.
    """
    result = []
    for name, text in files.items():
        for target, material, output in outputs(name):
            stages = output.stages
            result += held_functions(text, name, output)
            if name.endswith(".shader"):  # has all its stages, and declares their entries
                stages = dict(list(stages.items())[:1])
            for stage, entry in stages.items():
                companion = _companion(files, name, target, material, stage, output.includes)
                result.append(Source(text, target.name, cast(Stage, stage), entry or "main", name, companion))
    return result


def held_functions(text: str, name: str, output: descriptor.OutputFile) -> list[Source]:
    """The functions in a module of JavaScript, each on the lines that it has there."""
    result = []
    for constant, language in output.holds.items():
        for match in re.finditer(rf"const {constant} = /\* \w+ \*/ `((?:[^`\\]|\\.)*)`", text):
            above = text.count("\n", 0, match.start(1))
            functions = re.sub(r"\\(.)", r"\1", match[1])
            head = _SAMPLERS if registry.load(language).precision else ""
            result.append(Source(head + "\n" * above + functions, language, "library", "", name))
    return result


def outputs(name: str) -> list[tuple[descriptor.Target, str, descriptor.OutputFile]]:
    """(target, material, its file entry) of a file name; the longest pattern wins.

    A material's stage and that of a whole shader of plain GLSL have the same file names: one entry represents both.
    """
    matches = []
    seen: set[tuple[str, str]] = set()
    base = name.rpartition("/")[2]
    for target in map(registry.load, registry.names()):
        for output in (entry for entries in target.files.values() for entry in entries if not entry.sources):
            pattern = re.sub(r"\\{(?:material|module)\\}", r"(\\w+)", re.escape(output.name))
            match = re.fullmatch(pattern, base)
            if match and (target.name, output.name) not in seen:
                seen.add((target.name, output.name))
                matches.append((len(output.name), target, match[1], output))
    longest = max((length for length, *_ in matches), default=0)
    return [(target, material, output) for length, target, material, output in matches if length == longest]


def _companion(
    files: Mapping[str, str], name: str, target: descriptor.Target, material: str, stage: str, included: str
) -> str:
    folder = name[: len(name) - len(name.rpartition("/")[2])]
    if included:
        return files.get(folder + included.replace("{material}", material), "")
    if target.language != "glsl":
        return ""
    for output in (entry for entries in target.files.values() for entry in entries):
        if _OTHER_STAGE.get(stage) in output.stages:
            return files.get(folder + output.name.replace("{material}", material), "")
    return ""
