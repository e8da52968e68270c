"""Where everything of a chart stands, in pixels: the same for the pictures and for the page.

A chart is of one role: above, the medians over all scenes, below a panel for each scene, with the same axes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from textwrap import wrap
from typing import NamedTuple

from sssgen.lab.chart.drawing.labels import SIZE, Box, Label, Place, placed
from sssgen.lab.chart.drawing.labels import WIDTH as LETTER
from sssgen.lab.chart.drawing.scale import Scale, number, scale
from sssgen.lab.chart.drawing.summary import medians
from sssgen.lab.chart.record import Point, Record, measures, points_of

WIDTH = 900.0
"""Of a chart, as wide as a README is shown."""
HEADER, NOTE = 42.0, 16.0
"""How high the title is, and each of the notes below it."""
LONGEST_NOTE, LONGEST_UNIT = 125, 22
"""In letters: longer notes go on in another line; a longer unit stands in the notes alone."""
LARGE, SMALL = 400.0, 310.0
"""How high a panel across the chart is, and one of two beside each other."""
LEFT, RIGHT, TOP, BOTTOM = 68.0, 14.0, 34.0, 44.0
"""What lies around a panel's plot."""
BAND = 22.0
"""How high the band at a plot's top is, where what failed stands."""
KEY_COLUMNS, KEY_LINE, KEY_MARK = 4, 19.0, 28.0
"""Columns of the key at most; how high its lines are, and how wide a marker with what is around it."""
MOST_LINES = 60
"""Chains whose settings are joined by lines: more would hide the points."""

READING = (
    "filled: ours · hollow: published baselines · stepped line: none here is better · faint: beaten · × not finite"
)
COLORS, MARKERS = 7, 6
"""How many there are. They have no common divisor, so that 42 techniques look different."""


class Style(NamedTuple):
    """How a technique looks."""

    name: str
    color: int
    marker: int
    hollow: bool
    """Whether it is a published baseline."""


class Dot(NamedTuple):
    """A point, where it stands."""

    x: float
    y: float
    style: Style
    low: float
    high: float
    """Where its error bar ends; both `y` where it has none."""
    point: Point

    @property
    def failed(self) -> bool:
        """Whether it has no error: it stands at the top."""
        return math.isinf(measures(self.point)[1])

    @property
    def faint(self) -> bool:
        """Whether another point is better."""
        return not self.point.get("front")


class Panel(NamedTuple):
    """A plot of one scene."""

    title: str
    note: str
    plot: Box
    x_ticks: list[tuple[float, str]]
    y_ticks: list[tuple[float, str]]
    dots: list[Dot]
    """Those of the front last, so that they are drawn above the others."""
    lines: list[tuple[Style, list[Place]]]
    """Through a technique's settings."""
    front: list[Place]
    labels: list[tuple[Label, Style]]


class Chart(NamedTuple):
    """A chart of one role."""

    role: str
    title: str
    notes: list[str]
    width: float
    height: float
    x_title: str
    y_title: str
    panels: list[Panel]
    key: list[tuple[Place, Style]]


def chart(record: Record, role: str) -> Chart:
    """The chart of a role, of a checked record."""
    scenes = [scene for scene in record["scenes"] if points_of(record, role, scene["name"])]
    looks = styles(points_of(record, role))
    everywhere = medians(record, role) if len(scenes) > 1 else []
    everything = [*points_of(record, role), *everywhere]
    finite = [point for point in everything if math.isfinite(measures(point)[1])]
    ends = [end for point in finite for end in _ends(point)]
    x = scale((measures(point)[0] for point in everything), 0.10, 0.06)
    y = scale(ends, 0.14, 0.04)

    notes = _notes(record)
    panels, top = [], HEADER + NOTE * len(notes)
    if len(scenes) != 1:
        box = Box(0.0, top, WIDTH, top + LARGE)
        panels.append(_panel(f"All {len(scenes)} scenes", "medians over the scenes", box, everywhere, looks, x, y))
        top += LARGE
    columns = 1 if len(scenes) == 1 else 2
    wide, high = WIDTH / columns, LARGE if columns == 1 else SMALL
    for number_, scene in enumerate(scenes):
        left, upper = wide * (number_ % columns), top + high * (number_ // columns)
        box = Box(left, upper, left + wide, upper + high)
        here = points_of(record, role, scene["name"])
        title = scene.get("title") or scene["name"]
        panels.append(_panel(title, _volume(record, role, scene["name"]), box, here, looks, x, y))
    top += high * math.ceil(len(scenes) / columns)
    key = _key(list(looks.values()), top + 18.0)
    height = key[-1][0][1] + 18.0 if key else top
    title = f"{role.capitalize()}: error against cost"
    unit = str(record["cost_unit"])
    x_title = f"cost, {unit}" if len(unit) <= LONGEST_UNIT else "cost"
    return Chart(role, title, notes, WIDTH, height, x_title, "error", panels, key)


def series(point: Point) -> str:
    """What a point shares its look with: its technique; of whole chains, how light comes through in them."""
    chain = list(point.get("chain", ()))
    whole = point["role"] == "material" and not point.get("baseline")
    return str(chain[-1] if chain and whole else point["name"])


def styles(points: Sequence[Point]) -> dict[str, Style]:
    """How each technique looks: ours first, by name, then the baselines."""
    hollow = {series(point): bool(point.get("baseline")) for point in points}
    names = sorted(hollow, key=lambda name: (hollow[name], name))
    return {name: Style(name, at % COLORS, at % MARKERS, hollow[name]) for at, name in enumerate(names)}


def _ends(point: Point) -> list[float]:
    """The ends of a point's error bar, and its error."""
    found = [point["error"].get(name) for name in ("value", "low", "high")]
    return [max(float(value), 0.0) for value in found if value is not None]


def _panel(
    title: str, note: str, box: Box, points: Sequence[Point], looks: dict[str, Style], x: Scale, y: Scale
) -> Panel:
    plot = Box(box.left + LEFT, box.top + TOP, box.right - RIGHT, box.bottom - BOTTOM)
    x, y = x.within(plot.left, plot.right), y.within(plot.bottom, plot.top + BAND)
    dots = [_dot(point, looks[series(point)], plot, x, y) for point in points]
    dots.sort(key=lambda dot: (not dot.faint, dot.x, dot.y))
    best = [dot for dot in dots if not dot.faint and not dot.failed]
    steps = _steps([(dot.x, dot.y) for dot in best], plot)
    lines = []
    settings: dict[tuple[Style, tuple[str, ...]], list[Place]] = {}
    for dot in dots:
        if not dot.failed:
            settings.setdefault((dot.style, tuple(dot.point.get("chain", ()))), []).append((dot.x, dot.y))
    for (style, _), way in settings.items():
        if len(way) > 1 and len(settings) <= MOST_LINES:
            lines.append((style, sorted(way)))
    inside = Box(plot.left + 2.0, plot.top + BAND, plot.right - 2.0, plot.bottom - 2.0)
    wanted = [(text, (dot.x, dot.y)) for text, dot in zip(_texts(best), best, strict=True)]
    found = placed(
        wanted, inside, [(dot.x, dot.y) for dot in dots if not dot.failed], [steps, *(way for _, way in lines)]
    )
    labels = [(label, best[label.number].style) for label in found]
    return Panel(title, note, plot, x.ticks(), y.ticks(), dots, lines, steps, labels)


def _dot(point: Point, style: Style, plot: Box, x: Scale, y: Scale) -> Dot:
    cost, error = measures(point)
    if math.isinf(error):
        middle = plot.top + 0.5 * BAND
        return Dot(x.at(cost), middle, style, middle, middle, point)
    low, high = (point["error"].get(name) for name in ("low", "high"))
    ends = [error if end is None else max(end, 0.0) for end in (low, high)]
    return Dot(x.at(cost), y.at(error), style, y.at(ends[0]), y.at(ends[1]), point)


def _steps(best: Sequence[Place], plot: Box) -> list[Place]:
    """The front's line: what one gets for each cost."""
    found: list[Place] = []
    above = plot.top
    for x, y in best:
        found += [(x, above), (x, y)]
        above = y
    return [*found, (plot.right, above)] if found else []


def _texts(best: Sequence[Dot]) -> list[str]:
    """What is written at the front's points: of each technique, only the first has its name."""
    found: list[str] = []
    named: set[str] = set()
    for dot in best:
        name, label = dot.style.name, str(dot.point["label"])
        rest = label.removeprefix(name).lstrip(" ,:")
        found.append(rest if name in named and rest else label)
        named.add(name)
    return found


def _volume(record: Record, role: str, scene: str) -> str:
    for one in record.get("hypervolume", []):
        if (one["scene"], one["role"]) == (scene, role):
            return f"hypervolume: ours {number(one['ours'])}, baselines {number(one['baselines'])}"
    return ""


def _key(looks: list[Style], top: float) -> list[tuple[Place, Style]]:
    """The techniques in columns, from top to bottom."""
    longest = max((len(style.name) for style in looks), default=1)
    columns = max(1, min(KEY_COLUMNS, int((WIDTH - LEFT) / (KEY_MARK + SIZE * LETTER * longest))))
    rows = math.ceil(len(looks) / columns)
    wide = (WIDTH - LEFT) / columns
    places = [(LEFT + wide * (at // rows), top + KEY_LINE * (at % rows)) for at in range(len(looks))]
    found = list(zip(places, looks, strict=True))
    return sorted(found, key=lambda one: (one[0][1], one[0][0]))


def _notes(record: Record) -> list[str]:
    """What is under the title: how to read it, and what it was measured with."""
    facts = record["record"]
    told = [f"cost: {record['cost_unit']}"]
    told += [f"commit {str(facts['commit'])[:10]}"] if facts.get("commit") else []
    told += [f"{name} {facts[name]}" for name in ("seed", "samples") if facts.get(name) is not None]
    if record["cost"] == "gpu":
        told += [str(facts[name]) for name in ("device", "driver") if facts.get(name)]
        told += ["a driver in software: its times tell nothing of GPUs"] if facts.get("software") else []
    return [READING, *wrap(" · ".join(told), LONGEST_NOTE)]
