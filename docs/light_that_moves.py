"""Measures chains under lights that no fit used, and writes docs/light_that_moves.md with pictures.

python docs/light_that_moves.py [SCENE...] [--lights N] [--samples N] [--processes N]: half an hour on two cores. An
interrupted run continues where it stopped. With scenes, it prints the page of these and writes nothing.
"""

from __future__ import annotations

import argparse
import io
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

import numpy as np
from accuracy import INDEX, refracting, scenes
from accuracy_pictures import displayed, frame

from sssgen.lab.chart.charting import Settings, candidate_of, fit_of
from sssgen.lab.chart.drawing import figure as charts
from sssgen.lab.chart.drawn_lights import DrawnErrors, drawn_views, errors, views_of_light
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import pictures_of
from sssgen.run.backends import Array
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.extras import need
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

DOCS = Path(__file__).parent
PICTURE = "light_that_moves.png"


def chain(*techniques: str, path: str = "") -> FittedChain:
    """A chain of which nothing is fitted."""
    label = " → ".join(techniques) + (f" by {path}" if path else "")
    return {
        "role": "material", "name": label, "label": label, "baseline": False, "settings": {}, "path": path,
        "chain": list(techniques), "parameters": {}, "scale": [1.0] * 3, "matte": [0.0] * 3, "factor": "",
        "training_error": float("nan"),
    }  # fmt: skip


MATCHED = (
    chain("back_face_thickness", "fluence_factored_8", path="depth_map_path"),
    chain("fluence_relit"),
)
BOUNDARY = (
    chain("back_face_thickness", "fluence_factored_8_refracted"),
    chain("fluence_relit_refracted"),
)
"""Of each part of the page: what served moving lights before, and the volume of all lights."""


class Part(NamedTuple):
    """The bodies with one kind of surface."""

    title: str
    bodies: Sequence[MeasuredScene]
    chains: Sequence[FittedChain]
    measured: dict[str, list[DrawnErrors]]


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("scenes", nargs="*", metavar="SCENE")
    options.add_argument("--lights", type=int, default=24)
    options.add_argument("--samples", type=int, default=512, help="of a chart; a light has a quarter")
    options.add_argument("--processes", type=int)
    arguments = options.parse_args()
    settings = Settings(arguments.samples, processes=arguments.processes, progress_bar=ProgressBar)
    bodies = [body for body in map(measured_scene.load, arguments.scenes or scenes()) if body.medium is not None]
    parts = []
    for title, group, chains in (
        ("A matched boundary", bodies, MATCHED),
        (f"A smooth boundary of refractive index {INDEX}", [refracting(body) for body in bodies], BOUNDARY),
    ):
        measured = errors(group, {body.key: chains for body in group}, arguments.lights, settings)
        parts.append(Part(title, group, chains, measured))
    text = page(parts, arguments)
    if arguments.scenes:
        print(text)
        return
    files: dict[str, str | bytes] = {PICTURE: picture(parts, arguments.lights, settings)}
    write_files(str(DOCS / "accuracy"), files)
    write_files(str(DOCS), {"light_that_moves.md": text})


def page(parts: Sequence[Part], arguments: argparse.Namespace) -> str:
    """The page's text."""
    lines = [
        "# Light that moves", "",
        f"`python docs/light_that_moves.py` measures this page: each body under {arguments.lights} lights from "
        "afar, whose directions are drawn at random, the same for all bodies and chains; none was used in a fit. "
        f"The reference has {arguments.samples // 4} paths for each point and light. A figure is the error over "
        "the scene's two views, as in [accuracy.md](accuracy.md): the median over the lights, and the "
        "worst light in brackets.", "",
    ]  # fmt: skip
    for part in parts:
        names = [body.name for body in part.bodies]
        lines += [f"## {part.title}", "", f"| chain | operations | bytes | median | {' | '.join(names)} |"]
        lines.append("|---|---:|---:|---:|" + "---:|" * len(names))
        for number, each in enumerate(part.chains):
            of_bodies = [part.measured[body.key][number] for body in part.bodies]
            cells = [f"{result.median:.3f} ({result.worst:.3f})" for result in of_bodies]
            middle = f"{median(result.median for result in of_bodies):.3f} ({median(r.worst for r in of_bodies):.3f})"
            size = max(result.bytes for result in of_bodies) / 1024
            lines.append(
                f"| {each['label']} | {of_bodies[0].cost:.0f} | {size:.0f} KiB | {middle} | {' | '.join(cells)} |"
            )
        lines.append("")
    lines += [
        "The operations are those of one light; `fluence_relit` and `fluence_relit_refracted` have them once for all "
        "lights. The bytes are the largest of the bodies' textures; the file of a volume of all lights has about "
        "0.3 KiB a voxel.",
        "",
        "For each body, the light of the median error and the worst one; left half with a matched boundary, right half "
        "with a refracting one:",
        "", f"![Bodies by path tracing and by the volume of all lights](accuracy/{PICTURE})", "",
    ]  # fmt: skip
    return "\n".join(lines)


def picture(parts: Sequence[Part], count: int, settings: Settings) -> bytes:
    """The pictures as a PNG: for each body and surface the median and the worst light, path traced and ours."""
    rows: list[list[Array]] = [[] for _ in parts[0].bodies]
    for part in parts:
        views = drawn_views(part.bodies, count, settings)
        ours = part.chains[-1]
        for row, body in zip(rows, part.bodies, strict=True):
            order = np.argsort(part.measured[body.key][-1].values)
            for light in (order[(len(order) - 1) // 2], order[-1]):
                view = views_of_light(views[body.key], int(light))[0]
                values, reference = pictures_of(candidate_of(ours), fit_of(ours), view)
                inner = frame(reference)
                row += [displayed(reference[inner]), displayed(values[inner])]
    titles = ["path traced", "ours, median light", "path traced", "ours, worst light"] * len(parts)
    with charts.settings():
        figure = need("matplotlib.figure", extra="chart").Figure(figsize=(1.4 * len(titles), 1.5 * len(rows)))
        for index, axes in enumerate(figure.subplots(len(rows), len(titles)).flat):
            row, column = divmod(index, len(titles))
            axes.imshow(rows[row][column], interpolation="nearest")
            axes.axis("off")
            if row == 0:
                axes.set_title(titles[column], size=7.0)
            if column == 0:
                axes.text(0.0, -0.03, parts[0].bodies[row].title, size=6.0, va="top", transform=axes.transAxes)
        figure.tight_layout(pad=0.3)
        png = io.BytesIO()
        figure.savefig(png, format="png", dpi=120, metadata={"Software": None})
    return png.getvalue()


if __name__ == "__main__":
    main()
