"""What `sssgen lint` assumes of the inputs of plain GLSL: presets, files of the user, comments in the source.

A preset is a TOML file in `presets/`, or one with the same keys elsewhere. Each `[[assume]]` has `names`, patterns in
which `*` stands for any letters (a field of a struct is `lights.color`), where they may be declared (`storage`:
uniform, varying, attribute, parameter, texture), their `types`, and what holds: `range`, `length`, `unit`, `nonzero`,
`orthonormal` or `finite`. `because` says what guarantees it.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from sssgen.ir.contracts import Assumption
from sssgen.ir.intervals import INF
from sssgen.ir.nodes import Module
from sssgen.ir.spans import NOWHERE, Span
from sssgen.ir.types import Matrix, Sampler, Struct, Type, Vector, spell
from sssgen.lang.assumption_comments import UNIT, AssumedInput, assumption_of
from sssgen.passes.ranges.scalar_parts import innermost
from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean, failure
from sssgen.support.text_files import read_text
from sssgen.support.toml_source import Document, parse

FOLDER = Path(__file__).parent / "presets"
STORAGES = ("uniform", "varying", "attribute", "parameter", "texture")
DIFFERENCE = "difference"
"""The storage of a rule about `A - B`, a uniform minus an input."""
_FLAGS = ("unit", "nonzero", "orthonormal", "finite")
_KEYS = ("names", "storage", "types", "range", "length", *_FLAGS, "because")


class Rule(NamedTuple):
    """What is assumed of the inputs that it matches."""

    source: str
    """The preset's name, the file's path, or `comment`."""
    names: tuple[str, ...]
    storages: tuple[str, ...]
    types: tuple[str, ...]
    """The types as GLSL spells them; none means all."""
    assumption: Assumption
    because: str
    span: Span = NOWHERE
    """The place of the names; NOWHERE in a preset."""

    def matches(self, storage: str, name: str, type_: Type) -> bool:
        """Whether it is about an input."""
        return (
            storage in self.storages
            and (not self.types or spell(type_) in self.types)
            and any(fnmatchcase(name, pattern) for pattern in self.names)
        )

    def warning(self, names: Collection[str], read: Collection[str]) -> Diagnostic | None:
        """The warning where it matches none of the inputs with these names, of which the program reads some."""
        matching = [name for name in {*names, *read} if any(fnmatchcase(name, pattern) for pattern in self.names)]
        other = sorted(set(matching) & set(read))
        if other:
            message = f"the input '{other[0]}' has another storage or type than this rule is about"
            return Diagnostic("warning", message, self.span, "change storage or types of the rule")
        if matching:
            return None
        if self.storages == (DIFFERENCE,):
            message = f"this rule matches no difference: there is no '{self.names[0]}'"
            hint = "a difference is that of a uniform and an input, without fields and elements of arrays"
            return Diagnostic("warning", message, self.span, f"{hint}; for these write a comment at the statement")
        hint = did_you_mean(self.names[0].strip("*"), names)
        message = f"this rule matches no input: there is no '{self.names[0]}'"
        return Diagnostic(
            "warning", message, self.span, hint or "name a uniform, an input, a parameter or a field of one"
        )


class AssumedFact(NamedTuple):
    """An assumption that was used: what of which input, and from where."""

    name: str
    text: str
    source: str
    because: str

    def as_json(self) -> dict[str, str]:
        """For tools."""
        return self._asdict()


class Assumptions:
    """The rules for one program; it remembers those that it applied."""

    def __init__(self, rules: Iterable[Rule], is_vertex: bool) -> None:
        self.rules = list(rules)
        self.is_vertex = is_vertex
        self.applied: dict[tuple[str, str], AssumedFact] = {}
        self.inputs: dict[tuple[str, str], Type] = {}
        """The inputs that it was asked about: storage and name → type."""
        self.matched: set[Rule] = set()

    def of(self, storage: str, name: str, type_: Type) -> Assumption | None:
        """What is assumed of an input; None for nothing. Of several rules, all hold."""
        if isinstance(type_, Sampler):
            storage = "texture"
        elif storage == "input":
            storage = "attribute" if self.is_vertex else "varying"
        self.inputs[storage, name] = type_
        matching = [rule for rule in self.rules if rule.matches(storage, name, type_)]
        if not matching:
            return None
        self.matched.update(matching)
        for rule in matching:
            fact = AssumedFact(name, _value_text(rule.assumption, type_), rule.source, rule.because)
            self.applied[name, rule.source] = fact
        return Assumption(
            max(rule.assumption.low for rule in matching),
            min(rule.assumption.high for rule in matching),
            max(rule.assumption.shortest for rule in matching),
            min(rule.assumption.longest for rule in matching),
            any(rule.assumption.finite for rule in matching),
        )

    def warnings(self, names: Collection[str]) -> list[Diagnostic]:
        """A warning for each rule of a file, and for each preset, that matches none of the inputs."""
        result = []
        chosen = {rule.source for rule in self.rules}
        for source in sorted(chosen & set(presets()) - {rule.source for rule in self.matched}):
            others = [other for other in presets() if other not in chosen and self._matches(other)]
            hint = (
                f"presets that match: {', '.join(others)}"
                if others
                else "write a .toml file with the names of your engine"
            )
            result.append(Diagnostic("warning", f"the preset '{source}' matches no input of this shader", hint=hint))
        read = {name for _, name in self.inputs}
        files = [rule.warning(names, read) for rule in self.rules if rule.span.file and rule not in self.matched]
        return [*result, *(warning for warning in files if warning is not None)]

    def _matches(self, preset: str) -> bool:
        """Whether a preset is about one of the inputs."""
        rules = load_rules([preset])
        return any(rule.matches(*key, type_) for key, type_ in self.inputs.items() for rule in rules)


def presets() -> list[str]:
    """The names of the presets."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def load_rules(names: Sequence[str]) -> list[Rule]:
    """The rules of presets, by their names, and of TOML files. Raises SssgenError."""
    rules: list[Rule] = []
    for name in dict.fromkeys(names):
        if name in presets():
            rules += _rules(read_text(FOLDER / f"{name}.toml", f"{name}.toml"), f"{name}.toml", name)
        elif name.endswith(".toml") or os.path.isfile(name):
            rules += _rules(read_text(name, name), name, name)
        else:
            hint = did_you_mean(name, presets()) or f"presets: {', '.join(presets())}; or a .toml file"
            raise failure(f"there is no preset '{name}'", hint)
    return rules


def input_names(module: Module) -> frozenset[str]:
    """The names of the inputs of a module; of structs, those of their fields, of textures, those of channels."""
    names: set[str] = set()
    params = [(param.name, param.type) for function in module.functions for param in function.params]
    inputs = [(variable.name, variable.type) for variable in module.variables if variable.storage == "in"]
    pending = [*params, *inputs, *((uniform.name, uniform.type) for uniform in module.uniforms)]
    while pending:
        name, type_ = pending.pop()
        names.add(name)
        inner = innermost(type_)
        if isinstance(inner, Sampler):
            names.update([f"{name}.{channel}" for channel in "rgba"])
        elif isinstance(inner, Struct):
            pending += [(f"{name}.{field.name}", field.type) for field in inner.fields]
    return frozenset(names)


def rules_of_comments(assumed: Sequence[AssumedInput], names: Collection[str]) -> list[Rule]:
    """The rules of the comments beside inputs. Raises SssgenError for a name that is no input."""
    wrong = [
        Diagnostic(
            "error",
            f"there is no input '{row.name}'",
            row.span,
            did_you_mean(row.name, names) or "name a uniform, an input or a field of one",
        )
        for row in assumed
        if row.name not in names
    ]
    if wrong:
        raise SssgenError(wrong)
    return [Rule("comment", (row.name,), STORAGES, (), row.assumption, "") for row in assumed]


def _rules(text: str, file: str, source: str) -> list[Rule]:
    document = parse(text, file)
    for key in document.data:
        if key not in ("doc", "assume"):
            document.error(document.place(key).key, f"unknown key '{key}'", "keys: doc, and [[assume]] for each rule")
    tables = document.data.get("assume", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        document.error(document.place("assume").key, "'assume' must be written [[assume]]")
        tables = []
    rules = [_rule(document, table, index, source) for index, table in enumerate(tables)]
    document.reporter.check()
    return rules


def _rule(document: Document, table: dict[str, Any], index: int, source: str) -> Rule:
    def wrong(key: str, message: str, hint: str = "") -> None:
        document.error(document.place("assume", index, key).value, message, hint)

    def words(key: str) -> tuple[str, ...]:
        value = table.get(key, [])
        value = [value] if isinstance(value, str) else value
        if not isinstance(value, list) or not all(isinstance(word, str) for word in value):
            wrong(key, f"'{key}' must be a list of texts")
            return ()
        return tuple(value)

    def interval(key: str, lowest: float) -> tuple[float, float]:
        value = table.get(key, [lowest, INF])
        numbers = isinstance(value, list) and len(value) == 2 and all(type(end) in (int, float) for end in value)
        if not numbers or not lowest <= value[0] <= value[1]:
            wrong(key, f"'{key}' must be two numbers, the lower one first", f"write {key} = [0.0, 1.0]")
            return lowest, INF
        return float(value[0]), float(value[1])

    for key in table.keys() - set(_KEYS):
        wrong(key, f"unknown key '{key}'", did_you_mean(key, _KEYS) or f"keys: {', '.join(_KEYS)}")
    for word in words("storage"):
        if word not in (*STORAGES, DIFFERENCE):
            wrong("storage", f"unknown storage '{word}'", f"storages: {', '.join((*STORAGES, DIFFERENCE))}")
    if not words("names"):
        wrong("names", "this rule has no names", 'write names = ["roughness"]')
    (low, high), (shortest, longest) = interval("range", -INF), interval("length", 0.0)
    finite = False
    for flag in _FLAGS:
        value = table.get(flag, False)
        if not isinstance(value, bool):
            wrong(flag, f"'{flag}' must be true or false")
        elif value:
            own = assumption_of(flag)
            shortest, longest, finite = max(shortest, own.shortest), min(longest, own.longest), finite or own.finite
    if not table.keys() & {"range", "length", *_FLAGS}:
        wrong("names", "this rule assumes nothing", f"add one of: range, length, {', '.join(_FLAGS)}")
    because = table.get("because", "")
    return Rule(
        source, words("names"), words("storage") or STORAGES, words("types"),
        Assumption(low, high, shortest, longest, finite), because if isinstance(because, str) else "",
        NOWHERE if source in presets() else document.place("assume", index, "names").value,
    )  # fmt: skip


def _value_text(assumption: Assumption, type_: Type) -> str:
    """An assumption in words."""
    low, high, shortest, longest, finite = assumption
    texts = []
    if low > -INF and high < INF:
        texts.append(f"in {low:g}..{high:g}")
    elif low > -INF:
        texts.append(f">= {low:g}")
    elif high < INF:
        texts.append(f"<= {high:g}")
    if isinstance(type_, Matrix) and (shortest, longest) != (0.0, INF):
        texts.append("orthonormal" if (shortest, longest) == UNIT else f"lengthens by {shortest:g}..{longest:g}")
    elif (shortest, longest) == UNIT:
        texts.append("of length 1")
    elif (shortest, longest) != (0.0, INF):
        what = "long" if isinstance(type_, Vector) else "in size"
        texts.append(f"at least {shortest:g} {what}" if longest == INF else f"{shortest:g}..{longest:g} {what}")
    return ", ".join([*texts, *(["finite"] if finite else [])])
