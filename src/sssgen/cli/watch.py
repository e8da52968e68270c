"""`sssgen watch`: emits at once, and again whenever a file changes that the emission has read."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from sssgen.cli.emit import add_emission_options, chosen_targets, compile_all, report, take_default_target, written_rows
from sssgen.cli.options import add_output
from sssgen.cli.output import OK, failure_report, print_errors, print_warnings
from sssgen.presets.written_project import write_shaders
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.file_changes import FolderMessages, changes
from sssgen.support.file_memo import FileState, noted_files
from sssgen.support.paths import posix

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from sssgen.pipeline.emitted_cache import EmittedFiles


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen watch wax.toml\n"
        "  sssgen watch wax.toml ice -t wgsl,unity-urp -o out\n"
        "Ctrl-C ends it. An error is printed, and the files of the last emission without one stay. With --json every "
        "emission prints one line."
    )
    add_emission_options(parser)
    add_output(parser, "DIR", "the folder to write to (default: out)", default="out")


def run(arguments: Namespace) -> int:
    """Emits until Ctrl-C."""
    take_default_target(arguments)
    wrong: list[Diagnostic] = []
    chosen_targets(arguments.target, wrong)
    if wrong:  # no change of a file mends it
        raise SssgenError(wrong)
    try:
        messages, watch = FolderMessages(), Watch(arguments)
        watch.emit()
        for changed in changes(lambda: watch.files, messages=messages):
            watch.emit(changed)
    except KeyboardInterrupt:
        if not arguments.json:
            print("watched until Ctrl-C", file=sys.stderr)
    return OK


class Watch:
    """Emits materials again and again, and prints what became of it."""

    def __init__(self, arguments: Namespace) -> None:
        self.arguments = arguments
        self.files: dict[str, FileState] = {}
        """The files that the newest emission has read, each with its state before."""
        self._warnings: list[Diagnostic] = []

    def emit(self, changed: set[str] | None = None) -> None:
        """Emits, and prints which files were written, or the errors; `changed` are the files that made it necessary."""
        start = ", ".join(sorted(map(_display_path, changed))) + " changed" if changed else ""
        if start and not self.arguments.json:
            print(start, flush=True)
        try:
            with noted_files() as self.files:
                emitted = compile_all(self.arguments)
            if emitted.errors and not emitted.files:
                raise SssgenError(emitted.errors)
            self._write(emitted)
        except SssgenError as error:
            self._print_errors(error.diagnostics)
        if changed is None and not self.arguments.json:
            print(f"watching {len(self.files)} files; Ctrl-C ends it", flush=True)

    def _write(self, emitted: EmittedFiles) -> None:
        written = write_shaders(self.arguments.output, emitted.files, self.arguments.force)
        if self.arguments.json:
            rows = written_rows(emitted, written)
            _print_line({"ok": not emitted.errors, "form": self.arguments.form, **report(rows, emitted)})
            return
        if emitted.warnings != self._warnings:
            print_warnings(emitted.warnings)
            self._warnings = emitted.warnings
        for file in written:
            if file.changed:
                print(f"wrote {posix(file.path)}")
        if not any(file.changed for file in written):
            print(f"the {len(written)} files in {posix(self.arguments.output)} are the same")
        sys.stdout.flush()
        if emitted.errors:
            self._print_errors(emitted.errors)

    def _print_errors(self, errors: Sequence[Diagnostic]) -> None:
        if self.arguments.json:
            _print_line(failure_report(errors))
        else:
            print_errors(errors)
            sys.stderr.flush()


def _print_line(data: object) -> None:
    print(json.dumps(data, ensure_ascii=False), flush=True)


def _display_path(path: str) -> str:
    """A file as the user knows it: from the working folder, where it is in it."""
    shown = os.path.relpath(path) if os.path.splitdrive(path)[0] == os.path.splitdrive(os.getcwd())[0] else path
    return posix(path if shown.startswith(os.pardir) else shown)
