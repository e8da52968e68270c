"""What a chart shows: one chart per role, with a panel for the medians over all scenes and a panel per scene."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from sssgen.lab.chart.record import Point, Record, front, measures, points_of, roles
from sssgen.lab.chart.scene_conditions import conditions

COLORS = ("#00539C", "#C84E00", "#00805E", "#A8408F", "#946300", "#2F8FD0", "#505050")
"""After Okabe and Ito, "Color universal design" (2008), distinguishable for colour-blind readers; darker, for text."""
MARKERS = ("o", "s", "^", "D", "v", "p")
"""In matplotlib's notation. 7 colours and 6 markers have no common divisor, so 42 techniques look different."""
MEDIAN = "median over scenes"
"""The scene name of a point that is a median."""


@dataclass(frozen=True)
class Style:
    """How a technique is drawn."""

    name: str
    color: str
    marker: str
    baseline: bool
    """A published baseline has hollow markers."""


@dataclass(frozen=True)
class Panel:
    """The points of one scene, sorted by cost, then error."""

    title: str
    note: str
    points: list[Point]
    first_row: int
    """Row of points[0] in the page's table; the other points follow in order."""


@dataclass(frozen=True)
class Chart:
    """The chart of one role."""

    role: str
    cost_unit: str
    note: str
    panels: list[Panel]
    styles: dict[str, Style]


def charts_of(record: Record) -> list[Chart]:
    """The charts of a checked record."""
    charts, row = [], 0
    for role in roles(record):
        panels = []
        for title, note, points in _contents(record, role):
            panels.append(Panel(title, note, sorted(points, key=measures), row))
            row += len(points)
        note = "\n".join(filter(None, (_surroundings(record, role), _conditions(record))))
        charts.append(Chart(role, record["cost_unit"], note, panels, styles(points_of(record, role))))
    return charts


def _contents(record: Record, role: str) -> list[tuple[str, str, list[Point]]]:
    """Title, note and points of each panel."""
    contents = [
        (scene.get("title") or scene["name"], _hypervolumes(record, role, scene["name"]), points)
        for scene in record["scenes"]
        if (points := points_of(record, role, scene["name"]))
    ]
    if len(contents) > 1:
        contents.insert(0, (f"All {len(contents)} scenes", "medians over the scenes", medians(record, role)))
    return contents


def _hypervolumes(record: Record, role: str, scene: str) -> str:
    for volume in record.get("hypervolume", []):
        if (volume["scene"], volume["role"]) == (scene, role):
            return f"hypervolume: ours {number(volume['ours'])}, baselines {number(volume['baselines'])}"
    return ""


def _surroundings(record: Record, role: str) -> str:
    """The boundary and the lights of the scenes, in one line."""
    groups: dict[str, list[str]] = {}
    for scene in record["scenes"]:
        if points_of(record, role, scene["name"]) and (text := conditions(scene)):
            groups.setdefault(text, []).append(scene["name"])
    return " · ".join(f"{', '.join(names)}: {text}" for text, names in groups.items())


def _conditions(record: Record) -> str:
    """The conditions of the measurement, in one line."""
    facts: Mapping[str, object] = record["record"]
    parts = [f"commit {str(facts['commit'])[:10]}"] if facts.get("commit") else []
    parts += [f"{name} {facts[name]}" for name in ("seed", "samples") if facts.get(name) is not None]
    if record["cost"] == "gpu":
        parts += [str(facts[name]) for name in ("device", "driver") if facts.get(name)]
        parts += ["a software driver: its times do not apply to GPUs"] if facts.get("software") else []
    return " · ".join(parts)


def series(point: Point) -> str:
    """The technique that decides a point's style. In a whole chain of ours it is the last one, the translucency."""
    chain = list(point.get("chain", ()))
    is_own_chain = point["role"] == "material" and not point.get("baseline")
    return str(chain[-1] if chain and is_own_chain else point["name"])


def styles(points: Sequence[Point]) -> dict[str, Style]:
    """The style of each technique: ours first, by name, then the baselines."""
    baseline = {series(point): bool(point.get("baseline")) for point in points}
    names = sorted(baseline, key=lambda name: (baseline[name], name))
    return {
        name: Style(name, COLORS[index % len(COLORS)], MARKERS[index % len(MARKERS)], baseline[name])
        for index, name in enumerate(names)
    }


def label_texts(points: Sequence[Point]) -> list[str]:
    """The labels of a front's points; only the first point of a technique repeats the technique's name."""
    texts: list[str] = []
    named: set[str] = set()
    for point in points:
        name, label = series(point), str(point["label"])
        settings = label.removeprefix(name).lstrip(" ,:")
        texts.append(settings if name in named and settings else label)
        named.add(name)
    return texts


def medians(record: Record, role: str) -> list[Point]:
    """Points of a role whose cost and error are medians over the scenes, with their front marked.

    A failure counts as an infinite error: a technique that fails on half of the scenes has failed.
    """
    groups: dict[tuple[str, str], list[Point]] = {}
    for point in points_of(record, role):
        groups.setdefault((point["name"], point["label"]), []).append(point)
    points: list[Point] = []
    for group in groups.values():
        costs, errors = zip(*map(measures, group), strict=True)
        error = median(errors)
        failures = sum(map(math.isinf, errors))
        first = group[0]
        points.append(
            {
                "scene": MEDIAN,
                "role": role,
                "name": first["name"],
                "label": first["label"],
                "baseline": bool(first.get("baseline")),
                "settings": first.get("settings", {}),
                "chain": first.get("chain", []),
                "cost": {"value": median(costs)},
                "error": {"value": error if math.isfinite(error) else None},
                "failed": "" if math.isfinite(error) else f"fails on {failures} of {len(group)} scenes",
            }
        )
    best = {id(point) for point in front(points)}
    return [{**point, "front": id(point) in best} for point in points]


def number(value: float | None) -> str:
    """A number with three significant digits; – for None."""
    if value is None:
        return "–"
    return f"{value:,.0f}" if 1000.0 <= abs(value) < 1e7 else f"{value:.3g}"
