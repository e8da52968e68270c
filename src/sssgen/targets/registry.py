"""All targets by their names: the project's own, those of plug-ins, and those that only tests run, in
`targets/half`.

A plug-in brings a target through the entry-point group `sssgen.targets`: an entry with the target's name that gives a
`Target`, or the path of a descriptor file with its templates in the same folder.
"""

from __future__ import annotations

import contextlib
import functools
import os
from typing import Any

from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.paths import place, stem
from sssgen.targets import plugins
from sssgen.targets.descriptor import Names, Target
from sssgen.targets.descriptor_reader import read, target_of
from sssgen.targets.descriptor_table import table_of


@functools.cache
def names() -> tuple[str, ...]:
    """The names of all targets for users, the project's own first; without plug-ins that cannot be read."""
    own = _own_names()
    return own + tuple(sorted(name for name in plugins.entries() if name not in own and name not in faults()))


@functools.cache
def faults() -> dict[str, SssgenError]:
    """Name of a plug-in's target that cannot be read → the reason."""
    errors = {}
    for name in plugins.entries():
        try:
            load(name)
        except SssgenError as error:
            errors[name] = error
    return errors


@functools.cache
def load(name: str) -> Target:
    """A target by name. Raises SssgenError for an unknown one."""
    target = _load(name)
    others = [load(other).names for other in target.names.also]
    if not others:
        return target
    reserved = target.names.reserved.union(*(names.reserved for names in others))
    prefixes = tuple(sorted({*target.names.prefixes, *(prefix for names in others for prefix in names.prefixes)}))
    return target._replace(names=target.names._replace(reserved=reserved, prefixes=prefixes))


def _load(name: str) -> Target:
    folder = place("targets")
    path = os.path.join(folder, f"{name}.toml")
    table = _tables().get(name)
    if table is not None:
        return target_of(table, path)
    if os.path.isfile(path):
        return read(path)
    if name in plugins.entries():
        return _from_plugin(name)
    if os.path.isfile(variant := os.path.join(folder, "half", f"{name}.toml")):
        return read(variant)._replace(folder=folder)
    raise failure(
        f"unknown target '{name}'", found_under(name) or did_you_mean(name, names()) or f"targets: {', '.join(names())}"
    )


def found_under(name: str) -> str:
    """The hint for a name that a descriptor's `also` lists, or ''."""
    listing = [own for own, table in _tables().items() if name in table.get("also", ())]
    return f"its target is '{listing[0]}'" if listing else ""


def has_plugins() -> bool:
    """Whether other packages bring targets."""
    return bool(plugins.entries())


class ReservedNames:
    """The names that are not free: a set, and everything that starts with certain letters."""

    def __init__(self, names: frozenset[str], prefixes: tuple[str, ...]) -> None:
        self.names, self.prefixes = names, prefixes

    def __contains__(self, name: object) -> bool:
        return name in self.names or (isinstance(name, str) and name.startswith(self.prefixes))


@functools.cache
def reserved_everywhere() -> Names:
    """The names that any of the project's own targets reserves. No emitted name is among them."""
    return _reserved_names([load(name) for name in _own_names()])


@functools.cache
def reserved_of(language: str) -> Names:
    """The names reserved by a language: those of its first own target without an engine, by name, if it has one."""
    targets = [target for target in map(load, _own_names()) if target.language == language]
    return _reserved_names([target for target in targets if target.lighting][:1] or targets[:1])


def _reserved_names(targets: list[Target]) -> Names:
    return Names(
        reserved=frozenset().union(*(target.names.exact for target in targets)),
        case_insensitive=frozenset().union(*(target.names.case_insensitive for target in targets)),
        prefixes=tuple(sorted({prefix for target in targets for prefix in target.names.prefixes})),
    )


@functools.cache
def _own_names() -> tuple[str, ...]:
    return tuple(sorted(stem(name) for name in os.listdir(place("targets")) if name.endswith(".toml")))


@functools.cache
def _tables() -> dict[str, dict[str, Any]]:
    """The contents of the project's own descriptors that can be read."""
    tables = {}
    for name in _own_names():
        with contextlib.suppress(SssgenError):
            tables[name] = table_of(os.path.join(place("targets"), f"{name}.toml"))
    return tables


def _from_plugin(name: str) -> Target:
    """The target that an entry point gives. Raises SssgenError for whatever goes wrong in the plug-in."""
    loaded = plugins.load(name)
    target = read(loaded) if isinstance(loaded, str) else loaded
    if not isinstance(target, Target) or target.name != name:
        called = getattr(target, "name", type(target).__name__)
        message = f"the plug-in of target '{name}' gives a target called '{called}'"
        raise failure(message, "give the entry point and the descriptor the same name")
    return target
