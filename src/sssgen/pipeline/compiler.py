"""From a material to shader text: its program (`programs`), the values of its parameters, the target's templates.

A program is cached under everything that it depends on. The values of free parameters are not part of this: they
appear only in declarations, in an engine's properties and in the reflection. So a variant of a material runs no pass.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from sssgen.ir.nodes import Module, Uniform
from sssgen.ir.types import kind_of
from sssgen.lang.loader import key_of
from sssgen.material import library
from sssgen.material.bake_commands import needs
from sssgen.material.model import Material, TechniqueUse
from sssgen.material.requirements import bodies
from sssgen.passes.names import check_prefix
from sssgen.pipeline.emitted_cache import installation
from sssgen.pipeline.material_facts import facts_of
from sssgen.support import cache
from sssgen.support.diagnostics import Diagnostic, SssgenError, UnsupportedError, did_you_mean, failure
from sssgen.support.gc_pause import pause_gc
from sssgen.support.paths import place
from sssgen.targets import registry
from sssgen.targets.assemble import About, Program, emit
from sssgen.targets.descriptor import Embedded, Target
from sssgen.targets.reflection import as_text, reflect

if TYPE_CHECKING:
    from sssgen.passes.ranges.sites import Site
    from sssgen.pipeline.trace import Trace
    from sssgen.targets.reflection_record import Reflection

FORMS = ("shader", "functions")
GUARDS = ("auto", "all", "none")
"""Which operations that can fail get a guard: those not proven safe, all of them, none."""


class Compiled(NamedTuple):
    """The files of one material for one target."""

    files: dict[str, str]
    """File name → text; `NAME.TARGET.reflection.json` among them, at the end."""
    warnings: list[Diagnostic]

    @property
    def reflection(self) -> Reflection:
        """The reflection, parsed at each access; the caller may change it."""
        import json

        reflection: Reflection = json.loads(list(self.files.values())[-1])
        return reflection


_compiled: dict[tuple[int, str, str, str, str, bool], tuple[Material, Compiled]] = {}
_programs: dict[tuple[str, str, str, str, str], Program] = {}
_CACHE_SIZE = 128


def all_targets() -> dict[str, Target]:
    """Every target by name, plug-ins too."""
    return {name: registry.load(name) for name in registry.names()}


def compile(
    material: Material | str | os.PathLike[str],
    target: str,
    form: str = "shader",
    templates: str | os.PathLike[str] | None = None,
    guards: str = "auto",
    trace: Trace | None = None,
    prefix: str = "",
    standalone: bool = False,
) -> Compiled:
    """Compiles a material for a target.

    `material` is a checked material, the path of a material file, or the name of an example; `form` is `shader` (a
    complete shader) or `functions` (a library to paste); `templates` is a folder whose templates replace those of the
    same name; `guards` are added where they are needed (`auto`), everywhere (`all`), or nowhere (`none`).
    `trace` records the IR after each pass; then no cache is used. `prefix` begins every global name of the text, to fit
    in other people's shaders; whole shaders have one only where the target declares it. A module for the web imports
    the runtime of its engine from a file that all materials share; a `standalone` module contains it.
    Raises SssgenError for anything wrong with the input.

    >>> import sssgen
    >>> shader = sssgen.compile("paper_lantern", "glsl-330")
    >>> sorted(shader.files)[0]
    'paper_lantern.glsl-330.frag'
    """
    if not isinstance(material, Material):
        from sssgen.material.material_loading import load_material

        material = load_material(material)
    if form not in FORMS:
        raise failure(f"unknown form '{form}'", did_you_mean(form, FORMS) or "forms: shader, functions")
    _check_guards(guards)
    facts = facts_of(material)
    chosen = _with_prefix(registry.load(target).for_material(facts), prefix, form, material.name)
    if form not in chosen.files:
        hint = f"its forms: {', '.join([one for one in FORMS if one in chosen.files])}"
        raise UnsupportedError(failure(f"{chosen.title} has no form '{form}'", hint).diagnostics)
    key = (id(material), target, form, guards, prefix, standalone)
    cached = _compiled.get(key) if templates is None and trace is None else None
    if cached is not None and cached[0] is material:
        return _copy(cached[1])
    program = _program_of(material, chosen, form, guards, trace)._replace(about=_about(material))
    if chosen.embedded:
        inner = {name: _inner(chosen, embedded) for name, embedded in chosen.embedded.items()}
        others = {name: (one, _program_of(material, one, form, guards, None)) for name, one in inner.items()}
        program = program._replace(embedded=others)
    compiled = emit_program(program, chosen, form, os.fspath(templates) if templates else None, standalone)
    if templates is None:
        if len(_compiled) >= _CACHE_SIZE:
            _compiled.clear()
        _compiled[key] = material, compiled
    return _copy(compiled)


def _with_prefix(target: Target, prefix: str, form: str, material: str) -> Target:
    """The target with that prefix of global names. Raises SssgenError for a prefix that cannot be."""
    if not prefix and "{material}" in target.prefix:
        return target._replace(prefix=target.prefix.format(material=material) if form == "shader" else "")
    if not prefix:
        return target
    if form != "functions" and not target.prefix:
        raise without_prefix([target.name])
    return target._replace(prefix=check_prefix(prefix, registry.reserved_everywhere().prefixes))


def without_prefix(targets: Sequence[str]) -> SssgenError:
    """The one error for a prefix of whole shaders that have none."""
    message = f"--prefix is for text that is pasted into other shaders; whole shaders take none: {', '.join(targets)}"
    return failure(message, "leave the prefix out, or add --form functions")


def _inner(target: Target, embedded: Embedded) -> Target:
    """The target of an embedded text: that language under the outer target's engine."""
    return registry.load(embedded.target)._replace(
        name=f"{target.name}.{embedded.target}", inputs=embedded.inputs, light_inputs=embedded.light_inputs,
        frame=embedded.frame, surface=embedded.surface, absent=embedded.absent, reads=embedded.reads,
        variants=embedded.variants, spelling=embedded.spelling, arguments=embedded.arguments,
        lighting=target.lighting, fragment_shell=target.fragment_shell, engine_encodes=target.engine_encodes,
        clustered_lights=target.clustered_lights,
        parameters=target.parameters,
        prefix=target.prefix, properties=target.properties,
    )  # fmt: skip


def _copy(compiled: Compiled) -> Compiled:
    """A copy for the caller, who may change it; the cached one stays the same."""
    return Compiled(dict(compiled.files), list(compiled.warnings))


def transpile(
    module: Module, target: str, name: str, guards: str = "none", called: Sequence[str] | None = None,
    at: Callable[[Site], str] | None = None, chained: bool = False, keep: bool = False, head: Sequence[str] = (),
    trace: Trace | None = None, partner: Module | None = None,
) -> Compiled:  # fmt: skip
    """The functions form of a module of plain functions (no chain), or a whole shader where it has a `void main()`.

    This is what `sssgen transpile` writes. With `keep` the text stays as its author wrote it, except where the target
    has no such construct, and `called` only omits functions. `head` are the comment lines at the head of the source.

    `called` are the keys of the functions that are called from outside, with any argument that their types allow; None
    means all. `chained` means that they are techniques, whose parameters have the meaning of their names. `at` is the
    parameter of `passes.guards.guard`. `partner` is the other stage of a whole shader: the two then agree on what the
    vertex shader passes to the fragment shader, also where the latter declares less.
    """
    from sssgen.pipeline.programs import make_library

    _check_guards(guards)
    chosen = registry.load(target)._replace(prefix="")  # the names are the author's
    about = About(name, name, head=tuple(head))
    with pause_gc():
        program = make_library(module, chosen, guards, called, at, chained, keep, trace, partner)._replace(about=about)
        inner = {name: _inner(chosen, embedded) for name, embedded in chosen.embedded.items()}
        others = {
            name: (one, make_library(module, one, guards, called, at, chained, keep)) for name, one in inner.items()
        }
        program = program._replace(embedded=others)
        return emit_program(program, chosen, program.stage.kind if program.stage else "functions", None)


def guarded_sites(material: Material, target: str = "glsl-330", form: str = "shader") -> list[Site]:
    """Every operation with a domain in a material's program, and what the range analysis proved of it.

    Raises SssgenError.
    """
    from sssgen.pipeline.programs import analyse_material

    return list(analyse_material(material, registry.load(target), form).sites)


def _check_guards(guards: str) -> None:
    if guards not in GUARDS:
        raise failure(f"unknown guards '{guards}'", did_you_mean(guards, GUARDS) or "guards: auto, all, none")


def _program_of(material: Material, target: Target, form: str, guards: str, trace: Trace | None) -> Program:
    """The program of a material, with the material's values as the uniforms' defaults."""
    fixed = {name for stage in material.stages for name in stage.fixed}
    structural = material._replace(stages=tuple([_bare(stage, fixed) for stage in material.stages]))
    structure = _structure(structural, target) if trace is None else ""
    key = (structure, target.name, form, guards, target.prefix)
    program = _programs.get(key) if structure else None
    if program is None:
        program = _cached_program(structural, structure, target, form, guards, trace)
        if len(_programs) >= _CACHE_SIZE:
            _programs.clear()
        _programs[key] = program
    uniforms = tuple([_with_value(uniform, program, material) for uniform in program.module.uniforms])
    return program._replace(module=program.module._replace(uniforms=uniforms))


def _cached_program(
    structural: Material, structure: str, target: Target, form: str, guards: str, trace: Trace | None
) -> Program:
    """A program from the cache folder, or a new one. One entry per material file, target, form and guards is kept."""

    def make_program() -> Program:
        from sssgen.pipeline.programs import make

        return make(structural, structure, target, form, guards, trace)

    if not structure or target.folder != place("targets"):  # it is unknown which files a plug-in's program depends on
        return make_program()
    name = "\0".join([os.path.abspath(structural.file), target.name, form, guards, target.prefix])
    program: Program = cache.load_or_make(f"program-{cache.digest(name)}", [installation(), structure], make_program)
    return program


def _bare(stage: TechniqueUse, fixed: set[str]) -> TechniqueUse:
    """A stage without the values that no pass reads."""
    modules = [stage.technique.module, *(binding.module for binding in stage.bindings.values())]
    uniforms = [uniform for module in modules for uniform in module.uniforms]
    read = fixed | {uniform.name for uniform in uniforms if kind_of(uniform.type) in ("int", "uint")}
    return stage._replace(values={name: value for name, value in stage.values.items() if name in read})


def _structure(structural: Material, target: Target) -> str:
    """Everything that the program of a material depends on, as text; '' where this is unknown."""
    modules = [library.load(target.lighting).module] if target.lighting else []
    parts: list[object] = [
        structural.shading,
        structural.alpha_mode,
        structural.two_sided,
        structural.surroundings,
        structural.levels,
    ]
    for stage in structural.stages:
        technique, bindings = stage.technique, stage.bindings
        modules += [technique.module, *(binding.module for binding in bindings.values())]
        functions = [(slot, binding.function.key) for slot, binding in bindings.items()]
        values, fixed = sorted(stage.values.items()), sorted(stage.fixed)
        parts.append((technique.name, technique.role, functions, values, fixed, stage.span, stage.uv, stage.levels))
        parts.append(sorted(stage.textures.items()) if stage.levels else None)
    keys = [key_of(module) for module in modules]
    return repr((parts, keys)) if all(keys) else ""


def _with_value(uniform: Uniform, program: Program, material: Material) -> Uniform:
    """A uniform with the value that the material gives it."""
    for index, name in reversed(program.settings.get(program.source_names[uniform.name], ())):
        value = material.stages[index].values.get(name)
        if value is not None:
            return uniform._replace(default=value)
    return uniform


def _about(material: Material) -> About:
    return About(
        material.name,
        material.title,
        material.doc,
        material.shading,
        material.alpha_mode,
        material.two_sided,
        frozenset(facts_of(material)),
        material.makes_rays,
        bodies=tuple(bodies(material.stages)),
        needs=needs(material),
    )


def emit_program(
    program: Program, target: Target, form: str, templates: str | None = None, standalone: bool = False
) -> Compiled:
    """The files of a program."""
    emitted = emit(target, program, form, templates, standalone)
    files = dict(emitted.files)
    suffix = "reflection" if form == "shader" else f"{form}.reflection"
    files[f"{program.about.name}.{target.name}.{suffix}.json"] = as_text(reflect(target, program, emitted, form))
    return Compiled(files, program.warnings)
