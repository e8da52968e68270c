"""Completions in materials and scenes: sections, keys, techniques that fit the chain, parameters, slots, values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from sssgen.editor.analysis import Analysis
from sssgen.editor.completion_item import Item, items_of
from sssgen.editor.documents import Document
from sssgen.editor.lookup import slots_of, technique_named, uniforms_at
from sssgen.editor.toml_places import TomlPlace, place_at, tables_of
from sssgen.ir.nodes import Span, Uniform
from sssgen.ir.types import Sampler
from sssgen.material import library, roles, slots
from sssgen.material.library import OF_SHELLS, Technique
from sssgen.material.material_loading import examples
from sssgen.material.material_reader import CHOICES, FLAGS, MATERIAL_KEYS, STAGE_KEYS, parameter_names
from sssgen.material.model import UV_SETS
from sssgen.material.shell_stages import choices
from sssgen.material.technique_facts import uniform_facts, uniform_text
from sssgen.scene.scene_keys import CAMERA, KEYS, LIGHT, PLACE, SHAPES
from sssgen.support.paths import source_name

_LISTS = ("light",)
"""The sections of a scene that are written in double brackets."""
_TABLES = ("geometry", "camera", "light", "shell", "parameters", "textures")


def material_items(document: Document, analysis: Analysis, line: int, column: int) -> list[Item]:
    """Completions in a material."""
    place = place_at(document, line, column)
    if place.in_header:
        return items_of(("material", *roles.SECTIONS), "section")
    if place.section == "material":
        return _head_items(place)
    if place.section not in roles.SECTIONS:
        return []
    if place.key == "bind" and place.in_value:
        return _bind_items(document, place)
    if not place.in_value:
        uniforms = uniforms_at(document, analysis, place)
        return [*_keys(STAGE_KEYS, place), *_parameters(uniforms, place)]
    if place.key == "technique":
        return _techniques(document, place)
    return _quoted_items(UV_SETS, place) if place.key == "uv" else []


def _head_items(place: TomlPlace) -> list[Item]:
    if not place.in_value:
        return _keys(MATERIAL_KEYS, place)
    if place.key in CHOICES:
        return _quoted_items(CHOICES[place.key][0], place)
    return items_of(("true", "false"), "value") if place.key in FLAGS else []


def _techniques(document: Document, place: TomlPlace) -> list[Item]:
    """The techniques of the section's roles; those that the stages above supply with all they read come first."""
    before = list(_links(document, place))
    allowed = roles.allowed_roles(place.section)
    items = []
    for name in library.index():
        technique = technique_named(name, document)
        if technique is None or technique.role not in allowed:
            continue
        missing = _missing_input(before, technique)
        detail = f"{technique.role}: {missing}" if missing else technique.role
        rank = (2 if missing else 0) + technique.baseline
        text = name if place.in_text else f'"{name}"'
        items.append(Item(name, "technique", detail, technique.doc.get("summary", ""), text, rank))
    return sorted(items, key=lambda item: item.rank)


def _links(document: Document, place: TomlPlace) -> Iterator[roles.Link]:
    """The stages that run before the place's section, and those above it in the same section."""
    order = list(roles.SECTIONS)
    here = order.index(place.section), place.table.first_line
    tables = [table for table in tables_of(document) if table.section in order]
    for section, line, name in sorted((order.index(part.section), part.first_line, part.technique) for part in tables):
        technique = technique_named(name, document) if (section, line) < here else None
        if technique is not None:
            yield roles.Link(technique, technique.function.span)


def _missing_input(before: Sequence[roles.Link], technique: Technique) -> str:
    """What a technique reads that the stages before it do not give; '' where nothing is missing."""
    missing: list[str] = []

    def report(span: Span, message: str, hint: str) -> None:
        if message.startswith(f"'{technique.name}' takes "):
            missing.append(message.removeprefix(f"'{technique.name}' "))

    roles.check_chain([*before, roles.Link(technique, technique.function.span)], "lit", report)
    return missing[0] if missing else ""


def _bind_items(document: Document, place: TomlPlace) -> list[Item]:
    technique = technique_named(place.table.technique, document)
    if technique is None:
        return []
    known = slots_of(technique)
    if place.inner_key in known:
        return _quoted_items(slots.candidates(known[place.inner_key]), place, "function")
    if place.in_text or not place.in_table:
        return []
    return [Item(name, "function", slots.signature(slot), slot.doc, f'{name} = ""') for name, slot in known.items()]


def _parameters(uniforms: dict[str, Uniform], place: TomlPlace) -> list[Item]:
    items = []
    for name, uniform in uniforms.items():
        if name != uniform.name or any(alias in place.keys for alias in parameter_names(uniform)):
            continue
        facts = uniform_facts(uniform)
        kind = "texture" if isinstance(uniform.type, Sampler) else "parameter"
        items.append(Item(name, kind, uniform_text(facts), uniform.doc, f"{name} = {_toml_value(uniform)}"))
    return items


def _toml_value(uniform: Uniform) -> str:
    """A parameter's default as TOML writes it."""
    if isinstance(uniform.type, Sampler):
        return '""'
    default = uniform_facts(uniform)["default"]
    texts = [str(value).lower() if isinstance(value, bool) else f"{value!r}" for value in default]
    return texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]"


def _keys(keys: Iterable[str], place: TomlPlace) -> list[Item]:
    return [Item(key, "keyword", text=f"{key} = ") for key in keys if key not in place.keys]


def _quoted_items(values: Iterable[str], place: TomlPlace, kind: str = "value") -> list[Item]:
    return [Item(value, kind, text=value if place.in_text else f'"{value}"') for value in values]


def scene_items(document: Document, analysis: Analysis, line: int, column: int) -> list[Item]:
    """Completions in a scene."""
    place = place_at(document, line, column)
    section = place.section
    if place.in_header:
        return items_of(_TABLES, "section")
    if section in ("parameters", "textures") and not place.in_value:
        wanted = section == "textures"
        uniforms = uniforms_at(document, analysis, place)
        return _parameters({k: u for k, u in uniforms.items() if isinstance(u.type, Sampler) == wanted}, place)
    if section == "shell":
        if place.in_value:
            return _quoted_items(choices(place.key), place, "technique") if place.key in OF_SHELLS else []
        return _keys(OF_SHELLS, place)
    if place.in_value:
        return _scene_value(document, place)
    shape_keys = tuple(dict.fromkeys(key for keys in SHAPES.values() for key in keys))
    keys = {
        "": tuple(key for key in KEYS if key not in _TABLES),
        "camera": CAMERA,
        "light": LIGHT,
        "geometry": ("kind", *PLACE, *shape_keys),
    }
    return _keys(keys.get(section, ()), place)


def _scene_value(document: Document, place: TomlPlace) -> list[Item]:
    if place.section == "" and place.key == "material":
        return _quoted_items(examples(), place)
    if place.section.startswith("geometry") and place.key == "kind":
        return _quoted_items(SHAPES, place)
    if place.section.startswith("geometry") and place.key == "technique":
        paths = {name: path for name, path in library.index().items() if library.folder_of(path) == "distance"}
        return _quoted_items([f"{source_name(path)}:{name}" for name, path in paths.items()], place, "technique")
    return []
