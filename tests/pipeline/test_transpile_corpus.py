"""Plain GLSL with every construct (tests/transpile): the texts equal the snapshots, compile, and compute the same.

UPDATE_SNAPSHOTS=1 writes the snapshots.
"""

from __future__ import annotations

import re
from functools import cache

import pytest

from folders import SNAPSHOTS, TESTS
from skips import compiler_or_skip
from snapshot import check_snapshot
from sssgen.analyse.verify import verification
from sssgen.analyse.verify.inline_includes import expand
from sssgen.analyse.verify.machines import Machines
from sssgen.analyse.verify.verified_function import Options
from sssgen.ir.text import print_module
from sssgen.lang.plain_glsl import load_glsl, load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source, Stage, errors, readers
from sssgen.support.diagnostics import SssgenError

CORPUS = TESTS / "transpile"
FILES = sorted(path.name for path in CORPUS.iterdir() if path.is_file())
TARGETS = ("wgsl", "hlsl", "glsl-330")
SUFFIXES = {"wgsl": "wgsl", "hlsl": "hlsl", "glsl-330": "glsl", "metal": "metal"}
COMPILERS = ("naga", "tint", "glslang", "dxc", "metal")
REFUSED: set[tuple[str, str]] = set()
"""(file, target) pairs that the target cannot express; the snapshot is the error."""
STAGES: dict[str, Stage] = {"vert": "vertex", "comp": "compute"}
QUICK = ("switches.glsl", "loops.glsl", "side_effects.glsl", "stores.glsl", "conversions.glsl", "macros.glsl")
"""Files that the fast tests run, too."""

HEADER = re.compile(r"^// \w+\n// Made by sssgen .*\n(// Paste .*\n)?\n?", re.MULTILINE)
"""The head of each text; a second transpilation would read it as the comment of the first function."""

NOTHING_TO_COMPARE = ("it has no outputs", "it reads numbers, a texture of a type that is not supported here")
"""Accepted reasons why a function is not run."""


def entry(name: str) -> str:
    return "shadertoy" if ".shadertoy." in name else ""


@cache
def transpiled(name: str, target: str) -> str:
    """The transpiled text of a file. Raises SssgenError."""
    loaded = load_glsl(CORPUS / name, name, (), None, entry(name))
    return next(iter(transpile(loaded.module, target, name.split(".")[0], keep=True).files.values()))


def source(name: str, target: str) -> Source:
    """A text with its stage and entry, as input of a compiler."""
    text = transpiled(name, target)
    if name.endswith((".frag", ".vert", ".comp")) or entry(name):
        stage = STAGES.get(name.rpartition(".")[2], "fragment")
        return Source(text, target, stage, "main" if target == "glsl-330" else f"{stage}_main", name)
    return Source(text, target, "library", name=name)


CASES = [(name, target) for name in FILES for target in TARGETS]
CASES += [(name, "metal") for name in FILES if name.endswith(".comp")]


@pytest.mark.parametrize(("name", "target"), CASES)
def test_the_text_is_unchanged(name: str, target: str) -> None:
    try:
        text = transpiled(name, target)
    except SssgenError as error:
        assert (name, target) in REFUSED, error
        text = f"{error}\n"
    check_snapshot(f"transpile/{name}.{SUFFIXES[target]}", text)


def test_every_snapshot_has_a_case() -> None:
    stored = {path.name for path in (SNAPSHOTS / "transpile").iterdir()}
    assert stored == {f"{name}.{SUFFIXES[target]}" for name, target in CASES}


@pytest.mark.parametrize("compiler", COMPILERS)
def test_other_compilers_accept_it(compiler: str) -> None:
    result = compiler_or_skip(compiler)
    failures = []
    for name, target in CASES:
        if compiler in readers(target) and (name, target) not in REFUSED:
            failures += [f"{name} as {target}: {message}" for message in errors(result.check(source(name, target)))]
    assert failures == []


@pytest.mark.parametrize("name", FILES)
def test_a_second_transpilation_changes_nothing(name: str) -> None:
    """Transpiling the emitted GLSL again gives the same text."""
    title = name.split(".")[0]
    text = HEADER.sub("", transpiled(name, "glsl-330"))
    file = f"{title}.{name.rpartition('.')[2]}" if name.endswith((".vert", ".comp")) else name
    once = load_glsl_text(text, file).module
    again = HEADER.sub("", next(iter(transpile(once, "glsl-330", title, keep=True).files.values())))
    assert again == text
    assert print_module(load_glsl_text(again, file).module) == print_module(once)


def check_results(name: str, samples: int, machines: Machines) -> None:
    """Fails where a function's result differs from that of the original text in OpenGL's driver."""
    text = expand((CORPUS / name).read_text("utf-8"), CORPUS / name)
    report = verification.verify(text, name, Options(samples, 0, entry(name)), machines=machines)
    failures = [
        f"{row.function} as {target}: {result.error or result.at}"
        for row in report.rows
        for target, result in row.comparisons.items()
        if not result.ok and (name, target) not in REFUSED
    ]
    assert failures == []
    assert all(row.comparisons or row.reason in NOTHING_TO_COMPARE for row in report.rows), "\n".join(report.lines())


@pytest.mark.parametrize("name", QUICK)
def test_functions_keep_their_results(name: str, machines: Machines) -> None:
    check_results(name, 64, machines)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in FILES if not name.endswith(".comp")])
def test_all_functions_keep_their_results(name: str, machines: Machines) -> None:
    check_results(name, 512, machines)
