"""Measures chains under lights that no fit used, and writes docs/light_that_moves.md with pictures.

python docs/light_that_moves.py [SCENE...] [--lights N] [--samples N] [--processes N]. An interrupted run continues
where it stopped. With scenes, it prints the page of these, and writes only the pictures of the surroundings.
"""

from __future__ import annotations

import argparse
import io
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

import moving_goals
import numpy as np
from accuracy import INDEX, refracting, scenes
from accuracy_pictures import displayed, frame

from sssgen.lab.chart import bent_arm
from sssgen.lab.chart.case_errors import NEAR, CaseErrors, cost_of, errors
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of
from sssgen.lab.chart.drawing import figure as charts
from sssgen.lab.chart.drawn_lights import Case, cases_of, drawn_views, environment_cases, lamp_views
from sssgen.lab.chart.skies import skies
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import pictures_of
from sssgen.run.backends import Array
from sssgen.scene.environment import Environment, digest
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import points
from sssgen.scene.pictures.images import encode_srgb, png_bytes
from sssgen.support.extras import need
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

DOCS = Path(__file__).parent
LOOPS = DOCS / "light_loops"
"""What docs/light_loops.py has written"""
PICTURE = "light_that_moves.png"
ARMS = "bent_arms.png"
BENT = (0.0, 60.0, 90.0)
"""The angles of the arms, in degrees"""


def chain(*techniques: str, path: str = "") -> FittedChain:
    """A chain of which nothing is fitted."""
    label = " → ".join(techniques) + (f" by {path}" if path else "")
    return {
        "role": "material", "name": label, "label": label, "baseline": False, "settings": {}, "path": path,
        "chain": list(techniques), "parameters": {}, "scale": [1.0] * 3, "matte": [0.0] * 3, "factor": "",
        "training_error": float("nan"),
    }  # fmt: skip


BEFORE = {
    1.0: chain("back_face_thickness", "fluence_factored_8", path="depth_map_path"),
    INDEX: chain("back_face_thickness", "fluence_factored_8_refracted"),
}
"""What served moving lights before, by the boundary's index"""
RELIT = {1.0: chain("fluence_relit"), INDEX: chain("fluence_relit_refracted")}
"""The volume of all lights"""
ONCE = chain("back_face_thickness", "fluence_relit_once")
"""The same volume at one place"""
MATTE = chain()
"""The light that a white matte surface reflects, times the albedo that fits best"""


class Row(NamedTuple):
    """A line of a table: what is measured, and its errors on each body."""

    label: str
    errors: Sequence[CaseErrors]
    chain: FittedChain | None = None
    """The chain, where the table has its cost"""


class Part(NamedTuple):
    """The bodies with one kind of surface."""

    title: str
    bodies: Sequence[MeasuredScene]
    index: float
    tables: dict[str, list[Row]]
    costs: dict[str, tuple[float, int]]
    """Operations, and the largest bytes, by the chain's label"""


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("scenes", nargs="*", metavar="SCENE")
    options.add_argument("--lights", type=int, default=24)
    options.add_argument("--samples", type=int, default=512, help="of surroundings; a light has a quarter")
    options.add_argument("--processes", type=int)
    arguments = options.parse_args()
    settings = Settings(arguments.samples, processes=arguments.processes, progress_bar=ProgressBar)
    bodies = [body for body in map(measured_scene.load, arguments.scenes or scenes()) if body.medium is not None]
    surroundings = written_skies()
    parts = [
        measured("A matched boundary", bodies, 1.0, arguments.lights, surroundings, settings),
        measured(
            f"A smooth boundary of refractive index {INDEX}", [refracting(body) for body in bodies], INDEX,
            arguments.lights, surroundings, settings,
        ),
    ]  # fmt: skip
    lines, files = bent_arms(-(-arguments.lights // 2), settings)
    text = page(parts, lines, arguments)
    if arguments.scenes:
        print(text)
        return
    files[moving_goals.RECORD.name] = json.dumps(record_of(parts, arguments), indent=1) + "\n"
    write_files(str(DOCS / "accuracy"), {PICTURE: picture(parts, arguments.lights, settings), **files})
    write_files(str(DOCS), {"light_that_moves.md": text})


def record_of(parts: Sequence[Part], arguments: argparse.Namespace) -> moving_goals.MovingRecord:
    """The page's figures."""
    return {
        "lights": arguments.lights, "samples": arguments.samples,
        "parts": [
            {
                "index": part.index, "bodies": [body.name for body in part.bodies],
                "costs": {
                    label: {"operations": operations, "bytes": size}
                    for label, (operations, size) in part.costs.items()
                },
                "tables": {
                    title: [
                        {"label": row.label, "median": [each.median for each in row.errors],
                         "worst": [each.worst for each in row.errors]}
                        for row in rows
                    ]
                    for title, rows in part.tables.items()
                },
            }
            for part in parts
        ],
    }  # fmt: skip


def written_skies() -> dict[str, Environment]:
    """The pictures of the surroundings by their names, written beside the page's other pictures."""
    files: dict[str, str | bytes] = {sky_file(name): png_bytes(encode_srgb(light)) for name, light in skies().items()}
    write_files(str(DOCS / "accuracy"), files)
    # a relative path: it is a part of the key of stored results
    paths = {name: os.path.relpath(DOCS / "accuracy" / sky_file(name)) for name in skies()}
    return {name: Environment((1.0, 1.0, 1.0), path, digest(path)) for name, path in paths.items()}


def sky_file(name: str) -> str:
    return f"sky_{name.replace(' ', '_')}.png"


def measured(
    title: str, bodies: Sequence[MeasuredScene], index: float, count: int, surroundings: dict[str, Environment],
    settings: Settings,
) -> Part:  # fmt: skip
    """All tables of one kind of surface."""
    relit, before = RELIT[index], BEFORE[index]
    keys = [body.key for body in bodies]
    far, near = drawn_views(bodies, count, settings), lamp_views(bodies, -(-count // 2), settings)
    scattered, whole = environment_cases(bodies, list(surroundings.values()), settings)

    def rows(label: str, chains: Sequence[FittedChain], cases: Mapping[str, Sequence[Case]]) -> list[Row]:
        results = errors(bodies, chains, cases, settings)
        return [
            Row(label or chain["label"], [results[key][number] for key in keys], None if label else chain)
            for number, chain in enumerate(chains)
        ]

    def lit(views: Mapping[str, Case], size: int = 1) -> dict[str, list[Case]]:
        return {key: cases_of(views[key], size) for key in keys}

    around = []
    for number, name in enumerate(surroundings):
        around += rows(f"{name}: volume", [relit], {key: scattered[key][number : number + 1] for key in keys})
    around += rows(moving_goals.ALL_AROUND, [relit], scattered)
    around += rows("all three: best matte surface", [MATTE], scattered)
    around += rows("all three: volume, against light with what is seen through the body", [relit], whole)
    tables = {
        moving_goals.AFAR: rows("", [before, ONCE, relit], lit(far)),
        "Several lights from afar": rows("two", [relit], lit(far, 2)) + rows("three", [relit], lit(far, 3)),
        # the depth map of the chain before sees no body that is on both sides of a lamp
        moving_goals.NEAR: rows("", [ONCE, relit], lit(near)),
        moving_goals.AROUND: around,
    }
    costs = {}
    for each in (before, ONCE, relit):
        of_bodies = [cost_of(each, cases_of(far[key])[0], settings) for key in keys]
        costs[each["label"]] = of_bodies[0][0], max(size for _, size in of_bodies)
    return Part(title, bodies, index, tables, costs)


def bent_arms(count: int, settings: Settings) -> tuple[list[str], dict[str, str | bytes]]:
    """The section of skinned bodies, and its picture."""
    medium = measured_scene.load("cube").medium
    assert medium is not None
    without_bake: FittedChain = json.loads((DOCS / "accuracy" / "points.json").read_text())["best"]["depth_layers_path"]
    relit = RELIT[1.0]
    lines = [
        "## A skinned body in the volume of its rest pose", "",
        "| arm of marble | volume of the rest pose | its edges | volume of this pose | its edges | "
        f"{without_bake['label']}, without a bake | its edges |", "|---|" + "---:|" * 6,
    ]  # fmt: skip
    pictures = []
    for degrees in BENT:
        body = bent_arm.scene(degrees, medium)
        views = drawn_views([body], count, settings)[body.key]
        cases = cases_of(views)
        pose, chains = errors([body], [relit, without_bake], {body.key: cases}, settings)[body.key]
        rest = bent_arm.errors_at_rest(relit, degrees, medium, cases, settings)
        cells = [part for each in (rest, pose, chains) for part in (cell(each.median, each.worst), f"{each.edge:.3f}")]
        lines.append(f"| {f'bent by {degrees:.0f} degrees' if degrees else 'straight'} | {' | '.join(cells)} |")
        order = np.argsort(rest.values)
        for light in (order[(len(order) - 1) // 2], order[-1]):
            view = cases[int(light)][0]
            visible = points(view.scene)
            fitted = candidate_of(relit), fit_of(relit)
            values, problem = bent_arm.values_at_rest(*fitted, degrees, bent_arm.scene(0.0, medium), view)
            pictures.append((visible.picture(problem.target), visible.picture(values)))
    return [*lines, ""], {ARMS: arms_picture(pictures)}


def page(parts: Sequence[Part], arms: Sequence[str], arguments: argparse.Namespace) -> str:
    """The page's text."""
    goals = moving_goals.rows(record_of(parts, arguments)) if len(parts[0].bodies) > 1 else []
    lines = [
        "# Light that moves", "",
        f"`python docs/light_that_moves.py` measures this page: bodies under {arguments.lights} lights from afar, two "
        f"and three of these together, {-(-arguments.lights // 2)} lamps at one radius from the surface, and three "
        "pictures of surroundings. Directions are drawn at random, the same for all bodies and chains; none was used "
        "in a fit. The reference is path tracing with the true lights and pictures, "
        f"{arguments.samples // 4} paths for each point and light and {arguments.samples} in surroundings: for a light "
        "what is less than about .02 is within the noise. A figure is the error over the scene's two "
        "views, as in [accuracy.md](accuracy.md): the median over the lights, and the worst light in brackets. At the "
        f"*edges* are points with both lit and dark ones within {NEAR} pixels. A body's radius is half of the longest "
        "side of its box.", "",
        "| goal: medians over the bodies | measured | |", "|---|---|---|", *goals, "",
    ]  # fmt: skip
    for part in parts:
        lines += [f"## {part.title}", "", "| chain | operations | bytes |", "|---|---:|---:|"]
        lines += [f"| {label} | {cost:.0f} | {size / 1024:.0f} KiB |" for label, (cost, size) in part.costs.items()]
        lines.append("")
        for title, rows in part.tables.items():
            lines += table(title, [body.name for body in part.bodies], rows)
    lines += [
        *loops([body.name for body in parts[0].bodies]),
        *arms,
        "A point of the bent arm carries its rest position, and its normal and its view turned back; each voxel of the "
        "rest pose has the light's direction, turned back by the rotation of its blended bones. What the pose itself "
        "changes is left out: one part of the arm that shades another, and lengths in the bent elbow. In each "
        "row the light of the median error and the worst one, path traced and by the volume of the rest pose:",
        "", f"![Arms by path tracing and by the volume of the rest pose](accuracy/{ARMS})", "",
        "## What is measured", "",
        "The operations are those of one light; `fluence_relit` and `fluence_relit_refracted` have them once for all "
        "lights and surroundings. The bytes are the largest of the bodies' textures; the file of a volume of all "
        "lights has about 0.3 KiB a voxel.",
        "",
        "The three surroundings; a volume has their spherical harmonics of order 2, the reference the pictures:", "",
        " ".join(f"![{name}](accuracy/{sky_file(name)})" for name in skies()), "",
        "Light that comes through the body without being scattered is a picture of what is behind it, and no light of "
        "a volume. It is in the last row of the surroundings only, where thin parts and silhouettes with a matched "
        "boundary show the sky behind them.",
        "",
        "For each body, the light of the median error and the worst one; left half with a matched boundary, right half "
        "with a refracting one:",
        "", f"![Bodies by path tracing and by the volume of all lights](accuracy/{PICTURE})", "",
    ]  # fmt: skip
    return "\n".join(lines)


def loops(names: Sequence[str]) -> list[str]:
    """The section of the loops of these bodies that have been drawn."""
    drawn = [name for name in names if (LOOPS / f"{name}.json").is_file()]
    if not drawn:
        return []
    lines = [
        "## Loops", "",
        "Above, a lamp goes around each body; below, a dim room with a bright window turns. On the left is the volume "
        "of all lights in the emitted shader, on the right the body path traced. What surfaces reflect is left out. "
        "`python docs/light_loops.py` draws them; the table has the error of the frames, the median and the worst one.",
        "", "| body | lamp | surroundings |", "|---|---:|---:|",
    ]  # fmt: skip
    for name in drawn:
        record = json.loads((LOOPS / f"{name}.json").read_text("utf-8"))
        cells = [cell(record[light]["median"], record[light]["worst"]) for light in ("lamp", "surroundings")]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return [*lines, "", *(f"![{name} under light that moves](light_loops/{name}.webp)" for name in drawn), ""]


def table(title: str, names: Sequence[str], rows: Sequence[Row]) -> list[str]:
    """A table's lines: the medians over the cases, and the worst case in brackets where there are several."""
    edges = any(np.isfinite(each.edge) for row in rows for each in row.errors)
    heads = ["chain" if rows[0].chain else "light", "median", *(["edges"] if edges else []), *names]
    lines = [f"### {title}", "", f"| {' | '.join(heads)} |", "|---|" + "---:|" * (len(heads) - 1)]
    for row in rows:
        cells = [cell(median(each.median for each in row.errors), median(each.worst for each in row.errors))]
        if edges:
            cells.append(f"{median(each.edge for each in row.errors):.3f}")
        cells += [cell(each.median, each.worst) for each in row.errors]
        lines.append(f"| {row.label} | {' | '.join(cells)} |")
    return [*lines, ""]


def cell(middle: float, worst: float) -> str:
    return f"{middle:.3f}" if middle == worst else f"{middle:.3f} ({worst:.3f})"


def picture(parts: Sequence[Part], count: int, settings: Settings) -> bytes:
    """The pictures as a PNG: for each body and surface the median and the worst light, path traced and ours."""
    rows: list[list[Array]] = [[] for _ in parts[0].bodies]
    for part in parts:
        views = drawn_views(part.bodies, count, settings)
        ours, far = RELIT[part.index], part.tables[moving_goals.AFAR][-1]
        for row, body, result in zip(rows, part.bodies, far.errors, strict=True):
            order = np.argsort(result.values)
            for light in (order[(len(order) - 1) // 2], order[-1]):
                view = cases_of(views[body.key])[int(light)][0]
                values, reference = pictures_of(candidate_of(ours), fit_of(ours), view)
                inner = frame(reference)
                row += [displayed(reference[inner]), displayed(values[inner])]
    titles = ["path traced", "ours, median light", "path traced", "ours, worst light"] * len(parts)
    return grid(rows, titles, [body.title for body in parts[0].bodies])


def arms_picture(pictures: Sequence[tuple[Array, Array]]) -> bytes:
    """The picture of the arms: path traced and ours, for two lights in each row."""
    rows = []
    for number in range(0, len(pictures), 2):
        row = []
        for traced, ours in pictures[number : number + 2]:
            inner = frame(traced)
            row += [displayed(traced[inner]), displayed(ours[inner])]
        rows.append(row)
    titles = ["path traced", "ours, median light", "path traced", "ours, worst light"]
    return grid(rows, titles, [f"{degrees:.0f} degrees" for degrees in BENT])


def grid(rows: Sequence[Sequence[Array]], titles: Sequence[str], names: Sequence[str]) -> bytes:
    """Pictures in rows with the columns' titles and the rows' names, as a PNG."""
    with charts.settings():
        figure = need("matplotlib.figure", extra="chart").Figure(figsize=(1.3 * len(titles), 1.4 * len(rows)))
        for index, axes in enumerate(figure.subplots(len(rows), len(titles)).flat):
            row, column = divmod(index, len(titles))
            axes.imshow(rows[row][column], interpolation="nearest")
            axes.axis("off")
            if row == 0:
                axes.set_title(titles[column], size=6.5, pad=3.0)
            if column == 0:
                axes.text(0.0, -0.03, names[row], size=6.0, va="top", transform=axes.transAxes)
        figure.subplots_adjust(0.0, 0.0, 1.0, 1.0, wspace=0.04, hspace=0.12)
        png = io.BytesIO()
        figure.savefig(png, format="png", dpi=120, bbox_inches="tight", metadata={"Software": None})
    return png.getvalue()


if __name__ == "__main__":
    main()
