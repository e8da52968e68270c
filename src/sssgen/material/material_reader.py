"""Reads a material's TOML: sections, stages, parameters and bindings, checked against the techniques."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.ir.nodes import Function, Span, Uniform
from sssgen.ir.types import Sampler
from sssgen.lang.source_lines import keep_lines
from sssgen.material import baked, library, roles, slots
from sssgen.material.baked import BakeFile
from sssgen.material.level_reader import level_count, stage_levels
from sssgen.material.library import Technique
from sssgen.material.medium_look import REPLACED, look_keys, medium_parameters
from sssgen.material.model import ALPHA_MODES, SHADINGS, UV_SETS, Binding, Material, TechniqueUse, wrong_name
from sssgen.material.values import WrongValue, read_texture, read_value
from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean
from sssgen.support.paths import display_name
from sssgen.support.toml_source import Document, parse

_TEXTS = ("name", "title", "doc", "shading", "alpha_mode")
FLAGS = ("two_sided", "surroundings")
MATERIAL_KEYS = (*_TEXTS, *FLAGS, "levels")
STAGE_KEYS = ("technique", "bind", "uv", "level")
"""The keys of a stage that are not parameters."""
CHOICES = {
    "shading": (SHADINGS, "lit: the engine lights it; unlit: the chain gives the color"),
    "alpha_mode": (ALPHA_MODES, "opaque: alpha is ignored; mask: cut off at one half; blend: transparent"),
}


class _SharedValue(NamedTuple):
    """The value that a stage gives to a parameter shared by several stages."""

    value: object
    technique: str
    span: Span


def read_material(text: str, path: str, name: str) -> Material:
    """The material that a TOML text of this name describes; see `material_loading.parse_material`."""
    keep_lines({name: text})  # for errors of the passes
    reader = _Reader(parse(text, name), path)
    material = reader.material()
    own = sorted(reader.document.reporter.diagnostics, key=lambda diagnostic: diagnostic.span[1:3])
    if own or reader.foreign:
        raise SssgenError([*own, *reader.foreign])
    return material


class _Reader:
    """Reads one document; it collects errors in the document and continues."""

    def __init__(self, document: Document, path: str) -> None:
        self.document = document
        self.path = path
        self.foreign: list[Diagnostic] = []
        """The errors of the technique files that the material names."""
        self.levels = 1
        self.shared: dict[tuple[Span, tuple[int, ...]], _SharedValue] = {}
        """By the place of a parameter, and the levels of detail of the stages that share it."""
        self.media: list[tuple[BakeFile, Uniform, TechniqueUse, Uniform]] = []
        """Baked textures, each with its uniform and stage, and a parameter that other stages may share."""
        self.complete = True
        """Whether every stage has a technique, so that the chain can be checked."""

    def material(self) -> Material:
        data, error, place = self.document.data, self.document.error, self.document.place
        sections = ("material", *roles.SECTIONS)
        if isinstance(named := data.get("material"), str):
            error(place("material").key, "this is a scene, and no material", f"its material is {named}")
            self.document.reporter.check()
        for key, content in data.items():
            if key in sections and isinstance(content, dict | list):
                continue
            self.complete = False
            if key in sections:
                error(
                    place(key).key,
                    f"'{key}' is a section",
                    f"write [{key}] on a line of its own, its keys below",
                )
            elif isinstance(content, dict | list) and not _is_plain_list(content):
                error(place(key).key, f"unknown section '{key}'", _section_hint(key, sections))
            else:
                hint = f"sections: {', '.join(sections)}" if key not in MATERIAL_KEYS else "it belongs below [material]"
                error(place(key).key, f"'{key}' is outside any section", hint)
        name, title, doc, shading, alpha_mode = self.head(data.get("material"))
        self.levels = level_count(self.document, data.get("material"))
        stages = [stage for section in roles.SECTIONS for stage in self.section(section, data.get(section))]
        for texture, uniform, stage, other in self.media:
            if shared := self.shared.get((other.span, stage.levels)):
                self.check_medium(texture, uniform, stage, other, shared.value, shared.span)
        if not any(section in data for section in roles.SECTIONS):
            hint = f"add a section with a technique: {', '.join(f'[{section}]' for section in roles.SECTIONS)}"
            error(place("material").value, "the material has no stages", hint)
        elif self.complete and not self.foreign:
            links = [roles.Link(stage.technique, stage.span, stage.levels) for stage in stages]
            roles.check_levels(links, self.levels, shading, error)
        sides = self.two_sided(data.get("material"), stages)
        title = title or name.replace("_", " ").capitalize()
        around = self.flag(data.get("material"), "surroundings", True)
        return Material(name, title, doc, shading, tuple(stages), self.path, alpha_mode, sides, around, self.levels)

    # The head

    def head(self, table: Any) -> tuple[str, str, str, str, str]:
        """The name, title, doc, shading and alpha mode of the [material] section."""
        error, place = self.document.error, self.document.place
        if table is None:
            error(place().key, "there is no [material] section", 'add: [material] and below it name = "…"')
            return "", "", "", "lit", "opaque"
        if not isinstance(table, dict):
            error(place("material").key, "one file describes one material", "write [material], once")
            return "", "", "", "lit", "opaque"
        for key in table:
            if key not in MATERIAL_KEYS:
                hint = did_you_mean(key, MATERIAL_KEYS) or f"keys: {', '.join(MATERIAL_KEYS)}"
                error(place("material", key).key, f"unknown key '{key}' in [material]", hint)
        texts = {key: self.text(table.get(key, ""), key) for key in _TEXTS}
        name = texts["name"]
        if "name" not in table:
            error(place("material").value, "the material has no name", 'add: name = "…"')
        elif isinstance(table["name"], str) and (wrong := wrong_name(name)):
            error(place("material", "name").value, *wrong)
        chosen = {}
        for key, (words, meaning) in CHOICES.items():
            chosen[key] = texts[key] or words[0]
            if chosen[key] not in words:
                message = f"unknown {key.replace('_', ' ')} '{chosen[key]}'"
                error(place("material", key).value, message, did_you_mean(chosen[key], words) or meaning)
        return name, texts["title"], texts["doc"], chosen["shading"], chosen["alpha_mode"]

    def two_sided(self, table: Any, stages: Sequence[TechniqueUse]) -> bool:
        """Whether the material has back faces; a raymarched one has no mesh that could have any."""
        value = self.flag(table, "two_sided", False)
        if value and any(stage.technique.role == "geometry" for stage in stages):
            message = "a raymarched material has no back faces"
            place = self.document.place("material", "two_sided")
            self.document.error(place.key, message, "omit two_sided, or omit [geometry]")
        return value

    def flag(self, table: Any, key: str, default: bool) -> bool:
        """A key of the [material] section that is true or false."""
        value = table.get(key, default) if isinstance(table, dict) else default
        if isinstance(value, bool):
            return value
        wanted = str(not default).lower()
        self.document.error(
            self.document.place("material", key).value, f"'{key}' takes true or false", f"write {key} = {wanted}"
        )
        return default

    def text(self, raw: object, key: str) -> str:
        """A text of the [material] section; only `doc` may have several lines."""
        span = self.document.place("material", key).value
        if not isinstance(raw, str):
            self.document.error(span, f"'{key}' takes a string", f'write {key} = "…"')
            return ""
        controls = [character for character in raw if ord(character) < 32 and not (key == "doc" and character == "\n")]
        if controls and key != "name":
            self.document.error(span, f"'{key}' contains the control character {controls[0]!r}", "write it in one line")
        return raw.strip() if key != "name" else raw

    # Stages

    def section(self, section: str, content: Any) -> list[TechniqueUse]:
        """The stages of one section: a table, or an array of tables."""
        if not isinstance(content, dict | list):
            return []
        tables = list(enumerate(content)) if isinstance(content, list) else [(None, content)]
        stages = []
        for number, table in tables:
            path: tuple[str | int, ...] = (section,) if number is None else (section, number)
            if not isinstance(table, dict):
                self.document.error(self.document.place(*path).value, f"'{section}' is a section", f"write [{section}]")
                stage = None
            else:
                stage = self.stage(section, path, table)
            if stage is None:
                self.complete = False
            else:
                stages.append(stage)
        return stages

    def stage(self, section: str, path: tuple[str | int, ...], table: dict[str, Any]) -> TechniqueUse | None:
        """One stage; None if its technique is unknown."""
        technique = self.technique(section, path, table)
        if technique is None:
            return None
        span = self.document.place(*path, "technique").value
        bindings = self.bind(technique, path, table)
        functions = [function for function in (technique.function, technique.surroundings) if function]
        names = {name for function in functions for name in slots.needs(technique.module, function)[0]}
        uniforms = {uniform.span: uniform for uniform in technique.uniforms if uniform.name in names}
        for binding in bindings.values():
            names = set(slots.needs(binding.module, binding.function)[0])
            uniforms |= {uniform.span: uniform for uniform in binding.module.uniforms if uniform.name in names}
        levels: tuple[int, ...] = ()
        if "level" in table:
            levels = stage_levels(self.document, (*path, "level"), table["level"], self.levels)
        stage = TechniqueUse(technique, {}, frozenset(), {}, bindings, span, levels=levels)
        look = look_keys(uniforms.values())
        key_of: dict[Span, str] = {}
        for key, raw in table.items():
            if key in STAGE_KEYS:
                continue
            matches = [uniform for uniform in uniforms.values() if key in parameter_names(uniform)]
            if not matches and key in look:
                matches = _replaced(key, uniforms.values(), table)
            if not matches:
                self.unknown_parameter(technique, list(uniforms.values()), (*path, key))
            for uniform in matches:
                if uniform.span in key_of:
                    message = f"'{key_of[uniform.span]}' and '{key}' are the same parameter, given twice"
                    self.document.error(self.document.place(*path, key).key, message, "remove one of the two")
                    continue
                key_of[uniform.span] = key
                stage = self.parameter(stage, uniform, (*path, key), raw, look.get(key))
        if "uv" in table:
            stage = stage._replace(uv=self.uv_set(technique, (*path, "uv"), table["uv"]))
        return self.baked(stage, list(uniforms.values()), path, table)

    def uv_set(self, technique: Technique, path: tuple[str | int, ...], raw: object) -> str:
        """The set of texture coordinates that a stage reads."""
        place = self.document.place(*path)
        if raw not in UV_SETS:
            message = f"'uv' takes the name of a set of texture coordinates: {' or '.join(UV_SETS)}"
            self.document.error(place.value, message, 'write uv = "uv2"')
        elif all(param.name != "uv" for param in technique.function.params):
            self.document.error(place.key, f"'{technique.name}' reads no texture coordinates", "omit uv")
        return str(raw)

    def technique(self, section: str, path: tuple[str | int, ...], table: dict[str, Any]) -> Technique | None:
        """The technique that a stage names."""
        error, place = self.document.error, self.document.place
        allowed = roles.allowed_roles(section)
        name = table.get("technique")
        if name is None:
            error(
                place(*path).value,
                f"this [{section}] stage has no technique",
                f"write technique = one of: {', '.join(_of_roles(allowed))}",
            )
            return None
        span = place(*path, "technique").value
        if not isinstance(name, str):
            error(span, "'technique' takes a name", 'write technique = "…"')
            return None
        try:
            if name.endswith((".sss", ".glsl")):
                file = os.path.join(os.path.dirname(self.path), name)
                if not os.path.isfile(file):
                    error(span, f"cannot find the file '{name}'", "the path is relative to the material")
                    return None
                technique = library.load_path(file)
            elif name in library.index():
                technique = library.load(name)
            else:
                names = _of_roles(allowed)
                beside = library.file_meant(name, os.path.dirname(self.path))
                near = beside or did_you_mean(name, names) or did_you_mean(name, library.index())
                hint = near or f"techniques: {', '.join(names)}"
                error(span, f"unknown technique '{name}'", hint)
                return None
        except SssgenError as faulty:
            self.foreign += [diagnostic for diagnostic in faulty.diagnostics if diagnostic not in self.foreign]
            return None
        if technique.role not in allowed:
            home = "thickness" if technique.role == "conversion" else technique.role
            hint = f"put it into [{home}]"
            if technique.role == "distance":
                hint = f'it is bound to a slot: bind = {{ … = "{name}" }}'
            error(span, f"'{name}' is a {technique.role} technique and cannot be in [{section}]", hint)
            self.complete = False
        return technique

    def unknown_parameter(self, technique: Technique, uniforms: list[Uniform], path: tuple[str | int, ...]) -> None:
        key = str(path[-1])
        names = [*(uniform.name for uniform in uniforms), *look_keys(uniforms)]
        hint = did_you_mean(key, names, [name for uniform in uniforms for name in parameter_names(uniform)[1:]])
        if any(slot.name == key for slot in technique.slots):
            hint = f"'{key}' is a slot: write bind = {{ {key} = … }}"
        if not hint:
            hint = f"parameters: {', '.join(names)}" if uniforms else "it has none"
        message = f"unknown parameter '{key}' of '{technique.name}'"
        if any(uniform.name == key for uniform in technique.uniforms):
            message = f"'{technique.name}' does not read '{key}'"
        self.document.error(self.document.place(*path).key, message, hint)

    def parameter(
        self, stage: TechniqueUse, uniform: Uniform, path: tuple[str | int, ...], raw: object,
        look: Uniform | None = None,
    ) -> TechniqueUse:  # fmt: skip
        """The stage with one more parameter: `key = value` or `key = { value = …, fixed = true }`.

        `look` is the key of the medium's look that gives it, or None.
        """
        error, place = self.document.error, self.document.place
        fixed = False
        if isinstance(raw, dict):
            for key in raw.keys() - {"value", "fixed"}:
                hint = did_you_mean(key, ("value", "fixed")) or "write { value = …, fixed = true }"
                error(place(*path, key).key, f"unknown key '{key}' of a parameter", hint)
            fixed = raw.get("fixed", False)
            if not isinstance(fixed, bool):
                error(place(*path, "fixed").value, "'fixed' is true or false")
                fixed = False
            if "value" not in raw and "fixed" not in raw:
                error(place(*path).value, f"'{path[-1]}' has no value", "write { value = …, fixed = true }")
                return stage
            if "value" in raw:
                path, raw = (*path, "value"), raw["value"]
        try:
            if isinstance(uniform.type, Sampler):
                if fixed:
                    error(place(*path).value, "a texture cannot be fixed", "leave 'fixed' out")
                value: object = read_texture(uniform, raw)
                spans = (*stage.texture_spans, (uniform.name, place(*path).value))
                stage = stage._replace(textures={**stage.textures, uniform.name: str(value)}, texture_spans=spans)
            else:
                components = uniform.default if isinstance(raw, dict) else _components(uniform, raw, look)
                value = components
                stage = stage._replace(values={**stage.values, uniform.name: components})
                if fixed:
                    stage = stage._replace(fixed=stage.fixed | {uniform.name})
        except WrongValue as wrong:
            faulty_path = path if wrong.index is None else (*path, wrong.index)
            error(place(*faulty_path).value, wrong.message, wrong.hint)
            return stage
        if uniform.span.file != stage.technique.function.span.file:
            self.share(stage, uniform, path, value)
        return stage

    def baked(
        self, stage: TechniqueUse, uniforms: list[Uniform], path: tuple[str | int, ...], table: dict[str, Any]
    ) -> TechniqueUse:
        """The stage with the parameters of its baked textures, except those that it sets itself."""
        for uniform in uniforms:
            if uniform.name not in stage.textures:
                continue
            key = next(name for name in parameter_names(uniform) if name in table)
            span = self.document.place(*path, key).value
            file = os.path.join(os.path.dirname(self.path), stage.textures[uniform.name])
            try:
                texture = baked.read_bake_file(file)
                if texture is None:
                    continue
                baked.check(texture, uniform, stage.textures[uniform.name])
                matched = stage.technique.attributes.matched
                baked.check_boundary(texture, [other.name for other in uniforms], matched, stage.textures[uniform.name])
            except SssgenError as error:
                self.add_errors(error, span)
                continue
            for other in uniforms:
                keys = (*parameter_names(other), *(key for key, names in REPLACED.items() if other.name in names))
                given = [name for name in keys if name in table]
                if other.name in stage.values:
                    where = self.document.place(*path, given[0], "value").value if given else span
                    self.check_medium(texture, uniform, stage, other, stage.values[other.name], where)
                self.media.append((texture, uniform, stage, other))
                if other.name in texture.parameters and all(
                    isinstance(table[name], dict) and "value" not in table[name] for name in given
                ):
                    try:
                        components = read_value(other, texture.parameters[other.name])
                    except WrongValue as error:
                        message = (
                            f"a parameter baked with '{stage.textures[uniform.name]}' does not fit: {error.message}"
                        )
                        self.document.error(span, message, "; ".join(filter(None, (error.hint, baked.UNITS))))
                        continue
                    stage = stage._replace(values={**stage.values, other.name: components})
        return stage

    def check_medium(
        self, texture: BakeFile, uniform: Uniform, stage: TechniqueUse, other: Uniform, value: object, span: Span
    ) -> None:
        """Reports a value of the parameter `other` that is not of the medium of a stage's baked texture `uniform`."""
        if isinstance(value, tuple):
            try:
                baked.check_medium(texture, {other.name: value}, stage.textures[uniform.name])
            except SssgenError as error:
                self.add_errors(error, span)

    def add_errors(self, error: SssgenError, span: Span) -> None:
        for diagnostic in error.diagnostics:
            self.document.error(span, diagnostic.message, diagnostic.hint)

    def share(self, stage: TechniqueUse, uniform: Uniform, path: tuple[str | int, ...], value: object) -> None:
        """Checks that all stages agree about a parameter that they share.

        Those of included files and of bound functions are shared, textures in all levels of detail.
        """
        span = self.document.place(*path).value
        shared = _SharedValue(value, stage.technique.name, span)
        levels = () if isinstance(uniform.type, Sampler) else stage.levels
        earlier = self.shared.setdefault((uniform.span, levels), shared)
        if earlier.value != value:
            message = f"'{uniform.name}' has another value in '{earlier.technique}', line {earlier.span.line}"
            file = display_name(uniform.span.file)
            self.document.error(span, message, f"both stages share it (it is in {file}): give it once")

    # Slots

    def bind(self, technique: Technique, path: tuple[str | int, ...], stage: dict[str, Any]) -> dict[str, Binding]:
        """The bindings of a technique's slots, and of the slots of the functions bound to them."""
        error, place = self.document.error, self.document.place
        table = stage.get("bind", {})
        if not isinstance(table, dict):
            error(place(*path, "bind").value, "'bind' takes a table", 'write bind = { slot = "function" }')
            return {}
        bindings: dict[str, Binding] = {}
        unbound: list[Function] = []
        waiting = list(slots.needs(technique.module, technique.function)[1])
        reached: dict[str, Function] = {}
        while waiting:
            slot = waiting.pop(0)
            if slot.name in reached:
                continue
            reached[slot.name] = slot
            if slot.name not in table:
                unbound.append(slot)
            elif binding := self.binding(slot, table[slot.name], place(*path, "bind", slot.name).value):
                bindings[slot.name] = binding
                waiting += slots.needs(binding.module, binding.function)[1]
        for name in table.keys() - reached.keys():
            hint = did_you_mean(name, reached) or (f"slots: {', '.join(reached)}" if reached else "it has no slots")
            error(place(*path, "bind", name).key, f"'{technique.name}' has no slot '{name}'", hint)
            unbound = [slot for slot in unbound if f"'{slot.name}'" not in hint]  # it was misspelled
        for slot in unbound:
            if slot.name in stage:
                continue  # it was read as a parameter, and reported as one
            fitting = slots.candidates(slot)
            hint = f'write bind = {{ {slot.name} = "{fitting[0] if fitting else "FILE:FUNCTION"}" }}; '
            hint += (
                f"functions that fit: {', '.join(fitting)}" if fitting else f"the function is {slots.signature(slot)}"
            )
            where = place(*path, "bind").key if table else place(*path, "technique").value
            error(where, f"slot '{slot.name}' of '{technique.name}' is not bound", hint)
        for name in slots.cycle({name: (bound.module, bound.function) for name, bound in bindings.items()}):
            error(
                place(*path, "bind", name).value,
                f"the function bound to '{name}' calls '{name}' again",
                "bind another one",
            )
        return bindings

    def binding(self, slot: Function, raw: object, span: Span) -> Binding | None:
        """The function that a slot is bound to; None after an error."""
        if not isinstance(raw, str):
            self.document.error(span, "a slot is bound to the name of a function", f'write {slot.name} = "…"')
            return None
        try:
            return Binding(*slots.find(raw, slot, os.path.dirname(self.path)))
        except SssgenError as error:
            for diagnostic in error.diagnostics:
                if diagnostic.span.line:  # an error inside the file
                    self.foreign.append(diagnostic)
                else:
                    self.document.error(span, diagnostic.message, diagnostic.hint)
            return None


def parameter_names(uniform: Uniform) -> list[str]:
    """A uniform's name and its aliases."""
    return [uniform.name, *(str(name) for hint, names in uniform.hints if hint == "alias" for name in names)]


def _replaced(key: str, uniforms: Iterable[Uniform], table: Mapping[str, object]) -> list[Uniform]:
    """The parameters that a key of the medium's look sets: a mean free path of the stage's own stays beside a depth."""
    named = {uniform.name: uniform for uniform in uniforms}
    first, *others = [named[name] for name in REPLACED[key] if name in named]
    return [first, *(one for one in others if not set(parameter_names(one)) & table.keys())]


def _components(uniform: Uniform, raw: object, look: Uniform | None) -> tuple[float, ...]:
    """The components of a parameter, or those that follow from a key of the medium's look. Raises WrongValue."""
    if look is None:
        return read_value(uniform, raw)
    numbers = medium_parameters(look.name, read_value(look, raw))[uniform.name]
    return read_value(uniform, numbers if len(numbers) > 1 else numbers[0])


def _of_roles(allowed: tuple[str, ...]) -> list[str]:
    """The library's techniques of some roles, by their folders."""
    return [name for name, path in library.index().items() if library.folder_of(path) in allowed]


def _is_plain_list(content: object) -> bool:
    return isinstance(content, list) and not all(isinstance(element, dict) for element in content)


def _section_hint(key: str, sections: tuple[str, ...]) -> str:
    if key == "conversion":
        return "conversions belong in [[thickness]], after the technique whose result they convert"
    if key == "distance":
        return 'distance functions are bound to slots: bind = { … = "…" }'
    return did_you_mean(key, sections) or f"sections: {', '.join(sections)}"
