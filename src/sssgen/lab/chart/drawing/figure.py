"""A chart as PNG and SVG, by matplotlib (https://matplotlib.org); labels placed by textalloc."""

from __future__ import annotations

import html
import io
import math
import re
from collections.abc import Sequence
from textwrap import fill, wrap
from typing import Any, NamedTuple

from sssgen.lab.chart.drawing.panels import Chart, Panel, Style, label_texts, number, series
from sssgen.lab.chart.record import LEAST, Point, measures
from sssgen.support.extras import need

WIDTH, TALL, SHORT, KEY_LINE = 10.0, 4.8, 5.0, 0.21
"""In inches: the width of the chart, the height of a full-width panel, of a half-width panel, of a line of the key."""
DPI = 200
KEY_COLUMNS = 4
LABEL_WIDTH, LABEL_SIZE = 26, 6.0
"""The letters in a line of a label (a long name may have more), and their size in points."""
MOST_LINES = 60
"""The largest number of techniques whose settings are joined by lines: more lines would hide the points."""
MARKER_AREAS = {True: 34.0, False: 18.0}
"""The areas of markers, on the front and off it, in square points."""
PALE, GRID, SHADE, FAINT = "#5f6368", "#e4e6e8", "#f3f5f7", 0.38

READING = "filled: ours · hollow: published baselines · stepped line: Pareto front · faint: not on it · ×: not finite"
SETTINGS = {
    "backend": "agg", "svg.hashsalt": "sssgen", "svg.fonttype": "path", "font.family": "DejaVu Sans", "font.size": 7.5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": PALE, "axes.grid": True,
    "axes.axisbelow": True, "axes.titlelocation": "left", "axes.titleweight": "bold", "axes.titlesize": 8.5,
    "axes.titlepad": 16.0, "axes.labelcolor": PALE, "grid.color": GRID, "text.parse_math": False, "xtick.color": PALE,
    "ytick.color": PALE, "lines.linewidth": 0.8, "legend.frameon": False, "legend.title_fontsize": 7.5,
}  # fmt: skip


class Picture(NamedTuple):
    """A drawn chart. Equal charts give equal files."""

    png: bytes
    svg: str
    """Each marker is a link to #rowN, N being its row in the page's table, and has a tooltip."""


def picture_of(chart: Chart) -> Picture:
    """The chart as files. Raises SssgenError where matplotlib or textalloc is missing."""
    with settings():
        figure = figure_of(chart)
        png, svg = io.BytesIO(), io.BytesIO()
        figure.savefig(png, format="png", dpi=DPI, metadata={"Software": None})
        figure.savefig(svg, format="svg", metadata={"Date": None, "Creator": None})
    return Picture(png.getvalue(), _with_tooltips(svg.getvalue().decode(), chart))


def settings() -> Any:
    """A context with the settings for `figure_of` and for saving, independent of the user's."""
    matplotlib = need("matplotlib", extra="chart")
    return matplotlib.rc_context({**matplotlib.rcParamsDefault, **SETTINGS})


def figure_of(chart: Chart) -> Any:
    """The matplotlib figure of a chart."""
    figures = need("matplotlib.figure", extra="chart")
    need("matplotlib.backends.backend_agg", extra="chart")
    wide = len(chart.panels) % 2  # a full-width panel: the medians, or the only scene
    rows = wide + len(chart.panels) // 2
    key_lines = 2 + len(_note_lines(chart)) + math.ceil(len(chart.styles) / KEY_COLUMNS)
    height = 0.5 + TALL * wide + SHORT * (rows - wide) + KEY_LINE * key_lines
    figure = figures.Figure(figsize=(WIDTH, height), layout="constrained")
    grid = figure.add_gridspec(rows, 2, height_ratios=[TALL] * wide + [SHORT] * (rows - wide))
    figure.suptitle(f"{chart.role.capitalize()}: error against cost", x=0.01, ha="left", weight="bold", size=12)
    all_axes: list[Any] = []
    for index, panel in enumerate(chart.panels):
        row, column = divmod(index + wide, 2)
        cell = grid[0, :] if wide and not index else grid[row, column]
        first = all_axes[0] if all_axes else None
        axes = figure.add_subplot(cell, sharex=first, sharey=first)
        axes.set_title(panel.title)
        axes.text(0.0, 1.015, panel.note, transform=axes.transAxes, color=PALE)
        axes.set_xlabel(fill(f"cost, {chart.cost_unit}", 70))
        axes.set_ylabel("error")
        _draw_points(axes, panel, chart.styles)
        all_axes.append(axes)
    _set_scales(all_axes[0], [point for panel in chart.panels for point in panel.points])
    for axes, panel in zip(all_axes, chart.panels, strict=True):
        _draw_front(axes, panel)
    _draw_key(figure, chart)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # labels below do not change the layout
    for axes, panel in zip(all_axes, chart.panels, strict=True):
        _draw_labels(axes, panel, chart.styles)
    return figure


def _place(point: Point) -> tuple[float, float]:
    cost, error = measures(point)
    return max(cost, LEAST), max(error, 0.0)


def _set_scales(axes: Any, points: Sequence[Point]) -> None:
    """Logarithmic scales, shared by all panels; where an error is 0, the scale is linear below the least decade."""
    ticker = need("matplotlib.ticker", extra="chart")
    costs = [_place(point)[0] for point in points]
    bars = [_error_bar(point) for point in points if math.isfinite(measures(point)[1])]
    errors = [end for bar in bars for end in bar]
    positive = [error for error in errors if error >= LEAST] or [1.0]
    axes.set_xscale("log")
    axes.set_xlim(*_add_margins(min(costs), max(costs), 0.10, 0.06))
    low, high = _add_margins(min(positive), max(positive), 0.16, 0.18)
    linear = 0.0
    if min(errors, default=1.0) < LEAST:
        linear = 10.0 ** math.floor(math.log10(min(positive)))
        axes.set_yscale("symlog", linthresh=linear, linscale=0.5)
        low = -0.3 * linear
    else:
        axes.set_yscale("log")
    axes.set_ylim(low, high)
    for axis, (least, most) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, (max(low, linear), high))):
        steps = (1.0, 2.0, 5.0) if math.log10(most / least) < 2.2 else (1.0,)
        if axis is axes.yaxis and linear:
            axis.set_major_locator(ticker.SymmetricalLogLocator(base=10.0, linthresh=linear, subs=steps))
        else:
            axis.set_major_locator(ticker.LogLocator(subs=steps))
        axis.set_major_formatter(ticker.StrMethodFormatter("{x:,g}"))
        axis.set_minor_locator(ticker.NullLocator())


def _add_margins(least: float, most: float, before: float, after: float) -> tuple[float, float]:
    """The limits with margins, as shares of the range in decades, which is at least 0.8."""
    start, end = math.log10(least), math.log10(most)
    if end - start < 0.8:
        start, end = 0.5 * (start + end) - 0.4, 0.5 * (start + end) + 0.4
    return 10.0 ** (start - before * (end - start)), 10.0 ** (end + after * (end - start))


def _error_bar(point: Point) -> tuple[float, float]:
    error = measures(point)[1]
    low, high = point["error"].get("low"), point["error"].get("high")
    return max(error if low is None else low, 0.0), max(error if high is None else high, 0.0)


def _draw_points(axes: Any, panel: Panel, styles: dict[str, Style]) -> None:
    groups: dict[tuple[Style, bool, bool], list[tuple[Point, str]]] = {}
    for row, point in enumerate(panel.points, panel.first_row):
        key = (styles[series(point)], bool(point.get("front")), math.isinf(measures(point)[1]))
        groups.setdefault(key, []).append((point, f"#row{row}"))
    for (style, on_front, failed), members in groups.items():
        points, links = zip(*members, strict=True)
        x, y = zip(*map(_place, points), strict=True)
        look: dict[str, Any] = {"linewidth": 0.9, "alpha": 1.0 if on_front else FAINT, "zorder": 4 if on_front else 3}
        if failed:
            top = {"transform": axes.get_xaxis_transform(), "y": [0.97] * len(x)}
            axes.scatter(x, s=18.0, c=style.color, marker="x", urls=links, **top, **look)
            continue
        axes.vlines(x, *zip(*map(_error_bar, points), strict=True), colors=style.color, **look)
        look |= {"c": "white" if style.baseline else style.color, "edgecolor": style.color, "marker": style.marker}
        axes.scatter(x, y, s=MARKER_AREAS[on_front], urls=links, **look)
    for style, path in _setting_lines(panel, styles):
        axes.plot(*zip(*path, strict=True), color=style.color, alpha=FAINT, zorder=2)


def _setting_lines(panel: Panel, styles: dict[str, Style]) -> list[tuple[Style, list[tuple[float, float]]]]:
    """The lines that join the settings of a technique."""
    paths: dict[tuple[Style, tuple[str, ...]], list[tuple[float, float]]] = {}
    for point in panel.points:
        if math.isfinite(measures(point)[1]):
            paths.setdefault((styles[series(point)], tuple(point.get("chain", ()))), []).append(_place(point))
    lines = [(style, path) for (style, _), path in paths.items() if len(path) > 1]
    return lines if len(paths) <= MOST_LINES else []


def _draw_front(axes: Any, panel: Panel) -> None:
    """The least error for each cost as a stepped line, and the area that the front dominates."""
    if steps := _front_steps(axes, panel):
        x, y = zip(*steps, strict=True)
        axes.fill_between(x, y, axes.get_ylim()[1], color=SHADE, linewidth=0.0, zorder=0)
        axes.plot(x, y, color="black", zorder=2.5)


def _front_steps(axes: Any, panel: Panel) -> list[tuple[float, float]]:
    """The corners of the front's line, from the top of the panel to its right edge."""
    steps: list[tuple[float, float]] = []
    error = axes.get_ylim()[1]
    for x, y in (_place(point) for point in panel.points if point.get("front")):
        steps += [(x, error), (x, y)]
        error = y
    return [*steps, (axes.get_xlim()[1], error)] if steps else []


def _draw_key(figure: Any, chart: Chart) -> None:
    lines = need("matplotlib.lines", extra="chart")
    handles = [
        lines.Line2D(
            [], [], linestyle="", label=style.name, marker=style.marker, color=style.color, markersize=5.0,
            markerfacecolor="white" if style.baseline else style.color,
        )
        for style in chart.styles.values()
    ]  # fmt: skip
    title = "\n".join([READING, *_note_lines(chart)])
    figure.legend(
        handles=handles, loc="outside lower left", ncols=KEY_COLUMNS, title=title, alignment="left", labelspacing=0.6
    )


def _note_lines(chart: Chart) -> list[str]:
    return [line for part in chart.note.split("\n") for line in wrap(part, 130)]


def _draw_labels(axes: Any, panel: Panel, styles: dict[str, Style]) -> None:
    """Labels the front's points, except where a label would cover a point or another label."""
    front = [point for point in panel.points if point.get("front")]
    if not front:
        return
    textalloc = need("textalloc", extra="chart")
    colors = [styles[series(point)].color for point in front]
    texts = [fill(text, LABEL_WIDTH, break_long_words=False) for text in label_texts(front)]
    x, y = zip(*map(_place, front), strict=True)
    finite = [point for point in panel.points if math.isfinite(measures(point)[1])]
    x_points, y_points = zip(*map(_place, finite), strict=True)
    # the marker's radius in pixels: half of the root of its area, and a fifth more for diamonds, which are wider
    pixels = 0.6 * axes.figure.dpi / 72.0
    radii = [pixels * math.sqrt(MARKER_AREAS[bool(point.get("front"))]) for point in finite]
    lines = [_front_steps(axes, panel), *(path for _, path in _setting_lines(panel, styles))]
    x_lines, y_lines = zip(*(zip(*line, strict=True) for line in lines), strict=True)
    textalloc.allocate(
        axes, x, y, texts, x_scatter=x_points, y_scatter=y_points, x_lines=list(x_lines), y_lines=list(y_lines),
        textsize=LABEL_SIZE, textcolor=colors, linecolor=colors, linewidth=0.5, draw_all=False,
        avoid_label_lines_overlap=True, priority_strategy="largest", margin=0.008, min_distance=0.02,
        max_distance=0.8, nbr_candidates=2000, scatter_sizes=radii, va="bottom", zorder=7,
    )  # fmt: skip


def _with_tooltips(svg: str, chart: Chart) -> str:
    """The SVG with a <title> in each marker's link."""
    titles = {
        panel.first_row + index: f"{panel.title}\n{description(point)}"
        for panel in chart.panels
        for index, point in enumerate(panel.points)
    }

    def link(match: re.Match[str]) -> str:  # without matplotlib's target="_blank"
        return f'<a xlink:href="#row{match[1]}"><title>{html.escape(titles[int(match[1])])}</title>'

    return re.sub(r'<a xlink:href="#row(\d+)"[^>]*>', link, svg)


def description(point: Point) -> str:
    """A point's label and numbers."""
    cost, _ = measures(point)
    error = point.get("failed") or f"error {number(point['error']['value'])}"
    baseline = " (baseline)" if point.get("baseline") else ""
    return f"{point['label']}{baseline}\ncost {number(cost)}, {error}{', on the front' if point.get('front') else ''}"
