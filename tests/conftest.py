"""What the tests share: the real compilers, and hypothesis without clocks."""

from __future__ import annotations

import os
from collections.abc import Callable

import pytest
from hypothesis import settings

from sssgen.harness import compilers
from sssgen.harness.compilers import Compiler, CompilerMissing, Source, errors

settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")


def compiler_or_skip(name: str) -> Compiler:
    """The compiler of that name. Where it is missing the test is skipped; in CI (the variable CI is set) it fails."""
    try:
        return compilers.get(name)
    except CompilerMissing as reason:
        if os.environ.get("CI", "") not in ("", "0", "false"):
            pytest.fail(f"{name} is missing: {reason}")
        pytest.skip(f"{name} is missing: {reason}")


@pytest.fixture(scope="session")
def compiler() -> Callable[[str], Compiler]:
    """`compiler("tint")`: that compiler, or a skip (in CI: a failure) with what to install."""
    return compiler_or_skip


@pytest.fixture(scope="session")
def assert_compiles() -> Callable[[Source], None]:
    """`assert_compiles(source)`: every compiler for the source's language takes it."""

    def check(source: Source) -> None:
        told = {name: errors(compiler_or_skip(name).check(source)) for name in compilers.readers(source.language)}
        failures = [f"{name}: {message}" for name, messages in told.items() for message in messages]
        numbered = "\n".join(f"{i:4} {line}" for i, line in enumerate(source.text.splitlines(), 1))
        assert not failures, "\n".join([f"{source.name} ({source.language}, {source.stage})", *failures, numbered])

    return check


def pytest_report_header() -> list[str]:
    """Which Unity headers the run was against, and what is not there."""
    named = os.environ.get("SSSGEN_UNITY_INCLUDES")
    return [f"Unity headers: {f'real ones, {named}' if named else 'the stand-ins of tests/unity_standin'}"]
