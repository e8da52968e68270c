"""`sssgen transpile`: translates plain GLSL to a target's language, and reports renamed identifiers."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace
from math import inf
from pathlib import Path
from typing import Any

from sssgen.analyse.verify.time_limit import EACH, TOTAL, TimeLimit
from sssgen.cli.options import add_guards, add_output, add_seed, check_samples
from sssgen.cli.output import CHECK_FAILED, INTERRUPTED, OK, print_json, print_result
from sssgen.cli.translation import REFLECTION, explain_renames, macros, one_target, print_changes, title
from sssgen.ir.nodes import Module
from sssgen.lang.loader import load_file
from sssgen.lang.plain_glsl import GlslFile, load_glsl
from sssgen.material.library import TECHNIQUES
from sssgen.pipeline.as_technique import technique_file
from sssgen.pipeline.compiler import transpile
from sssgen.pipeline.trace import Trace
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix, source_name
from sssgen.support.progress import ProgressBar
from sssgen.support.text_files import read_code
from sssgen.targets.program_reflection import ROWS

MAX_SAMPLES = 1_000_000
"""The most inputs of --verify."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen transpile noise.glsl --target wgsl -o noise.wgsl\n"
        "  sssgen transpile scene.glsl --entry shadertoy --target hlsl\n"
        "  sssgen transpile library/fbm.glsl -I library -D OCTAVES=5 --prune -t unity-urp\n"
        "  sssgen transpile water.frag --with water.vert --target wgsl\n"
        "  sssgen transpile --stages water.vert water.frag --target wgsl -o web/water\n"
        "  sssgen transpile noise.glsl --verify\n"
        "  sssgen transpile noise.glsl --as technique --function snoise\n"
        "The accepted language: docs/transpile.md. \n"
        "Exit status 1: --verify found a difference, or did not reach each function in its time."
    )
    add = parser.add_argument
    add("FILE", nargs="?", help="a file of GLSL 1.00 ES to 4.60: functions, or a vertex, fragment or compute shader")
    add("--target", "-t", metavar="T", help="a target from `sssgen list targets`")
    add(
        "--include",
        "-I",
        metavar="DIR",
        action="append",
        default=[],
        help="search this folder for #include; may be repeated",
    )
    add("--define", "-D", metavar="NAME[=VALUE]", action="append", default=[], help="define a macro; may be repeated")
    add("--entry", choices=("shadertoy",), default="", help="the file's entry point: mainImage instead of main")
    add(
        "--with",
        dest="partner",
        metavar="FILE",
        help="the file of the other stage, so that both stages agree on the values between them",
    )
    add(
        "--stages",
        nargs=2,
        metavar=("VERTEX", "FRAGMENT"),
        help="both stages of a program instead of FILE: their bindings agree, and one JSON file describes them;"
        " -o NAME writes NAME.vertex.wgsl, NAME.fragment.wgsl, NAME.program.json and, for wgsl, webgl_program.js",
    )
    add(
        "--rows",
        choices=ROWS,
        default=ROWS[0],
        help="for --stages: the first row of a picture is at the bottom, as in WebGL (the default), or at the top",
    )
    add("--prune", action="store_true", help="omit functions that the file itself never calls")
    add_guards(parser, default="none")
    help = "the file to write; its reflection is written next to it. For --stages: a folder, or folder/name"
    add_output(parser, "FILE", help)
    add(
        "--trace",
        action="store_true",
        help="also write the IR after each pass to FILE.trace/NN-PASS.ir, where -o is FILE",
    )
    add(
        "--verify",
        action="store_true",
        help="run every function as written and as translated, and compare the results; with --target only that one's",
    )
    add(
        "--samples",
        type=int,
        default=1000,
        metavar="N",
        help="the number of inputs for --verify (default: 1000)",
    )
    add_seed(parser, "the seed of these inputs")
    add(
        "--seconds",
        type=float,
        default=TOTAL,
        metavar="N",
        help=f"the time of --verify for the file; it lists functions not reached (default: {TOTAL:g}; 0: no limit)",
    )
    add(
        "--function-seconds",
        type=float,
        default=EACH,
        metavar="N",
        help=f"its time for each function; it may try fewer inputs (default: {EACH:g}; 0: no limit)",
    )
    add("--as", dest="as_", choices=("technique",), help="write a function as the start of a technique's file")
    add(
        "--function",
        metavar="NAME",
        default="",
        help="the function for --as (default: the last one of the file) or --verify (default: all)",
    )


def run(arguments: Namespace) -> int:
    """Prints the translation, or writes it with its reflection; or prints the result of `--verify`."""
    if arguments.stages is not None:
        from sssgen.cli import transpile_stages

        return transpile_stages.run(arguments)
    if arguments.FILE is None:
        raise failure("the file is missing", "give a file, or both stages of a program: --stages A.vert B.frag")
    wrong: list[Diagnostic] = []
    names = _wanted_target(arguments, wrong)
    path = Path(arguments.FILE)
    if arguments.output == "-":
        arguments.output = None  # the text is printed
    module, loaded, partner = None, None, None
    try:
        if path.suffix == ".sss":
            module = load_file(path, (TECHNIQUES,))
        else:
            options = arguments.include, macros(arguments.define), arguments.entry
            loaded = load_glsl(path, path.as_posix(), *options)
            module = loaded.module
            if not any(module):
                hint = "write functions, structures or constants; those between #if and #endif may need -D NAME"
                wrong += failure("there is nothing to translate in the file", hint, path.as_posix()).diagnostics
            if arguments.partner is not None:
                partner = load_glsl(arguments.partner, posix(arguments.partner), *options).module
    except SssgenError as error:
        wrong += error.diagnostics
    inputs = [path, *map(Path, loaded.paths if loaded is not None else ())]
    inputs += [Path(arguments.partner)] if arguments.partner is not None else []
    for read in inputs:
        if arguments.output is not None and os.path.realpath(arguments.output) == os.path.realpath(read):
            message = "the output file is also an input file"
            wrong += failure(message, "give -o another name", read.as_posix()).diagnostics
            break
    if wrong or module is None:
        raise SssgenError(wrong)
    if arguments.verify:
        return _verify(arguments, path, bool(module.workgroup))
    if arguments.as_ == "technique":
        return _technique(arguments, module, path)
    return _translate(arguments, module, loaded, names[0], path, partner)


def _wanted_target(arguments: Namespace, wrong: list[Diagnostic]) -> list[str]:
    """The requested target; none if nothing is translated, or all that --verify runs."""
    if arguments.as_ and arguments.target is not None:
        hint = f"sssgen transpile {arguments.FILE} --as {arguments.as_}"
        wrong.append(Diagnostic("error", "--as takes no --target", hint=hint))
    if arguments.as_ or (arguments.verify and arguments.target is None):
        return []
    names = one_target(arguments.target, wrong)
    if arguments.trace and arguments.output in (None, "-"):
        wrong.append(
            Diagnostic(
                "error", "--trace needs an output file", hint="write -o FILE: the trace is written to FILE.trace"
            )
        )
    return names


def _translate(
    arguments: Namespace, module: Module, loaded: GlslFile | None, target: str, path: Path, partner: Module | None
) -> int:
    called = None
    if arguments.prune:
        own = path.as_posix() if loaded is not None else source_name(path)
        called = [function.key for function in module.functions if function.span.file == own]
        called = [key for key in called if key == "main()"] or called
    options: dict[str, Any] = {"called": called} if called else {}
    if loaded is not None:  # the text of a technique is simplified, that of plain GLSL is kept
        options |= {"keep": True, "head": loaded.head}
    if partner is not None:
        options["partner"] = partner
    trace = Trace(f"{os.path.basename(arguments.output)}.trace") if arguments.trace else None
    try:
        compiled = transpile(module, target, title(path.stem), arguments.guards, trace=trace, **options)
    finally:
        if trace is not None:
            trace.write(os.path.dirname(arguments.output) or ".")
    renamed = explain_renames(compiled.reflection["renames"], target, loaded, compiled.files)
    warnings = [*(loaded.warnings if loaded else []), *compiled.warnings]
    _print(arguments, compiled.files, warnings, renamed, loaded.constants if loaded else [])
    return OK


def _print(
    arguments: Namespace,
    files: dict[str, str],
    warnings: list[Diagnostic],
    renamed: list[dict[str, str]],
    constants: list[str],
) -> None:
    """Prints the text, or writes both files of `-o`; and prints warnings and renamed identifiers."""
    texts = [text for name, text in files.items() if not name.endswith(REFLECTION)]
    reflections = [text for name, text in files.items() if name.endswith(REFLECTION)]
    details: dict[str, Any] = {
        "renamed": renamed, "constants": constants, "diagnostics": [warning.as_json() for warning in warnings],
    }  # fmt: skip
    if arguments.output is not None:
        path = Path(arguments.output)
        outputs = {path.name: "\n".join(texts)}
        if reflections:
            outputs[f"{path.name}{REFLECTION}"] = reflections[0]
        written = write_files(os.fspath(path.parent), outputs)
        if arguments.json:
            rows = [{"file": posix(file.path), "changed": file.changed} for file in written]
            print_json({"ok": True, "files": rows, **details})
    elif arguments.json:
        print_json({"ok": True, "texts": files, **details})
    else:
        print("\n".join(texts), end="")
    if not arguments.json:
        print_changes(warnings, renamed)


def _verify(arguments: Namespace, path: Path, computes: bool) -> int:
    """Runs each function, or a compute shader, as written and as translated, and prints the differences."""
    from sssgen.analyse.verify import compute_verification as compute
    from sssgen.analyse.verify import inline_includes as includes
    from sssgen.analyse.verify import verification as transpiled
    from sssgen.analyse.verify.verification_report import Report, Row
    from sssgen.analyse.verify.verified_function import Options

    check_samples(arguments, MAX_SAMPLES)
    for option, seconds in (("--seconds", arguments.seconds), ("--function-seconds", arguments.function_seconds)):
        if not 0.0 <= seconds < inf:
            raise failure(f"{option} {seconds:g} is not a time", "seconds, or 0 for no limit")
    limit = TimeLimit(arguments.seconds or inf, arguments.function_seconds or inf)
    if arguments.define:
        raise failure("-D cannot be used with --verify", "write the #define into the file")
    text = includes.expand(read_code(path, path.as_posix()), path, arguments.include)
    if computes:
        if arguments.function:
            raise failure("a compute shader is run as a whole", "leave out --function", path.as_posix())
        if arguments.target:
            raise failure("a compute shader runs on all back ends together", "leave out --target", path.as_posix())
        computed = compute.verify_compute(text, path.as_posix(), arguments.seed)
        print_result(arguments.json, computed.as_json(), "\n".join(computed.lines()), computed.ok)
        return OK if computed.ok else CHECK_FAILED
    with ProgressBar() as progress:

        def show(report: Report, row: Row) -> None:
            if arguments.json:
                return  # one object at the end
            with progress.hide():
                lines = [report.head()] if len(report.rows) == 1 else []
                print("\n".join([*lines, *report.row_lines(row)]), flush=True)

        options = Options(
            arguments.samples, arguments.seed, arguments.entry, arguments.function, arguments.target or ""
        )
        report = transpiled.verify(text, path.as_posix(), options, progress=progress, limit=limit, show=show)
    if arguments.json:
        print_json({"ok": report.ok, **report.as_json()})
    else:
        for line in report.last_lines():
            print(line)
    if report.interrupted:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    return OK if report.ok else CHECK_FAILED


def _technique(arguments: Namespace, module: Module, path: Path) -> int:
    """Writes a function of the file as a technique's file, with a doc comment to be filled in."""
    name, text = technique_file(module, path.as_posix(), arguments.function)
    if arguments.output is None:
        print_result(arguments.json, {"texts": {f"{name}.sss": text}}, text.removesuffix("\n"))
        return OK
    target = Path(arguments.output)
    if target.is_dir():
        target /= f"{name}.sss"
    if target.exists():
        raise failure("the file already exists", "choose another name, or remove it first", target.as_posix())
    write_files(os.fspath(target.parent), {target.name: text})
    print_result(arguments.json, {"file": target.as_posix()}, f"wrote {target.as_posix()}")
    return OK
