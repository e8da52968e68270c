"""The command line: reads the arguments, runs one command, and turns whatever goes wrong into a message.

Exit status: 0 done · 1 a check failed · 2 wrong input · 70 an error of sssgen itself · 130 interrupted ·
141 the reader of the output went away.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import os
import re
import sys
from collections.abc import Sequence

from .diagnostics import SssgenError, did_you_mean, failure
from .ir.typed import Any, NoReturn

OK, CHECK_FAILED, WRONG_INPUT, INTERNAL_ERROR, INTERRUPTED, BROKEN_PIPE = 0, 1, 2, 70, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command line; returns the exit status. Never raises."""
    given = list(sys.argv[1:] if argv is None else argv)
    as_json = "--json" in given
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a character shows '?'
            stream.reconfigure(errors="replace")
    try:
        status = _run(given)
        sys.stdout.flush()
        return status
    except SssgenError as error:
        return _guarded(_report, error, as_json)
    except BrokenPipeError:
        return _pipe_closed()
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except Exception as error:
        if os.environ.get("SSSGEN_DEBUG"):
            import traceback

            traceback.print_exc()
        return _guarded(_report_internal, error, as_json)


def _run(given: list[str]) -> int:
    arguments = parser().parse_args(given)
    module = importlib.import_module(f"{__package__}.commands.{arguments.module}")
    status = module.run(arguments)
    assert isinstance(status, int)
    return status


def _guarded(report: Any, error: Exception, as_json: bool) -> int:
    """Reports an error to a reader who may have gone away."""
    try:
        status = report(error, as_json)
        sys.stdout.flush()
        return int(status)
    except BrokenPipeError:
        return _pipe_closed()


def _pipe_closed() -> int:
    """Keeps Python from complaining of the closed pipe when it ends."""
    with contextlib.suppress(OSError, ValueError):  # a stream without a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return BROKEN_PIPE


def _report(error: SssgenError, as_json: bool) -> int:
    if as_json:
        print_json({"ok": False, "diagnostics": [found.as_json() for found in error.diagnostics]})
    else:
        print("\n\n".join(found.render() for found in error.diagnostics), file=sys.stderr)
        if len(error.diagnostics) > 1:
            print(f"\n{len(error.diagnostics)} errors", file=sys.stderr)
    return WRONG_INPUT


def _report_internal(error: Exception, as_json: bool) -> int:
    what = " ".join(f"{type(error).__name__} {error}".split())[:300]
    message = f"internal error: {what}: a fault of sssgen; please report it with the input that shows it"
    hint = "SSSGEN_DEBUG=1 shows where"
    if as_json:
        found = failure(message, hint).diagnostics[0]
        print_json({"ok": False, "diagnostics": [found.as_json()]})
    else:
        print(f"{message} ({hint})", file=sys.stderr)
    return INTERNAL_ERROR


def print_json(data: object) -> None:
    """A command's result for programs."""
    import json

    print(json.dumps(data, indent=2, ensure_ascii=False))


class _Parser(argparse.ArgumentParser):
    """argparse, whose errors are ours."""

    def error(self, message: str) -> NoReturn:
        hint = f"see: {self.prog} --help"
        if found := re.match(r"argument ([^:]+): invalid choice: '?(.*?)'? \(choose from (.*)\)", message):
            which, word, known = found.groups()
            choices = re.findall(r"[\w-]+", known)
            message = f"unknown {'command' if which == 'COMMAND' else which.lower()} '{word}'"
            hint = did_you_mean(word, choices) or f"choose from: {', '.join(choices)}"
        raise failure(message, hint)


def parser() -> argparse.ArgumentParser:
    """The command line's grammar."""
    top = _Parser(
        prog="sssgen",
        description="Generates shaders for translucent and parallax materials from one description.",
        epilog="Exit status: 0 done, 1 a check failed, 2 wrong input.\nOf one command: sssgen COMMAND --help",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show the version")
    commands = top.add_subparsers(metavar="COMMAND", dest="COMMAND", required=True)

    def command(name: str, module: str, text: str, epilog: str = "") -> argparse.ArgumentParser:
        made: argparse.ArgumentParser = commands.add_parser(
            name,
            help=text,
            description=text[0].upper() + text[1:] + ".",
            epilog=epilog,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        made.set_defaults(module=module)
        made.add_argument("--json", action="store_true", help="print the result, or the errors, as JSON")
        return made

    listing = command("list", "listing", "list what there is to choose from")
    listing.add_argument(
        "KIND", choices=("techniques", "targets", "materials"), help="techniques, targets or materials"
    )
    listing.add_argument("--role", metavar="R", help="only the techniques of this role")

    show = command("show", "show", "show a technique: what it does, what it takes, where it comes from")
    show.add_argument("TECHNIQUE", help="a name of `sssgen list techniques`, or a .sss file")

    emit = command(
        "emit",
        "emit",
        "write the shaders of materials",
        "examples:\n  sssgen emit ice --target all -o out\n  sssgen emit wax.toml -t wgsl,unity-urp -o out",
    )
    emit.add_argument("MATERIAL", nargs="+", help="a .toml file, or an example of `sssgen list materials`")
    emit.add_argument(
        "--target", "-t", metavar="T,T|all", required=True, help="targets of `sssgen list targets`, or all"
    )
    emit.add_argument(
        "-o", "--output", metavar="DIR", required=True, help="the folder to write to; made if need be"
    )
    emit.add_argument(
        "--form",
        choices=("shader", "functions"),
        default="shader",
        help="whole shaders (default), or functions to paste into one's own",
    )
    emit.add_argument("--templates", metavar="DIR", help="a folder of templates that stand before ours")

    transpile = command("transpile", "transpile", "translate functions in plain GLSL to a target's language")
    transpile.add_argument("FILE", help="a GLSL file of the subset (functions and uniforms; no main)")
    transpile.add_argument(
        "--target", "-t", metavar="T", required=True, help="a target of `sssgen list targets`"
    )
    transpile.add_argument(
        "-o", "--output", metavar="FILE", help="the file to write, and its reflection beside it"
    )

    new = command("new", "new", "write a commented material to start from")
    new.add_argument("MATERIAL", help="its name, or a .toml file; an old one is never overwritten")
    return top


class _Version(argparse.Action):
    """`--version`, without importing anything for those who do not ask."""

    def __call__(self, *_: object) -> NoReturn:
        from .version import VERSION

        print(f"sssgen {VERSION}")
        raise SystemExit(0)
