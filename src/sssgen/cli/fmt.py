"""`sssgen fmt`: lays out techniques and TOML files."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from sssgen.cli.output import CHECK_FAILED, OK, print_json
from sssgen.support.diagnostics import Diagnostic, SssgenError


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen fmt mine.sss mine.toml\n  sssgen fmt --check *.toml\n"
        "Lines stay as you broke them, and comments stay where they are. A file with syntax errors is not changed. "
        "Exit status 1: with --check, a file would change."
    )
    parser.add_argument("FILE", nargs="+", help="a technique (.sss), or a TOML file")
    parser.add_argument("--check", action="store_true", help="write nothing, and name the files that would change")


def run(arguments: Namespace) -> int:
    """Lays the files out; returns 1 if one would change under --check."""
    from sssgen.editor.layout import lay_out_file

    wrong: list[Diagnostic] = []
    changed: dict[str, bool] = {}
    for path in dict.fromkeys(arguments.FILE):
        try:
            changed[path] = lay_out_file(path, not arguments.check)
        except SssgenError as error:
            wrong += error.diagnostics
        else:
            if changed[path] and not arguments.json:
                print(f"{'would change' if arguments.check else 'changed'}: {path}")
    if wrong:
        raise SssgenError(wrong)
    failed = arguments.check and any(changed.values())
    if arguments.json:
        print_json({"ok": not failed, "files": [{"file": path, "changed": new} for path, new in changed.items()]})
    return CHECK_FAILED if failed else OK
