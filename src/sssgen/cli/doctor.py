"""`sssgen doctor`: what this machine has for sssgen, for a report of a problem. It never fails."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Sequence

from sssgen.cli.layout import print_rows
from sssgen.cli.output import OK, print_json
from sssgen.run.machine_facts import VARIABLES, Facts, Item, facts
from sssgen.support.diagnostics import visible


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = "examples:\n  sssgen doctor\n  sssgen doctor --run"
    parser.add_argument(
        "--run",
        action="store_true",
        help="also start each compiler and back end that is found, with its browser or driver",
    )


def run(arguments: Namespace) -> int:
    """Prints what is found and what is missing, with how to get it."""
    machine = facts(arguments.run)
    if arguments.json:
        print_json({"ok": True, **machine.as_json()})
        return OK
    rows = [
        ("sssgen", f"{machine.sssgen}, {machine.source}"),
        ("Python", machine.python),
        ("platform", machine.platform),
        ("cache", machine.cache or "none: nothing is cached"),
    ]
    _print_rows(rows)
    print("\nEnvironment variables:")
    _print_rows(_variables(machine) or [("none is set", "")])
    print("\nPackages:")
    _print_rows([("", ", ".join(f"{name} {version}" for name, version in machine.packages.items()) or "none")], first=0)
    for title, items in (("Extras", machine.extras), ("Compilers", machine.compilers), ("Back ends", machine.backends)):
        print(f"\n{title}:")
        _print_rows([(item.name, _state(item)) for item in items])
    if not arguments.run:
        print("\nfound: its programs and packages are there; sssgen doctor --run starts it, too")
    return OK


def _variables(machine: Facts) -> list[tuple[str, str]]:
    return [
        (name, f"{value!r}: {VARIABLES[name]}" if name in VARIABLES else f"{value}  (sssgen reads no such variable)")
        for name, value in machine.variables.items()
    ]


def _state(item: Item) -> str:
    if not item.found:
        return f"missing: {item.how}"
    if item.failure:
        return f"does not start: {' '.join(item.failure.split())}"
    return f"starts: {item.started}" if item.started else f"found: {item.description}"


def _print_rows(rows: Sequence[tuple[str, str]], first: int | None = None) -> None:
    width = max(len(name) for name, _ in rows) if first is None else first
    print_rows([(visible(name), visible(text)) for name, text in rows], width)
