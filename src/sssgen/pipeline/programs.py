"""From a material or a module to a program: runs the passes (`pass_list`) and prints all but the uniforms."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from sssgen.ir.contracts import Assumed
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Function, Member, Module
from sssgen.ir.types import Struct
from sssgen.ir.walk import all_expressions, builtins_of
from sssgen.lang.source_lines import comment_behind, comments_before, source_line
from sssgen.material.chain_assembly import Entry
from sssgen.material.model import Material
from sssgen.passes.cost import Cost
from sssgen.passes.ranges.guard_report import GuardReport
from sssgen.passes.ranges.origins import Origins, RangeTrace
from sssgen.passes.ranges.range_pass import analyse
from sssgen.passes.ranges.sites import Site, report
from sssgen.passes.reachable import keep_reachable
from sssgen.passes.stage.stage_interface import entry_of, stage_kind
from sssgen.passes.stage.storage_layout import has_buffers
from sssgen.passes.unsupported import Note
from sssgen.pipeline import pass_list
from sssgen.pipeline.material_stages import check_shell, check_values
from sssgen.pipeline.state import State
from sssgen.pipeline.trace import Trace
from sssgen.support.diagnostics import Diagnostic, failure
from sssgen.targets import registry
from sssgen.targets.assemble import About, Program, print_parts
from sssgen.targets.descriptor import Target
from sssgen.targets.uniform_support import check_uniforms

_material_programs: dict[tuple[str, str, tuple[str, ...], bool, bool, bool, bool, str, str, str], State] = {}
"""The states after the passes of a material, which are the same for all targets of one kind."""
_CACHED = 8
"""Few, as materials are compiled one after another, each for all targets."""


def make(
    material: Material, structure: str, target: Target, form: str, guards: str, trace: Trace | None = None
) -> Program:
    """The program of a material for a target. Raises SssgenError.

    `structure` identifies what the program depends on; '' where that is unknown, and nothing is cached.
    """
    check_shell(material, target)
    check_values(material, target)
    state = _material_program(material, structure if trace is None else "", target, form, guards, trace)
    return target_program(replace(state, chosen=target, frame_functions={}), trace)


def make_library(
    module: Module, target: Target, guards: str, called: Sequence[str] | None,
    at: Callable[[Site], str] | None = None, chained: bool = False, keep: bool = False, trace: Trace | None = None,
    partner: Module | None = None,
) -> Program:  # fmt: skip
    """The program of a module of plain functions, or of a whole shader. Raises SssgenError.

    `called` are the keys of the functions that are called from outside; None means all of them. `at` and `chained` are
    those of `guard`. With `keep` the text stays as its author wrote it, except what the target cannot express: then
    `called` only leaves out the functions that these do not call. `partner` is the other stage of a whole shader.
    """
    kind = stage_kind(module)
    if partner is not None:
        check_partner(kind, stage_kind(partner))
    form = kind if kind in target.files else "functions"
    if module.workgroup:
        _check_compute(target, form)
    check_guards(module, guards)
    state = State(module, form, guards, target, keep, called, at, chained, partner)
    if trace is not None:
        trace.start(module)
    pass_list.run(pass_list.KEPT if keep else pass_list.PLAIN, state, trace)
    return target_program(state, trace)


def check_guards(module: Module, guards: str) -> None:
    """Raises SssgenError where a shader with memory is to have guards."""
    if (module.workgroup or has_buffers(module)) and guards != "none":
        raise failure("a shader with memory takes no guards: other invocations write it, too", "write --guards none")


def _check_compute(target: Target, form: str) -> None:
    """Raises SssgenError where a target has no compute shaders."""
    if form != "compute":
        able = [name for name in registry.names() if "compute" in registry.load(name).files]
        raise failure(f"{target.title} has no compute shaders here", f"they go to {', '.join(able)}")


def check_partner(kind: str, other: str) -> None:
    """Raises SssgenError where these are not two stages of one program."""
    if {kind, other} != {"vertex", "fragment"}:
        kinds = [f"a {stage} shader" if stage else "no whole shader" for stage in (kind, other)]
        hint = "give a vertex shader with a fragment shader, each with a main()"
        raise failure(f"these are not two stages of one program: {kinds[0]} and {kinds[1]}", hint)


class MaterialAnalysis(NamedTuple):
    """A program of a material, and what the passes found in it."""

    module: Module
    costs: Mapping[str, Cost]
    """The cost of each function that the shell calls."""
    sites: Sequence[Site]
    """Every operation with a domain."""
    slots: frozenset[str]
    """The keys of the functions that are bound to slots."""


def analyse_material(material: Material, target: Target, form: str) -> MaterialAnalysis:
    """The program of a material before the passes for a target. Raises SssgenError."""
    state = _material_program(material, "", target, form, "auto", None)
    return MaterialAnalysis(state.module, state.costs, state.guarded.sites if state.guarded else (), state.slots)


def library_sites(module: Module, called: Sequence[str] | None = None, chained: bool = False) -> list[Site]:
    """Every operation with a domain in a module of plain functions, or in the run of a whole shader.

    Raises SssgenError.
    """
    module, roots = _program_part(module, called)
    return analyse(module, roots, FLOAT32, chained).sites


def traced_sites(
    module: Module, called: Sequence[str] | None = None, chained: bool = False, assumed: Assumed | None = None,
    unguarded: bool = False,
) -> tuple[list[Site], Origins]:  # fmt: skip
    """The same, and where the ranges come from; `assumed` and `unguarded` are those of the analysis."""
    module, roots = _program_part(module, called)
    trace = RangeTrace(module, chained, assumed, unguarded)
    for key in roots:
        trace.root(key)
    return list(trace.sites.values()), Origins(module, trace)


def _program_part(module: Module, called: Sequence[str] | None) -> tuple[Module, Sequence[str]]:
    """A module of plain functions before guards, and the keys of what is called from outside."""
    module, _, roots = plain_module(module)
    entry = entry_of(module)
    return module, called or ([entry.key] if entry is not None else roots)


def plain_module(module: Module) -> tuple[Module, list[Note], list[str]]:
    """A module of plain functions folded, pruned and hoisted, and the keys of all of them. Raises SssgenError."""
    state = pass_list.run(pass_list.SIMPLIFY, State(module))
    return state.module, state.notes, state.roots


def _material_program(
    material: Material, structure: str, target: Target, form: str, guards: str, trace: Trace | None
) -> State:
    """The state after the passes of a material; cached for the other targets of the same kind."""
    new = State(Module(), form, guards, target, material=material)
    shell = (target.fragment_shell, str(target.own_body), *target.given_inputs) if new.has_shell else ()
    of_engine = (target.engine_encodes, target.clustered_lights, target.has_surroundings, target.has_rest_pose)
    key = (structure, target.lighting, shell, *of_engine, form, guards, new.format.name)
    state = _material_programs.get(key) if structure else None
    if state is None:
        state = pass_list.run(pass_list.MATERIAL, new, trace)
        if structure:
            if len(_material_programs) >= _CACHED:
                _material_programs.clear()
            _material_programs[key] = state
    return state


def target_program(state: State, trace: Trace | None = None) -> Program:
    """Runs the passes for the target, and prints the result."""
    pass_list.run(pass_list.TARGET, state, trace)
    module, target, material = state.module, state.target, state.material
    folder = os.path.dirname(os.path.realpath(material.file)) if material is not None else ""

    def final(entry: Entry) -> tuple[Function, tuple[str, ...]]:
        """An assembled function as the target has it, with its inputs."""
        name = state.renames.get(entry.function.name, entry.function.name)
        return next(function for function in module.functions if function.name == name), entry.inputs

    check_uniforms(target, state.form, module.uniforms, state.source_names, source_line, state.keep)
    shell = final(state.shell) if state.shell is not None else None
    parts = print_parts(
        target, module, comments_before, state.stage, state.entry_name, state.keep, comment_behind, source_line,
        shell,
    )  # fmt: skip
    unlit = material is not None and material.shading != "lit"
    encoded = unlit and any(stage.link.role == "output" for stage in state.stages)
    reached = _reachable(state, module) if any(file.without for file in target.files.get(state.form, ())) else {}
    entries = {kind: final(entry) for kind, entry in state.entries.items()}
    name = state.renames.get("Surface", "Surface")
    surface = next((s.type for s in module.structs if isinstance(s.type, Struct) and s.type.name == name), None)
    surface_reads = {kind: _members_read(function, surface) for kind, (function, _) in entries.items()}
    later_glsl = any(BUILTINS[name].later_glsl for name in builtins_of(module) if name in BUILTINS)
    later_glsl = later_glsl or any(variable.builtin in target.later_builtins for variable in module.variables)
    module = module._replace(functions=tuple([function._replace(body=()) for function in module.functions]))
    warnings = [
        Diagnostic("warning", note.message, note.span, note.hint, source_line(note.span)) for note in state.notes
    ]
    return Program(
        module, entries, surface, state.source_names, About("", ""), encoded, parts, state.owners, state.renames,
        {kind: cost._asdict() for kind, cost in state.costs.items()}, warnings, state.settings,
        report(state.guarded.sites, state.guarded.guarded, folder) if state.guarded else GuardReport(), state.stage,
        reached=reached, shell=shell, frame_functions=state.frame_names, folder=folder, surface_reads=surface_reads,
        later_glsl=later_glsl,
    )  # fmt: skip


def _members_read(function: Function, surface: Struct | None) -> frozenset[str]:
    """The members of the surface that a function reads."""
    expressions = all_expressions(function.body or ())
    return frozenset(expr.field for expr in expressions if type(expr) is Member and expr.value.type == surface)


def _reachable(state: State, module: Module) -> dict[str, frozenset[str]]:
    """Entry kind, or function of the frame → the names of the functions that it calls, its own among them."""
    keys = {function.name: function.key for function in module.functions}
    entries = {kind: entry.function.name for kind, entry in state.entries.items()}
    names = {**{kind: state.renames.get(name, name) for kind, name in entries.items()}, **state.frame_names}
    return {
        root: frozenset(function.name for function in keep_reachable(module, [keys[name]]).functions)
        for root, name in names.items()
    }
