"""`sssgen chart`: error against cost of every technique and baseline, on scenes with a reference solution."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from sssgen.cli.engine_options import add_condition_options, conditions_of, device_of
from sssgen.cli.layout import table_rows, table_width
from sssgen.cli.options import add_output, add_seed, add_workers, check_samples
from sssgen.cli.output import OK, print_result
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.file_writer import check_folder
from sssgen.support.progress import ProgressBar

if TYPE_CHECKING:
    from sssgen.lab.chart.charting import Settings
    from sssgen.lab.chart.record import Record
    from sssgen.scene.measured.measured_scene import MeasuredScene

MAX_SAMPLES = 1 << 16


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen chart cube torus -o charts\n"
        "  sssgen chart my/scene.toml --role thickness --json\n"
        "  sssgen chart cube --body deforming --without bake --cost bytes\n"
        "[medium] of a scene states the medium of its body. Without a scene, it charts all of examples/lab."
    )
    parser.add_argument("SCENE", nargs="*", help="a scene's .toml file, or one of examples/lab")
    add_output(parser, "DIR", "the folder for PNG, SVG, HTML, CSV and JSON")
    parser.add_argument("--role", metavar="R,R", help="some of the charts, such as thickness,material (default: all)")
    parser.add_argument(
        "--cost", choices=("static", "gpu", "bytes"), default="static",
        help="counted operations (default), time on the GPU, or bytes baked",
    )  # fmt: skip
    add_condition_options(parser)
    add_reference_options(parser)


def add_reference_options(parser: ArgumentParser) -> None:
    """How the reference is computed, and where: options of `chart`, `pick` and `fit`."""
    parser.add_argument(
        "--samples", type=int, default=512, metavar="N", help="samples of the reference per pixel (default: 512)"
    )
    add_seed(parser, "the seed of the reference")
    add_workers(parser)


def run(arguments: Namespace) -> int:
    """Measures, draws, and prints the Pareto fronts."""
    settings, conditions, device = settings_of(arguments), conditions_of(arguments), device_of(arguments)
    if device is not None and arguments.cost != "static":
        raise failure(f"--device and --cost {arguments.cost} are two costs", "give one of them")
    from sssgen.lab.chart import charting as chart
    from sssgen.lab.chart import drawing
    from sssgen.lab.chart.engine_conditions import by_bytes, under
    from sssgen.scene.measured import measured_scene

    scenes = [measured_scene.load(name) for name in arguments.SCENE or chart.DEFAULTS]
    names = [scene.name for scene in scenes]
    for name in names:
        if names.count(name) > 1:
            raise failure(
                f"two scenes are called '{name}'", "a scene has the name of its file: rename one of the files"
            )
    check_folder(arguments.output or "")
    announce(scenes, settings)
    record = under(chart.chart_record(scenes, settings), conditions)
    if device is not None:
        from sssgen.lab.gpu.device_costs import by_device

        record = by_device(record, device)
    elif arguments.cost == "gpu":
        from sssgen.lab.gpu.chart_times import by_gpu, with_gpu_cost

        record = by_gpu(with_gpu_cost(record, scenes))
    elif arguments.cost == "bytes":
        record = by_bytes(record)
    files = drawing.write(record, arguments.output) if arguments.output else []
    text = "\n".join([summary(record), *(f"wrote {file}" for file in files)])
    print_result(arguments.json, {"files": files, **record}, text)
    return OK


def announce(scenes: Sequence[MeasuredScene], settings: Settings) -> None:
    """Says which scenes are measured first, if that takes minutes: those with light transport that are not cached."""
    from sssgen.lab.chart.charting import cached_points

    names = [scene.name for scene in scenes if scene.medium is not None and cached_points(scene, settings) is None]
    if names and sys.stderr is not None:
        text = f"measuring {', '.join(names)}: minutes for each the first time, then cached; each finished step is kept"
        print(text, file=sys.stderr, flush=True)


def settings_of(arguments: Namespace) -> Settings:
    """The settings of the measurement, from the options. Raises SssgenError."""
    from sssgen.lab.chart.charting import Settings
    from sssgen.lab.measure import candidates

    check_samples(arguments, MAX_SAMPLES, least=2)
    roles = tuple(arguments.role.split(",")) if getattr(arguments, "role", None) else candidates.ROLES
    for role in roles:
        if role not in candidates.ROLES:
            hint = did_you_mean(role, candidates.ROLES) or f"roles: {', '.join(candidates.ROLES)}"
            raise failure(f"no chart has the role '{role}'", hint)
    roles = candidates.complete(roles)
    return Settings(arguments.samples, arguments.seed, roles, arguments.scheduler, arguments.processes, ProgressBar)


def summary(record: Record) -> str:
    """The fronts, as text."""
    lines: list[str] = []
    for volume in record["hypervolume"]:
        scene, role = volume["scene"], volume["role"]
        of_it = [point for point in record["points"] if (point["scene"], point["role"]) == (scene, role)]
        best = sorted((point for point in of_it if point["front"]), key=lambda point: float(point["cost"]["value"]))
        failed = sum(bool(point["failed"]) for point in of_it)
        lines += ["", f"{scene}, {role}: {len(of_it)} points" + (f", {failed} failed" if failed else "")]
        for point in best:
            numbers = f"{point['error']['value']:8.4f}  {point['cost']['value']:8.4g}"
            label = point["label"] + ("  (published)" if point["baseline"] else "")
            lines += table_rows([(numbers, label)], len(numbers), table_width())
        lines.append(f"  hypervolume {volume['ours']:.3f}, of the baselines {volume['baselines']:.3f}")
    return "\n".join(["   error      cost", *lines[1:]])
