"""`sssgen transpile --stages`: both stages of a program, their common reflection, and what loads it in a page."""

from __future__ import annotations

import os
from argparse import Namespace

from sssgen.cli.output import OK, print_json
from sssgen.cli.translation import explain_renames, macros, one_target, print_changes
from sssgen.lang.plain_glsl import GlslFile, load_glsl
from sssgen.passes.stage.stage_interface import entry_of
from sssgen.pipeline.two_stages import Source, transpile_stages
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix, stem
from sssgen.support.text_files import read_text
from sssgen.targets.javascript_runtime import FOLDER
from sssgen.targets.registry import load

LOADER = "webgl_program.js"
"""The ES module that makes a pipeline of the files, for WebGPU."""


def run(arguments: Namespace) -> int:
    """Writes the files of a program, or prints them as JSON. Raises SssgenError."""
    wrong = _unfit_options(arguments)
    targets = one_target(arguments.target, wrong)
    loaded: list[GlslFile] = []
    for file in arguments.stages:
        try:
            loaded.append(load_glsl(file, posix(file), arguments.include, macros(arguments.define)))
            if entry_of(loaded[-1].module) is None:
                hint = "give a vertex shader and a fragment shader, each with a main()"
                wrong += failure("the file has no main()", hint, posix(file)).diagnostics
        except SssgenError as error:
            wrong += error.diagnostics
    if wrong:
        raise SssgenError(wrong)
    folder, name = _place(arguments, targets[0])
    first, second = [Source(each.module, each.head) for each in loaded]
    program = transpile_stages(first, second, targets[0], name, arguments.guards, arguments.rows)
    files = dict(program.files)
    if targets[0] == "wgsl":
        files[LOADER] = read_text(os.path.join(FOLDER, LOADER), LOADER)
    inputs = {os.path.realpath(path): path for path in (*arguments.stages, *(p for each in loaded for p in each.paths))}
    for file in files:
        path = inputs.get(os.path.realpath(os.path.join(folder, file)))
        if path is not None and arguments.output is not None:
            message = f"the output file {file} is also an input file"
            raise failure(message, "give -o another folder or name", posix(path))
    renamed = [
        row
        for renames, each in zip(program.renames, loaded, strict=True)
        for row in explain_renames(renames, targets[0], each, program.files)
    ]
    warnings = [*(warning for each in loaded for warning in each.warnings), *program.warnings]
    details = {"renamed": renamed, "diagnostics": [warning.as_json() for warning in warnings]}
    if arguments.output is None:
        print_json({"ok": True, "texts": files, **details})
        return OK
    written = write_files(folder, files)
    if arguments.json:
        print_json({"ok": True, "files": [{"file": posix(f.path), "changed": f.changed} for f in written], **details})
    else:
        print_changes(warnings, renamed)
        for each in written:
            print(f"{'wrote' if each.changed else 'kept '} {posix(each.path)}")
    return OK


def _unfit_options(arguments: Namespace) -> list[Diagnostic]:
    """The options that do not fit --stages."""
    unfit = {
        "FILE": arguments.FILE, "--with": arguments.partner, "--verify": arguments.verify, "--as": arguments.as_,
        "--entry": arguments.entry, "--trace": arguments.trace,
    }  # fmt: skip
    wrong = [
        Diagnostic(
            "error", f"{option} cannot be used with --stages", hint=f"leave {option} out, or translate each stage"
        )
        for option, value in unfit.items()
        if value
    ]
    if arguments.output in (None, "-") and not arguments.json:
        hint = "write -o FOLDER or -o FOLDER/NAME; or add --json, which prints all files"
        wrong.append(Diagnostic("error", "--stages writes several files, and needs a place for them", hint=hint))
    return wrong


def _place(arguments: Namespace, target: str) -> tuple[str, str]:
    """The folder of the output, and the name of the program, without a suffix of the target: `-o web/water.wgsl`."""
    name = stem(arguments.stages[0])
    output = arguments.output
    if output in (None, "-"):
        arguments.output = None
        return ".", name
    if output.endswith(("/", os.sep)) or os.path.isdir(output):
        return output, name
    given = os.path.basename(output)
    files = [file for kind in ("vertex", "fragment") for file in load(target).files.get(kind, ())]
    is_file = os.path.splitext(given)[1] in {".json", *[os.path.splitext(file.name)[1] for file in files]}
    return os.path.dirname(output) or ".", stem(given) if is_file else given
