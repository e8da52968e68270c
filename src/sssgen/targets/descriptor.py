"""Target descriptors: what is known of a language or engine beside its printer, read from `targets/*.toml`.

A plug-in brings a target through the entry-point group `sssgen.targets`: an entry named like the target that gives a
`Target`, or the path of a descriptor file with its templates beside it.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import sys
from typing import Any, NamedTuple, TypeVar

from sssgen.passes.capabilities import Capabilities
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.paths import place, stem

_Record = TypeVar("_Record", bound=NamedTuple)


class OutputFile(NamedTuple):
    """One file that a target writes: its name with `{material}`, its template, and its stages' entry points."""

    name: str
    template: str
    stages: dict[str, str]


class Target(NamedTuple):
    """One target. The fields are keys of the descriptor file; all of it is in `table`, for templates and printers."""

    name: str
    title: str
    language: str
    """Which printer prints it: glsl, hlsl, wgsl or python, or `module:Class` of a plug-in."""
    dialect: str
    """The intrinsic table's language: glsl, hlsl, hlsl-dx9, hlsl-macros, wgsl."""
    types: dict[str, str]
    """Type as our language spells it → as the target does."""
    files: dict[str, list[OutputFile]]
    """Form (shader, functions) → the files it writes."""
    inputs: dict[str, str]
    """Chain input → the shell's expression for it."""
    light_inputs: dict[str, str]
    """The same, where it differs inside the loop over the lights."""
    reserved: frozenset[str]
    folded: frozenset[str]
    """Reserved in any case, as some of HLSL's words are; lower case here."""
    prefixes: tuple[str, ...]
    """Names that begin so are reserved."""
    capabilities: Capabilities
    """What the language can express; the passes rewrite the rest."""
    lighting: str
    """The technique that lights a lit material where the target brings no lighting."""
    output: str
    """The technique that encodes the final colour for a display; '' where the engine or framebuffer does that."""
    uniform_style: str
    """plain keeps `distortion`; unity makes `_Distortion`."""
    layout: str
    """The rule for offsets in a uniform block: std140, hlsl, or '' where there is none."""
    parameters: tuple[str, ...]
    """The forms in which uniforms are passed to every function instead of being read as globals."""
    textures: dict[str, str]
    """How a texture is declared, passed and named: declaration, parameter, argument, sampler."""
    table: dict[str, Any]
    folder: str
    """Where the descriptor lies; a plug-in keeps its `templates` there."""


@functools.cache
def names() -> tuple[str, ...]:
    """The names of all targets, the project's own first."""
    own = tuple(sorted(stem(name) for name in os.listdir(place("targets")) if name.endswith(".toml")))
    return own + tuple(sorted(name for name in _plugins() if name not in own))


@functools.cache
def _plugins() -> dict[str, Any]:
    """The plug-ins' entry points. `importlib.metadata` takes longer to import than a shader to emit, so it is asked
    only where some installed package mentions our group."""
    if not any(_mentions_targets(root or ".") for root in sys.path):
        return {}
    from importlib.metadata import entry_points

    return {entry.name: entry for entry in entry_points(group="sssgen.targets")}


def has_plugins() -> bool:
    """Whether other packages bring targets."""
    return bool(_plugins())


def _mentions_targets(root: str) -> bool:
    """Whether a package installed in this folder has an entry point of our group."""
    try:
        infos = [entry.path for entry in os.scandir(root) if entry.name.endswith("-info")]
    except OSError:
        return False
    for info in infos:
        with contextlib.suppress(OSError), open(f"{info}/entry_points.txt", "rb") as file:
            if b"[sssgen.targets]" in file.read():
                return True
    return False


@functools.cache
def load(name: str) -> Target:
    """A target by name. Raises SssgenError for an unknown one."""
    path = os.path.join(place("targets"), f"{name}.toml")
    table = _tables().get(name)
    if table is not None:
        return _target(table, path)
    if os.path.isfile(path):
        return read(path)
    if name in _plugins():
        return _from_plugin(name)
    if name in _INTERNAL:
        found: Target = importlib.import_module(_INTERNAL[name], __package__).target()
        return found
    raise failure(f"unknown target '{name}'", did_you_mean(name, names()) or f"targets: {', '.join(names())}")


_INTERNAL = {"wgsl-f16": ".wgsl_half", "numpy-f16": ".numpy_half"}
"""Targets that the harness runs and that no list of targets has: the module whose `target()` gives each."""


def _from_plugin(name: str) -> Target:
    """The target that an entry point gives. Raises SssgenError for whatever goes wrong in the plug-in."""
    entry = _plugins()[name]
    try:
        made = entry.load()
        made = made() if callable(made) else made
        target = made if isinstance(made, Target) else read(made)
    except SssgenError:
        raise
    except Exception as error:  # the plug-in's code: anything may be wrong in it
        message = f"the plug-in of target '{name}' cannot be loaded: {type(error).__name__}: {error}"
        raise failure(message, f"its entry point is {entry.value}") from None
    if target.name != name:
        message = f"the plug-in of target '{name}' gives a target called '{target.name}'"
        raise failure(message, "give the entry point and the descriptor the same name")
    return target


@functools.cache
def _tables() -> dict[str, dict[str, Any]]:
    """The contents of the project's own descriptors that have no fault."""
    tables: dict[str, dict[str, Any]] = cache.kept("targets", cache.stamp(place("targets")), _read_tables)
    return tables


def _read_tables() -> dict[str, dict[str, Any]]:
    tables = {}
    for name in os.listdir(place("targets")):
        with contextlib.suppress(SssgenError):
            tables[stem(name)] = _table(os.path.join(place("targets"), name))
    return tables


def read(path: str | os.PathLike[str]) -> Target:
    """Reads a descriptor file. Raises SssgenError where it is faulty."""
    path = os.fspath(path)
    return _target(_table(path), path)


def _table(path: str) -> dict[str, Any]:
    import tomllib

    try:
        with open(path, encoding="utf-8") as file:
            return tomllib.loads(file.read())
    except (OSError, ValueError) as error:
        raise failure(f"cannot read the target descriptor: {error}", file=os.path.basename(path)) from None


def _target(table: dict[str, Any], path: str) -> Target:
    names = table.get("names", {})
    try:
        return Target(
            name=table.get("name", stem(path)),
            title=table["title"],
            language=table["language"],
            dialect=table.get("dialect", table["language"]),
            types=table["types"],
            files={form: [OutputFile(**entry) for entry in entries] for form, entries in table["files"].items()},
            inputs=table.get("inputs", {}),
            light_inputs=table.get("light_inputs", {}),
            reserved=frozenset((names.get("reserved", "") + " " + names.get("shell", "")).split()),
            folded=frozenset(word.lower() for word in names.get("case_insensitive", ())),
            prefixes=tuple(names.get("prefixes", ())),
            capabilities=_record(Capabilities(), table.get("capabilities", {}), "capabilities", path),
            lighting=table.get("lighting", ""),
            output=table.get("output", ""),
            uniform_style=table.get("uniform_style", "plain"),
            layout=table.get("layout", ""),
            parameters=tuple(table.get("parameters", ("functions",))),
            textures=table.get("textures", {}),
            table=table,
            folder=os.path.dirname(path),
        )
    except (KeyError, TypeError, AttributeError) as error:
        raise failure(f"the target descriptor is incomplete: {error}", file=os.path.basename(path)) from None


def _record(empty: _Record, table: dict[str, Any], section: str, path: str) -> _Record:
    """A section of a descriptor as a record. Raises SssgenError for an unknown key or a value of the wrong type."""
    defaults = empty._asdict()
    file = os.path.basename(path)
    for key, value in table.items():
        if key not in defaults:
            hint = did_you_mean(key, defaults) or f"its keys: {', '.join(defaults)}"
            raise failure(f"the target descriptor has an unknown key '{key}' in [{section}]", hint, file)
        if not isinstance(value, type(defaults[key])):
            wanted = type(defaults[key]).__name__
            raise failure(f"the target descriptor needs a {wanted} for '{key}' in [{section}]", "", file)
    return empty._replace(**table)


class Words:
    """The names that are not free: words, words in any case, and whatever begins with certain letters."""

    def __init__(self, words: frozenset[str], prefixes: tuple[str, ...]) -> None:
        self.words, self.prefixes = words, prefixes

    def __contains__(self, name: object) -> bool:
        return name in self.words or (isinstance(name, str) and name.startswith(self.prefixes))


@functools.cache
def reserved_everywhere() -> tuple[frozenset[str], frozenset[str], tuple[str, ...]]:
    """What the project's own targets reserve: words, words in any case, prefixes. Names keep clear of all of it."""
    return _reserved([target for target in _own() if target.language != "python"])


@functools.cache
def reserved_of(language: str) -> tuple[frozenset[str], frozenset[str], tuple[str, ...]]:
    """What a language reserves by itself, without engines: the first of the project's own targets says it."""
    own = [target for target in _own() if target.language == language]
    return _reserved(own[:1])


def _own() -> list[Target]:
    """The project's own targets, in the order of their names."""
    return [load(name) for name in names() if os.path.isfile(os.path.join(place("targets"), f"{name}.toml"))]


def _reserved(shaders: list[Target]) -> tuple[frozenset[str], frozenset[str], tuple[str, ...]]:
    exact = frozenset().union(*(target.reserved for target in shaders))
    folded = frozenset().union(*(target.folded for target in shaders))
    return exact, folded, tuple(sorted({prefix for target in shaders for prefix in target.prefixes}))
