"""`sssgen check`: compiles shaders with the compilers of this machine."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Mapping

from sssgen.cli.emit import chosen_targets
from sssgen.cli.layout import print_rows, table_width, wrap
from sssgen.cli.options import unknown_name
from sssgen.cli.output import CHECK_FAILED, OK, print_json
from sssgen.ir.spans import Span
from sssgen.run.check import compile_check as check
from sssgen.run.check.compile_check import Report, Result
from sssgen.run.check.shader_files import Shader, read
from sssgen.run.compiler_registry import COMPILERS, readers
from sssgen.support.diagnostics import Diagnostic, SssgenError, visible
from sssgen.support.progress import ProgressBar

LISTED = 200
"""The largest number of files and compilers that are listed one by one without --verbose."""
SHOWN = 8
"""The number of messages shown per compiler and file; later ones mostly follow from the first."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen check ice\n  sssgen check wax.toml --target wgsl,hlsl\n  sssgen check out mine.frag"
    )
    parser.add_argument("FILE", nargs="+", help="a shader, a folder of shaders, a material's .toml file, or an example")
    parser.add_argument(
        "--target",
        "-t",
        metavar="T,T|all",
        action="append",
        help="check only these targets; also the language of a shader whose file name does not determine it",
    )
    parser.add_argument("--compiler", metavar="NAME", action="append", help="use only this compiler; may be repeated")
    help = f"list every file and compiler, where more than {LISTED} are compiled, too; else only failures"
    parser.add_argument("-v", "--verbose", action="store_true", help=help)
    parser.add_argument("--unity-includes", metavar="DIR", help="the folder of Unity's own headers")


def run(arguments: Namespace) -> int:
    """Compiles everything, and prints one line for each file and compiler, or for each that fails."""
    wrong: list[Diagnostic] = []
    targets = chosen_targets(",".join(arguments.target), wrong) if arguments.target else []
    compilers = _compilers(arguments.compiler or [], wrong)
    if wrong:
        raise SssgenError(wrong)
    shaders = read(arguments.FILE, targets)
    with ProgressBar() as progress:
        report = check.run(shaders, compilers, arguments.unity_includes, progress)
    good = _passes(report, shaders)
    if arguments.json:
        print_json({"ok": good, **check.as_json(report), "not_compiled": _reasons_not_compiled(report, shaders)})
    else:
        _print(report, shaders, arguments.verbose)
    return OK if good else CHECK_FAILED


def _compilers(names: list[str], wrong: list[Diagnostic]) -> list[str]:
    compilers = [name.strip() for text in names for name in text.split(",")]
    for name in compilers:
        if name not in COMPILERS:
            wrong += unknown_name("compiler", name, COMPILERS).diagnostics
    return compilers


def _passes(report: Report, shaders: list[Shader]) -> bool:
    """Whether something was compiled without errors; in CI, no compiler may be missing that `make setup` installs."""
    in_ci = os.environ.get("CI", "") not in ("", "0", "false")
    missing = [name for name in report.missing if not COMPILERS[name].apart]
    return all(result.ok for result in report.results) and bool(report.results) and not (in_ci and missing)


def _print(report: Report, shaders: list[Shader], verbose: bool) -> None:
    available = [(name, visible(version)) for name, version in report.versions.items()]
    missing = [(name, f"not found: {visible(instruction)}") for name, instruction in report.missing.items()]
    print_rows(available + missing, 7, 0)
    _print_engines()
    print()
    cells: dict[tuple[str, str], list[Result]] = {}
    for result in report.results:
        cells.setdefault((result.shader.name, result.compiler), []).append(result)
    width = max((len(shader.name) for shader in shaders), default=0)
    not_compiled = _reasons_not_compiled(report, shaders)
    every = verbose or len(cells) + len(not_compiled) <= LISTED
    for (name, compiler), results in cells.items():
        passed = all(result.ok for result in results)
        if every or not passed:
            print_rows([(f"{'ok  ' if passed else 'FAIL'} {visible(name)}", compiler)], 5 + width, 0)
            _print_messages(results)
    for name, why in not_compiled.items() if every else ():
        print_rows([(f"--   {visible(name)}", f"not compiled: {why}")], 5 + width, 0)
    if not every:
        good = [results for results in cells.values() if all(result.ok for result in results)]
        warned = sum(any(result.messages for result in results) for results in good)
        warnings = f", {warned} with warnings" if warned else ""
        print(f"{len(good)} of {len(cells)} are ok{warnings}; --verbose lists them")
    failed = sum(not result.ok for result in report.results)
    last = f"{len(shaders)} files, {len(report.results)} compilations, {failed} failed"
    print(f"\n{last}{f', {len(not_compiled)} not compiled' if not_compiled else ''}")
    _print_not_compiled(report, shaders, not_compiled)


def _print_not_compiled(report: Report, shaders: list[Shader], not_compiled: Mapping[str, str]) -> None:
    """How many files were not compiled for each reason, and how to get the compilers that they lack."""
    for why, count in Counter(not_compiled.values()).items():
        print(f"  {count} file{'s' * (count != 1)}: {why}")
    languages = {shader.sources[0].language for shader in shaders if shader.name in not_compiled}
    wanted = {name for language in languages for name in readers(language)}
    for name, instruction in report.missing.items():
        if name in wanted:
            _print_text(f"to get {name}: {visible(instruction)}")


def _print_text(text: str) -> None:
    """A text, indented, and wrapped on a terminal."""
    width = table_width()
    print("\n".join(wrap(text, width, "  ", "    ")) if width else f"  {text}")


def _reasons_not_compiled(report: Report, shaders: list[Shader]) -> dict[str, str]:
    """The files that no compiler compiled, with the reason."""
    done = {result.shader.name for result in report.results}
    left = [shader for shader in shaders if shader.name not in done]
    return {shader.name: _why_not(shader.sources[0].language, report) for shader in left}


def _print_engines() -> None:
    """The back ends of `render` and `eval` that are engines: those that are found, then those that lack the same."""
    names: dict[str, list[str]] = {"": []}
    for name, how in check.engines().items():
        names.setdefault(how, []).append(name)
    print("\nEngines as back ends:")
    for how, alike in names.items():
        if alike:
            _print_text(f"{', '.join(alike)}: {f'not found: {visible(how)}' if how else 'found'}")


def _why_not(language: str, report: Report) -> str:
    names = readers(language)
    if not names:
        return f"no compiler reads {language}"
    return f"{' and '.join(names)} not found" if report.missing.keys() & set(names) else "not by these compilers"


def _print_messages(results: list[Result]) -> None:
    """One compiler's messages for one file, without duplicates: each with its line, and the technique's line."""
    result = results[0]
    lines = result.shader.text.split("\n")
    messages = list(dict.fromkeys(message for result in results for message in result.messages))
    for message in messages[:SHOWN]:
        _print_text(f"{message.severity}: {visible(' '.join(message.text.split()))}")
        if message.line:
            place = f"{message.line}:{message.column}" if message.column else str(message.line)
            print(f"    --> {visible(result.shader.name)}:{place}")
            _print_line(lines[message.line - 1], message.line, message.column)
        if origin := result.origin(message):
            print(f"    from {visible(origin)}")
            _, line, column = origin.rsplit(":", 2)
            _print_line(check.source_line(origin), int(line), int(column))
    if len(messages) > SHOWN:
        print(f"  and {len(messages) - SHOWN} more")


def _print_line(text: str, line: int, column: int) -> None:
    """A line of a text with a caret below its column, as in the errors of sssgen."""
    if text.strip():
        rendered = Diagnostic("", "", Span("", line, column, line, column + 1), source_line=text).render()
        shown = rendered.split("\n")[1:]
        for row in shown if column else shown[:1]:
            print(f"   {row}")
