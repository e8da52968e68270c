"""Skips tests whose compiler or back end is missing."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TypeVar

import pytest

from sssgen.run import compilers
from sssgen.run.backend_registry import BACKENDS
from sssgen.run.compilers import Compiler, CompilerMissing

Tool = TypeVar("Tool")


def or_skip(get: Callable[[str], Tool], name: str) -> Tool:
    """The compiler or back end of that name. If it is missing, the test is skipped; with CI set, it fails, unless
    `make setup` leaves it out."""
    try:
        return get(name)
    except CompilerMissing as reason:
        record = compilers.COMPILERS.get(name) or BACKENDS.get(name)
        apart = record is not None and record.apart
        if os.environ.get("CI", "") not in ("", "0", "false") and not apart:
            pytest.fail(f"{name} is missing: {reason}")
        pytest.skip(f"{name} is missing: {reason}")


def compiler_or_skip(name: str) -> Compiler:
    return or_skip(compilers.get, name)
