"""The stages of a material that a target needs."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.frame_passes import VOLUMES, pass_name
from sssgen.ir.nodes import Module, Span
from sssgen.lang.source_lines import source_line
from sssgen.material import library
from sssgen.material.chain_assembly import IRRADIANCE, SURROUNDINGS
from sssgen.material.model import Material, TechniqueUse
from sssgen.material.requirements import read_uniforms
from sssgen.material.unwritten import unwritten, with_constants
from sssgen.passes.link import LinkInput
from sssgen.support.diagnostics import Diagnostic, UnsupportedError
from sssgen.targets.descriptor import Target

_AROUND = {"translucency": SURROUNDINGS, "environment": IRRADIANCE}
"""The role of a technique's second function."""


class TargetTechnique(NamedTuple):
    """A stage of the chain for a target."""

    link: LinkInput
    span: Span
    """The place that names it."""
    glows: bool = False
    """Whether its technique is documented to glow: its light needs no lamp."""
    uv: str = "uv"
    """The set of texture coordinates that it reads."""
    at_rest: bool = False
    """Whether it reads a volume of the body's rest pose."""


def stages_for(material: Material, target: Target) -> list[TargetTechnique]:
    """The material's stages without what the engine does, with the lighting that the target adds."""
    lit = material.shading == "lit"
    bends = lit and target.has_rest_pose
    transmits = lit and material.surroundings and target.has_surroundings
    stages = []
    for number, stage in enumerate(material.stages):
        link = _link_input(stage, number)
        at_rest = bends and any(pass_name(uniform) in VOLUMES for uniform in read_uniforms(stage))
        stages.append(TargetTechnique(link, stage.span, stage.technique.attributes.glows, stage.uv, at_rest))
        around = stage.technique.surroundings
        if transmits and around is not None:
            role = _AROUND[link.role]
            added = link._replace(role=role, function=around)
            stages.append(TargetTechnique(added, stage.span, role == SURROUNDINGS, stage.uv))
    if lit and target.lighting and all(stage.link.role != "lighting" for stage in stages):
        technique = library.load(target.lighting)
        added = LinkInput(
            technique.name, "lighting", technique.module, technique.function, {}, {}, frozenset(), len(material.stages)
        )
        stages.append(TargetTechnique(added, technique.function.span))
    engine = {"lighting"} if lit and not target.lighting else set()
    engine |= {"output"} if target.engine_encodes else set()
    stages = [stage for stage in stages if stage.link.role not in engine]
    absent = unwritten([stage.link.function for stage in stages])
    return [
        stage._replace(link=link._replace(function=with_constants(link.function, link.module, absent)))
        for stage in stages
        if (link := stage.link)
    ]


def check_values(material: Material, target: Target) -> None:
    """Raises UnsupportedError for stages that write a value of the surface which the target's engine lacks.

    A stage has one error, for the first of these values.
    """
    wrong = []
    for stage in material.stages if material.shading == "lit" else ():
        written = [param.name for param in stage.technique.function.params if param.direction != "in"]
        lacking = [name for name in written if name in target.lacks]
        if lacking:
            message = f"{target.title} has no '{lacking[0]}', which '{stage.technique.name}' gives"
            wrong.append(Diagnostic("error", message, stage.span, target.lacks[lacking[0]], source_line(stage.span)))
    if wrong:
        raise UnsupportedError(wrong)


def check_shell(material: Material, target: Target) -> None:
    """Raises UnsupportedError for stages that add to a shell, where the target's engine has that itself."""
    wrong = [
        Diagnostic("error", f"{target.title} does not take a material's [{role}]{_WHY[bool(target.shell)]}", stage.span,
                   f"leave it out for this target: --shell {role}=none", source_line(stage.span))
        for stage in material.stages
        if (role := stage.technique.role) in library.OF_SHELLS and role not in target.shell
    ]  # fmt: skip
    if wrong:
        raise UnsupportedError(wrong)


_WHY = {False: ": the engine does this", True: ": its shell cannot carry it"}


def _link_input(stage: TechniqueUse, number: int) -> LinkInput:
    technique = stage.technique
    bindings = {name: (binding.module, binding.function) for name, binding in stage.bindings.items()}
    return LinkInput(
        technique.name,
        technique.role,
        technique.module,
        technique.function,
        bindings,
        stage.values,
        stage.fixed,
        number,
        stage.levels,
        stage.textures,
    )


def slot_functions(material: Material, module: Module) -> frozenset[str]:
    """The keys of the linked functions that are bound to slots: the static cost counts their evaluations."""
    bound = {binding.function.span for stage in material.stages for binding in stage.bindings.values()}
    return frozenset(function.key for function in module.functions if function.span in bound)
