"""A picked chain as a material, with the parameters that were fitted to the scene's medium."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import components, kind_of
from sssgen.lab.chart.charting import candidate_of
from sssgen.lab.chart.levels import Level
from sssgen.lab.chart.picking import Pick
from sssgen.lab.measure.candidates import load
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.material import library
from sssgen.material.baked import ParameterValue
from sssgen.material.library import Technique
from sssgen.material.material_text import MaterialSection, material_text
from sssgen.material.slots import needs
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.scene_body import Body, body


def material_files(scene: MeasuredScene, picked: Pick, name: str) -> dict[str, str]:
    """The material's file and the files that it refers to, for the same folder: name → text."""
    shape = body(scene.geometry)
    stages: list[MaterialSection] = []
    if picked.coordinates is not None and picked.coordinates["name"] != "none":
        stages += _coordinates(scene, picked.coordinates, shape)
    return _files(scene, name, [*stages, *_chain_stages(scene, picked.chain, shape)])


def level_files(scene: MeasuredScene, levels: Sequence[Level], name: str) -> dict[str, str]:
    """The same for a material with levels of detail; its `doc` has the distances of each."""
    shape = body(scene.geometry)
    stages = by_level([_chain_stages(scene, level.point, shape) for level in levels])
    ranges = (f"level {number}: {level.range_text}" for number, level in enumerate(levels))
    distances = f" Distances, 1 is that of the scene's camera: {'; '.join(ranges)}." if len(levels) > 1 else ""
    return _files(scene, name, stages, distances, len(levels))


def by_level(levels: Sequence[Sequence[MaterialSection]]) -> list[MaterialSection]:
    """The stages of all levels. Each level has its own stages in their order; equal ones of several levels are one."""
    result: list[MaterialSection] = []
    for level, stages in enumerate(levels):
        end = len(result)
        for stage in reversed(stages):
            alike = (index for index in reversed(range(end)) if result[index]._replace(levels=()) == stage)
            index = next(alike, None)
            if index is None:
                result.insert(end, stage._replace(levels=(level,)))
            else:
                result[index] = result[index]._replace(levels=(*result[index].levels, level))
                end = index
    everywhere = tuple(range(len(levels)))
    return [stage._replace(levels=()) if stage.levels == everywhere else stage for stage in result]


def _chain_stages(scene: MeasuredScene, chain: FittedChain | None, shape: Body) -> list[MaterialSection]:
    """The stages of a chain with its reflection."""
    stages = stages_of(chain, shape, scene.medium) if chain is not None else []
    matte = chain["matte"] if chain is not None else [1.0, 1.0, 1.0]
    return [*stages, _surface("albedo", [*matte, 1.0]), _surface("roughness", 1.0)]


def _files(
    scene: MeasuredScene, name: str, stages: Sequence[MaterialSection], more: str = "", levels: int = 1
) -> dict[str, str]:
    doc = f"Picked for the scene {scene.name}: {scene.title}.{more}"
    used = {bound for stage in stages for _, bound in stage.bind}
    shapes = body(scene.geometry).files.items()
    files = {file: text for file, text in shapes if any(bound.startswith(file) for bound in used)}
    settings = {"levels": levels} if levels > 1 else {}
    return {f"{name}.toml": material_text(name, stages, scene.title, doc, settings), **files}


def _surface(name: str, value: object) -> MaterialSection:
    """The stage that sets a value of the surface; a colour has an opacity as its fourth component."""
    technique, uniform = library.setter(name)
    return MaterialSection("surface", technique, ((uniform, value),))


def stages_of(point: FittedChain, shape: Body, medium: Medium | None = None) -> list[MaterialSection]:
    """The stages of a point with its fitted parameters and those of the medium.

    Counts, and what the body sets, are constants; all others are adjustable.
    """
    candidate = candidate_of(point)
    known = medium.parameters if medium is not None else {}
    stages = []
    for name, stage in zip(candidate.techniques, candidate.stages(shape), strict=True):
        bound = [load(candidate.path)] if any(function == candidate.path for _, function in stage.bind) else []
        for technique in (load(name), *bound):
            stage = _with_values(stage, _parameters(technique, point, known))
        stages.append(stage)
    return stages


def _coordinates(scene: MeasuredScene, point: FittedChain, shape: Body) -> list[MaterialSection]:
    assert scene.inlay is not None
    stages = []
    for stage in stages_of(point, shape)[:1]:
        parameters = {uniform.name for uniform in load(point["chain"][0]).uniforms}
        values = {key: value for key, value in scene.inlay.parameters.items() if key in parameters}
        stages.append(_with_values(stage, values))
    return stages


def _with_values(stage: MaterialSection, values: Mapping[str, object]) -> MaterialSection:
    """The stage with these parameters too; those that it has already are unchanged."""
    present = dict(stage.values)
    return stage._replace(
        values=(*stage.values, *((key, value) for key, value in values.items() if key not in present))
    )


def _parameters(
    technique: Technique, point: FittedChain, known: Mapping[str, ParameterValue]
) -> dict[str, ParameterValue]:
    """A technique's fitted parameters, and those that the scene knows; the factor includes the scale."""
    values: dict[str, ParameterValue] = {}
    names, _ = needs(technique.module, technique.function)
    for uniform in technique.uniforms:
        if uniform.name not in names or kind_of(uniform.type) != "float":
            continue
        if uniform.name in known:
            values[uniform.name] = _clamp(uniform, known[uniform.name])
        elif uniform.name in point["parameters"]:
            value = point["parameters"][uniform.name]
            values[uniform.name] = _clamp(uniform, value[0] if components(uniform.type) == 1 else list(value))
        elif uniform.name == point["factor"]:
            default = np.array(uniform.default)
            scale = np.array(point["scale"])[: len(default)]
            values[uniform.name] = _clamp(
                uniform, [*(default * scale)] if len(default) > 1 else float((default * scale)[0])
            )
    return values


def _clamp(uniform: Uniform, value: ParameterValue) -> ParameterValue:
    """A value clamped to the parameter's range, which rounding may have exceeded."""
    limits = dict(uniform.hints).get("hint_range")
    if limits is None:
        return value
    low, high = float(limits[0]), float(limits[1])
    return (
        [min(max(float(part), low), high) for part in value] if isinstance(value, list) else min(max(value, low), high)
    )
