"""The arguments of `sssgen check` as shaders: files, folders of them, materials, examples."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple, cast, get_args

from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import FORMS, compile
from sssgen.run.check.compiler_inputs import outputs, sources
from sssgen.run.check.handwritten import LANGUAGES_OF, hand_written, language_of
from sssgen.run.compilers import Source, Stage, readers
from sssgen.support.diagnostics import Diagnostic, SssgenError, UnsupportedError, failure
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text
from sssgen.targets import registry
from sssgen.targets.reflection_record import Reflection

REFLECTION = "reflection.json"
STAGES = frozenset(get_args(Stage))


@dataclass(frozen=True)
class Shader:
    """One file: the sources in it, and `file:line:column` of the technique behind each line (its number as text)."""

    name: str
    text: str
    sources: tuple[Source, ...]
    origins: Mapping[str, str] = field(default_factory=dict)
    reflection: Reflection | None = None
    """Of a file of `sssgen transpile`."""


def read(arguments: Sequence[str], targets: Sequence[str]) -> list[Shader]:
    """The shaders that files, folders, materials and examples hold, only for `targets` if there are any.

    Raises SssgenError with all errors of the input, and where there is nothing to check.
    """
    problems: list[Diagnostic] = []
    shaders: list[Shader] = []
    files: dict[str, str] = {}
    named: set[str] = set()
    for argument in dict.fromkeys(arguments):
        try:
            if os.path.isdir(argument):
                files |= _read_folder(argument)
            elif _is_material(argument):
                shaders += of_material(argument, targets)
            else:
                path = posix(argument)
                files[path] = _read_file(argument, path)
                named.add(path)
        except SssgenError as error:
            problems += error.diagnostics
    try:
        shaders = [*of_files(files, named, targets), *shaders]
    except SssgenError as error:
        problems += error.diagnostics
    if problems:
        raise SssgenError(dict.fromkeys(problems))
    if not shaders:
        for_targets = f" for {', '.join(targets)}" if targets else ""
        hint = f"a shader is what `sssgen emit` writes, or ends in {', '.join(LANGUAGES_OF)}"
        raise failure(f"nothing to compile{for_targets}", hint, ", ".join(map(posix, arguments)))
    return shaders


def of_material(argument: str, targets: Sequence[str]) -> list[Shader]:
    """Both forms of a material for each target; no target: for all that a compiler reads."""
    material = load_material(argument)
    shaders: list[Shader] = []
    for target in targets or [name for name in registry.names() if _has_compiler(name)]:
        for form in FORMS:
            try:
                compiled = compile(material, target, form)
            except UnsupportedError:
                if targets:
                    raise
                continue  # nobody asked for this target
            shaders += _shaders(compiled.files, sources(compiled.files), compiled.reflection["source_map"])
    return shaders


def _has_compiler(target: str) -> bool:
    """Whether a compiler reads what is written for the target."""
    outputs = (output for form in registry.load(target).files.values() for output in form)
    return bool(readers(target)) or any(output.holds for output in outputs)


def of_files(files: Mapping[str, str], named: set[str], targets: Sequence[str]) -> list[Shader]:
    """The shaders among `files` (path → text). Raises SssgenError for a file in `named` that is no shader."""
    emitted: dict[str, str] = {}
    problems: list[Diagnostic] = []
    handwritten: list[Source] = []
    reflections: dict[str, Reflection] = {}
    for path, text in files.items():
        own = find_transpiled(path)
        target = own.target if own is not None else _emitted_for(path, text)
        if own is not None and (not targets or target in targets):
            handwritten += own.sources(text, path)
            reflections[path] = own.reflection
        elif target and (not targets or target in targets):
            emitted[path] = text
        elif target:
            if path in named:
                hint = f"write --target {target}, or leave --target out"
                problems += failure(f"the file is for {target}", hint, path).diagnostics
        elif language := _language(path, text, path in named, targets):
            handwritten += hand_written(text, language, path)
        elif path in named:
            hint = f"name it with --target T: {', '.join(registry.names())}"
            problems += failure("the language of the file cannot be determined", hint, path).diagnostics
    if problems:
        raise SssgenError(problems)
    origins = {path: _origins(path) for path in files}
    return _shaders(files, [*sources(emitted), *handwritten], origins, reflections)


def _shaders(
    files: Mapping[str, str],
    sources: Sequence[Source],
    origins: Mapping[str, Mapping[str, str]],
    reflections: Mapping[str, Reflection] = MappingProxyType({}),
) -> list[Shader]:
    """One for each file that has sources."""
    by_name: dict[str, list[Source]] = {}
    for source in sources:
        by_name.setdefault(source.name, []).append(source)
    return [
        Shader(name, files[name], tuple(by_name[name]), origins.get(name, {}), reflections.get(name))
        for name in files
        if name in by_name
    ]


def _is_material(argument: str) -> bool:
    if argument.endswith(".toml"):
        return True
    extension = os.path.splitext(argument)[1]
    return not os.path.exists(argument) and "/" not in argument and os.sep not in argument and not extension


def _read_folder(folder: str) -> dict[str, str]:
    """The shaders of a folder and its subfolders, not hidden ones. Raises SssgenError for a binary file."""
    problems: list[Diagnostic] = []
    files: dict[str, str] = {}
    for path in _walk(folder):
        shown = posix(path)
        extension = os.path.splitext(path)[1]
        # a Python file is a shader only if it has a reflection
        try:
            if (extension != ".py" and (extension in LANGUAGES_OF or outputs(shown))) or _origins(shown):
                files[shown] = _read_file(path, shown)
        except SssgenError as error:
            problems += error.diagnostics
    if problems:
        raise SssgenError(problems)
    return files


def _walk(folder: str) -> Iterator[str]:
    def refuse(error: OSError) -> None:
        raise failure(f"cannot read the folder: {error.strerror}", file=posix(error.filename or folder))

    for parent, folders, names in os.walk(folder, onerror=refuse):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name != "node_modules")
        yield from (os.path.join(parent, name) for name in sorted(names) if not name.startswith("."))


def _read_file(path: str, shown: str) -> str:
    text = read_text(path, shown)
    if not text.strip():
        raise failure("the file is empty", "emit it again, or leave it out", shown)
    return text


def _emitted_for(path: str, text: str) -> str:
    """The target that wrote a file, or ''. A name alone does not always decide: any program may write `my.hlsl`."""
    for target, _, output in outputs(path):
        named = f".{target.name}." in output.name
        if named or _origins(path) or all(entry in text for entry in output.stages.values()):
            return target.name
    return ""


def _language(path: str, text: str, named: bool, targets: Sequence[str]) -> str:
    if named and len(targets) == 1:
        return targets[0]
    return language_of(os.path.splitext(path)[1], text, targets)


def _origins(path: str) -> dict[str, str]:
    """The source map of an emitted file, from the reflection next to it; empty where there is none."""
    own = find_transpiled(path)
    if own is not None:
        return own.origins
    folder, base = os.path.split(path)
    names = [
        f"{material}.{target.name}.{form}{REFLECTION}"
        for target, material, _ in outputs(path)
        for form in ("", "functions.")
    ]
    for name in dict.fromkeys(names):
        if os.path.isfile(reflection := os.path.join(folder, name)):
            maps = _reflection(reflection)["source_map"]
            if base in maps:
                return maps[base]
    return {}


class TranspiledFile(NamedTuple):
    """What the reflection next to a file states that `sssgen transpile` wrote under any name."""

    target: str
    stages: dict[str, str]
    """Stage → its entry point."""
    origins: dict[str, str]
    reflection: Reflection

    def sources(self, text: str, name: str) -> list[Source]:
        """The file's sources."""
        return [
            Source(text, self.target, cast(Stage, stage), entry or "main", name) for stage, entry in self.stages.items()
        ]


def find_transpiled(path: str) -> TranspiledFile | None:
    """The reflection `FILE.reflection.json`; None where there is none."""
    name = f"{path}.{REFLECTION}"
    if not os.path.isfile(name):
        return None
    reflection = _reflection(name)
    try:
        base = os.path.basename(path)
        (file,) = [file for file in reflection["files"] if file["name"] == base] or reflection["files"]
        stages = {str(stage): str(entry) for stage, entry in file["stages"].items()}
        origins = reflection["source_map"][file["name"]]
        if reflection["target"] in registry.names() and stages.keys() <= STAGES:
            return TranspiledFile(reflection["target"], stages, origins, reflection)
    except (ValueError, KeyError, TypeError, AttributeError):
        pass
    raise _no_reflection(name)


def _reflection(path: str) -> Reflection:
    """A reflection file, with a source map of texts."""
    try:
        reflection: Reflection = json.loads(read_text(path, posix(path)))
        maps = reflection["source_map"]
        shown = {str(file): {str(line): str(span) for line, span in lines.items()} for file, lines in maps.items()}
        return {**reflection, "source_map": shown}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise _no_reflection(path) from None


def _no_reflection(path: str) -> SssgenError:
    return failure("this is not a reflection file of sssgen", "emit it again, or remove it", posix(path))
