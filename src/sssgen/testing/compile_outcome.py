"""Compiles a material with every available compiler, as one check. It needs no NumPy."""

from __future__ import annotations

from collections.abc import Iterable

from sssgen.ir.spans import Span
from sssgen.pipeline.compiler import all_targets
from sssgen.run.check import compile_check as check
from sssgen.run.check.compile_check import Report, Result
from sssgen.run.check.shader_files import of_material
from sssgen.run.compilers import Message, errors, readers
from sssgen.support.diagnostics import Diagnostic, did_you_mean, failure
from sssgen.testing.outcome import Outcome, missing_part


def compile_material(material: str, targets: str | Iterable[str] = "all") -> Outcome:
    """Compiles both forms of a material (a path, or an example's name) with every available compiler.

    `targets` is "all", names with commas between them, or a list. For "all" one available compiler is enough; a target
    that is named needs a compiler. Raises SssgenError for an invalid material and unknown targets.
    """
    names = target_names(targets)
    shaders = of_material(material, names)
    report = check.run(shaders)
    if diagnostics := [diagnostic for result in report.results for diagnostic in _diagnostics(result)]:
        compilers = sorted({result.compiler for result in report.results if not result.ok})
        detail = "\n\n".join(dict.fromkeys(diagnostic.render() for diagnostic in diagnostics))
        return Outcome("failed", f"{', '.join(compilers)} refused it: {len(diagnostics)} errors", detail)
    read = {result.source.language for result in report.results}
    unread = sorted({source.language for shader in shaders for source in shader.sources} - read)
    if not read or (names and unread):
        return missing_part(f"a compiler for {', '.join(unread)}", _instructions(report, unread))
    message = f"{len(read)} targets by {', '.join(report.versions)}: {len(report.results)} compilations"
    if not unread:
        return Outcome("passed", message)
    return Outcome("passed", f"{message}; not compiled: {', '.join(unread)}", _instructions(report, unread))


def target_names(targets: str | Iterable[str]) -> list[str]:
    """The named targets without duplicates; none for "all". Raises SssgenError for unknown targets."""
    listed = targets.split(",") if isinstance(targets, str) else targets
    names = list(dict.fromkeys(name.strip() for name in listed))
    if "all" in names:
        return []
    available = all_targets()
    for name in names or [""]:
        if name not in available:
            hint = did_you_mean(name, available) or f"targets: {', '.join(available)}, or all"
            raise failure(f"unknown target '{name}'", hint)
        if not readers(name):
            raise failure(f"no supported compiler reads {name}", "name other targets")
    return names


def _instructions(report: Report, languages: list[str]) -> str:
    """How to install the missing compilers of these languages."""
    compilers = dict.fromkeys(name for language in languages for name in readers(language))
    return "; ".join(f"{name}: {report.missing[name]}" for name in compilers if name in report.missing)


def _diagnostics(result: Result) -> list[Diagnostic]:
    """The errors, each at the technique's own line where that is known, else in the emitted file."""
    return [_diagnostic(result, message) for message in errors(result.messages)]


def _diagnostic(result: Result, message: Message) -> Diagnostic:
    text = f"{result.compiler}: {' '.join(message.text.split())}"
    name, lines = result.shader.name, result.shader.text.split("\n")
    emitted = f"line {message.line} of {name}: {lines[message.line - 1].strip()}" if message.line else name
    if not (origin := result.origin(message)):
        return Diagnostic(
            "error", text, Span(name, message.line, message.column, message.line, message.column), emitted
        )
    file, line, column = origin.rsplit(":", 2)
    span = Span(file, int(line), int(column), int(line), int(column) + 1)
    return Diagnostic("error", text, span, emitted, check.source_line(origin))
