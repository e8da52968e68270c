"""The charts as one HTML page that needs nothing else: every number at hover or focus, and in a table."""

from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from sssgen.lab.chart.drawing.layout import TOP, Chart, Style
from sssgen.lab.chart.drawing.scale import number
from sssgen.lab.chart.record import COSTS, ERRORS, Point, Record, measures

if TYPE_CHECKING:
    from jinja2 import Environment

MARKERS = (
    "M-1,0a1,1 0 1,0 2,0a1,1 0 1,0 -2,0z",
    "M-.88,-.88h1.76v1.76h-1.76z",
    "M0,-1.1L1.05,.85H-1.05z",
    "M0,-1.25L1.25,0L0,1.25L-1.25,0z",
    "M0,1.1L1.05,-.85H-1.05z",
    "M0,-1.1L1.05,-.34L.65,.89H-.65L-1.05,-.34z",
)
"""The paths of the markers, around 0, 1 large."""

COLUMNS = ("scene", "role", "technique", "cost", "error", "low", "high", "front", "failed", "settings", "chain")
"""Of the table, first of all; after them come the other numbers."""
FACTS = ("commit", "seed", "samples", "device", "driver", "software")
"""What of the record comes first at the page's top."""


class Cell(NamedTuple):
    """A cell of the table: its text, and what it is sorted by."""

    text: str
    key: float | str


class Row(NamedTuple):
    """A row of the table."""

    scene: str
    role: str
    front: bool
    cells: dict[str, Cell]


def written(record: Record, charts: Sequence[Chart]) -> str:
    """The page of a checked record and its charts."""
    rows: list[Row] = []
    numbers: dict[int, int] = {}
    titles = {scene["name"]: str(scene.get("title") or scene["name"]) for scene in record["scenes"]}
    for chart in charts:
        for panel in chart.panels:
            for dot in sorted(panel.dots, key=lambda dot: (dot.x, dot.y)):
                numbers[id(dot.point)] = len(rows)
                rows.append(_row(dot.point, titles))
    names = [*COLUMNS, *(name for name in rows[0].cells if name not in COLUMNS)]
    return _environment().get_template("page.html").render(
        charts=charts,
        number_of=lambda dot: numbers[id(dot.point)],
        told=lambda dot: _told(dot.point, titles),
        path=_path,
        title_room=TOP - 6.0,
        marker=_marker,
        columns=[name for name in names if any(row.cells[name].text not in ("", "–") for row in rows)],
        rows=rows,
        scenes=list(dict.fromkeys(row.scene for row in rows)),
        roles=[chart.role for chart in charts],
        facts=_facts(record),
        cost_unit=record["cost_unit"],
    )  # fmt: skip


@functools.cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(os.path.dirname(__file__))
    return Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )  # fmt: skip


def _row(point: Point, titles: dict[str, str]) -> Row:
    scene = str(titles.get(point["scene"], point["scene"]))
    role, failed, front = point["role"], point.get("failed", ""), bool(point.get("front"))
    texts = {
        "scene": scene,
        "role": role,
        "technique": point["label"] + (" (baseline)" if point.get("baseline") else ""),
        "front": "yes" if front else "",
        "failed": failed or "",
        "settings": _pairs(point.get("settings", {})),
        "chain": " + ".join(point.get("chain", [])),
        "parameters": _pairs(point.get("parameters", {})),
        "implementation": _pairs(point.get("implementation", {})),
    }
    cells = {name: Cell(text, text.lower()) for name, text in texts.items()}
    cells |= {title: _number(point["cost"].get(name)) for name, title in COSTS.items()}
    cells |= {title: _number(point["error"].get(name)) for name, title in ERRORS.items()}
    return Row(scene, role, front, cells)


def _number(value: float | None) -> Cell:
    return Cell(number(value), "" if value is None else float(value))


def _pairs(values: dict[str, Any]) -> str:
    """Names and values in one line."""
    return ", ".join(f"{name} = {_value(value)}" for name, value in sorted(values.items()))


def _value(value: Any) -> str:
    if isinstance(value, list):
        return f"({', '.join(map(_value, value))})"
    return number(value) if isinstance(value, float) else str(value)


def _told(point: Point, titles: dict[str, str]) -> str:
    """A point in words, for those who hear it."""
    cost, _ = measures(point)
    error = point.get("failed") or f"error {number(point['error']['value'])}"
    front = ", on the front" if point.get("front") else ""
    return f"{point['label']}, {titles.get(point['scene'], point['scene'])}: cost {number(cost)}, {error}{front}"


def _facts(record: Record) -> list[tuple[str, str]]:
    """What it was measured with, the best known first."""
    facts = record["record"]
    names = [name for name in FACTS if facts.get(name) not in (None, "")]
    names += sorted(name for name in facts if name not in FACTS and facts[name] not in (None, "", {}))
    return [(name, _fact(facts[name])) for name in names]


def _fact(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return _pairs(value) if isinstance(value, dict) else str(value)


def _path(places: Sequence[tuple[float, float]]) -> str:
    """The path through places."""
    return "M" + "L".join(f"{x:.1f},{y:.1f}" for x, y in places)


def _marker(style: Style) -> str:
    return MARKERS[style.marker]
