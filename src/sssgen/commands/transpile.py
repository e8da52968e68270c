"""`sssgen transpile`: functions in plain GLSL → a target's language."""

from __future__ import annotations

import os
import re
from argparse import Namespace
from pathlib import Path

from ..cli import OK, print_json
from ..data import posix
from ..diagnostics import Diagnostic, SssgenError, failure
from ..lang.loader import load_file
from ..library import TECHNIQUES
from ..output import write_files
from .emit import chosen_targets, print_warnings

REFLECTION = ".reflection.json"


def run(arguments: Namespace) -> int:
    """Prints the translation, or writes it with its reflection beside it."""
    from ..compiler import transpile

    wrong: list[Diagnostic] = []
    names = chosen_targets(arguments.target, wrong)
    if len(names) > 1:
        message = "transpile takes one target"
        wrong.append(Diagnostic("error", message, hint=f"write --target {names[0]}"))
    path = Path(arguments.FILE)
    if arguments.output is not None and os.path.realpath(arguments.output) == os.path.realpath(path):
        wrong += failure(
            "the output is the input: it would be lost", "write -o with another name", path.as_posix()
        ).diagnostics
    try:
        module = load_file(path, path.as_posix(), (TECHNIQUES,))
    except SssgenError as error:
        wrong += error.diagnostics
    if wrong:
        raise SssgenError(wrong)
    name = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    compiled = transpile(module, names[0], name if name[:1].isalpha() else f"file_{name}", arguments.guards)
    print_json_or_text(arguments, compiled.files, compiled.warnings)
    return OK


def print_json_or_text(arguments: Namespace, files: dict[str, str], warnings: list[Diagnostic]) -> None:
    """The text to the output, or both files to where `-o` says."""
    texts = [text for name, text in files.items() if not name.endswith(REFLECTION)]
    reflections = [text for name, text in files.items() if name.endswith(REFLECTION)]
    if arguments.output is not None:
        path = Path(arguments.output)
        outputs = {path.name: "\n".join(texts)}
        if reflections:
            outputs[f"{path.name}{REFLECTION}"] = reflections[0]
        written = write_files(os.fspath(path.parent), outputs)
        if arguments.json:
            rows = [{"file": posix(one.path), "changed": one.changed} for one in written]
            print_json({"ok": True, "files": rows, "diagnostics": [one.as_json() for one in warnings]})
    elif arguments.json:
        print_json({"ok": True, "texts": files, "diagnostics": [one.as_json() for one in warnings]})
    else:
        print("\n".join(texts), end="")
    if not arguments.json:
        print_warnings(warnings)
