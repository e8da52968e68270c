"""Translates the two stages of a program together: one interface, one set of uniforms, one reflection."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Module
from sssgen.lang.source_lines import source_line
from sssgen.passes.reachable import drop_unused, keep_reachable
from sssgen.passes.stage.linked_memory import unlike_memory, with_shared_memory, without_unused_memory
from sssgen.passes.stage.linked_stages import (
    disagreements,
    link_program,
    passed_textures,
    sampled_textures,
    unlike_blocks,
    unlike_locations,
    unlike_orders,
    with_common_names,
    with_shared_uniforms,
)
from sssgen.passes.stage.stage_interface import ENTRY, stage_kind
from sssgen.passes.unsupported import Unsupported
from sssgen.pipeline import pass_list
from sssgen.pipeline.compiler import emit_program
from sssgen.pipeline.programs import check_guards, check_partner, target_program
from sssgen.pipeline.state import State
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.gc_pause import pause_gc
from sssgen.targets import registry
from sssgen.targets.assemble import About
from sssgen.targets.block_places import block_members
from sssgen.targets.descriptor import Target
from sssgen.targets.program_reflection import ROWS, StageFacts, exceeded_limits, reflect_program
from sssgen.targets.reflection import as_text


class Source(NamedTuple):
    """One stage as it was loaded."""

    module: Module
    head: Sequence[str] = ()
    """The comment lines at the head of its file."""


class TranslatedProgram(NamedTuple):
    """A program for one target."""

    files: dict[str, str]
    """File name → text: a file a stage, and `NAME.program.json`, which is the last."""
    warnings: list[Diagnostic]
    renames: tuple[dict[str, str], dict[str, str]]
    """Of each source, in the order in which they were given: a name in it → the new one."""


def transpile_stages(
    first: Source, second: Source, target: str, name: str, guards: str = "none", rows: str = ROWS[0]
) -> TranslatedProgram:
    """Both stages of a program, in any order, and their common reflection.

    Functions, uniforms, attributes and values between the stages that the program does not use are left out, as a
    linker does. `rows` is one of ROWS: with `bottom-first`, pictures have the rows of OpenGL and WebGL, so that
    gl_FragCoord, dFdy and textures that were drawn before mean the same as there. Raises SssgenError.
    """
    kinds = stage_kind(first.module), stage_kind(second.module)
    check_partner(*kinds)
    sources = {"vertex": first, "fragment": second} if kinds[0] == "vertex" else {"vertex": second, "fragment": first}
    chosen = registry.load(target)._replace(prefix="", material_group=0)
    if any(kind not in chosen.files for kind in sources):
        able = [name for name in registry.names() if "vertex" in registry.load(name).files]
        raise failure(f"{target} has no whole shaders of plain GLSL", f"they go to {', '.join(able)}")
    for source in sources.values():
        check_guards(source.module, guards)
    with pause_gc():
        blocks = {kind: block_members(source.module) for kind, source in sources.items()}
        modules = {kind: drop_unused(keep_reachable(source.module, [ENTRY]), True) for kind, source in sources.items()}
        wrong = disagreements(modules["vertex"], modules["fragment"])
        for unlike in (unlike_blocks, unlike_orders, unlike_locations, unlike_memory):
            wrong += unlike(sources["vertex"].module, sources["fragment"].module)
        if wrong:
            raise SssgenError([_error(each.message, each) for each in wrong])
        modules["vertex"], modules["fragment"] = link_program(modules["vertex"], modules["fragment"])
        modules = _with_shared_memory(modules, chosen)
        if not chosen.capabilities.varying_locations:
            modules["vertex"], modules["fragment"] = with_common_names(modules["vertex"], modules["fragment"])
        states = _states(modules, guards, chosen, rows)
        own = {kind: {uniform.name for uniform in state.module.uniforms} for kind, state in states.items()}
        sampled = {kind: sampled_textures(state.module) for kind, state in states.items()}
        shared = with_shared_uniforms(states["vertex"].module, states["fragment"].module)
        uniforms = {kind: module.uniforms for kind, module in zip(states, shared, strict=True)}
        facts: dict[str, StageFacts] = {}
        files: dict[str, str] = {}
        warnings: list[Diagnostic] = []
        renames: dict[str, dict[str, str]] = {}
        for (kind, state), module in zip(states.items(), shared, strict=True):
            if chosen.layout:
                state.module = module
            about = About(name, name, head=tuple(sources[kind].head))
            program = target_program(state)._replace(about=about)
            given = passed_textures(state.module)  # the target's passes make functions, too
            final = zip(uniforms[kind], state.module.uniforms, strict=True) if chosen.layout else ()
            passed = {uniform.name for uniform, named in final if named.name in given}
            compiled = emit_program(program, chosen, kind)
            reflection = compiled.reflection
            *texts, _ = compiled.files.items()
            files |= dict(texts)
            warnings += compiled.warnings
            renames[kind] = reflection["renames"]
            facts[kind] = StageFacts(
                program,
                reflection,
                state.variable_names,
                uniforms[kind],
                own[kind],
                sampled[kind],
                passed,
                blocks[kind],
            )
    described = reflect_program(name, chosen, rows, facts["vertex"], facts["fragment"])
    beyond = exceeded_limits(described, chosen)
    described["warnings"] += beyond
    warnings += [Diagnostic("warning", message) for message in beyond]
    files[f"{name}.program.json"] = as_text(described)
    return TranslatedProgram(files, list(dict.fromkeys(warnings)), (renames[kinds[0]], renames[kinds[1]]))


def _with_shared_memory(modules: Mapping[str, Module], target: Target) -> dict[str, Module]:
    """The stages with the storage buffers and images that they use, alike in both. Raises SssgenError."""
    vertex, fragment = [without_unused_memory(modules[kind]) for kind in ("vertex", "fragment")]
    try:
        vertex, fragment = with_shared_memory(vertex, fragment, target.capabilities)
    except Unsupported as error:
        raise SssgenError([_error(f"{error.message} ({target.name})", error)]) from None
    return {"vertex": vertex, "fragment": fragment}


def _error(message: str, error: Unsupported) -> Diagnostic:
    return Diagnostic("error", message, error.span, error.hint, source_line(error.span))


def _states(modules: Mapping[str, Module], guards: str, target: Target, rows: str) -> dict[str, State]:
    """The states after the passes of plain GLSL, without what no function needs. Raises SssgenError for both stages."""
    states: dict[str, State] = {}
    errors: list[Diagnostic] = []
    for kind, module in modules.items():
        partner = modules["fragment" if kind == "vertex" else "vertex"]
        state = State(module, kind, guards, target, keep=True, partner=partner, bottom_first=rows == ROWS[0])
        try:
            states[kind] = pass_list.run(pass_list.KEPT, state)
        except SssgenError as error:
            errors += error.diagnostics
        else:
            state.module = drop_unused(state.module, True)  # members of structs became uniforms
    if errors:
        raise SssgenError(errors)
    return states
