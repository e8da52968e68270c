"""`sssgen pick`: the cheapest chain of techniques that is good enough for a scene, and its neighbours in cost."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from sssgen.cli.chart import add_reference_options, settings_of
from sssgen.cli.emit import chosen_targets
from sssgen.cli.engine_options import add_condition_options, conditions_of, device_of
from sssgen.cli.level_table import level_table, notes
from sssgen.cli.options import add_targets
from sssgen.cli.output import CHECK_FAILED, OK, print_result
from sssgen.material.material_loading import parse_material
from sssgen.material.model import MOST_LEVELS
from sssgen.pipeline.compiler import compile
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import check_folder, write_files
from sssgen.support.progress import ProgressBar

if TYPE_CHECKING:
    from sssgen.lab.chart.case_errors import CaseErrors
    from sssgen.lab.chart.charting import Settings
    from sssgen.lab.chart.engine_conditions import Conditions
    from sssgen.lab.chart.picking import Pick
    from sssgen.lab.chart.racing import Limits, Provisional
    from sssgen.lab.chart.record import Point, Record
    from sssgen.lab.chart.whole_progress import WholeProgress
    from sssgen.lab.gpu.device_costs import Device
    from sssgen.scene.measured.measured_scene import MeasuredScene


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen pick cube --max-error 0.5\n"
        "  sssgen pick my/scene.toml --max-cost 300 --emit out --target wgsl\n"
        "  sssgen pick cube --max-error 0.3 --light moving --body deforming --without depth-map\n"
        "  sssgen pick cube --budget-ms 0.5 --device h200 --lights 3 --emit out --target threejs\n"
        "The chains race: each is measured until it is surely too expensive or surely too far off.\n"
        "A chart of the scene in the cache is used as it is."
    )
    parser.add_argument("SCENE", help="a scene's .toml file, or one of examples/lab")
    add = parser.add_argument
    add(
        "--max-error", type=float, metavar="E",
        help="the largest relative error, such as 0.3; with --budget-ms the error at which cheaper is enough "
        "(default: 0.1)",
    )  # fmt: skip
    add("--max-cost", type=float, metavar="C", help="the largest cost, in operations, or in ns with --device")
    add(
        "--budget-ms", type=float, metavar="MS",
        help="the milliseconds of a frame of 1920 x 1080 that the body may take on --device: picks a level of detail "
        "for each distance",
    )  # fmt: skip
    add("--lights", type=int, metavar="N", help="with --budget-ms: the lights of the frame (default: 1)")
    add(
        "--distances", metavar="LIST",
        help="with --budget-ms: the distances from the camera, 1 is that of the scene (default: 0.5,1,2,4,8,16,32,64)",
    )  # fmt: skip
    parser.add_argument(
        "-o", "--emit", metavar="DIR", help="write the material, its shaders and its picture to this folder"
    )
    add_condition_options(parser)
    add_targets(parser)
    add_reference_options(parser)


def run(arguments: Namespace) -> int:
    """Measures if necessary, picks, and prints the reasons."""
    _check_limits(arguments)
    check_folder(arguments.emit or "")
    settings, conditions, device = settings_of(arguments), conditions_of(arguments), device_of(arguments)
    if arguments.budget_ms is not None:
        return _run_levels(arguments, settings, conditions, device)
    from sssgen.lab.chart.picked_steps import next_step
    from sssgen.lab.chart.picking import pick
    from sssgen.scene.measured import measured_scene

    scene, unit = measured_scene.load(arguments.SCENE), " ns" if device is not None else ""
    targets = _targets(arguments) if arguments.emit else []
    with _open_bar() as (bar, progress):
        record = _record(scene, settings, _limits(arguments, conditions, device), bar, progress, unit)
        if device is not None:
            from sssgen.lab.gpu.device_costs import by_device

            record = by_device(record, device)
        picked = pick(record, scene.name, arguments.max_error, arguments.max_cost, conditions)
        unseen = _unseen(scene, picked, settings, conditions, progress)
        files: list[str] = []
        bakes: list[str] = []
        if arguments.emit:
            from sssgen.lab.chart.picked_material import material_files

            texts, chains = material_files(scene, picked, _name(scene)), [picked.chain] if picked.chain else []
            files, bakes = _emit(scene, texts, chains, arguments, targets, progress.of(settings, "picture"))
    step = next_step(arguments.emit, _name(scene))
    fields = {**picked._asdict(), "roles": [role._asdict() for role in picked.roles]}
    text = summary(scene, picked, arguments.max_error, arguments.max_cost, unit)
    lines = [text, *lights_text(picked, unseen, conditions), *(f"wrote {file}" for file in files)]
    lines += [*(f"bake: {bake}" for bake in bakes), f"next: {step}"]
    others = unseen and {"values": unseen.values}
    report = {"files": files, **fields, "unseen_lights": others, "bakes": bakes, "next": step}
    print_result(arguments.json, report, "\n".join(lines), picked.met)
    return OK if picked.met else CHECK_FAILED


def _check_limits(arguments: Namespace) -> None:
    """Raises SssgenError for limits that are missing, wrong, or contradict each other."""
    given = [name for name in ("max_error", "max_cost", "budget_ms") if getattr(arguments, name) is not None]
    options = [f"--{name.replace('_', '-')}" for name in given]
    for name, option in zip(given, options, strict=True):
        value = getattr(arguments, name)
        if not 0.0 < value < float("inf"):
            raise failure(f"{option} {value:g} is not a limit", "a number above 0")
    if not given:
        raise failure("a limit is required", "write --max-error E, --max-cost C or --budget-ms MS")
    if "max_cost" in given and len(given) > 1:
        other = next(option for option in options if option != "--max-cost")
        raise failure(f"--max-cost is not allowed with {other}", "give one of them")
    if "budget_ms" not in given:
        for name in ("lights", "distances"):
            if getattr(arguments, name) is not None:
                raise failure(f"--{name} has no meaning without --budget-ms", "add --budget-ms MS, or omit it")
    elif arguments.device is None:
        raise failure("--budget-ms needs the device that it is for", "add --device NAME, such as --device h200")
    elif arguments.lights is not None and arguments.lights < 1:
        raise failure(f"--lights {arguments.lights} is not a number of lights", "1 or more")


def _distances(text: str | None) -> tuple[float, ...]:
    """The distances of the option, in increasing order. Raises SssgenError."""
    from sssgen.lab.chart.levels import DISTANCES

    if text is None:
        return DISTANCES
    try:
        values = tuple(sorted({float(part) for part in text.split(",")}))
    except ValueError:
        values = ()
    if not (0 < len(values) <= MOST_LEVELS and all(0.0 < value < float("inf") for value in values)):
        hint = f"1 to {MOST_LEVELS} numbers above 0, such as 0.5,1,2,4"
        raise failure(f"--distances {text} is not a list of distances", hint)
    return values


def _run_levels(arguments: Namespace, settings: Settings, conditions: Conditions, device: Device | None) -> int:
    """Picks a chain for each distance, and prints the table of the levels."""
    from sssgen.lab.chart import racing
    from sssgen.lab.chart.levels import VISIBLE, goals, levels
    from sssgen.lab.chart.picked_material import level_files
    from sssgen.lab.chart.picked_steps import next_step
    from sssgen.lab.chart.picking import is_allowed
    from sssgen.lab.gpu.device_costs import by_device
    from sssgen.scene.measured import measured_scene

    assert device is not None
    distances, lights = _distances(arguments.distances), arguments.lights or 1
    max_error = arguments.max_error if arguments.max_error is not None else VISIBLE
    scene = measured_scene.load(arguments.SCENE)
    if scene.medium is None or scene.inlay is not None:
        reason = "it has an inlay" if scene.medium is not None else "it has no [medium]"
        raise failure(f"--budget-ms chooses how light comes through, but not for '{scene.name}': {reason}", "omit it")
    targets = _targets(arguments) if arguments.emit else []
    wanted = goals(scene, arguments.budget_ms, distances)
    limits = racing.Limits(
        max_error, None, conditions, lambda cost: device.predict(cost, lights), repr((device, lights)), wanted
    )
    with _open_bar() as (bar, progress):
        record = by_device(_race(scene, settings, limits, bar, progress, " ns"), device, lights)
        chosen = levels([point for point in record["points"] if is_allowed(point)], wanted, max_error)
        used = racing.LIGHTS if conditions.light == "moving" else 0
        of_lights = progress.of(settings, "lights", 1.0 / len(chosen))
        unseen = [racing.unseen_errors(scene, level.point, of_lights, used) for level in chosen]
        files: list[str] = []
        bakes: list[str] = []
        if arguments.emit:
            chains, texts = [level.point for level in chosen], level_files(scene, chosen, _name(scene))
            files, bakes = _emit(scene, texts, chains, arguments, targets, progress.of(settings, "picture"))
    step = next_step(arguments.emit, _name(scene))
    count = f"{lights} light{'s' * (lights > 1)}"
    lines = [f"{scene.title}: {arguments.budget_ms:g} ms a frame on {device.name} with {count}, predicted"]
    lines += [*level_table(chosen, unseen), *notes(chosen, wanted, max_error, arguments.budget_ms)]
    if len(chosen) > 1 and arguments.emit:
        lines.append("  the engine sets the parameter detail_level of the material to the number of the level")
    lines += [*(f"wrote {file}" for file in files), *(f"bake: {bake}" for bake in bakes), f"next: {step}"]
    met = arguments.max_error is None or all(level.within for level in chosen)
    report = {
        "files": files, "scene": scene.name, "max_error": max_error, "budget_ms": arguments.budget_ms,
        "lights": lights, "levels": [level._asdict() for level in chosen], "goals": [goal._asdict() for goal in wanted],
        "unseen_lights": [errors and {"values": errors.values} for errors in unseen], "bakes": bakes, "next": step,
    }  # fmt: skip
    print_result(arguments.json, report, "\n".join(lines), met)
    return OK if met else CHECK_FAILED


@contextmanager
def _open_bar() -> Iterator[tuple[ProgressBar, WholeProgress]]:
    """The bar of the whole run, and its progress."""
    from sssgen.lab.chart.racing import STAGES
    from sssgen.lab.chart.whole_progress import WholeProgress

    with ProgressBar() as bar:
        yield bar, WholeProgress(bar, STAGES)


def _limits(arguments: Namespace, conditions: Conditions, device: Device | None) -> Limits:
    from sssgen.lab.chart.racing import Limits

    cost = device.predict if device is not None else None
    name = repr(device) if device is not None else ""
    return Limits(arguments.max_error, arguments.max_cost, conditions, cost, name)


def _record(
    scene: MeasuredScene, settings: Settings, limits: Limits, bar: ProgressBar, progress: WholeProgress, unit: str
) -> Record:
    """The scene's chart if it is cached or takes seconds, otherwise the record of a race. Raises SssgenError."""
    from sssgen.lab.chart import charting

    moves = limits.conditions.light == "moving"
    if scene.medium is None or (not moves and charting.cached_points(scene, settings) is not None):
        return charting.chart_record([scene], progress.of(settings, "chains", 0.2))
    return _race(scene, settings, limits, bar, progress, unit)


def _race(
    scene: MeasuredScene, settings: Settings, limits: Limits, bar: ProgressBar, progress: WholeProgress, unit: str
) -> Record:
    """The record of a race. Raises SssgenError."""
    from sssgen.lab.chart import racing

    if not racing.is_stored(scene, settings, limits):
        text = f"measuring chains on {scene.name}, the cheapest first: minutes; each finished step is kept"
        print(text, file=sys.stderr, flush=True)

    def show(answer: Provisional) -> None:
        with bar.hide():
            nearest = "" if answer.met else "no chain is within the limit so far; the nearest is "
            text = f"provisional, after {answer.seconds:.0f} s: {nearest}{_point(answer.point)}{unit}"
            print(text, file=sys.stderr, flush=True)

    return racing.race_record(scene, settings, limits, progress, show)


def _unseen(
    scene: MeasuredScene, picked: Pick, settings: Settings, conditions: Conditions, progress: WholeProgress
) -> CaseErrors | None:
    """The errors of the picked chain under lights that were not used."""
    if picked.chain is None:
        return None
    from sssgen.lab.chart import racing

    used = racing.LIGHTS if conditions.light == "moving" else 0
    return racing.unseen_errors(scene, picked.chain, progress.of(settings, "lights"), used)


def _targets(arguments: Namespace) -> Sequence[str]:
    """The targets to emit, checked before anything is measured. Raises SssgenError."""
    wrong: list[Diagnostic] = []
    chosen = chosen_targets(arguments.target, wrong)
    if wrong:
        raise SssgenError(wrong)
    return chosen


def _name(scene: MeasuredScene) -> str:
    """The name of the scene's material."""
    name = "".join(character if character.isalnum() and character.isascii() else "_" for character in scene.name)
    return name if name[:1].isalpha() else f"m_{name}"


def _emit(
    scene: MeasuredScene, files: dict[str, str], chains: Sequence[Point], arguments: Namespace,
    targets: Sequence[str], settings: Settings,
) -> tuple[list[str], list[str]]:  # fmt: skip
    """Writes the material's files, its shaders and the pictures of its chains; returns their paths, and what to do for
    its bakes. Raises SssgenError."""
    from sssgen.lab.chart.picked_steps import bakes

    name, folder = _name(scene), arguments.emit
    write_files(folder, files)
    material = parse_material(files[f"{name}.toml"], os.path.join(folder, f"{name}.toml"))
    for target in targets:
        files |= compile(material, target).files
    write_files(folder, files)
    paths = [os.path.join(folder, file) for file in files]
    if chains:
        from sssgen.lab.chart.picked_picture import side_by_side
        from sssgen.scene.pictures.images import write_png

        paths.append(os.path.join(folder, f"{name}_beside_path_tracing.png"))
        write_png(paths[-1], side_by_side(scene, chains, settings))
    return paths, bakes(material, arguments.SCENE)


def lights_text(picked: Pick, unseen: CaseErrors | None, conditions: Conditions) -> list[str]:
    """For which lights the limit holds, and the error under others."""
    if picked.chain is None:
        return []
    if conditions.light == "moving":
        holds = "the limit is for the scene's lights and each of 6 lights drawn at random"
    else:
        holds = "the limit is for the scene's own lights; --light moving has it for others, too"
    if unseen is None:
        return [f"  lights        {holds}; another light needs another bake"]
    count = len(unseen.values)
    found = (
        f"under {count} lights that were not used the error is {unseen.median:.3g} (median), {unseen.worst:.3g} (worst)"
    )
    return [f"  lights        {holds}", f"  other lights  {found}"]


def summary(scene: MeasuredScene, picked: Pick, max_error: float | None, max_cost: float | None, unit: str = "") -> str:
    """The choice, as text; `unit` follows each cost."""
    limit = f"an error of at most {max_error:g}" if max_error is not None else f"a cost of at most {max_cost:g}{unit}"
    lines = [f"{scene.title}: {limit}" + ("" if picked.met else ", which no chain reaches; this is the nearest")]
    lines += [f"  {role.role:13} {role.technique:24} {role.why}".rstrip() for role in picked.roles]
    main = picked.chain or picked.coordinates
    assert main is not None
    lines.append(f"  picked        {_point(main)}{unit}")
    if main.get("requires"):
        baked = f"; {main['bytes']:,} bytes baked".replace(",", " ") if main.get("bytes") else ""
        lines.append(f"  requires      {', '.join(main['requires'])}{baked}")
    if picked.excluded is not None:
        lines.append(f"  excluded      by {picked.excluded_by}: {_point(picked.excluded)}{unit}")
    for title, point in (("next cheaper", picked.cheaper), ("next better", picked.better)):
        lines.append(f"  {title:13} {_point(point) + unit if point is not None else 'none'}")
    return "\n".join(lines)


def _point(point: Point) -> str:
    from sssgen.lab.chart.picking import cost_of, limit_of

    error = point["error"]
    low, high = error["low"], error["high"]
    return (
        f"{point['label']}: error {error['value']:.3g} ({low:.3g} to {high:.3g}), within {limit_of(point):.3g} "
        f"on every measured view; cost {cost_of(point):.4g}"
    )
