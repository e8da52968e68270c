"""Curves of techniques: the result over one input, by the NumPy that sssgen emits.

The input is the angle of the light, or of the eye; or a length, a thinness, a transmittance or a grey. A technique has
no curve if it takes none of these, or if it takes what only a body has: a texture, a position, a distance function.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from markup import number
from picture import Picture
from sssgen.ir.types import Sampler, spell
from sssgen.material.library import Technique
from sssgen.material.technique_facts import facts_of
from sssgen.run import backends
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import evaluate
from sssgen.run.evaluate.probes import subject
from sssgen.support.diagnostics import SssgenError

STEPS = 181
PANELS = 4
COLUMNS = 2
SIZE = 3.7, 2.4
"""Of a panel, in inches."""
DOTS = 120
"""Per inch."""
CHANNELS = "#c0392b", "#27864a", "#2b6cc0"
ONE = "#333333"
STYLES = ((":", 1.4), ("-", 1.8), ("--", 1.4))
"""Of the curves for the lowest value, the default and the highest: dashes and width."""
SAME = 1e-4
"""The least difference, as a part of the highest value, between curves that are shown beside each other."""
ALIKE = 0.005
"""The largest difference, as a part of the highest value, between components that are shown as one."""

NORMAL, TANGENT, BITANGENT = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
DIRECTIONS = {"N": NORMAL, "V": NORMAL, "T": TANGENT, "B": BITANGENT}
QUANTITIES: Mapping[str, object] = {
    "thickness": 0.2, "view_thickness": 0.2, "thinness": 0.5, "transmittance": 0.5, "uv_position": (0.0, 0.0),
}  # fmt: skip
"""Of a point, where the curve is over something else."""
SURFACE: Mapping[str, object] = {
    "albedo": (0.8, 0.8, 0.8), "light_color": (1.0, 1.0, 1.0), "metallic": 0.0, "roughness": 0.5, "specular": 0.04,
    "clearcoat": 0.0, "clearcoat_roughness": 0.1,
}  # fmt: skip


class Sweep(NamedTuple):
    """The input below the curve."""

    name: str
    label: str
    ticks: Array
    values: Array


def sweep_of(technique: Technique) -> Sweep | None:
    """What the curves of a technique are over."""
    params = {param.name: param for param in technique.function.params if param.direction != "out"}
    if any(isinstance(uniform.type, Sampler) for uniform in technique.uniforms) or technique.slots:
        return None
    for name, label, largest in (("L", "light", 180.0), ("V", "eye", 89.0), ("ray_direction", "ray", 180.0)):
        if name in params:
            angle = np.linspace(0.0, largest, STEPS)
            radians = np.radians(angle)
            way = np.stack([np.sin(radians), np.zeros(STEPS), np.cos(radians)], axis=-1)
            axis = "normal" if "N" in params or "L" in params else "vertical"
            way = way if axis == "normal" else way[:, [0, 2, 1]]
            return Sweep(name, f"angle between the {label} and the {axis}, in degrees", angle, way)
    for name, param in params.items():
        if param.quantity in ("thickness", "view_thickness", "thinness", "transmittance"):
            unit = ", in world units" if "thickness" in param.quantity else ""
            values = np.linspace(0.0, 1.0, STEPS)
            return Sweep(name, param.quantity.replace("_", " ") + unit, values, values)
        if spell(param.type) == "vec3" and not param.quantity and len(params) == 1:
            values = np.linspace(0.0, 4.0, STEPS)
            return Sweep(name, f"{name}, a grey", values, np.repeat(values[:, None], 3, axis=1))
    return None


def default_curve(technique: Technique) -> Picture | None:
    """A picture of the result with all defaults, and its caption."""
    sweep = sweep_of(technique)
    result = _result(technique, sweep, {}) if sweep is not None else None
    if sweep is None or result is None:
        return None
    figure, (panel,) = _figure(1)
    _draw(panel, sweep, result, *STYLES[1])
    _finish(panel, sweep)
    caption = f"The result over the {sweep.label}, with the defaults"
    return Picture(_pixels(figure), caption + _conditions(technique, sweep) + _colors(result))


def curves_at_the_ends(technique: Technique) -> Picture | None:
    """A picture of the results with each parameter at the ends of its range, and its caption."""
    sweep = sweep_of(technique)
    usual = _result(technique, sweep, {}) if sweep is not None else None
    if sweep is None or usual is None:
        return None
    panels = []
    for parameter in facts_of(technique)["parameters"]:
        low, high = (*parameter.get("range", ()), None, None)[:2]
        if low is None or high is None or parameter["type"] != "float":
            continue
        ends = [_result(technique, sweep, {parameter["name"]: end}) for end in (low, high)]
        largest = max(float(np.abs(usual).max()), 1e-6)
        shown = [end if end is not None and np.abs(end - usual).max() > SAME * largest else None for end in ends]
        if any(end is not None for end in shown):
            panels.append((parameter["name"], ((low, shown[0]), (parameter["default"][0], usual), (high, shown[1]))))
    if not panels:
        return None
    panels = panels[:PANELS]
    figure, axes = _figure(len(panels))
    for panel, (name, curves) in zip(axes, panels, strict=True):
        for (value, result), style in zip(curves, STYLES, strict=True):
            _draw(panel, sweep, result, *style, number(value))
        _finish(panel, sweep)
        panel.set_title(name, fontsize=9)
        panel.legend(fontsize=7, frameon=False)
    names = ", ".join(name for name, _ in panels)
    caption = f"The result over the {sweep.label}, with {names} at the lowest value of the range (dotted), the default "
    caption += "and the highest (dashed), the others with their defaults"
    return Picture(_pixels(figure), caption + _conditions(technique, sweep) + _colors(usual))


def _conditions(technique: Technique, sweep: Sweep) -> str:
    """The values of the other inputs, as a reader needs them."""
    found = []
    for param in technique.function.params:
        value = QUANTITIES.get(param.quantity or "", SURFACE.get(param.name))
        if param.name != sweep.name and isinstance(value, float) and param.direction != "out":
            found.append(f"{(param.quantity or param.name).replace('_', ' ')} {value:g}")
        elif param.name == "V" != sweep.name:
            found.append("the eye along the normal")
    return f"; {', '.join(found)}" if found else ""


def _colors(result: Array) -> str:
    return "" if _is_grey(result) else "; red, green, blue: the components, in this order"


def _result(technique: Technique, sweep: Sweep, values: Mapping[str, Any]) -> Array | None:
    """The first output, (steps, components); None if an input has no usual value."""
    inputs: dict[str, Any] = {}
    for param in technique.function.params:
        if param.direction == "out":
            continue
        usual = QUANTITIES.get(param.quantity or "", {**DIRECTIONS, **SURFACE}.get(param.name))
        if param.name != sweep.name and usual is None:
            return None
        inputs[param.name] = sweep.values if param.name == sweep.name else usual
    try:
        outputs = evaluate(subject(technique.name), {**inputs, **values}, backends.get("numpy"))
    except SssgenError:  # such as an array among the uniforms
        return None
    first = np.asarray(next(iter(outputs.values())), np.float64)
    return np.broadcast_to(first.reshape(first.shape[0], -1), (STEPS, math.prod(first.shape[1:])))


def _figure(count: int) -> tuple[Figure, Sequence[Axes]]:
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    figure = Figure(figsize=(SIZE[0] * columns, SIZE[1] * rows), dpi=DOTS, layout="constrained")
    return figure, [figure.add_subplot(rows, columns, place + 1) for place in range(count)]


def _draw(panel: Axes, sweep: Sweep, result: Array | None, dashes: str, width: float, label: str = "") -> None:
    if result is None:
        return
    colors = (ONE,) if _is_grey(result) else CHANNELS
    for channel, color in zip(result.T, colors, strict=False):
        name = label if color == colors[0] else ""
        panel.plot(sweep.ticks, channel, dashes, color=color, linewidth=width, label=name or "_")


def _is_grey(result: Array) -> bool:
    return bool(np.abs(result - result[:, :1]).max() <= ALIKE * np.abs(result).max())


def _finish(panel: Axes, sweep: Sweep) -> None:
    panel.set_xlabel(sweep.label, fontsize=8)
    panel.tick_params(labelsize=7)
    panel.set_xlim(sweep.ticks[0], sweep.ticks[-1])
    panel.grid(alpha=0.25)
    panel.spines[["top", "right"]].set_visible(False)


def _pixels(figure: Figure) -> Array:
    """(height, width, 3), sRGB."""
    with matplotlib.rc_context({"font.family": "DejaVu Sans"}):
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()
    pixels: Array = np.asarray(canvas.buffer_rgba())[..., :3] / 255.0
    return pixels
