"""`sssgen lint`: reports operations that may fail in techniques, materials and plain GLSL."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections import Counter

from sssgen.cli.output import CHECK_FAILED, OK, print_json
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.progress import ProgressBar


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen lint ice\n  sssgen lint mine.glsl --json\n"
        "Exit status 1: an operation of a plain function may fail. The shaders that emit writes for materials have "
        "guards."
    )
    parser.add_argument("NAME", nargs="+", help="a technique, a material's .toml file, an example, or a GLSL file")
    parser.add_argument("--all", action="store_true", help="also list the operations that are proven safe")
    parser.add_argument(
        "--no-examples", action="store_true", help="do not search for inputs that fail, which is faster"
    )


def run(arguments: Namespace) -> int:
    """Prints the operations that are not proven safe; returns 1 if one of them has no guard."""
    from sssgen.harness.lint_findings import MAY_FAIL, PROVEN, UNKNOWN, Finding, lint

    wrong: list[Diagnostic] = []
    rows: list[tuple[str, list[Finding]]] = []
    names = list(dict.fromkeys(arguments.NAME))
    with ProgressBar() as progress:
        for index, name in enumerate(names):
            progress(index, len(names), name)
            try:
                rows.append((name, lint(name, not arguments.no_examples)))
            except SssgenError as error:
                wrong += error.diagnostics
    if wrong:
        raise SssgenError(wrong)
    unguarded = any(not finding.guarded and finding.verdict != PROVEN for _, findings in rows for finding in findings)
    if arguments.json:
        listed = [{"name": name, "findings": [finding.as_json() for finding in findings]} for name, findings in rows]
        print_json({"ok": not unguarded, "results": listed})
        return CHECK_FAILED if unguarded else OK
    for name, findings in rows:
        for finding in findings:
            if finding.verdict != PROVEN or arguments.all:
                print(f"{finding.render()}\n")
        counts = Counter(finding.verdict for finding in findings)
        unseen = "not proven" if arguments.no_examples else UNKNOWN
        print(
            f"{name}: {len(findings)} operation{'s' * (len(findings) != 1)} with a domain: "
            f"{counts[PROVEN]} proven safe, {counts[MAY_FAIL]} may fail, {counts[UNKNOWN]} {unseen}"
        )
    return CHECK_FAILED if unguarded else OK
