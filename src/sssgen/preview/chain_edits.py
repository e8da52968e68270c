"""What the menus of the page do to a material's file: stages come, go and change, and a preset replaces the chain."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from sssgen.lab.measure.technique_chain import bindings_of
from sssgen.material import library, slots
from sssgen.material.library import Technique
from sssgen.material.material_loading import parse_material
from sssgen.material.material_reader import STAGE_KEYS, parameter_names
from sssgen.material.material_text import MaterialSection
from sssgen.material.medium_look import look_keys
from sssgen.material.model import Material, TechniqueUse
from sssgen.material.requirements import DESCRIPTIONS, requirements
from sssgen.presets.preset import preset
from sssgen.presets.preset_list import MENU_QUALITIES
from sssgen.presets.preset_stages import preset_stages
from sssgen.preview.bodies import body_size
from sssgen.preview.saved_values import parse_document, section_of
from sssgen.preview.stage_edits import ChainText
from sssgen.scene.bake_advice import is_scene
from sssgen.scene.scene import Scene
from sssgen.scene.scene_parameters import uniforms_of
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.installed_files import is_installed
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text
from sssgen.support.toml_source import Path

SECTIONS = ("coordinates", "thickness", "surface", "translucency")
"""The sections that the menus change: those of a material that an engine lights."""
SMALLEST_MM, LARGEST_MM = 1e-3, 1e6
"""The sizes of bodies, as of `sssgen use`."""
_SUFFIX = ".sss"


class TechniqueRow(NamedTuple):
    """A technique in the menu of a place in the chain."""

    name: str
    role: str
    section: str
    summary: str
    needs: tuple[str, ...]
    """What it requires of the body and the program, for people"""
    baseline: bool
    """Whether it is there for comparison, as published"""
    reason: str
    """Why the chain would not link with it, or ''"""


def chain_text(material: Material) -> ChainText:
    """The text of a material's file, cut into stages. Raises SssgenError."""
    return ChainText(read_text(material.file, posix(material.file)), posix(material.file))


def stage_rows(material: Material) -> list[dict[str, Any]]:
    """The stages of the chain in the order in which they run, with their places in the file."""
    chain = chain_text(material)
    headers = {block.path: (block.first, block.end) for block in chain.blocks}
    return [
        {
            "path": list(path),
            "technique": use.technique.name,
            "role": use.technique.role,
            "doc": use.technique.doc.get("summary", ""),
            "changes": path[0] in SECTIONS,
        }
        for use in material.stages
        for path, (first, end) in headers.items()
        if first <= use.span.line - 1 < end and path[0] != "material"
    ]


def technique_rows(material: Material, path: Path) -> list[TechniqueRow]:
    """The techniques for a new stage, or for the place of the stage at `path`, with the reasons against them."""
    chain = chain_text(material)
    rows = []
    for name, technique in _techniques(material).items():
        section = section_of(technique)
        if section not in SECTIONS or (path and section != path[0]):
            continue
        use = TechniqueUse(technique, {}, frozenset(), {}, {}, technique.function.span)
        needs = tuple(DESCRIPTIONS[need] for need in requirements([use]))
        summary, reason = technique.doc.get("summary", ""), _reason(chain, material, name, technique, path)
        rows.append(TechniqueRow(name, technique.role, section, summary, needs, technique.baseline, reason))
    return sorted(rows, key=lambda row: (SECTIONS.index(row.section), bool(row.reason), row.baseline))


def _techniques(material: Material) -> dict[str, Technique]:
    """The techniques of the library, and those in files beside the material, by the names that a stage gives."""
    found = {name: library.load(name) for name in library.index()}
    folder = os.path.dirname(material.file) or "."
    for file in sorted(os.listdir(folder)):
        if file.endswith(_SUFFIX):
            try:
                found[file] = library.load_path(os.path.join(folder, file))
            except SssgenError:  # a file of functions, or one that is being written
                continue
    return found


def _reason(chain: ChainText, material: Material, name: str, technique: Technique, path: Path) -> str:
    """Why the chain does not link with a technique, or ''."""
    try:
        parse_material(_with_technique(chain, name, technique, path), material.file)
    except SssgenError as error:
        first = error.diagnostics[0]
        return f"{first.message}{f': {first.hint}' if first.hint else ''}"
    return ""


def _with_technique(chain: ChainText, name: str, technique: Technique, path: Path) -> str:
    bind = tuple(bindings_of(technique, chain.given_bindings()).items())
    stage = MaterialSection(section_of(technique), name, bind=bind)
    return chain.with_technique(path, stage, _keys_of(technique)) if path else chain.with_stage(stage)


def _keys_of(technique: Technique) -> set[str]:
    """The keys of a stage that a technique takes, besides those that are bound with it."""
    read = slots.needs(technique.module, technique.function)[0]
    uniforms = [uniform for uniform in technique.uniforms if uniform.name in read]
    keys = {name for uniform in uniforms for name in parameter_names(uniform)}
    return keys | look_keys(uniforms).keys() | {*STAGE_KEYS} - {"bind"}


def edited_files(scene: Scene, material: Material, edit: Mapping[str, Any]) -> dict[str, str]:
    """Path → text of the files that an edit changes: the material, and the scene without what it sets no longer.

    `edit` has `action`: `add`, `replace` or `remove`, with `technique` and `path`; or `preset`, with its name, its
    `quality` and, for another size than its own, `size_mm`. Raises SssgenError where the chain does not link, and for
    files that come with sssgen.
    """
    if is_installed(material.file):
        hint = "save it as your own first"
        raise failure("this material comes with sssgen and is not changed", hint, posix(material.file))
    chain, path = chain_text(material), tuple(edit.get("path", ()))
    if edit["action"] == "remove":
        text = chain.without_stage(path)
    elif edit["action"] == "preset":
        text = _with_preset(chain, scene, edit)
    else:
        name = str(edit["technique"])
        techniques = _techniques(material)
        if name not in techniques:
            raise failure(f"there is no technique '{name}' any more")
        text = _with_technique(chain, name, techniques[name], path if edit["action"] == "replace" else ())
    changed = parse_material(text, material.file)
    return {material.file: text} | _scene_without(scene, material, changed)


def _with_preset(chain: ChainText, scene: Scene, edit: Mapping[str, Any]) -> str:
    chosen = preset(str(edit["preset"]))
    if scene.geometry is None:
        raise failure("this material makes its own rays, and a preset is for a body")
    quality, longest = str(edit["quality"]), float(edit.get("size_mm") or chosen.size_mm)
    if quality not in MENU_QUALITIES:
        raise ValueError(quality)
    if not SMALLEST_MM <= longest <= LARGEST_MM:
        hint = f"its size is from {SMALLEST_MM:g} to {LARGEST_MM:g} mm"
        raise failure(f"a body cannot be {longest:g} mm large", hint)
    size = body_size(scene.geometry, longest)
    has_sides = "two_sided" in chain.document.data["material"]
    settings = ["two_sided = true"] if any(chosen.sheet) and not has_sides else []
    return chain.with_chain(preset_stages(chosen, quality, size), settings)


def _scene_without(scene: Scene, material: Material, changed: Material) -> dict[str, str]:
    """The scene's file without the parameters and textures that the changed material does not have; {} where it has
    all of them."""
    file = scene.document.reporter.file
    if not is_scene(scene, material) or is_installed(file):
        return {}
    known = uniforms_of(scene, changed)
    gone = [("parameters", name) for name in scene.parameters if name not in known]
    gone += [("textures", name) for name in scene.textures if name not in known]
    if not gone:
        return {}
    document = parse_document(file)
    for section, name in gone:
        del document[section][name]
    return {file: document.as_string()}
