"""The passes as steps of the pipeline: each calls its pass with parts of the state, and stores its results there."""

from __future__ import annotations

from collections.abc import Callable

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Module
from sssgen.lang.polyfills import guard as guard_source
from sssgen.lang.polyfills import polyfill
from sssgen.lang.source_lines import source_line
from sssgen.material.chain_assembly import TAKEN, ChainFunction, Entry
from sssgen.material.level_assembly import assemble_levels
from sssgen.material.shell_assembly import add_shell, without_unread_parameters
from sssgen.passes.cost import cost_of
from sssgen.passes.fold import fold
from sssgen.passes.guards import guard
from sssgen.passes.hoist import hoist
from sssgen.passes.late_constants import late_constants
from sssgen.passes.legal.legalise import legalise
from sssgen.passes.link import link
from sssgen.passes.names import Rules, rename
from sssgen.passes.prune import prune
from sssgen.passes.reachable import drop_unused, keep_reachable
from sssgen.passes.stage.atomic_places import check_atomics
from sssgen.passes.stage.host_uniforms import group_count_to_uniform, lengths_to_uniforms
from sssgen.passes.stage.initial_values import set_at_start, set_in_functions
from sssgen.passes.stage.interface_arrays import interface_arrays
from sssgen.passes.stage.stage_interface import (
    ENTRY,
    Matching,
    entry_of,
    interface,
    remarks,
)
from sssgen.passes.stage.storage_images import check_images
from sssgen.passes.stage.storage_layout import check_buffers, read_buffers, with_read_access
from sssgen.passes.stage.uniform_structs import uniform_structs
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.stage.varying_parts import varying_parts
from sssgen.passes.stage.varyings import interpolated_alike, mismatches
from sssgen.passes.undefined_constants import undefined_constants
from sssgen.passes.unsupported import Unsupported
from sssgen.pipeline.material_stages import slot_functions, stages_for
from sssgen.pipeline.state import State
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.targets import registry
from sssgen.targets.descriptor import Names
from sssgen.targets.registry import ReservedNames
from sssgen.targets.used_frame import OF_A_LIGHT, PER_LIGHT


def on_module(change: Callable[[Module], Module]) -> Callable[[State], Module]:
    """The step of a pass that needs the module alone."""
    return lambda state: change(state.module)


# The beginning of a material


def link_stages(state: State) -> Module:
    material = state.material
    assert material is not None
    state.stages = stages_for(material, state.target)
    linked = link([stage.link for stage in state.stages], TAKEN)
    own = range(len(material.stages))
    state.linked, state.fixed, state.owners = linked.functions, linked.fixed, linked.owners
    state.settings = {
        name: [(number, old) for number, old in places if number in own] for name, places in linked.settings.items()
    }
    state.slots = slot_functions(material, linked.module)
    return linked.module


def assemble_chain(state: State) -> Module:
    material = state.material
    assert material is not None
    stages = [
        ChainFunction(
            stage.link.role,
            stage.link.technique,
            function,
            stage.span,
            stage.glows,
            stage.uv,
            stage.link.levels,
            stage.at_rest,
        )
        for stage, function in zip(state.stages, state.linked, strict=True)
    ]
    lit, opaque = material.shading == "lit", material.alpha_mode == "opaque"
    chain = assemble_levels(state.module, stages, material.levels, lit, opaque)
    state.entries, state.surface = dict(chain.entries), chain.surface
    state.roots = [entry.function.key for entry in chain.entries.values()]
    return chain.module


def write_shell(state: State) -> Module:
    material = state.material
    assert material is not None
    target = state.target
    mesh = not target.own_body
    facts = {"two_sided": material.two_sided and mesh, "masked": material.alpha_mode == "mask" and mesh}
    module, shell = add_shell(
        state.module, state.entries, state.surface, facts, target.fragment_shell, target.given_inputs
    )
    state.roots.append(shell.key)
    return module


def find_frame(state: State) -> Module:
    old = next(function for function in state.module.functions if function.key == state.roots[-1])
    shell = without_unread_parameters(old)
    state.shell = Entry(shell, tuple([param.name for param in shell.params]))
    state.roots[-1] = shell.key
    return state.module._replace(
        functions=tuple([shell if function is old else function for function in state.module.functions])
    )


# The beginning of plain GLSL


def match_partner(state: State) -> Module:
    assert state.partner is not None
    is_vertex = state.form == "vertex"
    vertex, fragment = (state.module, state.partner) if is_vertex else (state.partner, state.module)
    errors = mismatches(vertex, fragment)
    if errors:
        raise Unsupported(errors[0].message, errors[0].span, errors[1:], errors[0].hint)
    return interpolated_alike(vertex, fragment) if is_vertex else fragment


def split_varyings(state: State) -> Module:
    if state.partner is not None:
        state.partner = varying_parts(state.partner)
    return varying_parts(state.module)


def note_differences(state: State) -> Module:
    differences = remarks(
        state.module, state.form, state.stage_builtins, state.y_down, state.target.capabilities, state.partner is None
    )
    state.notes += differences
    return state.module


def drop_uncalled(state: State) -> Module:
    return drop_unused(keep_reachable(state.module, state.called or ()), state.whole_shader)


def find_roots(state: State) -> Module:
    state.roots = [function.key for function in state.module.functions if function.body is not None]
    return state.module


# For both


def fold_constants(state: State) -> Module:
    return fold(state.module, state.fixed)


def split_uniforms(state: State) -> Module:
    return uniform_structs(state.module, state.keeps_structs)


def refuse_undefined_constants(state: State) -> Module:
    wrong = undefined_constants(state.module)
    if wrong:
        hint = "WGSL refuses it, and the others compute inf, NaN or any value"
        raise SssgenError([Diagnostic("error", message, span, hint, source_line(span)) for message, span in wrong])
    return state.module


def compute_constants_late(state: State) -> Module:
    module, notes = late_constants(state.module)
    state.notes += notes
    return module


def prune_unused(state: State) -> Module:
    return prune(state.module, state.roots)


def hoist_derivatives(state: State) -> Module:
    module, notes = hoist(state.module, state.roots, _called_for_lights_of_a_cluster(state))
    state.notes += notes
    return module


def hoist_derivatives_of_entry(state: State) -> Module:
    """The same, where the functions that main() calls are called from there alone."""
    module, notes = hoist(state.module, _called_from_outside(state.module, state.roots))
    state.notes += notes
    return module


def _called_for_lights_of_a_cluster(state: State) -> list[str]:
    """The keys of the entries that the engine's shell calls in a loop whose length differs from pixel to pixel."""
    if state.chosen is None or not state.chosen.clustered_lights:
        return []
    entries = [entry for kind, entry in state.entries.items() if kind in PER_LIGHT]
    return [entry.function.key for entry in entries if not OF_A_LIGHT.isdisjoint(entry.inputs)]


def _called_from_outside(module: Module, roots: list[str]) -> list[str]:
    """The `roots` of a whole shader that are not called by main() alone, and main(); of other modules, all of them."""
    entry = entry_of(module)
    if entry is None:
        return roots
    reached = {function.key for function in keep_reachable(module, [entry.key]).functions}
    return [entry.key, *(key for key in roots if key not in reached)]


def insert_guards(state: State) -> Module:
    called = list(state.called or _called_from_outside(state.module, state.roots))
    if state.form == "functions":
        remaining = {function.key for function in state.module.functions}
        called += [function.key for function in state.linked if function.key in remaining]
    state.guarded = guard(
        state.module, called, state.guards, guard_source, polyfill, state.format, state.guard_action,
        state.chained or state.material is not None,
    )  # fmt: skip
    return state.guarded.module


def count_cost(state: State) -> Module:
    state.costs = {
        kind: cost_of(state.module, entry.function.key, state.slots) for kind, entry in state.entries.items()
    }
    return state.module


# For one target


def compute_variables_in_functions(state: State) -> Module:
    capabilities = state.target.capabilities
    return set_in_functions(state.module, capabilities.module_variables, capabilities.variable_values)


def pass_variables(state: State) -> Module:
    return variables_to_parameters(state.module, _start(state))


def set_variables_at_start(state: State) -> Module:
    return set_at_start(state.module, _start(state))


def _start(state: State) -> str:
    return ENTRY if entry_of(state.module) is not None else ""


def replace_interface_arrays(state: State) -> Module:
    return interface_arrays(state.module, state.form, _start(state), state.target.capabilities)


def pass_host_uniforms(state: State) -> Module:
    module = state.module
    if not state.target.capabilities.buffer_lengths:
        module, notes = lengths_to_uniforms(module)
        state.notes += notes
    if "gl_NumWorkGroups" not in state.stage_builtins:
        module, notes = group_count_to_uniform(module)
        state.notes += notes
    return module


def check_shared_memory(state: State) -> Module:
    if not state.target.capabilities.plain_atomics:
        check_atomics(state.module)
    module = check_buffers(with_read_access(state.module), state.target.capabilities)
    module = check_images(module, state.form, state.target.capabilities)
    is_reader = state.form == "vertex" and not state.target.capabilities.vertex_buffer_writes
    return read_buffers(module) if is_reader else module


def legalise_nodes(state: State) -> Module:
    capabilities = state.target.capabilities
    if state.keep:  # kept operators have the meaning of GLSL, in which some results are undefined
        capabilities = capabilities._replace(integer_division=True)
    return legalise(state.module, state.target.dialect, capabilities, polyfill)


def make_names_legal(state: State) -> Module:
    target = state.target
    others = registry.reserved_of(target.language) if state.keep else registry.reserved_everywhere()
    local = target.names.local | BUILTINS.keys() if target.names.builtins else target.names.local
    rules = Rules(
        reserved=_reserved_names(state, others),
        reserved_folded=others.folded | target.names.folded,
        reserved_at_file_scope=local,
        capabilities=target.capabilities,
        uniform_name=_uniform_style(target.uniform_style),
        uniforms_declared=state.form not in target.parameters,
        prefix=target.prefix,
        uniform_ports=state.form == "shader" and bool(target.ports),
    )
    module, state.renames = rename(state.module, rules)
    functions = zip(module.functions, state.module.functions, strict=True)
    final = {old.key: new.name for new, old in functions}
    state.frame_names = {name: final[function.key] for name, function in state.frame_functions.items()}
    names = zip(module.uniforms, state.module.uniforms, strict=True)
    state.source_names = {new.name: old.name for new, old in names}
    variables = zip(module.variables, state.module.variables, strict=True)
    state.variable_names = {new.name: old.name for new, old in variables}
    return module


def _reserved_names(state: State, others: Names) -> ReservedNames:
    """The names that are not free: those of the target and of `others`, whose names its texts avoid, too.

    A shader whose entry is the author's `main` has that name, without a shell around it.
    """
    own = state.target.names
    names, prefixes = others.exact | own.exact | own.private, others.prefixes + own.prefixes
    if state.entry_name == "main":
        return ReservedNames(names - own.shell - {"main"}, prefixes)
    return ReservedNames(names | {"main", state.entry_name}, prefixes)


def _uniform_style(style: str) -> Callable[[str], str]:
    if style == "unity":
        return lambda name: "_" + "".join(word[:1].upper() + word[1:] for word in name.split("_"))
    return lambda name: name


def find_interface(state: State) -> Module:
    main = state.renames.get(ENTRY) or state.renames.get("main", "main")
    matching = Matching(state.variable_names, state.partner, state.target.capabilities.subset_varyings)
    entries = (
        function.key
        for function in state.module.functions
        if function.name == main and all(param.passes for param in function.params)
    )
    stage = interface(state.module, state.form, next(entries), state.stage_builtins, state.y_down, matching)
    upends = state.form == "vertex" and state.turned_framebuffer and state.bottom_first
    state.stage = stage._replace(upends=upends)
    return state.module
