"""The cases of tests/pitfalls: one rule per file, each case a source and its text in the targets.

A case is a source under `=== source` (see `validate`), followed by the output of each target. The output of GLSL ES
is listed if it differs from GLSL 3.30, that of Unity's dialects if it differs from HLSL. To add a case, write its
source; UPDATE_SNAPSHOTS=1 writes the outputs, for review.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

from folders import TESTS
from sssgen.ir.nodes import Function, Module
from sssgen.lang.loader import merge
from validate import module_of, printed

FOLDER = TESTS / "pitfalls"
COMPARED_WITH = {
    "glsl": "",
    "glsl-es": "glsl",
    "hlsl": "",
    "dx9": "hlsl",
    "urp": "hlsl",
    "wgsl": "",
    "godot": "glsl-es",
}
"""Target → the target whose output must differ for its own to be listed; '' if it is always listed."""


class Case(NamedTuple):
    """A source and its texts by target."""

    rule: str
    source: str
    texts: Mapping[str, str]

    @property
    def refused(self) -> bool:
        return any(text.startswith("error:") for text in self.texts.values())


def read(path: Path) -> tuple[str, list[Case]]:
    """The rule (the text before the first case), and the cases."""
    rule, *parts = re.split(r"^=== source\n", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    cases = []
    for part in parts:
        source, *texts = re.split(r"^--- (\S+)\n", part, flags=re.MULTILINE)
        result = dict(zip(texts[::2], (text.strip() for text in texts[1::2]), strict=True))
        cases.append(Case(path.stem, source.strip(), result))
    return rule.strip(), cases


def renewed(path: Path) -> str:
    """The text of the file with the current outputs of its sources."""
    rule, cases = read(path)
    lines = [rule, ""]
    for case in cases:
        lines += ["=== source", case.source]
        result = {target: printed(case.source, target) for target in COMPARED_WITH}
        for target, beside in COMPARED_WITH.items():
            same = beside and plain(result[target]) == plain(result[beside])
            lines += [] if same else [f"--- {target}", result[target]]
        lines.append("")
    return "\n".join(lines)


def plain(text: str) -> str:
    """A text without the target's name, which error messages contain."""
    return re.sub(r"(?m)^(error: .*) \([\w-]+\)$", r"\1", text)


RULES = sorted(FOLDER.glob("*.txt"))
if os.environ.get("UPDATE_SNAPSHOTS"):
    for rule_file in RULES:
        rule_file.write_text(renewed(rule_file), encoding="utf-8", newline="\n")
CASES = [case for path in RULES for case in read(path)[1]]


def called(module: Module) -> Function:
    """The tested function of a case, which is its last one."""
    return module.functions[-1]


@cache
def program() -> tuple[Module, tuple[tuple[Case, Function], ...]]:
    """A module with all cases that no target refuses, and the function of each case."""
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
