"""The stages of a material that a target needs."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.nodes import Module, Span
from sssgen.material import library
from sssgen.material.model import Material, Stage
from sssgen.passes.link import LinkStage
from sssgen.targets.descriptor import Target


class TargetStage(NamedTuple):
    """A stage of the chain for a target."""

    link: LinkStage
    span: Span
    """The place that names it."""
    number: int
    """Its position in the material; a stage that the target adds comes after all of them."""
    glows: bool = False
    """Whether its technique is documented to glow: its light needs no lamp."""


def stages_for(material: Material, target: Target) -> list[TargetStage]:
    """The material's stages without what the engine does, with the lighting that the target adds."""
    stages = [
        TargetStage(_link_stage(stage), stage.span, number, stage.technique.attributes.glows)
        for number, stage in enumerate(material.stages)
    ]
    lit = material.shading == "lit"
    if lit and target.lighting and all(stage.link.role != "lighting" for stage in stages):
        technique = library.load(target.lighting)
        added = LinkStage(technique.name, "lighting", technique.module, technique.function, {}, {}, frozenset())
        stages.append(TargetStage(added, technique.function.span, len(stages)))
    engine = {"lighting"} if lit and not target.lighting else set()
    engine |= {"output"} if target.engine_encodes else set()
    return [stage for stage in stages if stage.link.role not in engine]


def _link_stage(stage: Stage) -> LinkStage:
    technique = stage.technique
    bindings = {name: (binding.module, binding.function) for name, binding in stage.bindings.items()}
    return LinkStage(
        technique.name, technique.role, technique.module, technique.function, bindings, stage.values, stage.fixed
    )


def slot_functions(material: Material, module: Module) -> frozenset[str]:
    """The keys of the linked functions that are bound to slots: the static cost counts their evaluations."""
    bound = {binding.function.span for stage in material.stages for binding in stage.bindings.values()}
    return frozenset(function.key for function in module.functions if function.span in bound)
