"""`sssgen emit`: materials × targets → files."""

from __future__ import annotations

import itertools
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from sssgen.cli.options import DEFAULT_TARGET, add_guards, add_output, add_targets, nonempty
from sssgen.cli.output import CHECK_FAILED, OK, print_errors, print_json, print_warnings
from sssgen.pipeline import emitted_cache
from sssgen.pipeline.emitted_cache import EmittedFiles
from sssgen.support.diagnostics import Diagnostic, SssgenError, UnsupportedError, did_you_mean, failure
from sssgen.support.file_memo import changed_files, noted_files
from sssgen.support.file_writer import Written
from sssgen.support.paths import posix

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from sssgen.material.model import Material
    from sssgen.pipeline.compiler import Compiled
    from sssgen.pipeline.trace import Trace

STANDARD_OUTPUT = "-"

NAMED_TARGETS = 4
"""More targets than these, of which nothing draws a pass, are not named one by one."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen emit ice\n"
        "  sssgen emit ice --target all -o out\n"
        "  sssgen emit wax.toml -t wgsl,unity-urp -o out\n"
        "  sssgen emit ice -t wgsl -o -"
    )
    add_emission_options(parser)
    help = "the folder to write to (default: out), or - to print the shaders and write nothing"
    add_output(parser, "DIR", help, default="out")
    parser.add_argument(
        "--trace", action="store_true", help="also write the IR after each pass to DIR/NAME.TARGET.trace/NN-PASS.ir"
    )


def add_emission_options(parser: ArgumentParser) -> None:
    """What is emitted, and how: the options of `emit` and `watch`."""
    parser.add_argument("MATERIAL", nargs="+", help="a .toml file, or an example from `sssgen list materials`")
    add_targets(parser, default=None)
    parser.add_argument(
        "--form",
        choices=("shader", "functions"),
        default="shader",
        help="whole shaders (default), or functions to include in your own shader",
    )
    add_guards(parser)
    parser.add_argument(
        "--shell",
        action="append",
        default=[],
        metavar="ROLE=TECHNIQUE",
        help="add a shadow, environment or tone_mapping technique to the shell of every material, or omit the "
        "material's own (ROLE=none)",
    )
    parser.add_argument(
        "--prefix", type=nonempty, metavar="NAME", help="begin every global name with NAME, to fit in your own shader"
    )
    parser.add_argument(
        "--standalone",
        action="store_true",
        help="one file per module for three.js, Babylon.js and PlayCanvas, without the runtime that materials share",
    )
    parser.add_argument("--templates", metavar="DIR", help="a folder of templates that replace those of sssgen")
    parser.add_argument(
        "--force", action="store_true", help="replace files of a project of `sssgen use` that were edited"
    )


def run(arguments: Namespace) -> int:
    """Compiles everything, then writes or prints it; of a material with an error nothing is written.

    Where other materials are named, or other targets that can express the material, these are written, and the status
    is 1.
    """
    from sssgen.presets.written_project import write_shaders

    take_default_target(arguments)
    printed = arguments.output == STANDARD_OUTPUT
    if printed and arguments.trace:
        raise failure("--trace writes files", "name a folder with -o")
    traces: list[Trace] = []
    try:
        emitted = _load_or_compile(arguments, traces)
    finally:
        for trace in traces:
            trace.write(arguments.output)
    if emitted.errors and not emitted.files and len(arguments.MATERIAL) == 1:
        raise SssgenError(emitted.errors)
    written = [] if printed else write_shaders(arguments.output, emitted.files, arguments.force)
    if arguments.json:
        rows = _printed_rows(emitted) if printed else written_rows(emitted, written)
        print_json({"ok": not emitted.errors, "form": arguments.form, **report(rows, emitted)})
    else:
        print_warnings(emitted.warnings)
        if printed:
            _print_texts(emitted.files)
        for file in written:
            print(f"{'wrote' if file.changed else 'kept '} {posix(file.path)}")
        for material, requires in emitted.requires.items() if not printed else ():
            if requires:
                print(f"{material} requires {', '.join(requires)}")
        if emitted.errors:
            sys.stdout.flush()
            print_errors(emitted.errors)
    return CHECK_FAILED if emitted.errors else OK


def take_default_target(arguments: Namespace) -> None:
    """Sets the target where none is given, and says so."""
    if arguments.target is None:
        arguments.target = DEFAULT_TARGET
        if not arguments.json:
            message = f"the target is {DEFAULT_TARGET}; --target chooses others (sssgen list targets)"
            print(message, file=sys.stderr, flush=True)


def report(rows: list[dict[str, Any]], emitted: EmittedFiles) -> dict[str, Any]:
    """The JSON report of an emission."""
    diagnostics = [entry.as_json() for entry in (*emitted.errors, *emitted.warnings)]
    return {"files": rows, "requires": emitted.requires, "diagnostics": diagnostics}


def written_rows(emitted: EmittedFiles, written: list[Written]) -> list[dict[str, Any]]:
    return [
        {"file": posix(file.path), "material": material, "target": target, "changed": file.changed}
        for file, (material, target) in zip(written, emitted.sources.values(), strict=True)
    ]


def _printed_rows(emitted: EmittedFiles) -> list[dict[str, Any]]:
    return [
        {"file": name, "material": material, "target": target, "text": emitted.files[name]}
        for name, (material, target) in emitted.sources.items()
    ]


def _print_texts(files: dict[str, str]) -> None:
    """Prints the shaders without their reflections, as UTF-8; each of several follows a comment with its name."""
    texts = {name: text for name, text in files.items() if not name.endswith(".reflection.json")}
    if len(texts) == 1:
        (printed,) = texts.values()
    else:
        printed = "\n".join(f"{'#' if name.endswith('.py') else '//'} {name}\n{text}" for name, text in texts.items())
    sys.stdout.flush()
    sys.stdout.buffer.write(printed.encode("utf-8"))
    sys.stdout.buffer.flush()


def _load_or_compile(arguments: Namespace, traces: list[Trace]) -> EmittedFiles:
    """The cached result of the same command; with own templates or a trace it is compiled again."""
    if arguments.templates is not None or arguments.trace:
        return compile_all(arguments, traces if arguments.trace else None)
    options = (arguments.form, arguments.guards, arguments.prefix or "", ",".join(arguments.shell))
    command = [arguments.target, *options, str(arguments.standalone), *arguments.MATERIAL]
    cached = emitted_cache.load(command)
    if cached is not None:
        return cached
    with noted_files() as files:
        emitted = compile_all(arguments)
    if not emitted.errors and not changed_files(files):
        emitted_cache.store(command, emitted, files)
    return emitted


def compile_all(arguments: Namespace, traces: list[Trace] | None = None) -> EmittedFiles:
    """Compiles every material for every target; `traces` gets their traces.

    A material with an error has no files in the result. Raises SssgenError for faulty options, with all errors.
    """
    from sssgen.ir.frame_passes import BACK_FACES, INNER_LIGHT, MATT
    from sssgen.material.missing_files import missing_files
    from sssgen.material.requirements import describe
    from sssgen.pipeline.compiler import compile
    from sssgen.pipeline.trace import Trace
    from sssgen.support.progress import ProgressBar

    wrong: list[Diagnostic] = []
    errors: list[Diagnostic] = []
    failed: set[str] = set()
    names = chosen_targets(arguments.target, wrong)
    if arguments.standalone and arguments.form == "functions":
        wrong += failure("--standalone is for whole modules", "leave it out, or --form functions").diagnostics
    every = "all" in arguments.target.split(",")
    templates = arguments.templates
    if templates is not None and not os.path.isdir(templates):
        hint = "give the folder that holds TARGET/*.j2"
        wrong += failure("no such folder of templates", hint, posix(templates)).diagnostics
    materials = _materials(arguments.MATERIAL, arguments.shell, errors)
    files: dict[str, str] = {}
    sources: dict[str, tuple[str, str]] = {}
    warnings: list[Diagnostic] = []
    if arguments.prefix and arguments.form == "shader":
        from sssgen.pipeline.compiler import all_targets, without_prefix

        targets = all_targets()
        bare = [name for name in names if not targets[name].prefix]
        wrong += without_prefix(bare).diagnostics if bare else []
        names = [name for name in names if name not in bare]
    with ProgressBar() as progress:
        for index, (material, name) in enumerate(itertools.product(materials, names)):
            progress(index, len(materials) * len(names), f"{material.name} for {name}")
            trace = None
            if traces is not None:
                trace = Trace(f"{material.name}.{name}.trace")
                traces.append(trace)
            try:
                compiled = compile(
                    material, name, arguments.form, templates, arguments.guards, trace, arguments.prefix or "",
                    arguments.standalone,
                )  # fmt: skip
            except SssgenError as error:
                if len(names) > 1 and isinstance(error, UnsupportedError):
                    omitted = warnings if every else errors
                    omitted += _omissions(error, material, name, "warning" if every else "error")
                else:
                    errors += error.diagnostics
                    failed.add(material.name)
            else:
                failed |= _collect(compiled, (material.name, name), files, sources, errors)
                warnings += compiled.warnings
    if wrong:
        raise SssgenError(dict.fromkeys([*wrong, *errors]))
    sources = {file: source for file, source in sources.items() if source[0] not in failed}
    right = [material for material in materials if material.name not in failed]
    required = {
        material.name: describe(
            material.stages,
            *(_drawers(material.name, names, arguments.form, drawn) for drawn in (BACK_FACES, MATT, INNER_LIGHT)),
        )
        for material in right
    }
    warnings += [warning for material in right for warning in missing_files(material)]
    texts = {file: files[file] for file in sources}
    return EmittedFiles(texts, sources, list(dict.fromkeys(warnings)), required, list(dict.fromkeys(errors)))


def _drawers(material: str, names: Sequence[str], form: str, drawn: str) -> list[str]:
    """What draws a pass of a material: of each of several targets, with its name, where they differ."""
    from sssgen.pipeline.compiler import all_targets

    targets = [all_targets()[name] for name in names]
    texts = [target.drawer(drawn).format(material=material) if form == "shader" else "" for target in targets]
    if len(set(texts)) == 1:
        return texts[:1] if texts[0] else []
    drawers = [f"{text} in {target.title}" for target, text in zip(targets, texts, strict=True) if text]
    undrawn = [name for name, text in zip(names, texts, strict=True) if not text]
    others = ", ".join(undrawn) if len(undrawn) <= NAMED_TARGETS else "the other targets"
    return [*drawers, f"your own program for {others}"] if undrawn else drawers


def chosen_targets(text: str, wrong: list[Diagnostic]) -> list[str]:
    """The targets that `T,T` or `all` names, each once; unknown ones are added to `wrong`."""
    from sssgen.pipeline.compiler import all_targets
    from sssgen.targets.registry import faults, found_under

    targets, broken = list(all_targets()), faults()
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        wrong += failure("no target is named", f"targets: {', '.join(targets)}, or all").diagnostics
    for name in broken if "all" in names else names:
        if name in broken:
            wrong += broken[name].diagnostics
    for name in names:
        if name not in (*targets, *broken, "all"):
            hint = (
                found_under(name) or did_you_mean(name, [*targets, "all"]) or f"targets: {', '.join(targets)}, or all"
            )
            wrong += failure(f"unknown target '{name}'", hint).diagnostics
    return targets if "all" in names else [name for name in dict.fromkeys(names) if name in targets]


def _materials(arguments: list[str], shell: list[str], errors: list[Diagnostic]) -> list[Material]:
    """The materials; those that cannot be read, and those of one name in several files, are added to `errors`."""
    from sssgen.material.material_loading import load_material
    from sssgen.material.shell_stages import with_shell

    named: dict[str, dict[str, Material]] = {}
    for argument in arguments:
        try:
            material = load_material(argument)
            material = with_shell(material, shell) if shell else material
        except SssgenError as error:
            errors += error.diagnostics
        else:
            named.setdefault(material.name, {}).setdefault(os.path.realpath(material.file), material)
    for name, of_one_name in named.items():
        if len(of_one_name) > 1:
            files = " and ".join(posix(material.file) for material in of_one_name.values())
            message = f"{len(of_one_name)} materials are called '{name}', in {files}: their shaders would have one name"
            errors += failure(message, "give each another name in [material]; none of them is written").diagnostics
    return [next(iter(of_one_name.values())) for of_one_name in named.values() if len(of_one_name) == 1]


def _omissions(error: UnsupportedError, material: Material, target: str, severity: str) -> list[Diagnostic]:
    """The diagnostics that a material has no file for one of several targets."""
    left_out = f"{material.name} is not emitted for {target}: "
    return [entry._replace(severity=severity, message=left_out + entry.message) for entry in error.diagnostics]


def _collect(
    compiled: Compiled,
    source: tuple[str, str],
    files: dict[str, str],
    sources: dict[str, tuple[str, str]],
    errors: list[Diagnostic],
) -> set[str]:
    """Adds the files of one compilation. The materials of a target may share a file.

    Returns the materials with a file that has two sources, which is an error.
    """
    failed = set()
    for name, text in compiled.files.items():
        if files.get(name) == text and sources[name][1] == source[1]:
            continue
        if name in files:
            message = f"'{name}' comes from {' for '.join(sources[name])} and from {' for '.join(source)}"
            errors += failure(message, "give the target's files other names").diagnostics
            failed |= {sources[name][0], source[0]}
        files[name], sources[name] = text, source
    return failed
