"""What the engine offers, as options of `chart` and `pick`: `--max-bytes`, `--light`, `--body` and so on."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from sssgen.material.attributes import OMISSIONS
from sssgen.support.diagnostics import failure

if TYPE_CHECKING:
    from sssgen.lab.chart.engine_conditions import Conditions
    from sssgen.lab.gpu.device_costs import Device


def add_condition_options(parser: ArgumentParser) -> None:
    """The options; by default the engine has everything, the light is fixed and the body is rigid."""
    add = parser.add_argument
    add("--max-bytes", type=int, metavar="N", help="the most bytes of all baked textures of a chain")
    add(
        "--light", choices=("fixed", "moving"), default="fixed",
        help="whether the light moves relative to the body (default: fixed)",
    )  # fmt: skip
    add(
        "--body", choices=("rigid", "skinned", "deforming"), default="rigid",
        help="a rigid mesh (default); one that bones bend, in an engine that knows its rest pose, as three.js; or one "
        "that deforms otherwise",
    )  # fmt: skip
    add(
        "--without", choices=OMISSIONS, action="append", default=[], metavar="DATA",
        help=f"what the engine does not provide: {', '.join(OMISSIONS)}; may be repeated",
    )  # fmt: skip
    add("--device", metavar="NAME", help="costs are nanoseconds predicted for this device, or for its .toml file")


def device_of(arguments: Namespace) -> Device | None:
    """The device of the options, if any. Raises SssgenError."""
    if arguments.device is None:
        return None
    from sssgen.lab.gpu import device_costs

    return device_costs.load(arguments.device)


def conditions_of(arguments: Namespace) -> Conditions:
    """The conditions of the options. Raises SssgenError."""
    from sssgen.lab.chart.engine_conditions import Conditions

    if arguments.max_bytes is not None and arguments.max_bytes < 0:
        raise failure(f"--max-bytes {arguments.max_bytes} is not a number of bytes", "0 or more; 0 bakes nothing")
    return Conditions(arguments.max_bytes, arguments.light, arguments.body, tuple(dict.fromkeys(arguments.without)))
