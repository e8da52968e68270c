"""Where GLSL, HLSL and WGSL part ways: each file of tests/pitfalls is one rule, with cases that show all languages.

A case is a source under `=== source` (see `validate`) and behind it what each target makes of it. GLSL ES stands there
where it differs from GLSL 3.30, and Unity's dialects where they differ from HLSL. A new case is a new source;
UPDATE_SNAPSHOTS=1 adds and renews the rest, for review. Every case is compiled here, and run by test_execution.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

import sssgen
from sssgen.harness.compilers import Source
from sssgen.ir.nodes import Function, Module
from sssgen.lang.loader import merge
from sssgen.pipeline.compiler import transpile
from validate import TARGETS, module_of, printed, validate_all

FOLDER = Path(__file__).parent / "pitfalls"
SHOWN = {"glsl": "", "glsl-es": "glsl", "hlsl": "", "dx9": "hlsl", "urp": "hlsl", "wgsl": ""}
"""The targets that are shown, and for some the one that they are shown beside only where they differ."""


class Case(NamedTuple):
    """One source and the texts it gives, by target."""

    rule: str
    source: str
    texts: Mapping[str, str]

    @property
    def refused(self) -> bool:
        return any(text.startswith("error:") for text in self.texts.values())


def read(path: Path) -> tuple[str, list[Case]]:
    """The rule, which is the text before the first case, and the cases."""
    rule, *parts = re.split(r"^=== source\n", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    cases = []
    for part in parts:
        source, *texts = re.split(r"^--- (\S+)\n", part, flags=re.MULTILINE)
        found = dict(zip(texts[::2], (text.strip() for text in texts[1::2]), strict=True))
        cases.append(Case(path.stem, source.strip(), found))
    return rule.strip(), cases


def renewed(path: Path) -> str:
    """The file's text with what the targets make of its sources now."""
    rule, cases = read(path)
    lines = [rule, ""]
    for case in cases:
        lines += ["=== source", case.source]
        made = {target: printed(case.source, target) for target in SHOWN}
        for target, beside in SHOWN.items():
            same = beside and plain(made[target]) == plain(made[beside])
            lines += [] if same else [f"--- {target}", made[target]]
        lines.append("")
    return "\n".join(lines)


def plain(text: str) -> str:
    """A text without the name of the target that refuses."""
    return re.sub(r"(?m)^(error: .*) \([\w-]+\)$", r"\1", text)


RULES = sorted(FOLDER.glob("*.txt"))
if os.environ.get("UPDATE_SNAPSHOTS"):
    for rule_file in RULES:
        rule_file.write_text(renewed(rule_file), encoding="utf-8", newline="\n")
CASES = [case for path in RULES for case in read(path)[1]]


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.stem)
def test_rule(path: Path) -> None:
    rule, cases = read(path)
    assert rule.endswith(".")
    for case in cases:
        assert {target for target, beside in SHOWN.items() if not beside} <= set(case.texts), case.source
        validate_all(case.source, case.texts)


def called(module: Module) -> Function:
    """The function that a case is about: the last one."""
    return module.functions[-1]


@cache
def program() -> tuple[Module, tuple[tuple[Case, Function], ...]]:
    """All cases that no target refuses in one module, and the function of each."""
    whole, functions = Module(), []
    for number, case in enumerate(CASES):
        if case.refused:
            continue
        module = module_of(case.source, f"case {number}")
        if "{" not in case.source:
            module = module._replace(functions=(called(module)._replace(name=f"case_{number}"),))
        functions.append((case, called(module)))
        whole = merge(whole, module)
    return whole, tuple(functions)


def test_names_are_used_once() -> None:
    whole, functions = program()
    assert len({function.key for function in whole.functions}) == len(whole.functions)
    assert len({function.name for _, function in functions}) == len(functions)


@pytest.mark.parametrize("target", [*TARGETS, "unity-shadergraph"])
def test_every_case_compiles(target: str, assert_compiles: Callable[[Source], None]) -> None:
    """All cases in one library, in every compiler that reads the target."""
    name = TARGETS.get(target, target)
    files = transpile(program()[0], name, "pitfalls").files
    (file,) = [file for file in files if not file.endswith(".json")]
    assert_compiles(Source(files[file], name, "library", name=file))


def test_renames_are_reported() -> None:
    module = module_of("float f(float lerp, float x1) { float point = lerp; return point * x1; }")
    for target in ("glsl-330", "wgsl", "numpy"):
        assert transpile(module, target, "case").reflection["renames"] == {"f.lerp": "lerp_", "f.point": "point_"}


@pytest.mark.parametrize("target", sssgen.all_targets())
def test_conventions_are_said(target: str) -> None:
    """Which way is up, what is column and what row, who encodes: nothing in the text shows it."""
    conventions = sssgen.compile("ice", target).reflection["conventions"]
    assert {"matrices", "framebuffer_y", "uv_origin", "color_space"} <= set(conventions)
    in_a_shell = target not in ("numpy", "unity-shadergraph")
    assert {"clip_y", "clip_z"} <= set(conventions) or not in_a_shell


def test_precision_is_said_where_there_is_no_default() -> None:
    made = sssgen.compile("wax_suzanne", "glsl-es-300").files["wax_suzanne.glsl-es-300.frag"]
    code = [line for line in made.splitlines() if line and not line.startswith("//")]
    assert code[0] == "#version 300 es"
    assert {"precision highp float;", "precision highp int;", "precision highp sampler3D;"} <= set(code[1:5])
