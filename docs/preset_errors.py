"""Measures the presets against path tracing, and writes docs/preset_errors.md.

python docs/preset_errors.py [PRESET...] [--bodies NAME,...] [--qualities NAME,...] [--lights N] [--samples N]
[--processes N]. A preset takes minutes on each body; an interrupted run continues where it stopped.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple, TypedDict

import numpy as np
from accuracy import SPOT, scenes

from sssgen.interchange.material_writer import mean_chord
from sssgen.jobs.executor import Item
from sssgen.lab.chart.charting import Settings, results_of
from sssgen.lab.chart.drawn_lights import cases_of, drawn_views
from sssgen.lab.measure import fluence_inputs
from sssgen.lab.measure.written_material import WrittenError
from sssgen.presets.preset import Preset, presets
from sssgen.presets.preset_stages import BodySize, preset_stages
from sssgen.presets.qualities import QUALITIES
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.mesh_files import FileContent
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

DOCS = Path(__file__).parent
RECORD = DOCS / "presets" / "errors.json"
FITTED = ("wax", "jade", "skin_fair", "soap")
"""The presets that the constants of `fast` and `good` were fitted to, on the torus and the mouse, two also on Spot."""


class Row(TypedDict):
    """A preset in a quality on a body."""

    preset: str
    quality: str
    body: str
    errors: list[float]
    """One for each light"""
    level: list[float]
    """The light of the material over that of the reference, per channel, the median over the lights: 1 is right"""
    operations: int


class Filled(NamedTuple):
    """A body of a preset's medium."""

    preset: Preset
    size: BodySize
    scene: MeasuredScene


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("presets", nargs="*", metavar="PRESET", help="default: all whose light is scattered")
    options.add_argument("--bodies", type=lambda text: text.split(","), default=scenes())
    options.add_argument("--qualities", type=lambda text: text.split(","), default=list(QUALITIES))
    options.add_argument("--lights", type=int, default=8)
    options.add_argument("--samples", type=int, default=512, help="a light has a quarter of them")
    options.add_argument("--processes", type=int)
    arguments = options.parse_args()
    settings = Settings(arguments.samples, processes=arguments.processes, progress_bar=ProgressBar)
    bodies = [body for body in map(body_of, arguments.bodies) if body.medium is not None]
    chosen = [
        preset for name, preset in presets().items() if preset.scatters and name in (arguments.presets or presets())
    ]
    rows = measured([filled(preset, body) for preset in chosen for body in bodies], arguments, settings)
    text = page(rows, arguments)
    write_files(str(RECORD.parent), {RECORD.name: json.dumps(rows, indent=1) + "\n"})
    write_files(str(DOCS), {"preset_errors.md": text})


def body_of(name: str) -> MeasuredScene:
    """The scene of a body; that of Spot is the page's own."""
    return measured_scene.load(str(SPOT) if name == "spot" else name)


def filled(preset: Preset, body: MeasuredScene) -> Filled:
    """The body with the preset's medium, as large as the preset assumes."""
    vertices, faces = mesh_of(body.geometry)
    content = FileContent(vertices, faces, None)
    size = BodySize(preset.size_mm / float(np.ptp(vertices, axis=0).max()), mean_chord(content))
    return Filled(preset, size, dataclasses.replace(body, medium=preset.interior(size.unit_mm), lights=()))


def measured(bodies: Sequence[Filled], arguments: argparse.Namespace, settings: Settings) -> list[Row]:
    """All bodies in all qualities."""
    views = drawn_views([body.scene for body in bodies], arguments.lights, settings)
    items, labels = [], []
    for body in bodies:
        for quality in arguments.qualities:
            if quality == "best":
                with settings.progress_bar() as progress:
                    fluence_inputs.prepare(body.scene, settings.scheduler, settings.processes, progress)
            stages = [
                stage
                for stage in preset_stages(body.preset, quality, body.size)
                if stage.technique != "seen_through_body"
            ]
            cases = cases_of(views[body.scene.key])
            title = f"{body.preset.name}, {quality}, on {body.scene.name}"
            items.append(Item("sssgen.lab.measure.written_material:measure", (stages, cases), title))
            labels.append((body.preset.name, quality, body.scene.name))
    results: list[list[WrittenError]] = results_of(items, settings)
    return [
        {
            "preset": preset, "quality": quality, "body": body, "errors": [each.error for each in result],
            "level": np.median([each.level for each in result], axis=0).tolist(), "operations": result[0].operations,
        }
        for (preset, quality, body), result in zip(labels, results, strict=True)
    ]  # fmt: skip


def page(rows: Sequence[Row], arguments: argparse.Namespace) -> str:
    """The page's text."""
    qualities, names, bodies = (list(dict.fromkeys(row[key] for row in rows)) for key in ("quality", "preset", "body"))
    command = (
        f"python docs/preset_errors.py {' '.join(names)} --bodies {','.join(bodies)} --qualities {','.join(qualities)}"
    )
    lines = [
        "# The error of each preset", "",
        f"`{command} --lights {arguments.lights} --samples {arguments.samples}` measures this page: presets whose "
        f"light is scattered, on {', '.join(bodies)} in the size that the preset assumes, under {arguments.lights} "
        f"lights from afar, drawn at random{only(rows, names, bodies)}. The reference is path tracing through the "
        "refracting boundary, "
        f"{arguments.samples // 4} paths for each point and light. The materials are those that `sssgen use` writes; "
        f"the constants of `fast` and `good` were fitted to {', '.join(FITTED)}, and to no other preset.", "",
        "A figure is the root of relMSE over two views ([accuracy.md](accuracy.md)), the median over bodies and "
        "lights, and in brackets the median of the worst body. *Level* is the material's light over that of the "
        "reference in red, green and blue, the median over the bodies: 1 is right.", "",
        "| preset | " + " | ".join(f"{quality} | level" for quality in qualities) + " |",
        "|---|" + "---:|---:|" * len(qualities),
        *(f"| {name} | " + " | ".join(cells(rows, name, quality) for quality in qualities) + " |" for name in names),
        "| **median** | " + " | ".join(f"{summary(rows, quality):.3f} | " for quality in qualities) + " |", "",
    ]  # fmt: skip
    return "\n".join(lines)


def only(rows: Sequence[Row], names: Sequence[str], bodies: Sequence[str]) -> str:
    """The bodies on which not all presets were measured, with the presets that were."""
    text = ""
    for body in bodies:
        measured_on = [name for name in names if any(row["body"] == body and row["preset"] == name for row in rows)]
        if len(measured_on) < len(names):
            text += f"; {body} with {', '.join(measured_on)} alone"
    return text


def cells(rows: Sequence[Row], preset: str, quality: str) -> str:
    """The error and the level of a preset in a quality."""
    own = [row for row in rows if row["preset"] == preset and row["quality"] == quality]
    errors = [median(row["errors"]) for row in own]
    level = np.median([row["level"] for row in own], axis=0)
    return f"{median(errors):.3f} ({max(errors):.3f}) | {' '.join(f'{part:.2f}' for part in level)}"


def summary(rows: Sequence[Row], quality: str) -> float:
    """The median over presets, bodies and lights."""
    return median(error for row in rows if row["quality"] == quality for error in row["errors"])


if __name__ == "__main__":
    main()
