"""The record of a chart, as plain JSON: its checks, the Pareto front, the hypervolume, CSV and JSON.

A record has the scenes, and a point for every technique with each of its settings on each scene. Lower cost and lower
error are better.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Literal, NotRequired, TypedDict, TypeGuard, cast

from sssgen.lab.measure.measured_point import MeasuredPoint
from sssgen.material.attributes import REQUIREMENTS
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure

FORMAT = 1
"""The version of the record's format."""

ROLES = ("coordinates", "thickness", "view_thickness", "translucency", "material")
"""Points of the same role are compared; in the order of the charts."""

CostName = Literal[
    "value", "operations", "transcendentals", "fetches", "volume_fetches", "distance_evaluations", "gpu_ms"
]
ErrorName = Literal["value", "low", "high", "relmse", "bias", "p99", "max", "flip"]

COSTS: dict[CostName, str] = {
    "value": "cost", "operations": "operations", "transcendentals": "transcendentals", "fetches": "fetches",
    "volume_fetches": "volume fetches", "distance_evaluations": "distance evaluations", "gpu_ms": "GPU ms",
}  # fmt: skip
"""Key of a point's cost → table column; charts show `value`."""

ERRORS: dict[ErrorName, str] = {
    "value": "error", "low": "low", "high": "high", "relmse": "relMSE", "bias": "bias", "p99": "p99", "max": "max",
    "flip": "FLIP",
}  # fmt: skip
"""Key of a point's error → table column; charts show `value`, with a bar from `low` to `high`."""

LEAST = 1e-6
"""Logarithms of smaller costs and errors use this value, which is below the rounding of float32."""


class Point(MeasuredPoint):
    """A point in a record."""

    scene: str
    """The name of its scene"""


class MediumEntry(TypedDict, total=False):
    """The medium of a scene."""

    name: str
    albedo: list[float]
    """Single-scattering albedo, 0 to 1, for red, green and blue"""
    extinction: list[float]
    """Per unit of the scene, for red, green and blue"""
    ior: float
    roughness: float
    """Of the boundary, 0 to 1"""


class SceneEntry(TypedDict):
    """A scene of a record."""

    name: str
    title: NotRequired[str]
    key: NotRequired[str]
    """Differs between scenes that differ"""
    medium: NotRequired[MediumEntry]
    lights: NotRequired[list[str]]
    """The kinds of its lights; with a medium only"""
    fitted_to: NotRequired[list[str]]
    """The names of the training views; with a medium only"""


class Hypervolume(TypedDict):
    """The hypervolumes of a scene and role, in decades of cost × decades of error."""

    scene: str
    role: str
    reference_point: NotRequired[list[float]]
    """(cost, error)"""
    ours: float
    baselines: float


class Measurement(TypedDict, total=False):
    """The conditions of the measurement."""

    sssgen: str
    commit: str
    versions: dict[str, str]
    """By package; '' if it is not installed"""
    seed: int
    samples: int
    """Of the reference, per ray and channel"""
    device: str
    """'' without times of a GPU; so is `driver`"""
    driver: str
    software: bool
    """Whether the device is a rasteriser on the CPU"""
    size: list[int]
    """Width and height of the timed pictures, in pixels"""
    rounds: int
    rank_correlation: dict[str, float]
    """Of static cost and time, by role; -1 to 1"""


class Record(TypedDict):
    """A chart's record."""

    format: int
    record: Measurement
    cost: str
    """static, gpu, bytes or device"""
    cost_unit: str
    scenes: list[SceneEntry]
    points: list[Point]
    hypervolume: NotRequired[list[Hypervolume]]
    conditions: NotRequired[dict[str, Any]]
    """The fields of `engine_conditions.Conditions`, if points are left out because of them"""


def check_record(record: object) -> Record:
    """A copy of the record with None for numbers that are not finite. Raises SssgenError with up to 20 errors."""
    faults = list(_faults(record)) if isinstance(record, dict) else ["it is not a JSON object"]
    if faults:
        raise SssgenError(
            [failure(f"this is not a record of a chart: {fault}").diagnostics[0] for fault in faults[:20]]
        )
    return cast(Record, _finite(record))


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(name): _finite(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    if isinstance(value, float):  # also a NumPy float64
        return float(value) if math.isfinite(value) else None
    return value


def _faults(record: dict[str, Any]) -> Iterator[str]:
    if record.get("format") != FORMAT:
        yield f"its format is {record.get('format')!r}, not {FORMAT}"
    for name, kind in (("record", dict), ("scenes", list), ("points", list), ("cost", str), ("cost_unit", str)):
        if not isinstance(record.get(name), kind):
            yield f"'{name}' is missing, or has the wrong type"
    scenes = [scene.get("name") for scene in _objects(record.get("scenes"))]
    if not all(isinstance(scene, str) and scene for scene in scenes) or len(set(scenes)) != len(scenes):
        yield "each scene needs a unique name"
    for number, point in enumerate(_objects(record.get("points"))):
        for fault in _point_faults(point, scenes):
            yield f"point {number}: {fault}"
    for number, volume in enumerate(_objects(record.get("hypervolume", []))):
        if volume.get("scene") not in scenes or volume.get("role") not in ROLES:
            yield f"hypervolume {number}: its scene or role is unknown"
        elif not all(_is_number(volume.get(name)) for name in ("ours", "baselines")):
            yield f"hypervolume {number}: 'ours' and 'baselines' are numbers"


def _objects(value: Any) -> list[dict[str, Any]]:
    return [entry if isinstance(entry, dict) else {} for entry in value] if isinstance(value, list) else []


def _point_faults(point: dict[str, Any], scenes: Sequence[Any]) -> Iterator[str]:
    if point.get("scene") not in scenes:
        near = did_you_mean(str(point.get("scene")), [str(scene) for scene in scenes])
        yield f"its scene {point.get('scene')!r} is unknown" + (f": {near}" if near else "")
    if point.get("role") not in ROLES:
        yield f"its role {point.get('role')!r} is none of {', '.join(ROLES)}"
    for name in ("name", "label"):
        if not (isinstance(point.get(name), str) and point[name]):
            yield f"'{name}' is missing"
    if not isinstance(point.get("path", ""), str) or not isinstance(point.get("path_settings", {}), dict):
        yield "'path' is a name, and 'path_settings' has its counts"
    unknown = [name for name in point.get("requires", ()) if name not in REQUIREMENTS]
    if unknown:
        yield f"it requires {unknown[0]!r}, which is none of {', '.join(REQUIREMENTS)}"
    if not (_is_number(point.get("bytes", 0)) and point.get("bytes", 0) >= 0):
        yield "'bytes' is not a number of bytes"
    for name, parts in (("cost", COSTS), ("error", ERRORS)):
        numbers = point.get(name)
        if not isinstance(numbers, dict):
            yield f"'{name}' is missing"
            continue
        for part in parts:
            value = numbers.get(part)
            if value is not None and not _is_number(value):
                yield f"{name}.{part} is not a number"
        value = numbers.get("value")
        if _is_number(value) and value < 0.0:
            yield f"{name}.value is below 0"
        if not (_is_number(value) and math.isfinite(value)) and (name == "cost" or not point.get("failed")):
            yield f"{name}.value is not finite" + (", and 'failed' does not say why" if name == "error" else "")


def _is_number(value: Any) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def measures(point: Point) -> tuple[float, float]:
    """A point's cost and error; the error of a failed one is infinite."""
    error = point["error"]["value"]
    return float(point["cost"]["value"]), math.inf if point.get("failed") or error is None else float(error)


def front(points: Iterable[Point]) -> list[Point]:
    """The Pareto front, sorted by cost, without failed points: no other point is as good in both and better in one.

    Errors below LEAST are equal, and so are errors that differ by a millionth, which is rounding.
    """
    ordered = sorted((point for point in points if math.isfinite(measures(point)[1])), key=measures)
    best, result = (math.inf, math.inf), []
    for point in ordered:
        cost, error = measures(point)[0], max(measures(point)[1], LEAST)
        if error < best[1] * (1.0 - LEAST) or (cost, error) == best:
            best = (cost, error)
            result.append(point)
    return result


def hypervolume(points: Iterable[Point], reference_point: Sequence[float]) -> float:
    """The area that points dominate up to a reference point (cost, error), in decades of cost × decades of error.

    Larger is better: a point with a tenth of the reference's cost and a tenth of its error has 1. Both axes are
    logarithmic and end at LEAST. After Zitzler and Thiele, "Multiobjective optimization using evolutionary
    algorithms", PPSN 1998.
    """
    right, top = map(_log, reference_point)
    area = 0.0
    for point in front(points):
        x, y = map(_log, measures(point))
        if x < right and y < top:
            area += (right - x) * (top - y)
            top = y
    return area


def on_fronts(points: Sequence[Point]) -> list[Point]:
    """The points; `front` is whether a point is on the front of its scene and role."""
    groups: dict[tuple[str, str], list[Point]] = {}
    for point in points:
        groups.setdefault((point["scene"], point["role"]), []).append(point)
    best = {id(point) for group in groups.values() for point in front(group)}
    return [{**point, "front": id(point) in best} for point in points]


def hypervolumes(points: Sequence[Point]) -> list[Hypervolume]:
    """The hypervolumes of our points and of all baselines together, for each scene and role."""
    volumes: list[Hypervolume] = []
    for scene, role in dict.fromkeys((point["scene"], point["role"]) for point in points):
        group = [point for point in points if (point["scene"], point["role"]) == (scene, role)]
        reference_point = [1.1 * max(float(point["cost"]["value"]) for point in group), 1.0]
        ours = [point for point in group if not point["baseline"]]
        baselines = [point for point in group if point["baseline"] or point["name"] == "none"]
        volumes.append({
            "scene": scene, "role": role, "reference_point": reference_point,
            "ours": hypervolume(ours, reference_point), "baselines": hypervolume(baselines, reference_point),
        })  # fmt: skip
    return volumes


def fronts_of(record: Record) -> Record:
    """The record with the fronts and hypervolumes of the points that it has now."""
    points = on_fronts(record["points"])
    return {**record, "points": points, "hypervolume": hypervolumes(points)}


def _log(value: float) -> float:
    return math.log10(max(value, LEAST))


def points_of(record: Record, role: str, scene: str = "") -> list[Point]:
    """The points of a role, on one scene or on all."""
    return [point for point in record["points"] if point["role"] == role and scene in ("", point["scene"])]


def roles(record: Record) -> list[str]:
    """The roles that have points."""
    return [role for role in ROLES if points_of(record, role)]


def to_json(record: Record) -> str:
    """The record as text, independent of the order of its keys."""
    return json.dumps(record, indent=1, sort_keys=True, ensure_ascii=False, allow_nan=False) + "\n"


def to_csv(record: Record) -> str:
    """A line per point, after a line of column names."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    columns = ["scene", "role", "name", "label", "baseline", "front", "failed", "chain", "settings", "parameters"]
    columns += ["path", "path_settings", "requires", "bytes"]
    columns += [f"cost_{name}" for name in COSTS] + [f"error_{name}" for name in ERRORS]
    writer.writerow([*columns, "implementation"])
    for point in record["points"]:
        row: list[object] = [point["scene"], point["role"], point["name"], point["label"]]
        row += [int(bool(point.get("baseline"))), int(bool(point.get("front")))]
        row += [point.get("failed", ""), " + ".join(point.get("chain", []))]
        row += [_compact(point.get("settings", {})), _compact(point.get("parameters", {}))]
        row += [point.get("path", ""), _compact(point.get("path_settings", {}))]
        row += [" + ".join(point.get("requires", [])), point.get("bytes", "")]
        row += [point["cost"].get(name) for name in COSTS] + [point["error"].get(name) for name in ERRORS]
        writer.writerow([*row, _compact(point.get("implementation", {}))])
    return file.getvalue()


def _compact(value: object) -> str:
    return json.dumps(value, sort_keys=True, ensure_ascii=False)
