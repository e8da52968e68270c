"""Writes docs/accuracy.md, and docs/accuracy/ with its pictures: python docs/accuracy.py [--scheduler ADDRESS]

It measures every figure of the pages except those of the GPU, which benchmarks/gpu.py and `--gpu` write into
docs/accuracy/*.json on a machine with a GPU. An interrupted run continues where it stopped. The whole records of the
charts are in build/accuracy/: in docs/accuracy/ is what pages quote.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import resource
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypedDict

import accuracy_front
import accuracy_goals
import accuracy_pictures
import accuracy_points
import moving_goals
import moving_trial
import pick_trial
from accuracy_pictures import moderate
from choice_pictures import ScenePictures, scene_pictures

from sssgen.lab.chart import charting as chart
from sssgen.lab.chart import drawing
from sssgen.lab.chart.charting import Settings
from sssgen.lab.chart.record import Point, Record, check_record, measures, to_json
from sssgen.lab.chart.scene_conditions import boundary, lights
from sssgen.lab.gpu import chart_times as chart_gpu
from sssgen.lab.gpu.gpu_timing import TimesRecord
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

DOCS = Path(__file__).parent
FOLDER = DOCS / "accuracy"
RECORDS = DOCS.parent / "build" / "accuracy"
"""The records of the charts, and what they were drawn from on a GPU: megabytes."""
OVERVIEW = "overview"
"""The template of docs/accuracy.md; docs/accuracy/NAME.md has the template NAME.md.in beside it."""
GPU_CHART = "gpu_chart.json"
BY_HAND = "gpu_jelly_cubes.json"
"""The record of `make bench-gpu`."""
TIMED = ("cube", "torus", "inlay_plate", "inlay_ball")
"""The scenes whose chains are timed, in one or two minutes each."""
BENT = "chart_refracting.json"
INDEX = 1.4
"""The refractive index of the bodies that are charted a second time."""
UNMEASURED = "Not measured with the present techniques: `make accuracy` without `--charts-only` measures it."
SPOT = FOLDER / "spot.toml"
MESHES = DOCS.parent.parent / "shared" / "data" / "meshes"

ROLES = {
    "material": "Whole materials",
    "translucency": "Translucency, after the exact thickness",
    "thickness": "Thickness in the light's direction",
    "view_thickness": "Length along the eye's ray",
    "coordinates": "Parallax",
}


def main() -> int:
    """Measures, draws the charts and writes the pages; with --gpu, times the chains of the stored chart instead."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--gpu", action="store_true", help="time the chains of build/accuracy/chart.json on this GPU")
    options.add_argument("--scheduler", default="")
    options.add_argument("--processes", type=int)
    options.add_argument(
        "--charts-only",
        action="store_true",
        help="without the refracting bodies and the test of pick: half of the time",
    )
    arguments = options.parse_args()
    if arguments.gpu:
        return timed()
    settings = Settings(scheduler=arguments.scheduler, processes=arguments.processes, progress_bar=ProgressBar)
    bodies = [measured_scene.load(name) for name in scenes()]
    record = chart.chart_record(bodies, settings)
    pictures = scene_pictures(record, bodies, accuracy_pictures.LIMITS, settings)
    trial, bent = None, None
    if not arguments.charts_only:
        lit = [refracting(body) for body in bodies if body.medium is not None]
        trial, bent = pick_trial.trial_rows(settings), chart.chart_record(lit, settings._replace(roles=("material",)))
    write_pages(record, pictures, trial, bent)
    print(f"{processor_minutes():.0f} minutes of processor time in this run, with its processes")
    return 0


def processor_minutes() -> float:
    """The processor time of this process and of the ended processes that it started; resumed work does not count."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(part.ru_utime + part.ru_stime for part in used) / 60.0


def scenes() -> list[str]:
    """The scenes of the page: those of examples/lab, and Spot if its mesh is there."""
    return [*chart.DEFAULTS, *([str(SPOT)] if (MESHES / "spot.obj").is_file() else [])]


def refracting(scene: MeasuredScene) -> MeasuredScene:
    """The same scene with a smooth refracting boundary."""
    assert scene.medium is not None
    return dataclasses.replace(scene, medium=dataclasses.replace(scene.medium, ior=INDEX))


def write_pages(
    record: Record,
    pictures: Sequence[ScenePictures],
    trial: Sequence[pick_trial.Row] | None,
    bent: Record | None,
) -> None:
    """Writes pictures and pages; `bent` has the bodies with a refracting boundary. What is None is not shown."""
    chart_files = drawing.chart_files(record)
    records = {name: data for name, data in chart_files.items() if name.endswith((".csv", ".json"))}
    if bent is not None:
        records[BENT] = to_json(check_record(bent))
    write_files(str(RECORDS), records)
    files = {name: moderate(data) for name, data in chart_files.items() if name.endswith(".png")}
    files["points.json"] = accuracy_points.quoted([record, *([bent] if bent is not None else [])])
    files["front.png"] = moderate(accuracy_front.drawn(record))
    write_files(str(FOLDER), files | {"pictures.png": accuracy_pictures.drawn(pictures)})
    parts: dict[str, Callable[[], str]] = {
        "scenes": lambda: scene_table(record), "fronts": lambda: fronts(record),
        "moving goals": lambda: "\n".join(moving_goals.rows(moving_goals.load())),
        "moving pick": lambda: moving_trial.goal(moving_trial.load()),
        "goals": lambda: accuracy_goals.table(record, bent, bench_gpu()["interior"]),
        "medians": lambda: accuracy_goals.medians(record, True),
        "moving": lambda: accuracy_goals.medians(record, False),
        "boundary": lambda: accuracy_goals.medians(bent, True) if bent is not None else UNMEASURED,
        "volumes": lambda: hypervolumes(record),
        "known": lambda: expected_results(record), "losses": lambda: baselines_on_fronts(record),
        "implementation": lambda: implementation(record), "gpu": gpu, "by_hand": by_hand, "inside": inside,
        "pick": lambda: pick_trial.table(trial) if trial is not None else UNMEASURED,
        "moving picks": lambda: moving_trial.table(moving_trial.load()),
    }  # fmt: skip
    texts = {
        template.name.partition(".")[0]: template.read_text(encoding="utf-8") for template in FOLDER.glob("*.md.in")
    }
    for name, part in parts.items():
        mark = f"<!-- {name} -->"
        assert sum(text.count(mark) for text in texts.values()) == 1, name
        texts = {page: text.replace(mark, part()) if mark in text else text for page, text in texts.items()}
    for page, text in texts.items():
        file = DOCS / "accuracy.md" if page == OVERVIEW else FOLDER / f"{page}.md"
        file.write_text(text, encoding="utf-8")
        print(f"wrote {file}")


def timed() -> int:
    """Times the chains on the fronts of the stored chart, and the baselines, on the local GPU."""
    stored = RECORDS / "chart.json"
    if not stored.is_file():
        print(f"{stored} is missing: python docs/accuracy.py --charts-only measures it", file=sys.stderr)
        return 1
    record = check_record(json.loads(stored.read_text(encoding="utf-8")))
    points = [point for point in record["points"] if point["front"] or point["baseline"] or point["role"] != "material"]
    names = [scene["name"] for scene in record["scenes"] if scene["name"] in TIMED]
    shortened: Record = {**record, "points": [point for point in points if point["scene"] in names]}

    def progress(completed: int, total: int, name: str) -> None:
        print(f"{completed} of {total}: {name}", file=sys.stderr, flush=True)

    timed_record = chart_gpu.with_gpu_cost(shortened, [measured_scene.load(name) for name in names], progress=progress)
    charts = drawing.chart_files(chart_gpu.by_gpu(timed_record), "gpu")
    write_files(
        str(FOLDER), {"gpu_material.png": moderate(charts["gpu_material.png"]), GPU_CHART: gpu_summary(timed_record)}
    )
    write_files(str(RECORDS), {GPU_CHART: to_json(timed_record)})
    print(timed_record["record"]["device"], timed_record["record"]["rank_correlation"])
    return 0


def gpu_summary(record: Record) -> str:
    """JSON with what the page quotes of a record with times: what was measured how, and the cube's chains."""
    chosen = {}
    for point in record["points"]:
        if point["scene"] == "cube" and point["cost"].get("gpu_ms") is not None and not point["failed"]:
            kept = {name: point["cost"][name] for name in ("value", "gpu_ms", "gpu_ms_low", "gpu_ms_high")}
            chosen[point["role"], point["label"]] = {"label": point["label"], **kept}
    chains = ",\n".join(map(json.dumps, chosen.values()))
    return f'{{"record": {json.dumps(record["record"])}, "chains": [\n{chains}\n]}}\n'


def scene_table(record: Record) -> str:
    """The table of the scenes."""
    rows = [
        "| scene | medium | σt per unit (r, g, b) | albedo (r, g, b) | boundary | lights |",
        "|---|---|---|---|---|---|",
    ]
    for scene in record["scenes"]:
        medium = scene.get("medium")
        cells = [medium["name"], *(", ".join(f"{x:.4g}" for x in medium[key]) for key in ("extinction", "albedo"))] \
            if medium else ["clear, with an inlay", "", ""]  # fmt: skip
        cells += [boundary(medium), lights(scene)] if medium else ["", ""]
        rows.append(f"| `{scene['name']}`: {scene['title']} | {' | '.join(cells)} |")
    return "\n".join(rows)


def points_of(record: Record, scene: str, role: str) -> list[Point]:
    """The points of a scene and role, by cost."""
    points = [point for point in record["points"] if point["scene"] == scene and point["role"] == role]
    return sorted(points, key=lambda point: float(point["cost"]["value"]))


def fronts(record: Record) -> str:
    """The fronts of whole materials."""
    rows = ["| scene | cost | relative error | FLIP | chain |", "|---|---:|---|---:|---|"]
    for scene in record["scenes"]:
        for point in points_of(record, scene["name"], "material"):
            if point["front"]:
                published = " (published)" if point["baseline"] else ""
                rows.append(
                    f"| {scene['name']} | {point['cost']['value']:.0f} | {error(point)} | "
                    f"{point['error']['flip']:.3f} | {point['label']}{published} |"
                )
    return "\n".join(rows)


def error(point: Point) -> str:
    """An error with its bar."""
    figures = point["error"]
    return f"{figures['value']:.3f} ({figures['low']:.3f}–{figures['high']:.3f})"


def hypervolumes(record: Record) -> str:
    """The hypervolumes."""
    rows = ["| scene | role | library | all baselines together |", "|---|---|---:|---:|"]
    rows += [
        f"| {entry['scene']} | {entry['role']} | {entry['ours']:.3f} | {entry['baselines']:.3f} |"
        for entry in record["hypervolume"]
    ]
    return "\n".join(rows)


def expected_results(record: Record) -> str:
    """The table of results that theory predicts, with the measured figures."""
    rows = ["| known answer | measured |", "|---|---|"]
    for scene in (entry["name"] for entry in record["scenes"] if "medium" in entry):
        by_label = {point["label"]: point for point in points_of(record, scene, "material")}
        ice, gdc = by_label["Unity ice"], by_label["GDC 2011"]
        rows.append(
            "| the Unity ice lobe adds nothing to its ambient light, so its fit does not change power, scale and "
            f"distortion ({scene}) | {lobe_parameters(ice)}; error {error(ice)}, with a correct lobe {error(gdc)} |"
        )
        thickness = {point["label"]: point for point in points_of(record, scene, "thickness")}
        cheap = min((point for point in thickness.values() if point["name"] == "cheap_sss_thinness"), key=value)
        best = min(thickness.values(), key=value)
        rows.append(
            f"| Cheap SSS does not measure the thickness towards the light ({scene}) | {value(cheap):.3f}, "
            f"where {best['label']} has an error of {value(best):.4f} |"
        )
    for scene in (entry["name"] for entry in record["scenes"] if "medium" not in entry):
        named = {point["name"]: point for point in points_of(record, scene, "coordinates")}
        on_plane = value(named["parallax_refracted"]) < 1e-6
        statement = (
            "corrected Subsurface Parallax is exact on a plane"
            if on_plane
            else "corrected Subsurface Parallax is not exact on a curved body"
        )
        rows.append(
            f"| {statement} ({scene}) | {value(named['parallax_refracted']):.2g}; "
            f"without refraction {value(named['parallax_straight']):.3g} |"
        )
    return "\n".join(rows)


def value(point: Point) -> float:
    """A point's error."""
    return measures(point)[1]


def lobe_parameters(point: Point) -> str:
    """The fitted values of a lobe's power, scale and distortion."""
    return ", ".join(f"{name} {point['parameters'][name][0]:.3g}" for name in ("power", "scale", "distortion"))


def baselines_on_fronts(record: Record) -> str:
    """The baselines on a front, each with the cheapest technique of the library that is as accurate."""
    rows = [
        "| scene | role | baseline | cost | error | library, at most this error | cost |",
        "|---|---|---|---:|---:|---|---:|",
    ]
    for scene in record["scenes"]:
        for role in ROLES:
            points = points_of(record, scene["name"], role)
            for point in points:
                if not point["front"] or not point["baseline"]:
                    continue
                as_good = [
                    candidate
                    for candidate in points
                    if not candidate["baseline"]
                    and not candidate["failed"]
                    and value(candidate) <= 1.001 * max(value(point), 1e-6)
                ]
                ours = min(as_good, key=lambda candidate: float(candidate["cost"]["value"]), default=None)
                nearest = f"{ours['label']} | {ours['cost']['value']:.0f}" if ours else "none | "
                rows.append(
                    f"| {scene['name']} | {role} | {point['label']} | {point['cost']['value']:.0f} | "
                    f"{value(point):.3f} | {nearest} |"
                )
    return "\n".join(rows)


def implementation(record: Record) -> str:
    """The errors of float32 and of finite counts, without the error of the model."""
    errors: dict[str, dict[str, list[float]]] = {}
    for point in record["points"]:
        if point["role"] in ("thickness", "view_thickness", "translucency", "coordinates") and not point["failed"]:
            for kind, apart in point.get("implementation", {}).items():
                if apart is not None:
                    errors.setdefault(point["label"], {}).setdefault(kind, []).append(float(apart))
    rows = ["| technique | float32 | counts |", "|---|---:|---:|"]
    for label, kinds in sorted(errors.items()):
        cells = [f"{max(kinds[kind]):.1e}" if kind in kinds else "" for kind in ("float32", "counts")]
        rows.append(f"| {label} | {' | '.join(cells)} |")
    return "\n".join(rows)


def gpu() -> str:
    """The record of the GPU, if there is one."""
    file = FOLDER / GPU_CHART
    if not file.is_file():
        return (
            "Not measured: `python docs/accuracy.py --gpu` on a machine with a GPU writes docs/accuracy/gpu_chart.json."
        )
    record = json.loads(file.read_text(encoding="utf-8"))
    about = record["record"]
    rows = [
        f"{about['device']}, {about['driver']}, {about['size'][0]} × {about['size'][1]}, {about['rounds']} rounds.",
        "", "| role | rank correlation of static cost and ms |", "|---|---:|",
        *(f"| {role} | {rank:.3f} |" for role, rank in about["rank_correlation"].items()),
        "", "<details>", "<summary>The cube's chains</summary>", "",
        "| technique | static cost | ms (10th to 90th percentile) |", "|---|---:|---|",
    ]  # fmt: skip
    for chain in record["chains"]:
        if math.isfinite(chain["gpu_ms"]):
            low, high = chain["gpu_ms_low"], chain["gpu_ms_high"]
            rows.append(f"| {chain['label']} | {chain['value']:.0f} | {chain['gpu_ms']:.4f} ({low:.4f}–{high:.4f}) |")
    return "\n".join([*rows, "", "</details>"])


class SceneTimes(TimesRecord):
    """The times of a scene as published and as emitted."""

    flip: float
    """FLIP between the two pictures, 0 to 1"""


class BenchRecord(TypedDict):
    """What the page quotes of the record of `make bench-gpu`."""

    jelly_cubes: SceneTimes
    techniques: TimesRecord
    interior: accuracy_goals.InteriorTimes


def bench_gpu() -> BenchRecord:
    """The record of `make bench-gpu`."""
    record: BenchRecord = json.loads((FOLDER / BY_HAND).read_text(encoding="utf-8"))
    return record


def inside() -> str:
    """The times of chains that know the light inside a body."""
    record = bench_gpu()["interior"]
    rows = ["| chain | ms | of the published thinness |", "|---|---:|---:|"]
    rows += [
        f"| {label} | {ratio * record['added_ms']:.3f} | {ratio:.3f} |"
        for label, ratio in record["of_thinness"].items()
    ]
    return "\n".join(rows)


def by_hand() -> str:
    """Emitted shaders compared with handwritten ones."""
    record = bench_gpu()
    scene_record = record["jelly_cubes"]
    scene = {name: program["net_ms"]["median"] for name, program in scene_record["programs"].items()}
    published, emitted = scene["jelly_cubes published"], scene["jelly_cubes emitted"]
    ms = {name: program["net_ms"]["median"] for name, program in record["techniques"]["programs"].items()}
    compared = [name for name in ms if f"{name} by hand" in ms and ms[name] > 1e-4]  # some compile to nothing
    ratios = {name: ms[name] / ms[f"{name} by hand"] for name in compared}
    slower = sorted((ratio, name) for name, ratio in ratios.items() if ratio > 1.01)
    rows = [
        f"{scene_record['device']}, {scene_record['driver']}: the scene of 42yeah as published takes {published:.2f} "
        f"ms at 1080p and as emitted {emitted:.2f} ms, {emitted / published:.2f} ×, with the same picture (FLIP "
        f"{scene_record['flip']:.4f}); of {len(ratios)} techniques {len(ratios) - len(slower)} are within 1 % of the "
        "handwritten formula or faster. The slower ones have a guard or a numerically stable form that the handwritten "
        "code lacks:",
        "", "| technique | emitted / handwritten | ms emitted |", "|---|---:|---:|",
        *(f"| `{name}` | {ratio:.2f} | {ms[name]:.4f} |" for ratio, name in slower),
    ]  # fmt: skip
    return "\n".join(rows)


if __name__ == "__main__":
    sys.exit(main())
