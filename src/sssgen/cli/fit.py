"""`sssgen fit`: fits the parameters of techniques to a scene's medium."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from sssgen.cli.chart import add_reference_options, settings_of
from sssgen.cli.options import unknown_name
from sssgen.cli.output import OK, print_result
from sssgen.support.diagnostics import failure

if TYPE_CHECKING:
    from sssgen.lab.chart.record import Point


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = "example:\n  sssgen fit cube lobe_exp2"
    parser.add_argument("SCENE", help="a scene's .toml file, or one of examples/lab")
    parser.add_argument("TECHNIQUE", nargs="*", help="translucency techniques (default: all)")
    add_reference_options(parser)


def run(arguments: Namespace) -> int:
    """Fits on balls, bars and a slab of the medium, and prints the error there and on the scene itself."""
    settings = settings_of(arguments)._replace(roles=("coordinates", "translucency"))
    from sssgen.lab.chart import charting as chart
    from sssgen.lab.chart.record import measures
    from sssgen.lab.measure import candidates
    from sssgen.scene.measured import measured_scene

    scene = measured_scene.load(arguments.SCENE)
    wanted = set(arguments.TECHNIQUE)
    techniques = {technique.name for role in settings.roles for technique in candidates.of_role(role)}
    for name in sorted(wanted - techniques):
        raise unknown_name("technique", name, sorted(techniques))
    points = chart.chart_record([scene], settings._replace(techniques=frozenset(wanted)))["points"]
    points = [point for point in points if point["name"] != "none"]
    if not points:
        names = ", ".join(sorted(wanted)) or "any technique"
        hint = "a technique needs light from afar, a boundary, or a body of a size that its parameters allow"
        raise failure(f"{names} cannot be fitted to '{scene.name}'", hint)
    lines = [
        f"{scene.title}: fitted with the exact thickness, on balls, bars and a slab of the same medium",
        "  fit: relative error on these; scene: on this scene, and from the side",
        *map(_point_text, sorted(points, key=lambda point: measures(point)[1])),
    ]
    print_result(arguments.json, {"scene": scene.name, "points": points}, "\n".join(lines))
    return OK


def _point_text(point: Point) -> str:
    parameters = dict(point["parameters"])
    if point["factor"]:
        parameters[f"{point['factor']} ×"] = point["scale"]
    values = ", ".join(f"{name} {' '.join(f'{number:.3g}' for number in value)}" for name, value in parameters.items())
    views = " ".join(f"{view['value']:.3f}" for view in point["views"].values())
    failed = f"  {point['failed']}" if point["failed"] else ""
    return f"  {point['label']:28} fit {point['training_error']:.3f}  scene {views}  {values}{failed}"
