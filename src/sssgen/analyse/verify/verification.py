"""`sssgen transpile --verify`: a file's functions as the driver reads them, compared with their translations.

Each function runs on inputs that reach its branches (`input_search`): the author's own text in OpenGL's driver, and its
translations to GLSL, HLSL, WGSL and NumPy in float64, the oracle, or to the target that is named. A deviation is the
difference from the author's text, relative to the larger of the value's size and 1. Two kinds of lanes are excluded
and counted:

- undefined ones, where the function meets an operation that GLSL leaves undefined (`lane_interpreter`), or where the
  author's text gives infinity or NaN: the languages guarantee nothing there;
- ill-conditioned ones, where rounding explains the deviation (`rounding_noise`): at the edge of a cell, in a hash; or
  where a device takes the derivative of the other row or column of a quad of pixels, which GLSL leaves to it. The
  translation to GLSL runs in the driver that runs the author's text, so its builtins have the same errors; for the
  others, builtins have the errors that their rows grant.

A uniform has one value in each of several rounds. Functions that cannot be run are listed with the reason.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import nullcontext
from functools import partial

from sssgen.analyse.verify.machines import Machines, backends_of, start_machines
from sssgen.analyse.verify.plain_probes import probe_functions
from sssgen.analyse.verify.stage_variables import MAIN, plain
from sssgen.analyse.verify.time_limit import TimeLimit
from sssgen.analyse.verify.unnamed_parameters import with_names
from sssgen.analyse.verify.verification_report import (
    EVERY,
    TRANSLATIONS,
    Report,
    Row,
)
from sssgen.analyse.verify.verified_function import Case, Options, title
from sssgen.ir.nodes import Function, Module
from sssgen.lang import shadertoy
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.progress import Progress, silent


def load(text: str, shown: str, version: str = "") -> Module:
    """The module of a text of plain GLSL, whose `#version` is passed separately: `330`, `300 es`."""
    number, _, profile = version.partition(" ")
    language = (int(number), "es" if number == "100" else profile) if number else None
    return load_glsl_text(text, shown, language=language).module


DEFAULTS = Options()


def verify(
    text: str, shown: str, options: Options = DEFAULTS, read: Callable[[str, str], Module] | None = None,
    machines: Machines | None = None, progress: Progress = silent, limit: TimeLimit | None = None,
    show: Callable[[Report, Row], None] = lambda report, row: None,
) -> Report:  # fmt: skip
    """Runs the functions of a text without `#include` (see `inline_includes`).

    `shown` is the text's name in messages; `read(text, shown)` parses it; without `machines` the back ends are started
    here. `show` gets the report so far and each row as it is done. Ctrl-C and the end of the time leave functions out.
    Raises SssgenError where the front end refuses the text, where no function has the name, where no back end runs the
    target here, and without OpenGL, which runs the reference.
    """
    written = plain(_scene(text) if options.entry == "shadertoy" else text)
    read = read or partial(load, version=written.version)
    module = read(written.text, shown)
    complete = with_names(written.text, _functions(module, shown))
    if complete != written.text:
        written, module = written._replace(text=complete), read(complete, shown)
    functions = _functions(module, shown)
    if options.function:
        functions = _functions_named(options.function, functions, shown)
    cases = probe_functions(module, functions, written.text)
    probes = "\n".join(probe.text for case in cases for probe in case.probes)
    with_probes = read(written.text + probes, shown)
    with nullcontext(machines) if machines else start_machines(backends_of(options.target)) as (running, missing):
        titles = [title(case.function) for case in cases]
        named = TRANSLATIONS.get(options.target, EVERY).values()
        asked = tuple([name for name in (*running, *missing) if name in named])
        devices = {name: machine.device() for name, machine in running.items()}
        report = Report([], missing, asked, max(map(len, titles), default=0), devices=devices)
        limit = limit or TimeLimit()
        limit.start()
        for index, case in enumerate(cases):
            progress(index, len(cases), titles[index])
            limit.start_function()
            try:
                if limit.over:
                    row = unreached(case.function)
                else:
                    row = Case(case, written, with_probes, running, options, limit).row()
            except KeyboardInterrupt:
                rest = [unreached(other.function) for other in cases[index:]]
                return report._replace(rows=[*report.rows, *rest], interrupted=True)
            report = report._replace(rows=[*report.rows, row])
            show(report, row)
    return report


def unreached(function: Function) -> Row:
    """The row of a function that the time did not suffice for."""
    return Row(title(function), function.span.line, reason="not reached", complete=False)


def _functions(module: Module, shown: str) -> list[Function]:
    """The functions that a file defines."""
    return [part for part in module.functions if part.body is not None and part.span.file == shown]


def _functions_named(name: str, functions: list[Function], shown: str) -> list[Function]:
    """The functions of this name, which may be overloads. Raises SssgenError where there is none."""
    names = {part.name.replace(MAIN, "main") for part in functions}
    if name not in names:
        raise failure(f"the file has no function '{name}'", did_you_mean(name, sorted(names)), shown)
    return [part for part in functions if part.name.replace(MAIN, "main") == name]


def _scene(text: str) -> str:
    """A Shadertoy scene; the uniforms that it uses without a declaration are declared on its first line."""
    named = [line for name, line in shadertoy.UNIFORMS.items() if re.search(rf"\b{name}\b", text)]
    lines = [line.split("//")[0] for line in named if not re.search(rf"\buniform\s+{line.split(maxsplit=1)[1]}", text)]
    version = re.match(r"\s*#\s*version[^\n]*\n", text)
    start = version.end() if version is not None else 0
    return text[:start] + " ".join(lines) + "\n" + text[start:]
