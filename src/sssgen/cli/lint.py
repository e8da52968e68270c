"""`sssgen lint`: reports operations that may fail in techniques, materials and plain GLSL."""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser, Namespace
from collections import Counter
from typing import TYPE_CHECKING, Any

from sssgen.cli.output import CHECK_FAILED, OK, WRONG_INPUT, print_errors, print_json, print_warnings, write_text
from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean, failure
from sssgen.support.progress import ProgressBar

if TYPE_CHECKING:
    from sssgen.analyse.lint.lint_findings import Report
    from sssgen.ir.intrinsics import Kind


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen lint ice\n  sssgen lint mine.glsl --json\n"
        "  sssgen lint mine.frag --kind nan,division\n  sssgen lint mine.frag --assume threejs\n"
        "  sssgen lint mine.frag --baseline lint.json --write-baseline\n"
        "  sssgen lint mine.frag --baseline lint.json --sarif lint.sarif\n"
        "Kinds: nan, division (by 0), undefined (by the language), range (out of range), overflow (to infinity).\n"
        "Exit status 1: an operation of a plain function may fail. The shaders that emit writes for materials have "
        "guards."
    )
    parser.add_argument("NAME", nargs="+", help="a technique, a material's .toml file, an example, or a GLSL file")
    parser.add_argument("--all", action="store_true", help="also list the operations that are proven safe")
    parser.add_argument(
        "--kind", metavar="KIND,KIND", help="the kinds of failures to report, or 'all' (default: all but overflow)"
    )
    parser.add_argument(
        "--assume", metavar="PRESET|FILE", action="append", default=[],
        help="assume what an engine guarantees of the inputs of plain GLSL: threejs, babylonjs, playcanvas, generic, "
        "unit-normals, colors, or a TOML file; may be repeated",
    )  # fmt: skip
    parser.add_argument("--sarif", metavar="FILE", help="also write the findings as SARIF 2.1.0, for code review")
    parser.add_argument("--baseline", metavar="FILE", help="report only findings that this file does not accept")
    parser.add_argument(
        "--write-baseline", action="store_true", help="write all findings to the file of --baseline, which accepts them"
    )
    parser.add_argument(
        "--no-examples", action="store_true", help="do not search for inputs that fail, which is faster"
    )


def run(arguments: Namespace) -> int:
    """Prints the operations that are not proven safe; returns 1 if one of them has no guard.

    A file with errors does not stop the others, unless a report is written: it would lack findings.
    """
    from sssgen.analyse.lint.finding_baseline import baseline_text, load_baseline, new_findings

    kinds = _kinds(arguments.kind)
    if arguments.write_baseline and not arguments.baseline:
        raise failure("--write-baseline needs --baseline FILE", "name the file to write")
    accepted = load_baseline(arguments.baseline) if arguments.baseline and not arguments.write_baseline else None
    reports, wrong = _reports(arguments, kinds)
    if wrong and (not reports or arguments.write_baseline or arguments.sarif):
        raise SssgenError(wrong)
    warnings = _warnings(reports)
    unproven = [finding for report in reports for finding in report.unproven()]
    new = unproven if accepted is None else new_findings(unproven, accepted)
    if arguments.write_baseline:
        _write(arguments.baseline, baseline_text(unproven))
        new = []
    is_new = {id(finding) for finding in new}
    if arguments.sarif:
        from sssgen.analyse.lint.sarif_report import sarif

        log = sarif(reports, is_new if arguments.baseline else None)
        _write(arguments.sarif, f"{json.dumps(log, indent=1)}\n")
    result = WRONG_INPUT if wrong else CHECK_FAILED if any(not finding.guarded for finding in new) else OK
    if arguments.json:
        others = {"warnings": [warning.as_json() for warning in warnings]}
        others |= {"diagnostics": [error.as_json() for error in wrong]} if wrong else {}
        print_json({"ok": result == OK, "results": [_as_json(report, is_new) for report in reports], **others})
        return result
    print_warnings(warnings)
    for report in reports:
        _print(report, is_new, arguments.all)
    if arguments.baseline:
        count = len(unproven) - len(new)
        written = " now" if arguments.write_baseline else ""
        print(f"{arguments.baseline}{written} accepts {count} finding{'s' * (count != 1)}; {len(new)} new")
    if wrong:
        sys.stdout.flush()
        print_errors(wrong)
    return result


def _reports(arguments: Namespace, kinds: tuple[Kind, ...]) -> tuple[list[Report], list[Diagnostic]]:
    """The reports of the files, and the errors of those that have some."""
    from sssgen.analyse.lint.lint_findings import lint

    reports: list[Report] = []
    wrong: list[Diagnostic] = []
    names = list(dict.fromkeys(arguments.NAME))
    with ProgressBar() as progress:
        for index, name in enumerate(names):
            progress(index, len(names), name)
            try:
                reports.append(lint(name, not arguments.no_examples, kinds, arguments.assume))
            except SssgenError as error:
                wrong += error.diagnostics
    return reports, wrong


def _as_json(report: Report, new: set[int]) -> dict[str, Any]:
    """A report; `new` has the identities of the findings that no baseline accepts."""
    return {
        "name": report.name,
        "findings": [finding.as_json() | {"new": id(finding) in new} for finding in report.findings],
        "hidden": dict(report.hidden),
        "assumptions": [fact.as_json() for fact in report.assumptions],
    }


def _print(report: Report, new: set[int], proven: bool) -> None:
    """Prints the new findings of a report, and those that are proven if these are wanted."""
    from sssgen.analyse.lint.lint_findings import PROVEN

    for finding in report.findings:
        if id(finding) in new or (finding.verdict == PROVEN and proven):
            print(f"{finding.render()}\n")
    print(_summary(report))
    for source, assumed in _assumptions(report):
        print(f"  assumed ({source}): {assumed}")


def _write(path: str, text: str) -> None:
    """Writes a report; `-` is the standard output."""
    if path == "-":
        print(text, end="")
    else:
        write_text(path, text)


def _warnings(reports: list[Report]) -> list[Diagnostic]:
    """The assumptions that match an input of none of the files."""
    counts = Counter((warning.message, warning.span) for report in reports for warning in report.warnings)
    last = {(warning.message, warning.span): warning for report in reports for warning in report.warnings}
    return [warning for key, warning in last.items() if counts[key] == len(reports)]


def _kinds(option: str | None) -> tuple[Kind, ...]:
    """The kinds that `--kind` selects. Raises SssgenError for an unknown one."""
    from sssgen.analyse.lint.lint_findings import REPORTED
    from sssgen.ir.intrinsics import KINDS

    if option is None:
        return REPORTED
    words = {word.strip() for word in option.split(",")}
    for word in sorted(words - {"all", *KINDS}):
        raise failure(f"unknown kind '{word}'", did_you_mean(word, KINDS) or f"kinds: {', '.join(KINDS)}, all")
    return tuple([kind for kind in KINDS if kind in words or "all" in words])


def _assumptions(report: Report) -> list[tuple[str, str]]:
    """What was assumed, a line for each source and each thing assumed."""
    names: dict[tuple[str, str], list[str]] = {}
    for fact in report.assumptions:
        names.setdefault((fact.source, fact.text), []).append(fact.name)
    return [(source, f"{', '.join(group)}: {text}") for (source, text), group in names.items()]


def _summary(report: Report) -> str:
    """The line below the findings of a file: how many operations were proven, and how many findings are not shown."""
    from sssgen.analyse.lint.lint_findings import MAY_FAIL, NOT_PROVEN, PROVEN

    counts = Counter(finding.verdict for finding in report.findings)
    total = len({id(finding.site) for finding in report.findings})
    kinds = Counter(finding.kind for finding in report.unproven())
    by_kind = f" ({', '.join(f'{kind}: {count}' for kind, count in kinds.items())})" if len(kinds) > 1 else ""
    hidden = "".join(f"; --kind {kind} shows {count} more" for kind, count in report.hidden.items())
    return (
        f"{report.name}: {total} operation{'s' * (total != 1)} with a domain: "
        f"{counts[PROVEN]} proven safe, {counts[MAY_FAIL]} may fail, {counts[NOT_PROVEN]} {NOT_PROVEN}{by_kind}{hidden}"
    )
