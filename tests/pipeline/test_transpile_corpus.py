"""Plain GLSL of every construct (tests/transpile): texts equal the snapshots, compile, are stable, compute the same.

UPDATE_SNAPSHOTS=1 writes the snapshots.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import pytest

from folders import SNAPSHOTS, TESTS
from skips import compiler_or_skip
from snapshot import check_snapshot
from sssgen.harness.backends import Backend
from sssgen.harness.compilers import Source, errors, readers
from sssgen.harness.verify import verification as transpiled
from sssgen.harness.verify.inline_includes import expanded
from sssgen.harness.verify.verification_report import BACKENDS
from sssgen.ir.text import print_module
from sssgen.lang.plain_glsl import load_glsl, load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError

CORPUS = TESTS / "transpile"
FILES = sorted(path.name for path in CORPUS.iterdir() if path.is_file())
TARGETS = ("wgsl", "hlsl", "glsl-330")
SUFFIXES = {"wgsl": "wgsl", "hlsl": "hlsl", "glsl-330": "glsl"}
COMPILERS = ("naga", "tint", "glslang", "dxc")
REFUSED = {("array_results.glsl", "hlsl")}
"""What a target has no way to say; the snapshot is the error."""
QUICK = ("switches.glsl", "loops.glsl", "side_effects.glsl", "stores.glsl", "conversions.glsl", "macros.glsl")
"""What is run in the fast tests, too."""

HEADER = re.compile(r"^// \w+\n// Made by sssgen .*\n(// Paste .*\n)?\n?", re.MULTILINE)
"""What stands above each text, and would be taken for the first function's comment."""

NOTHING_TO_COMPARE = ("it has no outputs", "it reads numbers, a texture of a type that is not supported here")
"""Why a function may not be run."""


def entry(name: str) -> str:
    return "shadertoy" if ".shadertoy." in name else ""


@cache
def made(name: str, target: str) -> str:
    """The transpiled text of a file. Raises SssgenError."""
    loaded = load_glsl(CORPUS / name, name, (), None, entry(name))
    return next(iter(transpile(loaded.module, target, name.split(".")[0], keep=True).files.values()))


def source(name: str, target: str) -> Source:
    """What compilers are given."""
    text = made(name, target)
    if name.endswith((".frag", ".vert")) or entry(name):
        stage = "vertex" if name.endswith(".vert") else "fragment"
        return Source(text, target, stage, "main" if target == "glsl-330" else f"{stage}_main", name)
    return Source(text, target, "library", name=name)


CASES = [(name, target) for name in FILES for target in TARGETS]


@pytest.mark.parametrize(("name", "target"), CASES)
def test_the_text_is_unchanged(name: str, target: str) -> None:
    try:
        text = made(name, target)
    except SssgenError as error:
        assert (name, target) in REFUSED, error
        text = f"{error}\n"
    check_snapshot(f"transpile/{name}.{SUFFIXES[target]}", text)


def test_no_snapshot_is_left_over() -> None:
    stored = {path.name for path in (SNAPSHOTS / "transpile").iterdir()}
    assert stored == {f"{name}.{SUFFIXES[target]}" for name, target in CASES}


@pytest.mark.parametrize("compiler", COMPILERS)
def test_other_compilers_accept_it(compiler: str) -> None:
    result = compiler_or_skip(compiler)
    failures = []
    for name, target in CASES:
        if compiler in readers(target) and (name, target) not in REFUSED:
            failures += [f"{name} as {target}: {said}" for said in errors(result.check(source(name, target)))]
    assert failures == []


@pytest.mark.parametrize("name", FILES)
def test_a_second_transpilation_changes_nothing(name: str) -> None:
    """Transpiling the emitted GLSL again gives the same text."""
    title = name.split(".")[0]
    text = HEADER.sub("", made(name, "glsl-330"))
    shown = f"{title}.vert" if name.endswith(".vert") else name
    once = load_glsl_text(text, shown).module
    again = HEADER.sub("", next(iter(transpile(once, "glsl-330", title, keep=True).files.values())))
    assert again == text
    assert print_module(load_glsl_text(again, shown).module) == print_module(once)


def computed(name: str, samples: int) -> None:
    """Fails where a function's result differs from that of the original text in OpenGL's driver."""
    text = expanded((CORPUS / name).read_text("utf-8"), CORPUS / name)
    report = transpiled.verify(text, name, samples, 0, entry(name))
    failures = [
        f"{row.function} as {target}: {result.error or result.at}"
        for row in report.rows
        for target, result in row.comparisons.items()
        if not result.ok and (name, target) not in REFUSED
    ]
    assert failures == []
    assert all(row.comparisons or row.reason in NOTHING_TO_COMPARE for row in report.rows), "\n".join(report.lines())


@pytest.fixture
def machines(backend: Callable[[str], Backend]) -> None:
    """All that functions run on, or a skip."""
    for name in BACKENDS.values():
        backend(name)


@pytest.mark.usefixtures("machines")
@pytest.mark.parametrize("name", QUICK)
def test_functions_keep_their_results(name: str) -> None:
    computed(name, 64)


@pytest.mark.slow
@pytest.mark.usefixtures("machines")
@pytest.mark.parametrize("name", FILES)
def test_all_functions_keep_their_results(name: str) -> None:
    computed(name, 512)
