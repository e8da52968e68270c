"""Reads a target's descriptor file into the records of descriptor.py; a key that no record has is an error."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

from sssgen.ir.surface_fields import NAMES, OPTIONAL
from sssgen.ir.types import BY_NAME
from sssgen.lang.check.quantities import SCALARS
from sssgen.support.diagnostics import SssgenError, did_you_mean
from sssgen.support.paths import stem
from sssgen.targets.chain_inputs import CHAIN_INPUTS, SHELL_INPUTS
from sssgen.targets.descriptor import FACTS, STAGE_BUILTINS, Embedded, OutputFile, Port, Target
from sssgen.targets.descriptor_table import error_at, table_of
from sssgen.targets.frame import Parts, Variant

_Record = TypeVar("_Record", bound=NamedTuple)

_FRAME = ("frame", "surface", "absent", "variants")
_NESTED = ("files", "ports", "embedded", *_FRAME)
"""The sections of sections; `_FRAME` are those of a frame."""
_REQUIRED = ("title", "language", "types", "files")
_KEYS: dict[str, Collection[str]] = {
    "": ("extends", "words", *Target._fields[:-1]),
    "types": (*BY_NAME, "sampler", "samplerShadow"),
    "inputs": {**CHAIN_INPUTS, **SHELL_INPUTS},
    "light_inputs": CHAIN_INPUTS,
    "ports": (*CHAIN_INPUTS, "Front", "side"),
    "lacks": OPTIONAL,
    "variants": FACTS,
    "stage_builtins": STAGE_BUILTINS,
}
"""The keys of the sections that have no record type."""


def read(path: str | os.PathLike[str]) -> Target:
    """Reads a descriptor file. Raises SssgenError where it is faulty."""
    path = os.fspath(path)
    return target_of(table_of(path), path)


def target_of(table: Mapping[str, Any], path: str) -> Target:
    """The target that the contents of the descriptor at `path` describe. Raises SssgenError where they are faulty."""
    return _Reader(path).target(table)._replace(folder=os.path.dirname(path))


class _Reader:
    """Makes records of tables. Raises SssgenError for an unknown key and for a value of the wrong type."""

    def __init__(self, path: str) -> None:
        self.path = path

    def target(self, table: Mapping[str, Any]) -> Target:
        self.check_keys(table, _KEYS[""], "")
        missing = [key for key in _REQUIRED if key not in table]
        if missing:
            raise self.wrong(f"is incomplete: it has no {' and no '.join(missing)}", "", ())
        simple = {key: value for key, value in table.items() if key not in _NESTED}
        target = self.record(Target(name=stem(self.path), dialect=table["language"]), simple, "")
        files = {
            form: tuple([self.record(OutputFile(), entry, f"files.{form}") for entry in self.is_a(list, entries, form)])
            for form, entries in self.is_a(dict, table["files"], "files").items()
        }
        embedded = {
            name: self.with_frames(Embedded(), entry, f"embedded.{name}")
            for name, entry in self.is_a(dict, table.get("embedded", {}), "embedded").items()
        }
        self.check_keys(ports := self.is_a(dict, table.get("ports", {}), "ports"), _KEYS["ports"], "ports")
        target = target._replace(
            types=_present(target.types),
            inputs=_present(target.inputs),
            light_inputs=_present(target.light_inputs),
            files=files,
            **self.frames(table, ""),
            ports={name: self.record(Port(), port, f"ports.{name}") for name, port in ports.items()},
        )
        return target._replace(embedded={name: _completed(inner, target) for name, inner in embedded.items()})

    def parts(self, table: object, section: str, names: Collection[str] = ()) -> Parts:
        """Parts of a frame: place → name → text; only these `names`, where any are given."""
        parts: dict[str, dict[str, str]] = {}
        for places, texts in self.is_a(dict, table, section).items():
            self.is_a(dict, texts, places, section)
            if names:
                self.check_keys(texts, names, f"{section}.{places}")
            for name, text in texts.items():
                self.is_a(str, text, name, f"{section}.{places}")
            for place in places.split():
                parts.setdefault(place, {}).update(texts)
        return parts

    def frames(self, table: Mapping[str, Any], section: str) -> dict[str, Any]:
        """The sections of a frame that a table has."""
        names = {"frame": (), "surface": (*NAMES, *SCALARS), "absent": NAMES}
        found: dict[str, Any] = {
            key: self.parts(table[key], section + key, names[key]) for key in names if key in table
        }
        if "variants" in table:
            variants = self.is_a(dict, table["variants"], f"{section}variants")
            self.check_keys(variants, FACTS, f"{section}variants")
            found["variants"] = {
                fact: self.with_frames(Variant(), entry, f"{section}variants.{fact}")
                for fact, entry in variants.items()
            }
        return found

    def with_frames(self, defaults: _Record, table: object, section: str) -> _Record:
        """A record with the values of a table, the sections of a frame among them."""
        entry = self.is_a(dict, table, section)
        simple = {key: value for key, value in entry.items() if key not in _FRAME}
        return self.record(defaults, simple, section)._replace(**self.frames(entry, f"{section}."))

    def record(self, defaults: _Record, table: object, section: str) -> _Record:
        """The record with the values of a table."""
        values = self.is_a(dict, table, section)
        self.check_keys(values, _KEYS.get(section, defaults._fields), section)
        own = defaults._asdict()
        return defaults._replace(**{key: self.value(own[key], value, key, section) for key, value in values.items()})

    def value(self, default: Any, value: Any, key: str, section: str) -> Any:
        """A value of the default's type."""
        if hasattr(default, "_fields"):
            return self.record(default, value, key)
        if isinstance(default, frozenset):
            return frozenset(value.split() if isinstance(value, str) else self.is_a(list, value, key, section))
        if isinstance(default, tuple):
            return tuple(self.is_a(list, value, key, section))
        if key in _KEYS:
            self.check_keys(self.is_a(dict, value, key, section), _KEYS[key], key)
            for name, text in value.items():
                self.is_a(str, text, name, key)
        return self.is_a(dict if isinstance(default, Mapping) else type(default), value, key, section)

    def is_a(self, kind: type, value: Any, key: str, section: str = "") -> Any:
        """The value, if it is of that kind."""
        if type(value) is not kind:
            where = f" in [{section}]" if section else ""
            raise self.wrong(f"needs {_KINDS[kind]} for '{key}'{where}", "", (*_parts(section), key))
        return value

    def check_keys(self, table: Mapping[str, Any], keys: Collection[str], section: str) -> None:
        for key in table:
            if key not in keys:
                where = f" in [{section}]" if section else ""
                hint = did_you_mean(key, keys) or _listed(keys)
                raise self.wrong(f"has an unknown key '{key}'{where}", hint, (*_parts(section), key))

    def wrong(self, message: str, hint: str, keys: Sequence[str]) -> SssgenError:
        return error_at(self.path, keys, f"the target descriptor {message}", hint)


_KINDS = {bool: "true or false", int: "an integer", str: "a text", list: "a list", dict: "a table"}


def _parts(section: str) -> list[str]:
    return section.split(".") if section else []


def _present(texts: Mapping[str, str]) -> Mapping[str, str]:
    """The texts without those that an empty text takes away from the base."""
    return {name: text for name, text in texts.items() if text}


def _completed(inner: Embedded, outer: Target) -> Embedded:
    """An embedded language with the inputs that it has in common with the target, and the frame if it is the same."""
    own = Variant(inner.inputs, inner.light_inputs, inner.frame, inner.surface, inner.absent, inner.reads)
    common = Variant(outer.inputs, outer.light_inputs)
    variants = inner.variants
    if inner.same_shell:
        common = Variant(outer.inputs, outer.light_inputs, outer.frame, outer.surface, outer.absent, outer.reads)
        variants = {
            fact: outer.variants.get(fact, Variant()).with_variant(inner.variants.get(fact, Variant()))
            for fact in {**outer.variants, **inner.variants}
        }
    return inner._replace(**common.with_variant(own)._asdict(), variants=variants)


def _listed(keys: Collection[str]) -> str:
    return f"the keys there are: {', '.join(keys)}"
