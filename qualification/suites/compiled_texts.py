"""Whether the compilers of a target's language accept an emitted text."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping

from qualification.suites.outcomes import CRASH, INVALID, REFUSED, RIGHT, Outcome
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import CompilerMissing, Source, Stage, errors, readers
from sssgen.run.compilers.compiler_process import Worker
from sssgen.support.diagnostics import SssgenError

TARGETS = ("wgsl", "hlsl", "glsl-330", "glsl-es-300", "metal")
"""The targets that programs are translated to."""


def translated(translate: Callable[..., Mapping[str, str]], *arguments: object) -> Outcome:
    """The outcome of a translation to the files of `translate`: right where all compilers accept their texts."""
    try:
        files = translate(*arguments)
    except SssgenError as error:
        return Outcome(REFUSED, error.diagnostics[0].message)
    except Exception as error:  # a bug, which the table shows
        return crash(error)
    message = complaint(files)
    return Outcome(INVALID, message) if message else Outcome(RIGHT)


def crash(error: Exception) -> Outcome:
    """The outcome of an internal error."""
    return Outcome(CRASH, f"{type(error).__name__}: {error}")


def complaint(files: Mapping[str, str]) -> str:
    """The first error of a compiler about emitted files, with the compiler's name; '' where there is none."""
    for source in sources(files):
        for name in readers(source.language):
            worker = _worker(name)
            if worker is not None and (wrong := errors(worker.check(source))):
                return f"{name}: {wrong[0].text}"
    return ""


def judgement(text: str, stage: Stage) -> str:
    """The first error of glslang about an author's shader; '' where it has none, or where it is missing."""
    worker = _worker("glslang")
    wrong = errors(worker.check(Source(text, "glsl-330", stage))) if worker is not None else []
    return wrong[0].text if wrong else ""


@functools.cache
def _worker(name: str) -> Worker | None:
    """A compiler in a process that ends with this one; None where this machine lacks it."""
    worker = Worker(name)
    try:
        worker.version()
    except CompilerMissing:
        return None
    return worker
