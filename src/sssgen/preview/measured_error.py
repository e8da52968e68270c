"""The error of the chart's entry that is nearest to a material, where a chart of its scene is in the cache."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sssgen.lab.chart.charting import Settings, cached_points
from sssgen.lab.chart.picking import cost_of, limit_of
from sssgen.lab.chart.record import Point, measures
from sssgen.lab.measure.candidates import ROLES, is_path
from sssgen.material.model import Material
from sssgen.scene.measured import measured_scene
from sssgen.scene.scene import Scene
from sssgen.support.paths import shell_word

_MEASURED = (*ROLES, "conversion")
"""The roles whose techniques a chart compares."""


def measured_error(scene: Scene, material: Material) -> str:
    """The error with its entry, or what is to be done to have one. Raises SssgenError for a faulty scene."""
    if not {"medium", "inlay"} & set(scene.measured):
        return "Error: not measured, as the scene has no [medium] and no [inlay]."
    if _is_clear(scene.measured.get("medium")):
        return "Error: not measured, as a clear medium scatters no light; sssgen chart compares scattering bodies."
    file = scene.document.reporter.file
    record = cached_points(measured_scene.load(file), Settings())
    if record is None:
        return f"Error: no chart of this scene is in the cache. It takes minutes: sssgen chart {shell_word(file)}"
    names = _techniques_of_material(material)
    point = nearest(record["points"], names)
    if point is None:
        return "Error: the chart of this scene has no complete chain."
    same = "this chain" if _techniques_of_point(point) == names else "the nearest chain"
    error, highest = measures(point)[1], limit_of(point)
    numbers = f"{error:.3g}, at most {highest:.3g}; its cost {cost_of(point):g}"
    return f"Error of {same} in the chart, {point['label']}: {numbers}."


def _is_clear(medium: object) -> bool:
    """Whether a section [medium] says that nothing scatters; without the key it scatters."""
    return isinstance(medium, Mapping) and medium.get("scattering") == [0, 0, 0]


def nearest(points: Sequence[Point], names: frozenset[str]) -> Point | None:
    """The complete chain with the fewest other techniques than these; of several the one with the least error."""
    whole = [point for point in points if point["role"] in ("material", "coordinates") and not point.get("failed")]
    return min(whole, key=lambda point: (len(_techniques_of_point(point) ^ names), limit_of(point)), default=None)


def _techniques_of_point(point: Point) -> frozenset[str]:
    """The techniques of a chart's point."""
    return frozenset(filter(None, (*point["chain"], point.get("path", ""))))


def _techniques_of_material(material: Material) -> frozenset[str]:
    """The techniques of a material that a chart compares, with the functions of lengths inside the body."""
    stages = [stage for stage in material.stages if stage.technique.role in _MEASURED]
    paths = [
        stage.bindings[slot.name].function.name
        for stage in stages
        for slot in stage.technique.slots
        if is_path(slot) and slot.name in stage.bindings
    ]
    return frozenset((*(stage.technique.name for stage in stages), *paths))
