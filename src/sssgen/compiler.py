"""From a material to shader text: the passes in their order, then the target's printer and templates.

The part up to `legalise` is the same for every target of one kind and is done once a material.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from . import library
from .diagnostics import Diagnostic, SssgenError
from .ir.nodes import Function, Local, Module, Return
from .ir.types import Struct
from .lang.loader import comments_before, source_line
from .lang.polyfills import polyfill
from .material import Material
from .passes.chain import ChainStage, Entry, assemble
from .passes.cost import Cost, cost_of
from .passes.fold import fold
from .passes.hoist import Note, hoist
from .passes.inline import inline
from .passes.legalise import Unsupported, legalise
from .passes.link import LinkError, LinkStage, link
from .passes.names import rename
from .passes.parameters import uniforms_to_parameters
from .passes.predicate import predicate
from .passes.prune import prune
from .passes.undefined import undefined_constants
from .targets import descriptor
from .targets.descriptor import Target, Words
from .targets.emit import About, Program, emit
from .targets.reflection import as_text, reflect

FORMS = ("shader", "functions")


class Compiled(NamedTuple):
    """The files of one material for one target."""

    files: dict[str, str]
    """File name → text; `NAME.TARGET.reflection.json` among them."""
    reflection: dict[str, Any]
    warnings: list[Diagnostic]


class _Middle(NamedTuple):
    """A material's program before anything of a target has touched it."""

    module: Module
    entries: dict[str, Entry]
    surface: Struct | None
    owners: dict[str, tuple[str, str]]
    costs: dict[str, Cost]
    warnings: list[Diagnostic]
    encoded: bool = False
    """Whether an output technique has encoded the colour."""


_middles: dict[tuple[int, str, bool], tuple[Material, _Middle]] = {}
_compiled: dict[tuple[object, ...], tuple[Material, Compiled]] = {}
_KEPT = 512


def all_targets() -> dict[str, Target]:
    """Every target by name, plug-ins too."""
    return {name: descriptor.load(name) for name in descriptor.names()}


def compile(  # noqa: A001 - the library's verb, used as sssgen.compile
    material: Material | str | os.PathLike[str],
    target: str,
    form: str = "shader",
    templates: str | os.PathLike[str] | None = None,
) -> Compiled:
    """Compiles a material for a target.

    `material` is a checked material, the path of a material file, or the name of an example; `form` is `shader` (a
    complete shader) or `functions` (a library to paste); `templates` a folder whose templates go before ours.
    Raises SssgenError for anything wrong with the input.

    >>> import sssgen
    >>> made = sssgen.compile("paper_lantern", "glsl-330")
    >>> sorted(made.files)[0]
    'paper_lantern.glsl-330.frag'
    """
    if not isinstance(material, Material):
        from .material import load_material

        material = load_material(material)
    if form not in FORMS:
        from .diagnostics import did_you_mean, failure

        raise failure(f"unknown form '{form}'", did_you_mean(form, FORMS) or "forms: shader, functions")
    chosen = descriptor.load(target)
    key = (id(material), target, form)
    known = _compiled.get(key) if templates is None else None
    if known is not None and known[0] is material:
        return known[1]
    middle = _middle_of(material, chosen)
    made = _finish(middle, chosen, form, os.fspath(templates) if templates else None, _about(material))
    if templates is None:
        if len(_compiled) >= _KEPT:
            _compiled.clear()
        _compiled[key] = material, made
    return made


def transpile(module: Module, target: str, name: str) -> Compiled:
    """The functions form of a module of plain functions (no chain): what `sssgen transpile` writes."""
    chosen = descriptor.load(target)
    roots = [function.key for function in module.functions if function.body is not None]
    module, notes = hoist(prune(_folded(module, {}), roots), roots)
    middle = _Middle(module, {}, None, {}, {}, _warnings(notes))
    return _finish(middle, chosen, "functions", None, About(name, name))


def _middle_of(material: Material, target: Target) -> _Middle:
    """Links, assembles, folds, prunes and hoists; kept for the other targets of the same kind."""
    drop_output = bool(target.table.get("engine_encodes"))
    key = (id(material), target.lighting, drop_output)
    kept = _middles.get(key)
    if kept is not None and kept[0] is material:
        return kept[1]
    made = _build(material, target.lighting, drop_output)
    if len(_middles) >= _KEPT:
        _middles.clear()
        _compiled.clear()
    _middles[key] = (material, made)
    return made


def _build(material: Material, lighting: str, drop_output: bool) -> _Middle:
    stages = [_link_stage(stage) for stage in material.stages]
    spans = [stage.span for stage in material.stages]
    lit = material.shading == "lit"
    if lit and lighting and all(stage.role != "lighting" for stage in stages):
        technique = library.load(lighting)
        stages.append(LinkStage(technique.name, "lighting", technique.module, technique.function, {}, {}, frozenset()))
        spans.append(technique.function.span)
    if lit and not lighting:
        kept = [index for index, stage in enumerate(stages) if stage.role != "lighting"]
        stages, spans = [stages[index] for index in kept], [spans[index] for index in kept]
    if drop_output:
        kept = [index for index, stage in enumerate(stages) if stage.role != "output"]
        stages, spans = [stages[index] for index in kept], [spans[index] for index in kept]
    try:
        linked = link(stages)
        chained = [
            ChainStage(stage.role, stage.technique, function, span)
            for stage, function, span in zip(stages, linked.functions, spans, strict=True)
        ]
        chain = assemble(linked.module, chained, lit, material.alpha_mode == "opaque")
    except LinkError as error:
        raise SssgenError([Diagnostic("error", error.message, error.span, "", source_line(error.span))]) from None
    roots = [entry.function.key for entry in chain.entries.values()]
    module = prune(inline(_folded(chain.module, linked.fixed), _only_renames), roots)
    module, notes = hoist(module, roots)
    warnings = _warnings(notes)
    slots = _slot_functions(material, linked.module)
    costs = {kind: cost_of(module, entry.function.key, slots) for kind, entry in chain.entries.items()}
    encoded = not lit and any(stage.role == "output" for stage in stages)
    return _Middle(module, dict(chain.entries), chain.surface, linked.owners, costs, warnings, encoded)


def _folded(module: Module, fixed: Mapping[str, tuple[float, ...]]) -> Module:
    """The folded module. Raises SssgenError for constants that are no numbers."""
    module = fold(module, fixed)
    wrong = undefined_constants(module)
    if wrong:
        hint = "WGSL refuses it, and the others compute inf or NaN"
        raise SssgenError([Diagnostic("error", message, span, hint, source_line(span)) for message, span in wrong])
    return module


def _only_renames(function: Function) -> bool:
    """Whether a function returns its parameter as it is: such a conversion is for the types' sake alone."""
    body = function.body or ()
    return len(body) == 1 and isinstance(body[0], Return) and isinstance(body[0].value, Local)


def _about(material: Material) -> About:
    raymarched = any(stage.technique.role == "geometry" for stage in material.stages)
    return About(material.name, material.title, material.doc, material.shading, material.alpha_mode, raymarched)


def _warnings(notes: list[Note]) -> list[Diagnostic]:
    return [Diagnostic("warning", note.message, note.span, "", source_line(note.span)) for note in notes]


def _link_stage(stage: Any) -> LinkStage:
    technique = stage.technique
    bindings = {name: (binding.module, binding.function) for name, binding in stage.bindings.items()}
    return LinkStage(
        technique.name, technique.role, technique.module, technique.function, bindings, stage.values, stage.fixed
    )


def _slot_functions(material: Material, module: Module) -> frozenset[str]:
    """The linked functions that stand behind slots: the static cost counts their evaluations."""
    bound = {binding.function.span for stage in material.stages for binding in stage.bindings.values()}
    return frozenset(function.key for function in module.functions if function.span in bound)


def _finish(
    middle: _Middle,
    target: Target,
    form: str,
    templates: str | None,
    about: About,
) -> Compiled:
    """The target's own part: parameters, legalise, names, printing, templates, reflection."""
    module = middle.module
    if form in target.parameters:
        module = uniforms_to_parameters(module)
    try:
        module = legalise(module, target.dialect, target.can, polyfill)
    except Unsupported as error:
        message = f"{error.message} ({target.name})"
        raise SssgenError([Diagnostic("error", message, error.span, "", source_line(error.span))]) from None
    if not target.can("lane_control_flow"):
        module = predicate(module)
    before = [uniform.name for uniform in module.uniforms]
    exact, folded, prefixes = descriptor.reserved_everywhere()
    module, renames = rename(
        module,
        Words(exact | target.reserved, prefixes + target.prefixes),
        _uniform_style(target),
        not target.can("overloads"),
        folded | target.folded,
    )
    entries = {}
    for kind, entry in middle.entries.items():
        found = next(function for function in module.functions if function.name == entry.function.name)
        entries[kind] = (found, entry.inputs)
    source_names = {uniform.name: old for uniform, old in zip(module.uniforms, before, strict=True)}
    surface = next((s.type for s in module.structs if isinstance(s.type, Struct) and s.type.name == "Surface"), None)
    program = Program(module, entries, surface, source_names, about, middle.encoded, comments_before)
    emitted = emit(target, program, form, templates)
    messages = [warning.message for warning in middle.warnings]
    data = reflect(target, program, emitted, form, middle.owners, renames, middle.costs, messages)
    files = dict(emitted.files)
    suffix = "reflection" if form == "shader" else f"{form}.reflection"
    files[f"{about.name}.{target.name}.{suffix}.json"] = as_text(data)
    return Compiled(files, data, middle.warnings)


def _uniform_style(target: Target) -> Any:
    if target.uniform_style == "unity":
        return lambda name: "_" + "".join(word[:1].upper() + word[1:] for word in name.split("_"))
    return lambda name: name

