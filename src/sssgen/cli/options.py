"""The options that several commands share."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import Any

from sssgen.support.diagnostics import SssgenError, did_you_mean, failure

DEFAULT_TARGET = "glsl-330"
"""The target of a command that is called without one: plain text that the preferred back end draws."""


def unknown_name(kind: str, name: str, names: Iterable[str]) -> SssgenError:
    """The error for a name that no thing of a kind has; the hint has the most similar name, or all."""
    return failure(f"unknown {kind} '{name}'", did_you_mean(name, names) or f"{kind}s: {', '.join(names)}")


def nonempty(text: str) -> str:
    """The value of an option that names something. Raises ArgumentTypeError for the empty text."""
    if not text.strip():
        raise argparse.ArgumentTypeError("the name is empty")
    return text


def add_json(parser: argparse.ArgumentParser) -> None:
    """Every command has `--json`."""
    parser.add_argument("--json", action="store_true", help="print the result, or the errors, as JSON")


def add_output(
    parser: argparse.ArgumentParser, metavar: str, help: str, *, required: bool = False, default: str | None = None
) -> None:
    """The file or folder to write to: `-o`, `--output`."""
    parser.add_argument("-o", "--output", type=nonempty, metavar=metavar, required=required, default=default, help=help)


def add_targets(parser: argparse.ArgumentParser, default: str | None = DEFAULT_TARGET) -> None:
    """The targets to emit for: `--target`. With None as the default, the command says which target it takes."""
    help = f"targets from `sssgen list targets`, or all (default: {DEFAULT_TARGET})"
    parser.add_argument("--target", "-t", metavar="T,T|all", help=help, default=default, action=_Joined)


class _Joined(argparse.Action):
    """An option that may be repeated: its texts with commas between them."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option: str | None = None
    ) -> None:
        before = getattr(namespace, self.dest)
        setattr(namespace, self.dest, values if before is self.default else f"{before},{values}")


def add_guards(parser: argparse.ArgumentParser, default: str = "auto") -> None:
    """Which operations are guarded: `--guards`."""
    help = "which operations that can fail get a guard: auto, those not proven safe; all; or none"
    choices = ("auto", "all", "none")
    parser.add_argument("--guards", choices=choices, default=default, help=f"{help} (default: {default})")


def add_seed(parser: argparse.ArgumentParser, help: str) -> None:
    """Which random numbers are used: `--seed`."""
    parser.add_argument("--seed", type=int, default=0, metavar="N", help=f"{help} (default: 0)")


def check_samples(arguments: argparse.Namespace, most: int, least: int = 1) -> None:
    """Raises SssgenError where `--samples` is out of its range, or `--seed` negative."""
    if not least <= arguments.samples <= most:
        raise failure(f"--samples {arguments.samples} is not a number of samples", f"from {least} to {most}")
    if arguments.seed < 0:
        raise failure(f"--seed {arguments.seed} is negative")


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Where the command's work items run: `--processes` and `--scheduler`."""
    parser.add_argument("--processes", type=_processes, metavar="N", help="distribute the work over N processes")
    parser.add_argument(
        "--scheduler", default="", metavar="ADDRESS", help="distribute the work over a Dask cluster: tcp://HOST:8786"
    )


def _processes(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of processes")
    return int(text)
