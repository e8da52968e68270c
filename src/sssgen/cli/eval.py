"""`sssgen eval`: evaluates a technique on arrays of inputs, on one back end, or on all compared with the oracle."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from sssgen.cli.layout import print_rows
from sssgen.cli.options import add_guards, add_seed, check_samples
from sssgen.cli.output import CHECK_FAILED, OK, print_json
from sssgen.run.backend_registry import BACKENDS, FUNCTIONS, HALF, backend_names, half_counterparts
from sssgen.support.diagnostics import failure
from sssgen.testing.outcome import in_ci

if TYPE_CHECKING:
    from sssgen.run.evaluate.deviation import Row
    from sssgen.run.evaluate.evaluation import Inputs
    from sssgen.run.evaluate.probes import Subject

SHOWN = 12
"""The number of lanes that are printed."""
MAX_SAMPLES = 1_000_000


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen eval lobe_gdc2011 --inputs lobe.json --backend all\n"
        "  sssgen eval standard --samples 10000 --backend all\n"
        "  sssgen eval march_light --inputs rays.json --bind body_distance=shapes.sss:star\n"
        "The inputs are values by name, one value or a list: "
        '{"N": [[0, 0, 1], [0, 1, 0]], "power": 4.0, "map": "wood.png"}'
    )
    add = parser.add_argument
    add("TECHNIQUE", help="a name from `sssgen list techniques`, a .sss file, or FILE:FUNCTION")
    add("--inputs", "-i", metavar="FILE", help="the inputs, as JSON; - reads them from the standard input")
    add("--samples", type=int, metavar="N", help="for each input without a value, draw N random values in its range")
    add_seed(parser, "the seed of the random inputs")
    add(
        "--backend", "-b", metavar="NAME", default="numpy",
        help=f"{', '.join(FUNCTIONS)}, several, or all (default: numpy)",
    )  # fmt: skip
    add("--bind", action="append", default=[], metavar="SLOT=FUNCTION", help="a function for a slot, or FILE:FUNCTION")
    add_guards(parser)
    add(
        "--precision",
        choices=("f64", "f32", "f16"),
        help="the precision of numpy (default: f64); f16 also applies to webgpu",
    )


def run(arguments: Namespace) -> int:
    """Prints the outputs; for several back ends, the deviation of each from the oracle."""
    from sssgen.run.evaluate import input_files as inputs
    from sssgen.run.evaluate.probes import subject

    names = _backends(arguments.backend, arguments.precision)
    chosen = subject(arguments.TECHNIQUE, inputs.bindings(arguments.bind))
    values = inputs.read(arguments.inputs, chosen) if arguments.inputs else {}
    sampled = arguments.samples is not None
    if sampled:
        from sssgen.run.evaluate.random_inputs import samples

        check_samples(arguments, MAX_SAMPLES)
        values = samples(chosen, arguments.samples, arguments.seed) | values
    from sssgen.run.evaluate.evaluation import fit_inputs

    fit = fit_inputs(chosen, values)
    if len(names) == 1:
        return _report(chosen, fit, names[0], arguments.json, arguments.guards)
    return _compare(chosen, fit, names, arguments.json, not sampled, arguments.guards)


def _backends(text: str, precision: str | None) -> list[str]:
    """The named back ends; the oracle comes first."""
    names = list(FUNCTIONS) if text == "all" else backend_names(text)
    if precision is None:
        return names
    if precision == "f16":
        return list(HALF) if text == "all" else half_counterparts(names)
    wanted = {"f64": "numpy", "f32": "numpy-f32"}[precision]
    if "numpy" in names:
        return [wanted if name == "numpy" else name for name in names if name not in ("numpy-f32", *HALF)]
    if precision == "f64" or not set(HALF).isdisjoint(names):
        raise failure(f"{names[0]} computes in its own precision, not in {precision}", "--backend numpy")
    return names


def _report(subject: Subject, fit: Inputs, name: str, as_json: bool, guards: str) -> int:
    from sssgen.run.backends import require
    from sssgen.run.evaluate.evaluation import run as evaluated

    backend = require(name)
    outputs = evaluated(subject, fit, backend, guards)
    if as_json:
        plain = {key: _json_numbers(value) for key, value in outputs.items()}
        print_json({"ok": True, "backend": name, "device": backend.device(), "lanes": fit.lanes, "outputs": plain})
        return OK
    print(f"{subject.name} on {name} ({backend.device()}), {fit.lanes} lane{'s' * (fit.lanes != 1)}")
    _print_outputs(outputs)
    return OK


def _compare(subject: Subject, fit: Inputs, names: list[str], as_json: bool, listed: bool, guards: str) -> int:
    from sssgen.run.evaluate.deviation import GOAL, compare
    from sssgen.support.progress import ProgressBar

    with ProgressBar() as progress:
        oracle, rows = compare(subject, fit, names, guards, progress)
    here = [row for row in rows if not row.missing]
    lacking = any(row.missing and not BACKENDS[row.name].apart for row in rows)
    good = bool(here) and all(row.ok for row in here) and not (in_ci() and lacking)
    if as_json:
        deviations = [row.as_json() for row in rows]
        plain = {key: _json_numbers(value) for key, value in oracle.items()} if listed else {}
        print_json({"ok": good, "lanes": fit.lanes, "goal": GOAL, "backends": deviations, "outputs": plain})
        return OK if good else CHECK_FAILED
    print(f"{subject.name}, {fit.lanes} lane{'s' * (fit.lanes != 1)}, against the oracle in float64")
    if listed:
        _print_outputs(oracle)
    _print_rows(rows)
    return OK if good else CHECK_FAILED


def _print_rows(rows: Sequence[Row]) -> None:
    """A row for each back end, wrapped on a terminal."""
    from sssgen.run.evaluate.deviation import GOAL

    width = max(len(row.name) for row in rows)
    print(f"\n{'':{width}}  largest deviation (goal: {GOAL:g})")
    print_rows([(row.name, row.text) for row in rows], width, 0)


def _json_numbers(value: Any) -> Any:
    """Numbers for JSON, which has no NaN."""
    import numpy as np

    finite = np.isfinite(value) if value.dtype.kind == "f" else np.array(True)
    return np.array(np.where(finite, value.astype(object), None)).tolist()


def _print_outputs(outputs: Mapping[str, Any]) -> None:
    import numpy as np

    for name, value in outputs.items():
        lanes = value if value.ndim else value[None]
        print(f"{name}:")
        for lane, number in enumerate(lanes[:SHOWN]):
            shown = np.array2string(np.asarray(number), precision=7, separator=", ", suppress_small=False)
            print(f"  {lane:4}  {shown}")
        if len(lanes) > SHOWN:
            print(f"  … {len(lanes) - SHOWN} more, of all: from {lanes.min():.7g} to {lanes.max():.7g}")
        if value.dtype.kind == "f" and (bad := int((~np.isfinite(lanes.reshape(len(lanes), -1))).any(axis=1).sum())):
            print(f"  {bad} of {len(lanes)} lanes are NaN or infinite")
