"""Shared by the tests: the real compilers, hypothesis without deadlines, and the counts of random inputs."""

from __future__ import annotations

import gc
import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from amounts import COUNTED
from command_line import CommandResult, Run
from skips import compiler_or_skip, or_skip
from sssgen.analyse.verify.machines import Machines, start_machines
from sssgen.analyse.verify.verification_report import BACKENDS
from sssgen.cli import main as cli
from sssgen.run import backends, compilers
from sssgen.run.backends import Backend
from sssgen.run.compilers import Compiler, Source, errors


def pytest_collection_finish() -> None:
    """What is loaded now stays: the garbage collector leaves it out, and the tests take 4 % less time."""
    gc.collect()
    gc.freeze()


settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")


@pytest.fixture(scope="session")
def compiler() -> Callable[[str], Compiler]:
    """`compiler("tint")`: that compiler, or a skip (in CI: a failure) with what to install."""
    return compiler_or_skip


@pytest.fixture(scope="session")
def backend() -> Callable[[str], Backend]:
    """`backend("gl")`: that back end, or a skip (in CI: a failure) with what to install."""
    return lambda name: or_skip(backends.get, name)


@pytest.fixture
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder; it is the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def outside_ci(monkeypatch: pytest.MonkeyPatch) -> None:
    """Missing tools are no failures."""
    monkeypatch.delenv("CI", raising=False)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """`run("emit", "ice")`: the exit status of the command, and what it prints."""

    def call(*arguments: str) -> CommandResult:
        status = cli.main(arguments)
        return CommandResult(status, *capsys.readouterr())

    return call


@pytest.fixture(scope="session")
def machines(backend: Callable[[str], Backend]) -> Iterator[Machines]:
    """The back ends of `sssgen transpile --verify`, started once; or a skip."""
    for name in BACKENDS.values():
        backend(name)
    with start_machines() as machines:
        yield machines


@pytest.fixture(scope="session")
def assert_compiles() -> Callable[[Source], None]:
    """`assert_compiles(source)`: every compiler for the source's language accepts it.

    Those that `make setup` leaves out have tests of their own.
    """

    def check(source: Source) -> None:
        names = [name for name in compilers.readers(source.language) if not compilers.COMPILERS[name].apart]
        readers = map(compiler_or_skip, names)
        failures = [f"{reader.name}: {said}" for reader in readers for said in errors(reader.check(source))]
        lines = [f"{i:4} {line}" for i, line in enumerate(source.text.splitlines(), 1)]
        head = f"{source.name} ({source.language}, {source.stage})"
        assert not failures, "\n".join([head, *failures, *lines])

    return check


def pytest_report_header() -> list[str]:
    """The Unity headers of the run."""
    named = os.environ.get("SSSGEN_UNITY_INCLUDES")
    return [f"Unity headers: {f'real ones, {named}' if named else 'the stand-ins of run/compilers/unity_standin'}"]


# `pytest -n` runs the tests in workers; the counts of each are added up where the run is reported


def pytest_sessionfinish(session: pytest.Session) -> None:
    if (output := getattr(session.config, "workeroutput", None)) is not None:
        output["counted"] = dict(COUNTED)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    COUNTED.update(getattr(node, "workeroutput", {}).get("counted", {}))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Prints how many random inputs were tried; FUZZ_COUNTS names a file for the counts."""
    if COUNTED:
        counts = ", ".join(f"{count} × {name}" for name, count in sorted(COUNTED.items()))
        terminalreporter.write_line(f"fuzzed: {counts}")
    if name := os.environ.get("FUZZ_COUNTS"):
        Path(name).write_text(json.dumps(COUNTED), encoding="utf-8")
