"""The error of the chart's entry that is nearest to a material, where a chart of its scene is in the cache."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

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


class MeasuredError(NamedTuple):
    """The error in a chart, or why there is none."""

    text: str
    """With the entry, or with what is to be done to have one"""
    short: str


_NONE = "error not measured"


def measured_error(scene: Scene, material: Material) -> MeasuredError:
    """The error of the nearest chain of the scene's chart. Raises SssgenError for a faulty scene."""
    if not {"medium", "inlay"} & set(scene.measured):
        return MeasuredError("Error: not measured, as the scene has no [medium] and no [inlay].", _NONE)
    if _is_clear(scene.measured.get("medium")):
        reason = "as a clear medium scatters no light; sssgen chart compares scattering bodies"
        return MeasuredError(f"Error: not measured, {reason}.", _NONE)
    file = scene.document.reporter.file
    record = cached_points(measured_scene.load(file), Settings())
    if record is None:
        command = f"sssgen chart {shell_word(file)}"
        return MeasuredError(f"Error: no chart of this scene is in the cache. It takes minutes: {command}", _NONE)
    names = _techniques_of_material(material)
    point = nearest(record["points"], names)
    if point is None:
        return MeasuredError("Error: the chart of this scene has no complete chain.", _NONE)
    same = "this chain" if _techniques_of_point(point) == names else "the nearest chain"
    error, highest = measures(point)[1], limit_of(point)
    numbers = f"{error:.3g}, at most {highest:.3g}; its cost {cost_of(point):g}"
    return MeasuredError(f"Error of {same} in the chart, {point['label']}: {numbers}.", f"error {error:.3g} ({same})")


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
