"""`sssgen pick`: the cheapest chain of techniques that is good enough for a scene, and its neighbours in cost."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from sssgen.cli.chart import add_reference_options, announce, settings_of
from sssgen.cli.emit import chosen_targets
from sssgen.cli.engine_options import add_condition_options, conditions_of, device_of
from sssgen.cli.options import add_targets
from sssgen.cli.output import CHECK_FAILED, OK, print_result
from sssgen.material.material_loading import parse_material
from sssgen.pipeline.compiler import compile
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import write_files

if TYPE_CHECKING:
    from sssgen.lab.chart.picking import Pick
    from sssgen.lab.chart.record import Point
    from sssgen.scene.measured.measured_scene import MeasuredScene


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen pick cube --max-error 0.5\n"
        "  sssgen pick my/scene.toml --max-cost 300 --emit out --target wgsl\n"
        "  sssgen pick cube --max-error 0.3 --light moving --body deforming --without depth-map\n"
        "The scene is measured first, unless its chart is in the cache."
    )
    parser.add_argument("SCENE", help="a scene's .toml file, or one of examples/lab")
    limits = parser.add_mutually_exclusive_group(required=True)
    limits.add_argument("--max-error", type=float, metavar="E", help="the largest relative error, such as 0.3")
    limits.add_argument(
        "--max-cost", type=float, metavar="C", help="the largest cost, in operations, or in ns with --device"
    )
    parser.add_argument("--emit", metavar="DIR", help="write the material and its shaders to this folder")
    add_condition_options(parser)
    add_targets(parser)
    add_reference_options(parser)


def run(arguments: Namespace) -> int:
    """Measures if necessary, picks, and prints the reasons."""
    for name in ("max_error", "max_cost"):
        value = getattr(arguments, name)
        if value is not None and not 0.0 < value < float("inf"):
            raise failure(f"--{name.replace('_', '-')} {value:g} is not a limit", "a number above 0")
    settings, conditions, device = settings_of(arguments), conditions_of(arguments), device_of(arguments)
    from sssgen.lab.chart import charting as chart
    from sssgen.lab.chart.picking import pick
    from sssgen.scene.measured import measured_scene

    scene = measured_scene.load(arguments.SCENE)
    announce([scene], settings)
    record = chart.chart_record([scene], settings)
    if device is not None:
        from sssgen.lab.gpu.device_costs import by_device

        record = by_device(record, device)
    picked = pick(record, scene.name, arguments.max_error, arguments.max_cost, conditions)
    files = _emit(scene, picked, arguments.emit, arguments.target) if arguments.emit else []
    fields = {**picked._asdict(), "roles": [role._asdict() for role in picked.roles]}
    text = summary(scene, picked, arguments.max_error, arguments.max_cost, " ns" if device is not None else "")
    text = "\n".join([text, *(f"wrote {file}" for file in files)])
    print_result(arguments.json, {"files": files, **fields}, text, picked.met)
    return OK if picked.met else CHECK_FAILED


def _emit(scene: MeasuredScene, picked: Pick, folder: str, targets: str) -> list[str]:
    """Writes the material and its shaders. Raises SssgenError."""
    from sssgen.lab.chart.picked_material import material_files

    name = "".join(character if character.isalnum() and character.isascii() else "_" for character in scene.name)
    name = name if name[:1].isalpha() else f"m_{name}"
    files = material_files(scene, picked, name)
    wrong: list[Diagnostic] = []
    chosen = chosen_targets(targets, wrong)
    if wrong:
        raise SssgenError(wrong)
    write_files(folder, files)
    material = parse_material(files[f"{name}.toml"], os.path.join(folder, f"{name}.toml"))
    for target in chosen:
        files |= compile(material, target).files
    write_files(folder, files)
    return [os.path.join(folder, file) for file in files]


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
