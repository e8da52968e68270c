"""The records of back ends and compilers name existing modules; the documentation has the same list."""

from __future__ import annotations

import re
from importlib.util import find_spec

import pytest

from folders import ROOT
from sssgen.run.backend_registry import BACKENDS, DEFAULT, DRIVERS, FUNCTIONS, HALF, SCENES, SINGLE, backend_names
from sssgen.run.compiler_registry import COMPILERS
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry


def test_every_record_names_a_module_and_targets() -> None:
    for backend in BACKENDS.values():
        assert find_spec(f"sssgen.run.backends.{backend.program.partition(':')[0]}")
        assert bool(registry.load(backend.target).half_of) == (backend.bits == 16)
    for compiler in COMPILERS.values():
        assert find_spec(f"sssgen.run.compilers.{compiler.module}")
        assert compiler.languages <= set(registry.names())


def test_the_lists_of_back_ends() -> None:
    assert {record.half for record in BACKENDS.values() if record.half} == set(HALF)
    assert [*FUNCTIONS] == sorted({"numpy", *SINGLE, *HALF}, key=[*BACKENDS].index)
    assert {name for name, record in BACKENDS.items() if record.scenes_only} == set(BACKENDS) - set(FUNCTIONS)
    assert set(DRIVERS) < set(SINGLE)
    assert set(DEFAULT) < set(SINGLE)


def test_what_draws_no_scenes_is_refused_for_a_scene() -> None:
    """No other back end is: `sssgen render --help` lists exactly these."""
    for name, record in BACKENDS.items():
        assert not (record.functions_only and record.scenes_only)
        if name in SCENES:
            assert backend_names(name, scenes=True) == [name]
            continue
        with pytest.raises(
            SssgenError, match=f"{name} evaluates functions and draws no scenes\n.*choose from: numpy, "
        ):
            backend_names(name, scenes=True)
    assert {"bevy", "tsl", "tsl-webgl2", "unreal", "webgpu-f16"} == set(BACKENDS) - set(SCENES)


def test_the_documentation_lists_every_back_end() -> None:
    """The table of docs/harness.md names each back end and every package that its record requires."""
    text = (ROOT / "docs" / "harness.md").read_text(encoding="utf-8").partition("## Back ends")[2].partition("\n## ")[0]
    rows = [line.split("|") for line in text.splitlines() if line.startswith("| `")]
    assert {name for row in rows for name in re.findall(r"`([\w-]+)`", row[1] + row[2])} >= set(BACKENDS)
    needs = " ".join(row[3] for row in rows)
    for record in BACKENDS.values():
        install = re.sub(r'`[^`]* install [^`]*\[([\w,]+)\]"`', r"`pip install '.[\1]'`", record.install)
        for package in re.findall(r"`([^`]+)`", install):
            assert all(word in needs or word in BACKENDS for word in package.split()), (record.name, package)
