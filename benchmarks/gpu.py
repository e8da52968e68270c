"""Compares the cost of emitted and handwritten shaders on a GPU: make bench-gpu, or python benchmarks/gpu.py.

    python benchmarks/gpu.py --size 320x180 --rounds 5 --json out.json --markdown out.md

The first table compares 42yeah's published scene with jelly_cubes, with the same camera and glow, and shows the
difference of their pictures. The second table compares each technique, with default parameters, with its formula in
benchmarks/by_hand. The third table shows the materials of the examples in their scenes. The last table compares chains
whose light starts inside the body with the time that the published thinness of 30 taps adds to its scene.
Emitted and handwritten programs take turns in the same run; a ratio below 1 means that the emitted program is faster.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import operator_times
import sssgen
from sssgen.lab.gpu import gpu_timing as gpu_cost
from sssgen.lab.gpu import timed_programs as gpu_programs
from sssgen.lab.gpu.gpu_timing import Program, ProgramTimes, Spread
from sssgen.lab.measure import candidates
from sssgen.lab.measure.candidates import Candidate
from sssgen.material import library
from sssgen.material.material_loading import examples
from sssgen.material.slots import needs
from sssgen.scene import scene_loading
from sssgen.scene.measured import measured_scene
from sssgen.scene.pictures.picture_difference import compare

BY_HAND = Path(__file__).parent / "by_hand"
TIME = 1.2
"""A time at which both cubes and the shadow are visible, in seconds."""
BODY = {"body_distance": "sphere", "scene_distance": "sphere", "distance_at": "distance_texture"}
"""Slot → the function that is bound to it; the programs in by_hand use the same functions."""
REACH = 1.5
"""The reach of the thinness techniques; with it the last taps leave the ball on the far side."""
BODY_SCENE = "cube"
"""The scene at whose points chains are timed."""
EVALUATIONS = 32
"""Evaluations of a technique per pixel; reading the inputs would hide the cost of one evaluation."""


class Table(NamedTuple):
    title: str
    head: list[str]
    rows: list[list[str]]


def published(aspect: float) -> Program:
    """42yeah's scene as published, written by hand."""
    return Program(
        "jelly_cubes published", (BY_HAND / "jelly_cubes_published.glsl").read_text(), {"time": TIME, "aspect": aspect}
    )


def emitted(aspect: float) -> Program:
    """The same scene, emitted, with the same field of view."""
    compiled = sssgen.compile("jelly_cubes", "glsl-330")
    values = {uniform["name"]: uniform["default"] for uniform in compiled.reflection["uniforms"]}
    # 0.9 of the largest value of the mean in the published scene, 0.38667
    values |= {"time": [TIME], "aspect": [aspect], "glow_strength": [0.9 * 0.38667]}
    return Program("jelly_cubes emitted", compiled.files["jelly_cubes.glsl-330.frag"], values)


def hand_written() -> dict[str, str]:
    """Technique → the file text that contains its handwritten form."""
    texts = [path.read_text() for path in sorted(BY_HAND.glob("*.glsl"))]
    results = {name: text for text in texts for name in re.findall(r"^\w+ (\w+)\(", text, re.MULTILINE)}
    return {name: text for name, text in results.items() if name in library.index()}


def techniques(points: gpu_programs.Points, evaluations: int) -> list[tuple[Program, Program]]:
    """Pairs of programs for each technique: emitted, handwritten."""
    pairs = []
    for name, text in hand_written().items():
        technique = library.load(name)
        bind = {slot.name: BODY[slot.name] for slot in needs(technique.module, technique.function)[1]}
        values = {"reach": REACH} if bind and name.startswith("thinness_") else {}
        result = [
            gpu_programs.of_technique(name, points, bind, evaluations, text=source, values=values)
            for source in ("", text)
        ]
        pairs.append((result[0], result[1]))
    return pairs


def frame(spread: Spread, software: bool) -> str:
    """A time in milliseconds; a dash for a software rasteriser."""
    return "–" if software else f"{spread.median:.4g} ({spread.low:.4g}–{spread.high:.4g})"


def times(spread: Spread) -> str:
    return f"{spread.median:.2f} ({spread.low:.2f}–{spread.high:.2f})"


def jelly_cubes(size: tuple[int, int], rounds: int) -> tuple[Table, ProgramTimes, dict[str, Any]]:
    """The table of 42yeah's scene."""
    pair = published(size[0] / size[1]), emitted(size[0] / size[1])
    pictures = [gpu_cost.picture(program, size)[::-1, :, :3] for program in pair]
    flip = compare(pictures[1], pictures[0]).flip
    result = gpu_cost.measure(pair, size, rounds)
    rows = [
        [
            program.name,
            frame(result.raw(program.name), result.device.software),
            times(result.ratio(program.name, pair[0].name)),
        ]
        for program in pair
    ]
    title = f"42yeah's scene; FLIP between the two pictures {flip:.4f}"
    return Table(title, ["", "ms per frame", "× published"], rows), result, {"flip": flip}


def by_technique(size: tuple[int, int], rounds: int, evaluations: int) -> tuple[Table, ProgramTimes, dict[str, Any]]:
    """The table of the techniques, with the ratio to the handwritten form."""
    pairs = techniques(gpu_programs.ball_points(size), evaluations)
    result = gpu_cost.measure([program for pair in pairs for program in pair], size, rounds)
    rows, ratios = [], {}
    for program, reference in pairs:
        ratio = result.ratio(program.name, reference.name)
        ratios[program.name] = [round(value, 4) for value in ratio]
        cells = [frame(result.net(name), result.device.software) for name in (program.name, reference.name)]
        rows.append([program.name, *cells, times(ratio)])
    title = (
        f"Techniques, {evaluations} evaluations per pixel; ms per evaluation at all pixels, without reading the inputs"
    )
    return Table(title, ["", "emitted", "by hand", "emitted / by hand"], rows), result, {"ratios": ratios}


def by_example(size: tuple[int, int], rounds: int) -> tuple[Table, ProgramTimes, dict[str, Any]]:
    """The table of the examples' materials in their scenes."""
    scenes = {name: scene_loading.load(name) for name in examples()}
    chosen = [gpu_programs.TimedMaterial(name, scene.material, scene) for name, scene in scenes.items()]
    timing = gpu_programs.costs(chosen, size, rounds)
    rows = [
        [
            material.name,
            frame(timing.net(material.name), timing.device.software),
            times(timing.ratio(material.name, chosen[0].name)),
        ]
        for material in chosen
    ]
    return Table("The examples' materials", ["", "ms per frame", f"× {chosen[0].name}"], rows), timing, {}


def interior(size: tuple[int, int], rounds: int) -> tuple[Table, ProgramTimes, dict[str, Any]]:
    """The table of the techniques that know the light inside a body, beside the published thinness of 30 taps."""
    scene = published(size[0] / size[1])
    call = "thinness(p, n)"
    assert scene.fragment.count(f"float thin = {call}") == 1
    fragment = scene.fragment.replace(f"= {call}", "= 0.0")
    without = scene._replace(name=f"{scene.name}, without thinness", fragment=fragment)
    result = gpu_cost.measure([scene, without], size, rounds)
    added = result.raw(scene.name).median - result.raw(without.name).median
    pixels_per_ns = size[0] * size[1] / 1e6
    rows = [["published thinness", "–" if result.device.software else f"{added:.4g}", "1"]]
    ratios, details = {}, {}
    chains = operator_times.time_chains(chains_inside(), measured_scene.load(BODY_SCENE), size, rounds)
    for label, ns, count in zip(chains.labels, chains.ns, chains.counts, strict=True):
        median = pixels_per_ns * float(np.median(ns))
        ratios[label] = median / added
        details[label] = {"ns": float(np.median(ns)), **count}
        ms = "–" if chains.driver.software else f"{median:.4g}"
        rows.append([label, ms, f"{median / added:.3f}"])
    title = "ms at all pixels for one light, and relative to what the published thinness of 30 taps adds to its scene"
    return Table(title, ["", "ms", "× published"], rows), result, {
        "added_ms": added, "of_thinness": ratios, "chains": details
    }  # fmt: skip


def chains_inside() -> list[Candidate]:
    """Our chains whose light starts inside the body, with back faces from the eye and a depth map from the light."""
    views = [candidate for candidate in candidates.view_thickness() if candidate.name == "back_face_thickness"]
    paths = [candidate for candidate in candidates.thickness() if candidate.name == "depth_map_path"]
    return [
        candidate
        for candidate in candidates.materials((), views, paths)
        if candidate.techniques and not candidate.baseline
    ]


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


TABLES = ("jelly_cubes", "techniques", "examples", "interior")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1920x1080", help="width and height in pixels")
    parser.add_argument("--rounds", type=int, default=gpu_cost.ROUNDS)
    parser.add_argument("--evaluations", type=int, default=EVALUATIONS, help="evaluations of a technique per pixel")
    parser.add_argument("--table", choices=TABLES, action="append", help="only these")
    parser.add_argument("--json", help="a file for all numbers")
    parser.add_argument("--markdown", help="a file for the tables")
    options = parser.parse_args()
    width, height = (int(side) for side in options.size.split("x"))
    size = width, height

    tables, record = [], {}
    timed: dict[str, Callable[[], tuple[Table, ProgramTimes, dict[str, Any]]]] = {
        "jelly_cubes": lambda: jelly_cubes(size, options.rounds),
        "techniques": lambda: by_technique(size, options.rounds, options.evaluations),
        "examples": lambda: by_example(size, options.rounds),
        "interior": lambda: interior(size, options.rounds),
    }
    for name in options.table or TABLES:
        table, result, more = timed[name]()
        tables.append(table)
        record[name] = {**result.record(), **more}
        print(as_text(table), flush=True)
    device = (
        f"{result.device.renderer}, {result.device.version}; {width} × {height}, medians of {options.rounds} rounds"
    )
    message = f"{device}, with the 10th and 90th percentiles."
    print(message + (" Software: ratios only." if result.device.software else ""))
    if options.json:
        Path(options.json).write_text(json.dumps(record, indent=1) + "\n")
    if options.markdown:
        Path(options.markdown).write_text("\n".join([*map(as_markdown, tables), message, ""]))


if __name__ == "__main__":
    main()
