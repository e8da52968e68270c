"""`sssgen ci`: checks a folder's materials, scenes and numbers."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections import Counter

from sssgen.cli.output import CHECK_FAILED, OK, print_json
from sssgen.support.diagnostics import visible
from sssgen.support.progress import ProgressBar
from sssgen.testing import junit
from sssgen.testing import project_run as ci
from sssgen.testing.project_run import Case, CaseResult

WORDS = {"passed": "ok  ", "failed": "FAIL", "skipped": "skip"}


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen ci shaders --junit report.xml\n"
        "  sssgen ci shaders --update\n"
        "The golden picture of a scene is golden/NAME.png next to it. A file NAME.eval.json has inputs to evaluate: "
        '{"technique": "lobe_gdc2011", "inputs": {"N": [[0, 0, 1]]}, "tolerance": 1e-5}'
    )
    add = parser.add_argument
    add("DIR", help="the folder of your materials and scenes")
    add(
        "--backend",
        "-b",
        metavar="NAME",
        help="one or several back ends, separated by commas (default: gl for scenes, all for numbers)",
    )
    add("--update", action="store_true", help="write the golden pictures instead of comparing with them")
    add("--flip", type=float, metavar="X", help="the largest mean of FLIP that passes (default: 0.005)")
    add("--junit", metavar="FILE", help="write a report in JUnit's XML")


def run(arguments: Namespace) -> int:
    """Checks all cases and prints a line for each; returns 0 if none failed and one passed."""
    backends: list[str] = []
    if arguments.backend is not None:
        from sssgen.run.backends import backend_names

        backends = backend_names(arguments.backend)
    cases = ci.cases(arguments.DIR, backends)
    if arguments.flip is not None:
        from sssgen.testing.golden import check_limit

        check_limit(arguments.flip)
    if arguments.junit:
        junit.write(arguments.junit, [])  # an error here is reported before the run, which takes minutes
    width = max(len(case.name) for case in cases)
    results: list[CaseResult] = []
    try:
        with ci.Run(arguments.update, arguments.flip) as check, ProgressBar() as progress:
            for case in cases:
                progress(len(results), len(cases), f"{case.kind} {case.name}")
                results.append(check(case))
                if not arguments.json:
                    with progress.hide():
                        _print(results[-1], width)
    finally:
        if arguments.junit:
            junit.write(arguments.junit, results)
    count = Counter(result.outcome.state for result in results)
    good = not count["failed"] and count["passed"] > 0
    if arguments.json:
        print_json({"ok": good, "cases": [_as_json(result) for result in results]})
    else:
        counts = [f"{count[state]} {state}" for state in ("passed", "failed", "skipped") if count[state]]
        print(f"\n{len(results)} cases in {sum(result.seconds for result in results):.1f} s: {', '.join(counts)}")
        if not good and not count["failed"]:
            print("nothing was checked")
    return OK if good else CHECK_FAILED


def _print(result: CaseResult, width: int) -> None:
    case, outcome = result.case, result.outcome
    name = f"{visible(case.name):{width}}"
    print(
        f"{WORDS[outcome.state]} {case.kind:7} {name} {result.seconds:6.2f} s  {visible(outcome.message)}", flush=True
    )
    if outcome.state == "failed":
        for line in outcome.detail.split("\n") if outcome.detail else []:
            print(f"       {visible(line)}")


def _as_json(result: CaseResult) -> dict[str, object]:
    case: Case = result.case
    return {
        "kind": case.kind, "file": case.path, "backends": list(case.backends), "outcome": result.outcome.state,
        "seconds": round(result.seconds, 3), "message": result.outcome.message, "detail": result.outcome.detail,
    }  # fmt: skip
