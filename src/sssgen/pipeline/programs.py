"""From a material to a program: the passes in their order, and the printed text of all but the uniforms.

The part up to `legalise` is the same for every target of one kind and is done once a material.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.ir.formats import FLOAT16, FLOAT32, Format
from sssgen.ir.nodes import Function, Local, Module, Return, Span
from sssgen.ir.types import Struct
from sssgen.lang.polyfills import guard as guard_source
from sssgen.lang.polyfills import polyfill
from sssgen.lang.source_lines import comment_behind, comments_before, source_line
from sssgen.material import library
from sssgen.material.chain_assembly import TAKEN, ChainStage, Entry, assemble
from sssgen.material.model import Material
from sssgen.passes.cost import Cost, cost_of
from sssgen.passes.fold import fold
from sssgen.passes.guards import Guarded, guard
from sssgen.passes.hoist import Note, hoist
from sssgen.passes.inline import inline
from sssgen.passes.legal.legalise import Unsupported, legalise
from sssgen.passes.link import LinkError, LinkStage, link
from sssgen.passes.names import rename
from sssgen.passes.numpy.predicate import predicate
from sssgen.passes.prune import only, prune, used
from sssgen.passes.ranges.range_pass import analyse
from sssgen.passes.ranges.sites import Site, report
from sssgen.passes.stage.initial_values import NoEntry, set_at_start
from sssgen.passes.stage.stage_interface import (
    ENTRY,
    Stage,
    StageError,
    colors_in_use,
    entry_of,
    interface,
    remarks,
    stage_kind,
    turned_derivatives,
)
from sssgen.passes.stage.uniform_structs import Unreadable, uniform_structs
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.stage.vertex_reads import with_levels
from sssgen.passes.undefined_constants import undefined_constants
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.targets import registry
from sssgen.targets.assemble import About, Program, print_parts
from sssgen.targets.descriptor import Names, Target
from sssgen.targets.registry import ReservedNames


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
    settings: Mapping[str, list[tuple[int, str]]] = {}
    """A uniform → the stages that may give it a value, and its name there."""
    guarded: Guarded | None = None


_middles: dict[tuple[str, str, bool, str, str, str], _Middle] = {}
_KEPT = 8
"""Materials come one after another, each for all targets."""


def make(material: Material, structure: str, target: Target, form: str, guards: str) -> Program:
    """The program of a material for a target. Raises SssgenError.

    `structure` says what it depends on, and is '' where that cannot be told.
    """
    return _finish(_middle_of(material, structure, target, form, guards), target, form)


def make_library(
    module: Module, target: Target, guards: str, called: Sequence[str] | None,
    at: Callable[[Site], str] | None = None, chained: bool = False, keep: bool = False,
) -> Program:  # fmt: skip
    """The program of a module of plain functions, or of a whole shader. Raises SssgenError.

    `called` are the keys of those that are called from outside; None means all of them. `at` and `chained` are
    those of `guard`. With `keep` the text stays as its author wrote it, but for what the target cannot say: then
    `called` only leaves out the functions that these do not call.
    """
    try:
        module = uniform_structs(module)
    except Unreadable as error:
        raise _refused(error.message, error.span, target) from None
    kind = stage_kind(module)
    kind = kind if kind in target.files else ""
    notes: list[Note] = []
    if kind:
        module, notes = _prepared(module, kind, target)
    if keep:
        module, more, roots = _kept(module, target, called)
    else:
        module, more, roots = plain_module(module)
    notes += more
    guarded = guard(module, called or roots, guards, guard_source, polyfill, format_of(target), at, chained)
    middle = _Middle(guarded.module, {}, None, {}, {}, _warnings(notes), guarded=guarded)
    return _finish(middle, target, kind or "functions", keep)


def _prepared(module: Module, kind: str, target: Target) -> tuple[Module, list[Note]]:
    """A whole shader with the meaning that it has in GLSL, and what of that the target cannot give."""
    module = colors_in_use(module)
    if _turned(target):
        module = turned_derivatives(module)
    if kind == "vertex" and not target.capabilities.implicit_levels:
        module = with_levels(module)
    known = _stage_builtins(module, target)
    return module, [Note(*one) for one in remarks(module, known, _turned(target), target.capabilities)]


def _stage_builtins(module: Module, target: Target) -> set[str]:
    """The values that a stage of the target can be given and give; a descriptor that lists none has GLSL's own."""
    return set(target.stage_builtins) or {variable.builtin for variable in module.variables}


def _turned(target: Target) -> bool:
    """Whether the target's framebuffer counts y from the top."""
    return target.conventions.framebuffer_y == "down"


def _kept(module: Module, target: Target, called: Sequence[str] | None) -> tuple[Module, list[Note], list[str]]:
    """A module as it was written, with its derivatives where the target can have them."""
    if called is not None:
        module = used(only(module, called))
    roots = [function.key for function in module.functions if function.body is not None]
    if not target.capabilities.undefined_constants:
        _refuse_undefined(module)
    if target.capabilities.implicit_levels:
        return module, [], roots
    entry = entry_of(module)
    if entry is None:
        return *hoist(module, roots), roots
    # what main() calls is only called from there
    reached = {function.key for function in only(module, [entry.key]).functions}
    return *hoist(module, [entry.key, *(key for key in roots if key not in reached)]), roots


def sites_of(material: Material, target: Target, form: str) -> list[Site]:
    """Every operation with a domain in the program of a material. Raises SssgenError."""
    guarded = _build(material, target, form, "auto").guarded
    return guarded.sites if guarded is not None else []


def library_sites(module: Module, called: Sequence[str] | None = None, chained: bool = False) -> list[Site]:
    """Every operation with a domain in a module of plain functions. Raises SssgenError."""
    module, _, roots = plain_module(module)
    return analyse(module, called or roots, FLOAT32, chained).sites


def plain_module(module: Module) -> tuple[Module, list[Note], list[str]]:
    """A module of plain functions folded, pruned and hoisted, and the keys of all of them."""
    roots = [function.key for function in module.functions if function.body is not None]
    module, notes = hoist(prune(_folded(module, {}), roots), roots)
    return module, notes, roots


def format_of(target: Target) -> Format:
    """What the target's text computes in."""
    return FLOAT16 if target.half_of else FLOAT32


def _middle_of(material: Material, structure: str, target: Target, form: str, guards: str) -> _Middle:
    """Links, assembles, folds, prunes, hoists and guards; kept for the other targets of the same kind."""
    key = (structure, target.lighting, target.engine_encodes, form, guards, format_of(target).name)
    middle = _middles.get(key) if structure else None
    if middle is None:
        if len(_middles) >= _KEPT:
            _middles.clear()
        middle = _middles[key] = _build(material, target, form, guards)
    return middle


class _Stage(NamedTuple):
    link: LinkStage
    span: Span
    """The place that names it."""
    number: int
    """Its place in the material; one that the target adds has the next."""
    glows: bool = False
    """Whether the technique says so: its light needs no lamp."""


def _stages(material: Material, target: Target) -> list[_Stage]:
    """The stages of a material that a target needs."""
    stages = [
        _Stage(_link_stage(stage), stage.span, number, "glows" in stage.technique.doc)
        for number, stage in enumerate(material.stages)
    ]
    lit = material.shading == "lit"
    if lit and target.lighting and all(stage.link.role != "lighting" for stage in stages):
        technique = library.load(target.lighting)
        added = LinkStage(technique.name, "lighting", technique.module, technique.function, {}, {}, frozenset())
        stages.append(_Stage(added, technique.function.span, len(stages)))
    engine = {"lighting"} if lit and not target.lighting else set()
    engine |= {"output"} if target.engine_encodes else set()
    return [stage for stage in stages if stage.link.role not in engine]


def _build(material: Material, target: Target, form: str, guards: str) -> _Middle:
    stages = _stages(material, target)
    lit = material.shading == "lit"
    try:
        linked = link([stage.link for stage in stages], TAKEN)
        chained = [
            ChainStage(stage.link.role, stage.link.technique, function, stage.span, stage.glows)
            for stage, function in zip(stages, linked.functions, strict=True)
        ]
        chain = assemble(linked.module, chained, lit, material.alpha_mode == "opaque")
    except LinkError as error:
        raise SssgenError([Diagnostic("error", error.message, error.span, "", source_line(error.span))]) from None
    roots = [entry.function.key for entry in chain.entries.values()]
    module = prune(inline(_folded(chain.module, linked.fixed), _only_renames), roots)
    module, notes = hoist(module, roots)
    kept = {function.key for function in module.functions}
    called = [*roots, *(f.key for f in linked.functions if f.key in kept)] if form == "functions" else roots
    guarded = guard(module, called, guards, guard_source, polyfill, format_of(target))
    module = guarded.module
    slots = _slot_functions(material, linked.module)
    costs = {kind: cost_of(module, entry.function.key, slots) for kind, entry in chain.entries.items()}
    encoded = not lit and any(stage.link.role == "output" for stage in stages)
    settings = {
        name: [(stages[index].number, own) for index, own in found if stages[index].number < len(material.stages)]
        for name, found in linked.settings.items()
    }
    entries = dict(chain.entries)
    return _Middle(module, entries, chain.surface, linked.owners, costs, _warnings(notes), encoded, settings, guarded)


def _folded(module: Module, fixed: Mapping[str, tuple[float, ...]]) -> Module:
    """The folded module. Raises SssgenError for constants that are no numbers."""
    module = fold(module, fixed)
    _refuse_undefined(module)
    return module


def _refuse_undefined(module: Module) -> None:
    """Raises SssgenError for constants that are no numbers."""
    wrong = undefined_constants(module)
    if wrong:
        hint = "WGSL refuses it, and the others compute inf or NaN"
        raise SssgenError([Diagnostic("error", message, span, hint, source_line(span)) for message, span in wrong])


def _only_renames(function: Function) -> bool:
    """Whether a function returns its parameter as it is: such a conversion is for the types' sake alone."""
    body = function.body or ()
    return len(body) == 1 and isinstance(body[0], Return) and isinstance(body[0].value, Local)


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


def _finish(middle: _Middle, target: Target, form: str, keep: bool = False) -> Program:
    """The target's own part: parameters, legalise, names, printing."""
    module = middle.module
    start = ENTRY if entry_of(module) is not None else ""
    # kept operators mean what GLSL says, which leaves some results open
    capabilities = target.capabilities._replace(integer_division=True) if keep else target.capabilities
    try:
        if not target.capabilities.module_variables:
            module = variables_to_parameters(module, start).module
        elif not target.capabilities.variable_values:
            module = set_at_start(module, start)
        if form in target.parameters:
            module = uniforms_to_parameters(module)
        module = legalise(module, target.dialect, capabilities, polyfill)
    except Unsupported as error:
        refused = [_refused(one.message, one.span, target).diagnostics[0] for one in (error, *error.more)]
        raise SssgenError(refused) from None
    except NoEntry as error:
        raise _refused(error.message, error.span, target) from None
    if not target.capabilities.lane_control_flow:
        module = predicate(module)
    before = [uniform.name for uniform in module.uniforms]
    main = _entry_name(target, form)
    module, renames = rename(
        module,
        _reserved(target, main, keep),
        _uniform_style(target),
        not target.capabilities.overloads,
        _others_names(target, keep).folded | target.names.folded,
        target.capabilities.matrix_overloads,
    )
    try:
        stage = _stage(module, target, form, renames)
    except StageError as error:
        raise _refused(error.message, error.span, target) from None
    parts = print_parts(target, module, comments_before, stage, main, keep, comment_behind, source_line)
    module = module._replace(functions=tuple([function._replace(body=()) for function in module.functions]))
    entries = {}
    for kind, entry in middle.entries.items():
        found = next(function for function in module.functions if function.name == entry.function.name)
        entries[kind] = (found, entry.inputs)
    source_names = {uniform.name: old for uniform, old in zip(module.uniforms, before, strict=True)}
    surface = next((s.type for s in module.structs if isinstance(s.type, Struct) and s.type.name == "Surface"), None)
    return Program(
        module, entries, surface, source_names, About("", ""), middle.encoded, parts, middle.owners, renames,
        {kind: cost._asdict() for kind, cost in middle.costs.items()}, middle.warnings, middle.settings,
        report(middle.guarded.sites, middle.guarded.guarded) if middle.guarded else {}, stage,
    )  # fmt: skip


def _refused(message: str, span: Span, target: Target) -> SssgenError:
    return SssgenError([Diagnostic("error", f"{message} ({target.name})", span, "", source_line(span))])


def _entry_name(target: Target, form: str) -> str:
    """What the function is called that a whole shader begins with; '' in the other forms."""
    return target.files[form][0].stages[form] if form in ("vertex", "fragment") else ""


def _reserved(target: Target, entry: str, keep: bool) -> ReservedNames:
    """The names that are not free.

    Kept names avoid those of the target's language alone. A shader whose entry is the author's has that name, and no
    shell around it.
    """
    others = _others_names(target, keep)
    names, prefixes = others.exact | target.names.exact, others.prefixes + target.names.prefixes
    if entry == "main":
        return ReservedNames(names - target.names.shell - {"main"}, prefixes)
    return ReservedNames(names | {"main"}, prefixes)


def _others_names(target: Target, keep: bool) -> Names:
    """The names that other targets reserve and that this target's texts avoid, too."""
    return registry.reserved_of(target.language) if keep else registry.reserved_everywhere()


def _stage(module: Module, target: Target, form: str, renames: Mapping[str, str]) -> Stage | None:
    """The interface of a whole shader with its final names. Raises StageError."""
    if not _entry_name(target, form):
        return None
    main = renames.get(ENTRY) or renames.get("main", "main")
    return interface(module, form, f"{main}()", _stage_builtins(module, target), _turned(target))


def _uniform_style(target: Target) -> Any:
    if target.uniform_style == "unity":
        return lambda name: "_" + "".join(word[:1].upper() + word[1:] for word in name.split("_"))
    return lambda name: name
