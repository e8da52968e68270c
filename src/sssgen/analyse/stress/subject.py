"""The subject of a stress run: a technique of the library or a file, or one stage of a material with its bindings."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Param
from sssgen.material import library
from sssgen.material.material_loading import examples, load_material
from sssgen.material.model import Material
from sssgen.passes.link import LinkInput
from sssgen.run.evaluate.probes import RESULT, Subject, of_stages, subject
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.paths import display_name
from sssgen.support.text_files import refuse_folder


class Specimen(NamedTuple):
    """A subject, and what is known about its technique."""

    title: str
    """As reports call it: `beer_lambert`, or `ice: beer_lambert`."""
    technique: str
    """What `sssgen eval` calls it."""
    subject: Subject
    role: str
    doc: Mapping[str, str]
    baseline: bool = False
    """Whether this is a formula as published, with its faults, for which the library has a better technique."""
    bind: Mapping[str, str] = {}
    """Slot → function, as `--bind` takes them."""
    settings: Mapping[str, tuple[float, ...]] = {}
    """The uniforms that are not inputs, since a material fixes them."""

    @property
    def slots(self) -> tuple[str, ...]:
        """The slots that another function may be bound to; none for a material's stage, which is already bound."""
        if self.title != self.technique or not self.doc:
            return ()
        return tuple(slot.name for slot in library.load(self.technique).slots)

    def rebound(self, slot: str, function: str) -> Specimen:
        """The same technique with a function bound to one of its slots."""
        bind = {**self.bind, slot: function}
        return self._replace(subject=subject(self.technique, bind), bind=bind)

    def output(self, name: str) -> Param:
        """An output as a parameter, with its name and its quantity."""
        probe = next(probe for probe in self.subject.probes if probe.output == name)
        called = probe.function.removesuffix(f"_shows_{name}")
        function = next(function for function in self.subject.module.functions if function.name == called)
        written = next((param for param in function.params if param.name == name and param.direction != "in"), None)
        return written or Param(RESULT, function.result, "out", function.quantity, function.span)

    def quantity(self, output: str) -> str:
        """The quantity of an output; '' where it has none or does not exist."""
        exists = any(probe.output == output for probe in self.subject.probes)
        return self.output(output).quantity if exists else ""


def specimens(names: Sequence[str]) -> list[Specimen]:
    """The techniques and the stages of the materials named; without names, the library except its baselines.

    A name is a technique, a .sss file, FILE:FUNCTION, an example or a .toml file. Raises SssgenError.
    """
    if not names:
        return [technique(loaded.name) for loaded in library.load_all() if not loaded.attributes.superseded_by]
    errors, chosen = [], []
    for name in dict.fromkeys(names):
        try:
            chosen += named_specimens(name)
        except SssgenError as error:
            errors += error.diagnostics
    if errors:
        raise SssgenError(errors)
    return chosen


def named_specimens(name: str) -> list[Specimen]:
    """The specimens that one name stands for. Raises SssgenError."""
    if name.endswith(".toml") or name in examples():
        return stages(load_material(name))
    if name not in library.index() and not name.rpartition(":")[0] and not name.endswith((".sss", ".glsl")):
        refuse_folder(name, (".sss", ".toml", ".glsl"))
        names = [*library.index(), *examples()]
        hint = did_you_mean(name, names) or "see: sssgen list techniques, sssgen list materials"
        raise failure(f"'{name}' is neither a technique nor a material", hint)
    return [technique(name)]


def technique(name: str, bind: Mapping[str, str] | None = None) -> Specimen:
    """A technique by its name or its file, or FILE:FUNCTION. Raises SssgenError."""
    probes = subject(name, bind)
    if name.rpartition(":")[0].endswith((".sss", ".glsl")):
        return Specimen(name, name, probes, "distance", {}, bind=bind or {})
    loaded = library.load(name)
    return Specimen(name, name, probes, loaded.role, loaded.doc, bool(loaded.attributes.superseded_by), bind or {})


def stages(material: Material) -> list[Specimen]:
    """A material's stages, each with its bindings; uniforms that the material fixes keep their values."""
    specimens = []
    for stage in material.stages:
        chosen = stage.technique
        bound = {slot: (binding.module, binding.function) for slot, binding in stage.bindings.items()}
        link = LinkInput(chosen.name, chosen.role, chosen.module, chosen.function, bound, stage.values, frozenset())
        probes = of_stages(chosen.name, [link])
        bind = {
            slot: _function_name(bound_function.function.span.file, bound_function.function.name)
            for slot, bound_function in stage.bindings.items()
        }
        settings = {
            name: stage.values[name] for name in stage.fixed if name in probes.uniforms and name in stage.values
        }
        name = chosen.name if chosen.name in library.index() else chosen.path
        title = f"{material.name}: {chosen.name}"
        specimens.append(
            Specimen(
                title, name, probes, chosen.role, chosen.doc, bool(chosen.attributes.superseded_by), bind, settings
            )
        )
    return specimens


def _function_name(file: str, function: str) -> str:
    stem = os.path.splitext(os.path.basename(file))[0]
    if stem in library.index():
        return stem if stem == function else f"{stem}:{function}"
    return f"{display_name(file)}:{function}"
