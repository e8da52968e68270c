"""Compiles shader texts with every compiler for their language; messages have the technique's own line."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event, Lock
from typing import Any

from sssgen.material.library import TECHNIQUES
from sssgen.run.backend_registry import BACKENDS, ENGINES
from sssgen.run.check.shader_files import Shader
from sssgen.run.check.stage_pairs import disagreements, pairs
from sssgen.run.compilers import COMPILERS, CompilerMissing, Message, Source, errors, readers
from sssgen.run.compilers import unity_compiler as unity
from sssgen.run.compilers.compiler_process import Worker
from sssgen.run.machine_parts import all_lacks
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.paths import place, posix
from sssgen.support.progress import Progress, silent
from sssgen.support.text_files import read_text

INTERFACE = "interface"
"""In place of a compiler: whether two stages agree."""


@dataclass(frozen=True)
class Result:
    """The messages of one compiler about one source."""

    shader: Shader
    source: Source
    compiler: str
    messages: list[Message]

    @property
    def ok(self) -> bool:
        """Whether it compiles."""
        return not errors(self.messages)

    def origin(self, message: Message) -> str:
        """`file:line:column` of the technique behind a message, or ''."""
        return self.shader.origins.get(str(message.line), "")


@dataclass(frozen=True)
class Report:
    """A run: compiler → version, missing compiler → how to get it, and the results by file, then by compiler."""

    versions: dict[str, str]
    missing: dict[str, str]
    results: list[Result]


def run(
    shaders: Sequence[Shader],
    names: Sequence[str] = (),
    unity_includes: str | None = None,
    progress: Progress = silent,
) -> Report:
    """Compiles every shader with every compiler for its language, or only those in `names`, each in its own process.

    Raises SssgenError where one in `names` is missing, or where none of them reads any of the shaders.
    """
    programs = [(shader, source) for shader in shaders for source in shader.sources]
    languages = sorted({source.language for _, source in programs})
    selected = [
        name
        for name, record in COMPILERS.items()
        if name in (names or COMPILERS) and record.languages.intersection(languages)
    ]
    if not selected:
        requested = " or ".join(names) or "available compiler"
        able = sorted({name for language in languages for name in readers(language)})
        hint = f"compilers that do: {', '.join(able)}" if able else ""
        raise failure(f"no {requested} reads {', '.join(languages)}", hint)
    environment = {"SSSGEN_UNITY_INCLUDES": _headers(unity_includes)} if unity_includes is not None else {}
    stop, lock = Event(), Lock()
    total, done = sum(name in readers(source.language) for name in selected for _, source in programs), 0

    def compiled(worker: Worker, name: str, shader: Shader, source: Source) -> Result:
        nonlocal done
        result = Result(shader, source, name, _limit_places(shader, worker.check(source)))
        with lock:
            done += 1
            progress(done, total, f"{name}: {shader.name}")
        return result

    def work(name: str) -> tuple[str, bool, list[Result]]:
        """(version or how to get it, whether it is available, results)."""
        worker = Worker(name, environment)
        try:
            version = worker.version()
            results = [
                compiled(worker, name, shader, source)
                for shader, source in programs
                if name in readers(source.language) and not stop.is_set()
            ]
        except CompilerMissing as error:
            return str(error), False, []
        finally:
            worker.close()
        return version, True, results

    with ThreadPoolExecutor(len(selected)) as pool:
        try:
            outcomes = dict(zip(selected, pool.map(work, selected), strict=True))
        finally:
            stop.set()
    missing = {name: text for name, (text, available, _) in outcomes.items() if not available}
    if absent := [name for name in names if name in missing]:
        raise SssgenError(
            [
                diagnostic
                for name in absent
                for diagnostic in failure(f"{name} is not available", missing[name]).diagnostics
            ]
        )
    order = {id(shader): number for number, shader in enumerate(shaders)}
    results = [result for _, _, compiler_results in outcomes.values() for result in compiler_results]
    for vertex, fragment in pairs(shaders):
        messages = [Message("error", 0, 0, text) for text in disagreements(vertex, fragment)]
        results.append(Result(fragment, fragment.sources[0], INTERFACE, messages))
    return Report(
        {name: text for name, (text, available, _) in outcomes.items() if available},
        missing,
        sorted(results, key=lambda result: order[id(result.shader)]),
    )


def _limit_places(shader: Shader, messages: list[Message]) -> list[Message]:
    """Messages with places in the file only: the check appends calls that make a program of a library."""
    count = shader.text.count("\n") + 1
    return [
        replace(m, line=0, column=0, text=f"in the calls of every function that the check adds: {m.text}")
        if m.line > count
        else m
        for m in messages
    ]


def _headers(folder: str) -> str:
    path = Path(folder).expanduser()
    if not path.is_dir():
        raise failure(
            "no such folder of Unity's headers", f"name the folder that contains {unity.HEADERS}", posix(folder)
        )
    if not unity.holds_headers(path):
        raise failure(
            "the folder has none of Unity's headers", f"name the folder that contains {unity.HEADERS}", posix(folder)
        )
    return str(path.resolve())


def source_line(origin: str) -> str:
    """The line of a technique or material that `file:line:column` names, where this machine has the file; else ''."""
    file, line, _ = origin.rsplit(":", 2)
    for path in (os.path.join(TECHNIQUES, file), file, os.path.join(os.path.dirname(place("examples")), file)):
        if os.path.isfile(path):
            try:
                lines = read_text(path, file).split("\n")
            except SssgenError:
                return ""
            return lines[int(line) - 1] if line.isdigit() and 0 < int(line) <= len(lines) else ""
    return ""


def engines() -> dict[str, str]:
    """Each back end that is an engine or a stand-in for one → how to get what it lacks, '' where it lacks nothing."""
    return {name: all_lacks(BACKENDS[name].parts) for name in ENGINES}


def as_json(report: Report) -> dict[str, Any]:
    """The report for programs."""
    return {
        "compilers": [{"name": name, "version": version} for name, version in report.versions.items()],
        "missing": [{"name": name, "how": instruction} for name, instruction in report.missing.items()],
        "engines": [
            {"name": name, "found": not how} | ({"how": how} if how else {}) for name, how in engines().items()
        ],
        "results": [
            {
                "file": result.shader.name,
                "stage": result.source.stage,
                "compiler": result.compiler,
                "ok": result.ok,
                "messages": [_message_as_json(result, message) for message in result.messages],
            }
            for result in report.results
        ],
    }


def _message_as_json(result: Result, message: Message) -> dict[str, Any]:
    record: dict[str, Any] = {
        "severity": message.severity,
        "line": message.line,
        "column": message.column,
        "text": message.text,
    }
    if origin := result.origin(message):
        record["source"] = origin
    return record
