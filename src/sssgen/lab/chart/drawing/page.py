"""The charts as one HTML page that works offline: SVGs, whose markers link to the rows of a table of all numbers."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template

from sssgen.lab.chart.drawing.panels import Chart, number
from sssgen.lab.chart.record import COSTS, ERRORS, Point, Record, SceneEntry
from sssgen.lab.chart.scene_conditions import conditions

COLUMNS = ("scene", "role", "technique", "cost", "error", "low", "high", "front", "failed", "settings", "chain")
"""The table's first columns; the other numbers follow."""
FACTS = ("commit", "seed", "samples", "device", "driver", "software")
"""The conditions of the measurement that come first at the page's top."""


class Cell(NamedTuple):
    """A cell of the table: its text and its sort key."""

    text: str
    key: float | str


def html_page(record: Record, charts: Sequence[Chart], pictures: Sequence[str]) -> str:
    """The page of a checked record, its charts and their SVGs."""
    titles = {scene["name"]: str(scene.get("title") or scene["name"]) for scene in record["scenes"]}
    rows = [_row(point, titles) for chart in charts for panel in chart.panels for point in panel.points]
    names = [*COLUMNS, *(name for name in rows[0] if name not in COLUMNS)]
    return _template().render(
        charts=[(chart.role, _svg_element(svg, chart.role)) for chart, svg in zip(charts, pictures, strict=True)],
        columns=[name for name in names if any(row[name].text not in ("", "–") for row in rows)],
        rows=rows,
        scenes=list(dict.fromkeys(row["scene"].text for row in rows)),
        roles=[chart.role for chart in charts],
        facts=_facts(record),
        media=[_medium(scene) for scene in record["scenes"] if scene.get("medium")],
        cost_unit=record["cost_unit"],
    )  # fmt: skip


@functools.cache
def _template() -> Template:
    loader = FileSystemLoader(os.path.dirname(__file__))
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True)
    return environment.get_template("page.html")


def _svg_element(svg: str, role: str) -> str:
    """The <svg> element of a file, without its metadata, and with ids that are unique in the page."""
    svg = re.sub("<metadata>.*?</metadata>", "", svg[svg.index("<svg") :], flags=re.DOTALL)
    return re.sub(r'(\bid="|url\(#|href="#(?!row\d))', rf"\g<1>{role}_", svg)


def _row(point: Point, titles: dict[str, str]) -> dict[str, Cell]:
    texts = {
        "scene": titles.get(point["scene"], point["scene"]),
        "role": point["role"],
        "technique": point["label"] + (" (baseline)" if point.get("baseline") else ""),
        "front": "yes" if point.get("front") else "",
        "failed": point.get("failed") or "",
        "settings": _pairs(point.get("settings", {})),
        "chain": " + ".join(point.get("chain", [])),
        "parameters": _pairs(point.get("parameters", {})),
        "implementation": _pairs(point.get("implementation", {})),
    }
    cells = {name: Cell(text, text.lower()) for name, text in texts.items()}
    numbers = {title: point["cost"].get(name) for name, title in COSTS.items()}
    numbers |= {title: point["error"].get(name) for name, title in ERRORS.items()}
    for title, value in numbers.items():
        cells[title] = Cell(number(value), "" if value is None else float(value))
    return cells


def _medium(scene: SceneEntry) -> tuple[str, str]:
    """A scene's title, and its medium with its conditions."""
    text = " · ".join(filter(None, (scene["medium"].get("name", ""), conditions(scene))))
    return str(scene.get("title") or scene["name"]), text


def _pairs(values: Mapping[str, object]) -> str:
    return ", ".join(f"{name} = {_value(value)}" for name, value in sorted(values.items()))


def _value(value: object) -> str:
    if isinstance(value, list):
        return f"({', '.join(map(_value, value))})"
    return number(value) if isinstance(value, float) else str(value)


def _facts(record: Record) -> list[tuple[str, str]]:
    """The conditions of the measurement, those of FACTS first."""
    facts = {name: value for name, value in record["record"].items() if value not in (None, "", {})}
    names = [name for name in FACTS if name in facts] + sorted(facts.keys() - set(FACTS))
    return [(name, _fact(facts[name])) for name in names]


def _fact(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return _pairs(value) if isinstance(value, dict) else str(value)
