"""The cost of emitted shaders on a GPU against hand-written ones: make bench-gpu, or python benchmarks/gpu.py.

    python benchmarks/gpu.py --size 320x180 --rounds 5 --json out.json --markdown out.md

First 42yeah's scene as published against jelly_cubes with the same camera and glow, and how far apart their pictures
are. Then each technique with its defaults against its formula in benchmarks/by_hand. Last the examples' materials in
their scenes. Emitted and written by hand take turns in the same run; below 1 the emitted one is the faster.
"""

from __future__ import annotations

import argparse
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

import sssgen
from sssgen.harness.pictures.picture_difference import compare
from sssgen.harness.scenes import scene_loading
from sssgen.lab.gpu import gpu_timing as gpu_cost
from sssgen.lab.gpu import timed_programs as gpu_programs
from sssgen.lab.gpu.gpu_timing import Measured, Program, Spread
from sssgen.material import library
from sssgen.material.material_loading import examples
from sssgen.material.slots import needs

BY_HAND = Path(__file__).parent / "by_hand"
TIME = 1.2
"""Where both cubes and the shadow are seen."""
BODY = {"body_distance": "sphere", "scene_distance": "sphere", "distance_at": "distance_texture"}
"""What the techniques' slots are bound to; by_hand has the same."""
REACH = 1.5
"""Of thinness: on the far side of the ball the taps come out again."""
EVALUATIONS = 32
"""Of a technique at each pixel: one alone is hidden behind the reading of its inputs."""


class Table(NamedTuple):
    title: str
    head: list[str]
    rows: list[list[str]]


def published(aspect: float) -> Program:
    """42yeah's scene, by hand."""
    return Program(
        "jelly_cubes published", (BY_HAND / "jelly_cubes_published.glsl").read_text(), {"time": TIME, "aspect": aspect}
    )


def emitted(aspect: float) -> Program:
    """The same, emitted: its image has the other's width."""
    compiled = sssgen.compile("jelly_cubes", "glsl-330")
    values = {one["name"]: one["default"] for one in compiled.reflection["uniforms"]}
    # 0.9 of a mean that was never more than 0.38667
    values |= {"time": [TIME], "aspect": [aspect], "glow_strength": [0.9 * 0.38667]}
    return Program("jelly_cubes emitted", compiled.files["jelly_cubes.glsl-330.frag"], values)


def hand_written() -> dict[str, str]:
    """Technique → the text that has it by hand."""
    texts = [path.read_text() for path in sorted(BY_HAND.glob("*.glsl"))]
    results = {name: text for text in texts for name in re.findall(r"^\w+ (\w+)\(", text, re.MULTILINE)}
    return {name: text for name, text in results.items() if name in library.index()}


def techniques(points: gpu_programs.Points, evaluations: int) -> list[tuple[Program, Program]]:
    """Each technique, as emitted and by hand."""
    pairs = []
    for name, text in hand_written().items():
        technique = library.load(name)
        bind = {slot.name: BODY[slot.name] for slot in needs(technique.module, technique.function)[1]}
        values = {"reach": REACH} if bind and name.startswith("thinness_") else {}
        result = [
            gpu_programs.of_technique(name, points, bind, evaluations, text=one, values=values) for one in ("", text)
        ]
        pairs.append((result[0], result[1]))
    return pairs


def frame(spread: Spread, software: bool) -> str:
    """Milliseconds; a software rasteriser's are not shown."""
    return "–" if software else f"{spread.median:.4g} ({spread.low:.4g}–{spread.high:.4g})"


def times(spread: Spread) -> str:
    return f"{spread.median:.2f} ({spread.low:.2f}–{spread.high:.2f})"


def jelly_cubes(size: tuple[int, int], rounds: int) -> tuple[Table, Measured, dict[str, Any]]:
    """42yeah's scene."""
    pair = published(size[0] / size[1]), emitted(size[0] / size[1])
    pictures = [gpu_cost.picture(one, size)[::-1, :, :3] for one in pair]
    flip = compare(pictures[1], pictures[0]).flip
    result = gpu_cost.measure(pair, size, rounds)
    rows = [
        [one.name, frame(result.raw(one.name), result.device.software), times(result.ratio(one.name, pair[0].name))]
        for one in pair
    ]
    title = f"42yeah's scene; FLIP between the two pictures {flip:.4f}"
    return Table(title, ["", "ms a frame", "× published"], rows), result, {"flip": flip}


def by_technique(size: tuple[int, int], rounds: int, evaluations: int) -> tuple[Table, Measured, dict[str, Any]]:
    """Each technique, and the ratio to its hand-written twin."""
    pairs = techniques(gpu_programs.ball_points(size), evaluations)
    result = gpu_cost.measure([one for pair in pairs for one in pair], size, rounds)
    rows, ratios = [], {}
    for one, other in pairs:
        ratio = result.ratio(one.name, other.name)
        ratios[one.name] = [round(value, 4) for value in ratio]
        cells = [frame(result.net(name), result.device.software) for name in (one.name, other.name)]
        rows.append([one.name, *cells, times(ratio)])
    title = (
        f"Each technique, {evaluations} evaluations a pixel; ms of one at every pixel, less the reading of its inputs"
    )
    return Table(title, ["", "emitted", "by hand", "emitted / by hand"], rows), result, {"ratios": ratios}


def by_example(size: tuple[int, int], rounds: int) -> tuple[Table, Measured, dict[str, Any]]:
    """The examples' materials in their scenes."""
    scenes = {name: scene_loading.load(name) for name in examples()}
    chosen = [gpu_programs.TimedMaterial(name, one.material, one) for name, one in scenes.items()]
    timing = gpu_programs.costs(chosen, size, rounds)
    rows = [
        [one.name, frame(timing.net(one.name), timing.device.software), times(timing.ratio(one.name, chosen[0].name))]
        for one in chosen
    ]
    return Table("The examples' materials", ["", "ms a frame", f"× {chosen[0].name}"], rows), timing, {}


def as_markdown(table: Table) -> str:
    lines = [f"### {table.title}", "", "| " + " | ".join(table.head) + " |", "|---|" + "---:|" * (len(table.head) - 1)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in table.rows), ""])


def as_text(table: Table) -> str:
    widths = [max(len(row[at]) for row in [table.head, *table.rows]) for at in range(len(table.head))]
    lines = [
        "  ".join(
            cell.rjust(width) if at else cell.ljust(width)
            for at, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in [table.head, *table.rows]
    ]
    return "\n".join([table.title, *lines, ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1920x1080", help="width and height in pixels")
    parser.add_argument("--rounds", type=int, default=gpu_cost.ROUNDS)
    parser.add_argument("--evaluations", type=int, default=EVALUATIONS, help="of a technique at each pixel")
    parser.add_argument("--json", help="a file for all numbers")
    parser.add_argument("--markdown", help="a file for the tables")
    options = parser.parse_args()
    width, height = (int(side) for side in options.size.split("x"))
    size = width, height

    tables, record = [], {}
    for name, (table, result, more) in {
        "jelly_cubes": jelly_cubes(size, options.rounds),
        "techniques": by_technique(size, options.rounds, options.evaluations),
        "examples": by_example(size, options.rounds),
    }.items():
        tables.append(table)
        record[name] = {**result.record(), **more}
        print(as_text(table), flush=True)
    device = (
        f"{result.device.renderer}, {result.device.version}; {width} × {height}, medians of {options.rounds} rounds"
    )
    message = f"{device}, with what 8 of 10 rounds lie between."
    print(message + (" Software: ratios only." if result.device.software else ""))
    if options.json:
        Path(options.json).write_text(json.dumps(record, indent=1) + "\n")
    if options.markdown:
        Path(options.markdown).write_text("\n".join([*map(as_markdown, tables), message, ""]))


if __name__ == "__main__":
    main()
