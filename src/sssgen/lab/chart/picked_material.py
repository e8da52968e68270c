"""What was picked, as a material: the chain with the parameters that were fitted to the scene's medium."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import components, kind_of
from sssgen.lab.chart.charting import candidate_of
from sssgen.lab.chart.picking import Pick
from sssgen.lab.measure.candidates import load
from sssgen.lab.measure.measured_chain import Stage, material_text
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.scene_body import Body, body
from sssgen.material.slots import needs


def material_files(one: MeasuredScene, picked: Pick, name: str) -> dict[str, str]:
    """The material's file, and those that it names, to lie beside it: name → text."""
    of = body(one.geometry)
    stages: list[Stage] = []
    if picked.coordinates is not None and picked.coordinates["name"] != "none":
        stages += _slide(one, picked.coordinates, of)
    if picked.chain is not None:
        stages += stages_of(picked.chain, of)
    matte = picked.chain["matte"] if picked.chain is not None else [1.0, 1.0, 1.0]
    stages += [
        Stage("surface", "base_color", (("tint", [*matte, 1.0]),)),
        Stage("surface", "pbr_constants", (("surface_roughness", 1.0),)),
    ]
    doc = f"Picked for the scene {one.name}: {one.title}."
    used = {bound for stage in stages for _, bound in stage.bind}
    files = {file: text for file, text in of.files.items() if any(bound.startswith(file) for bound in used)}
    return {f"{name}.toml": material_text(name, stages, one.title, doc), **files}


def stages_of(point: Mapping[str, Any], of: Body) -> list[Stage]:
    """The stages of a point, with what was fitted; its counts are fixed, the rest is the artist's to change."""
    candidate = candidate_of(point)
    stages = zip(candidate.techniques, candidate.stages(of), strict=True)
    return [_with(stage, _given(load(name), point)) for name, stage in stages]


def _slide(one: MeasuredScene, point: Mapping[str, Any], of: Body) -> list[Stage]:
    assert one.inlay is not None
    stages = []
    for stage in stages_of(point, of)[:1]:
        known = {uniform.name for uniform in load(point["chain"][0]).uniforms}
        scene = {key: value for key, value in one.inlay.parameters.items() if key in known}
        stages.append(_with(stage, scene))
    return stages


def _with(stage: Stage, values: Mapping[str, object]) -> Stage:
    """The stage with more parameters; those that it has stay."""
    own = dict(stage.values)
    return stage._replace(values=(*stage.values, *((key, value) for key, value in values.items() if key not in own)))


def _given(technique: Any, point: Mapping[str, Any]) -> dict[str, object]:
    """What was fitted of a technique's parameters, and the scale in the one that can take it."""
    found: dict[str, object] = {}
    names, _ = needs(technique.module, technique.function)
    for uniform in technique.uniforms:
        if uniform.name not in names or kind_of(uniform.type) != "float":
            continue
        if uniform.name in point["parameters"]:
            value = point["parameters"][uniform.name]
            found[uniform.name] = _cut(uniform, value[0] if components(uniform.type) == 1 else list(value))
        elif uniform.name == point["factor"]:
            default = np.array(uniform.default)
            scale = np.array(point["scale"])[: len(default)]
            found[uniform.name] = _cut(
                uniform, [*(default * scale)] if len(default) > 1 else float((default * scale)[0])
            )
    return found


def _cut(uniform: Uniform, value: Any) -> Any:
    """A value within the parameter's range: rounding may have left it by a little."""
    limits = dict(uniform.hints).get("hint_range")
    if limits is None:
        return value
    low, high = float(limits[0]), float(limits[1])
    return [min(max(float(one), low), high) for one in value] if isinstance(value, list) else min(max(value, low), high)
