"""A chart as PNG and SVG, by matplotlib (https://matplotlib.org)."""

from __future__ import annotations

import io
from typing import Any

from sssgen.lab.chart.drawing.labels import SIZE
from sssgen.lab.chart.drawing.layout import NOTE, Chart, Dot, Panel, Style
from sssgen.support.extras import need

COLORS = ("#00539C", "#C84E00", "#00805E", "#A8408F", "#946300", "#2F8FD0", "#505050")
"""After Okabe and Ito, "Color universal design" (2008): colour-blind people tell them apart. Darker, for text."""
MARKERS = ("o", "s", "^", "D", "v", "p")

INK, PALE, GRID, SHADE, FAILED = "#1a1a1a", "#5f6368", "#e4e6e8", "#f3f5f7", "#b00020"
POINT = 0.72
"""A pixel of the chart, in typographic points: 100 pixels are an inch."""
SCALE = 2.0
"""Pixels of the PNG for one of the chart."""
FAINT = 0.38


def drawn(chart: Chart) -> dict[str, bytes]:
    """The suffix → the file: `png` and `svg`, always the same bytes. Raises SssgenError without matplotlib."""
    matplotlib = need("matplotlib", extra="chart")
    figures, agg = need("matplotlib.figure", extra="chart"), need("matplotlib.backends.backend_agg", extra="chart")
    settings = {"svg.hashsalt": "sssgen", "font.family": "DejaVu Sans", "svg.fonttype": "path", "text.usetex": False}
    with matplotlib.rc_context({**matplotlib.rcParamsDefault, "backend": "agg", **settings}):
        figure = figures.Figure(figsize=(chart.width / 100.0, chart.height / 100.0), facecolor="white")
        agg.FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_xlim(0.0, chart.width)
        axes.set_ylim(chart.height, 0.0)
        axes.set_axis_off()
        _draw(axes, chart)
        files = {}
        for suffix, metadata in (("png", {"Software": None}), ("svg", {"Date": None, "Creator": None})):
            file = io.BytesIO()
            figure.savefig(file, format=suffix, dpi=100.0 * SCALE, metadata=metadata)
            files[suffix] = file.getvalue()
    return files


def _draw(axes: Any, chart: Chart) -> None:
    _text(axes, 20.0, 24.0, chart.title, size=17.0, weight="bold")
    for at, note in enumerate(chart.notes):
        _text(axes, 20.0, 46.0 + NOTE * at, note, size=10.5, color=PALE)
    for panel in chart.panels:
        _panel(axes, panel, chart)
    for (x, y), style in chart.key:
        _marker(axes, x, y, style, 6.5, 1.0)
        _text(axes, x + 11.0, y, style.name, size=10.5)


def _panel(axes: Any, panel: Panel, chart: Chart) -> None:
    plot = panel.plot
    if panel.front:
        corners = [*panel.front, (plot.right, plot.top)]
        axes.fill(*zip(*corners, strict=True), color=SHADE, lw=0.0, zorder=0)
    for x, text in panel.x_ticks:
        axes.plot([x, x], [plot.top, plot.bottom], color=GRID, lw=0.7, zorder=1)
        _text(axes, x, plot.bottom + 11.0, text, size=10.0, color=PALE, ha="center")
    for y, text in panel.y_ticks:
        axes.plot([plot.left, plot.right], [y, y], color=GRID, lw=0.7, zorder=1)
        _text(axes, plot.left - 6.0, y, text, size=10.0, color=PALE, ha="right")
    axes.plot([plot.left, plot.left, plot.right], [plot.top, plot.bottom, plot.bottom], color=PALE, lw=0.8, zorder=2)
    _text(axes, plot.left, plot.top - 12.0, panel.title, size=12.0, weight="bold")
    _text(axes, plot.left, plot.bottom + 28.0, panel.note, size=10.0, color=PALE)
    _text(axes, plot.right, plot.bottom + 28.0, f"{chart.x_title} →", size=10.0, color=PALE, ha="right")
    _text(
        axes,
        plot.left - 52.0,
        plot.bottom,
        f"{chart.y_title} →",
        size=10.0,
        color=PALE,
        ha="center",
        va="bottom",
        rotation=90.0,
    )
    for style, way in panel.lines:
        axes.plot(*zip(*way, strict=True), color=COLORS[style.color], lw=0.9, alpha=FAINT, zorder=3)
    if panel.front:
        axes.plot(*zip(*panel.front, strict=True), color=INK, lw=1.1, zorder=4, solid_joinstyle="miter")
    for dot in panel.dots:
        _dot(axes, dot)
    if failed := [dot for dot in panel.dots if dot.failed]:
        _text(axes, plot.left - 6.0, failed[0].y, "not finite", size=9.5, color=FAILED, ha="right")
    for label, style in panel.labels:
        if label.far:
            axes.plot([label.x, label.at[0]], [label.y, label.at[1]], color=COLORS[style.color], lw=0.6, zorder=5)
        anchor = {"start": "left", "middle": "center", "end": "right"}[label.anchor]
        _text(axes, label.x, label.y, label.text, SIZE, COLORS[style.color], ha=anchor, halo=True)


def _dot(axes: Any, dot: Dot) -> None:
    if dot.failed:
        axes.plot([dot.x], [dot.y], "x", color=COLORS[dot.style.color], ms=6.0 * POINT, mew=1.4, zorder=6)
        return
    alpha = FAINT if dot.faint else 1.0
    if dot.low != dot.high:
        axes.plot([dot.x, dot.x], [dot.low, dot.high], color=COLORS[dot.style.color], lw=1.0, alpha=alpha, zorder=5)
    _marker(axes, dot.x, dot.y, dot.style, 6.0 if dot.faint else 8.5, alpha)


def _marker(axes: Any, x: float, y: float, style: Style, size: float, alpha: float) -> None:
    color = COLORS[style.color]
    inside = "white" if style.hollow else color
    size *= POINT
    if style.hollow:  # nothing shows through
        axes.plot([x], [y], MARKERS[style.marker], ms=size, mfc="white", mec="white", zorder=6)
    axes.plot([x], [y], MARKERS[style.marker], ms=size, mfc=inside, mec=color, mew=1.1, alpha=alpha, zorder=6)


def _text(
    axes: Any,
    x: float,
    y: float,
    text: str,
    size: float,
    color: str = INK,
    halo: bool = False,
    va: str = "center",
    **more: Any,
) -> None:
    back = {"facecolor": "white", "alpha": 0.75, "lw": 0.0, "pad": 0.6} if halo else None
    safe = text.replace("$", r"\$")  # it is no formula
    axes.text(x, y, safe, fontsize=size * POINT, color=color, va=va, bbox=back, zorder=7, **more)
