"""The technique library: finding technique files, loading them, and reading their documentation."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Iterator
from typing import NamedTuple

from sssgen.ir.nodes import Function, Module, Uniform
from sssgen.lang.loader import load_file
from sssgen.lang.source_lines import line_before, source_line
from sssgen.material import attributes
from sssgen.material.attributes import Attributes
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.file_memo import CachedResult, remember
from sssgen.support.paths import TECHNIQUES as TECHNIQUES
from sssgen.support.paths import source_name, stem
from sssgen.support.text_files import refuse_folder

ROLES = (
    "geometry",
    "coordinates",
    "thickness",
    "conversion",
    "surface",
    "translucency",
    "lighting",
    "shadow",
    "environment",
    "tone_mapping",
    "output",
    "distance",
)
"""The roles of a material's chain, in the order they run; `distance` functions are bound to slots."""

OF_SHELLS = ("shadow", "environment", "tone_mapping")
"""The roles that add to a shell without an engine what an engine has of its own."""


class Technique(NamedTuple):
    """One technique: the last function of its file, which has the file's name."""

    name: str
    role: str
    path: str
    module: Module
    function: Function
    doc: dict[str, str]
    """The doc comment's sections: `summary` and its `key: text` entries."""
    attributes: Attributes
    """The values of the sections that are more than text."""

    @property
    def surroundings(self) -> Function | None:
        """The function NAME_surroundings of a translucency technique, for the light from everywhere that comes through;
        of an environment technique, for the light from everywhere on a white matte surface.
        """
        name = f"{self.name}_surroundings" if self.role in ("translucency", "environment") else ""
        return next((function for function in self.module.functions if function.name == name), None)

    @property
    def baseline(self) -> bool:
        """Whether this is a formula as its source published it."""
        return self.attributes.baseline

    @property
    def slots(self) -> tuple[Function, ...]:
        """The functions that a material has to bind."""
        return tuple(function for function in self.module.functions if function.body is None)

    @property
    def uniforms(self) -> tuple[Uniform, ...]:
        """The parameters and textures of the technique."""
        return self.module.uniforms


@functools.cache
def index() -> dict[str, str]:
    """Every technique of the library by name."""
    paths = {}
    for folder in sorted(os.listdir(TECHNIQUES)):
        if folder != "common":
            for name in sorted(os.listdir(os.path.join(TECHNIQUES, folder))):
                if name.endswith(".sss"):
                    paths[name.removesuffix(".sss")] = os.path.join(TECHNIQUES, folder, name)
    return paths


def folder_of(path: str) -> str:
    """The name of a technique's folder: its role, unless it declares another."""
    return os.path.basename(os.path.dirname(path))


def file_meant(name: str, folder: str = "") -> str:
    """The hint for a name that the library does not have, but a file of the folder; '' where it has no such file."""
    files = [file for file in (f"{name}.sss", f"{name}.glsl") if os.path.isfile(os.path.join(folder, file))]
    return f"did you mean the file '{files[0]}'?" if files else ""


def load(name: str) -> Technique:
    """A technique of the library by name, or of a file by path (`my/lobe.sss`).

    Raises SssgenError for an unknown name or a faulty file.
    """
    if name.endswith((".sss", ".glsl")):
        return load_path(name)
    path = index().get(name)
    if path is None:
        refuse_folder(name, (".sss", ".glsl"))
        hint = file_meant(name) or did_you_mean(name, index()) or "see: sssgen list techniques"
        raise failure(f"unknown technique '{name}'", hint)
    return load_path(path)


_techniques: dict[str, CachedResult] = {}


def load_path(path: str) -> Technique:
    """The technique that a file holds; the file is read again only if it, or what it includes, has changed."""
    return remember(_techniques, os.path.abspath(path), lambda: _read_technique(path))


def _read_technique(path: str) -> Technique:
    shown, name = source_name(path), stem(path)
    module = load_file(path, (TECHNIQUES,))
    function = next((f for f in reversed(module.functions) if f.name == name and f.body is not None), None)
    if function is None:
        raise failure(f"the file has no function '{name}'", "a technique has the name of its file", shown)
    try:
        doc = attributes.sections(function.doc, shown)
        role = doc.get("role", folder_of(path))
        if "role" not in doc and role not in ROLES:
            hint = "write, for example, `role: translucency` in the doc comment directly before the function"
            raise failure(f"the technique '{name}' has no role", hint, shown)
        if role not in ROLES:
            raise failure(f"unknown role '{role}'", did_you_mean(role, ROLES) or f"roles: {', '.join(ROLES)}", shown)
        declared = attributes.read_attributes(doc, shown)
        _check_attributes(declared, module, function, shown)
    except SssgenError as error:
        raise _with_places(error, function) from None
    return Technique(name, role, path, module, function, doc, declared)


def _with_places(error: SssgenError, function: Function) -> SssgenError:
    """Errors of a doc comment with their places: the attribute's line, or the function where no line names it."""
    placed = []
    for diagnostic in error.diagnostics:
        words = [re.escape(word) for word in re.findall(r"[a-z_]\w*", diagnostic.message)]
        span = line_before(function.span, rf"^[\s/*]*(?:{'|'.join(words)})\s*:") or function.span
        placed.append(diagnostic._replace(span=span, source_line=source_line(span)))
    return SssgenError(placed)


def _check_attributes(declared: Attributes, module: Module, function: Function, shown: str) -> None:
    """Raises SssgenError if attributes do not agree with the library, the uniforms or the function."""
    for name in declared.superseded_by:
        if name not in index():
            raise failure(f"unknown technique '{name}' in superseded_by", did_you_mean(name, index()), shown)
    if declared.suggested:
        source, target = declared.suggested
        if [param.quantity for param in function.params] != [source] or function.quantity != target:
            raise failure(f"'{function.name}' does not convert {source} to {target}", "", shown)
    for value, uniform in declared.sets.items():
        written = [param.name for param in function.params if param.direction != "in"]
        if value not in written:
            raise failure(f"'{function.name}' does not write '{value}'", did_you_mean(value, written), shown)
        names = [declared_uniform.name for declared_uniform in module.uniforms]
        if uniform not in names:
            raise failure(f"the file has no uniform '{uniform}'", did_you_mean(uniform, names), shown)


def setter(value: str) -> tuple[str, str]:
    """The technique that sets a value of the surface to a uniform, and the uniform, by the attribute `sets`."""
    return next(
        (technique.name, technique.attributes.sets[value])
        for technique in load_all()
        if value in technique.attributes.sets
    )


def load_all() -> Iterator[Technique]:
    """Every technique of the library. Raises SssgenError with the errors of all faulty files."""
    errors = []
    for path in index().values():
        try:
            yield load_path(path)
        except SssgenError as error:
            errors += error.diagnostics
    if errors:
        raise SssgenError(errors)
