"""Draws docs/accuracy/front.png: median error over the bodies against cost, of sssgen and of published shaders."""

from __future__ import annotations

import io
from typing import Any

import accuracy_goals

from sssgen.lab.chart.drawing import figure as charts
from sssgen.lab.chart.record import Record
from sssgen.support.extras import need

SIZE, DPI = (8.0, 4.6), 175
"""Inches, and pixels in an inch."""
COSTS, STEPS_OF_COST = (10.0, 2000.0), (10, 20, 50, 100, 200, 500, 1000, 2000)
OURS, PUBLISHED = "#c2541b", "#5f6368"
STEPS = (120.0, 250.0, 500.0)
"""Costs whose best chain has its error written beside it, as the goals have them."""


def drawn(record: Record) -> bytes:
    """The picture as a PNG; chains for a light that is fixed to the body are left out."""
    ours, published = [], []
    for chain in accuracy_goals.chains(record, fixed=False):
        (published if chain.baseline else ours).append(chain)
    with charts.settings():
        figure = need("matplotlib.figure", extra="chart").Figure(figsize=SIZE, layout="constrained")
        axes = figure.add_subplot()
        for group, color, filled, label in ((published, PUBLISHED, False, "published"), (ours, OURS, True, "sssgen")):
            face = color if filled else "none"
            costs, errors = [chain.cost for chain in group], [chain.error for chain in group]
            alpha = 0.22 if filled else 0.9
            axes.scatter(
                costs, errors, s=16, facecolors=face, edgecolors=color, linewidths=0.8, alpha=alpha, label=label
            )
        front = _front(ours)
        costs, errors = [chain.cost for chain in front], [chain.error for chain in front]
        axes.step([*costs, COSTS[1]], [*errors, errors[-1]], where="post", color=OURS, linewidth=2.0)
        for limit in STEPS:
            best = min((chain for chain in ours if chain.cost <= limit), key=lambda chain: chain.error)
            axes.plot(best.cost, best.error, "o", color=OURS, markersize=6)
            _write(axes, best, f"{best.error:.2f}", OURS, 11.0)
        for chain in (published[0], min(published, key=lambda chain: chain.error)):
            _write(axes, chain, f"{chain.label}, {chain.error:.2f}", PUBLISHED, 8.5)
        axes.set(xscale="log", yscale="log", xlim=COSTS, ylim=(0.05, 1.2))
        axes.set_xlabel("cost: operations for a pixel and a light")
        axes.set_ylabel("median error over six bodies: 0 is path tracing")
        axes.set_xticks(STEPS_OF_COST, [f"{cost:g}" for cost in STEPS_OF_COST])
        axes.set_xticks([], minor=True)
        ticks = (0.05, 0.1, 0.2, 0.5, 1.0)
        axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_yticks([], minor=True)
        axes.legend(loc="lower left", fontsize=10)
        png = io.BytesIO()
        figure.savefig(png, format="png", dpi=DPI, metadata={"Software": None})
    return png.getvalue()


def _write(axes: Any, chain: accuracy_goals.Chain, text: str, color: str, size: float) -> None:
    """A text on the right of a chain's point: above it, for a published one below it."""
    place = chain.cost, chain.error
    axes.annotate(
        text,
        place,
        (7, -13 if chain.baseline else 5),
        textcoords="offset points",
        color=color,
        size=size,
        weight="bold",
    )


def _front(chains: list[accuracy_goals.Chain]) -> list[accuracy_goals.Chain]:
    """The chains that are more accurate than all cheaper ones, by cost."""
    front: list[accuracy_goals.Chain] = []
    for chain in sorted(chains, key=lambda chain: (chain.cost, chain.error)):
        if not front or chain.error < front[-1].error:
            front.append(chain)
    return front
