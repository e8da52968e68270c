"""Known NaN bugs of public trackers, each rebuilt as a small function, and mended: `sssgen lint` tells them apart.

Each file of `tests/lint_corpus` names its reference and the kind of the failure; the line that fails ends in
`// fails`, and the function whose name ends in `_mended` has the repair.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.analyse.lint.lint_findings import lint
from sssgen.ir.intrinsics import KINDS

CORPUS = sorted((ROOT / "tests/lint_corpus").glob("*.glsl"))


def stated(key: str, text: str) -> str:
    """What a file's line `// key: value` states."""
    line = re.search(rf"^// {key}: (\S+)$", text, re.MULTILINE)
    assert line is not None
    return line[1]


def test_the_corpus_is_complete() -> None:
    texts = [path.read_text(encoding="utf-8") for path in CORPUS]
    references = {stated("reference", text) for text in texts}
    assert all(reference.startswith("https://") for reference in references)
    assert len(references) == len(CORPUS) >= 15
    assert {stated("kind", text) for text in texts} >= {"nan", "division", "undefined"}


@pytest.mark.parametrize("path", CORPUS, ids=lambda path: path.stem)
def test_the_bug_is_reported_and_its_repair_is_not(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    kind = stated("kind", text)
    failing = [number for number, line in enumerate(text.split("\n"), 1) if line.endswith("// fails")]
    kinds = ("nan", "division", "undefined", "range", *(("overflow",) if kind == "overflow" else ()))
    report = lint(str(path), with_examples=False, kinds=kinds)
    assert set(kinds) <= set(KINDS)
    reported = {(finding.site.node.span.line, finding.kind) for finding in report.unproven()}
    assert reported == {(line, kind) for line in failing}
    assert all(not finding.site.function.endswith("_mended") for finding in report.unproven())
    assert all(finding.why for finding in report.unproven())
