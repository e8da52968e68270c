"""Baselines: the findings that a project has accepted, so that only new ones fail its checks.

A finding is matched by its file, function, kind, operation and text, not by its line: code may move. Of several equal
findings in a function, as many are accepted as the baseline has.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from sssgen.analyse.lint.lint_findings import Finding
from sssgen.lang.source_lines import source_text
from sssgen.support.diagnostics import failure
from sssgen.support.json_source import parse
from sssgen.support.paths import display_name
from sssgen.support.text_files import read_text

VERSION = 1
_KEYS = ("file", "function", "kind", "operation", "text")


class Identity(NamedTuple):
    """What a finding keeps when lines move."""

    file: str
    function: str
    kind: str
    operation: str
    text: str
    """The source of the operation, with single blanks."""


def identity(finding: Finding) -> Identity:
    """The identity of a finding."""
    site = finding.site
    text = " ".join(source_text(site.node.span).split())
    file = display_name(site.node.span.file).replace("\\", "/")
    return Identity(file, site.function, finding.kind, site.operation, text)


def baseline_text(findings: Iterable[Finding]) -> str:
    """A baseline that accepts these findings, as JSON, in an order that makes small differences."""
    counts = Counter(map(identity, findings))
    rows = [key._asdict() | {"count": count} for key, count in sorted(counts.items())]
    return json.dumps({"version": VERSION, "findings": rows}, indent=2) + "\n"


def load_baseline(path: str) -> Counter[Identity]:
    """How many findings of each identity a file accepts. Raises SssgenError."""
    data = parse(read_text(path, path), path)
    rows = data.get("findings") if isinstance(data, dict) else None
    if not isinstance(rows, list) or data.get("version") != VERSION:
        raise failure("this is no baseline of sssgen lint", "write one with --write-baseline", path)
    counts: Counter[Identity] = Counter()
    for index, row in enumerate(rows):
        texts = [row.get(key) for key in _KEYS] if isinstance(row, dict) else []
        count = row.get("count", 1) if isinstance(row, dict) else None
        if len(texts) != len(_KEYS) or not all(isinstance(text, str) for text in texts) or type(count) is not int:
            keys = ", ".join((*_KEYS, "count"))
            raise failure(f"findings[{index}] of the baseline is incomplete", f"it needs: {keys}", path)
        counts[Identity(*map(str, texts))] += count
    return counts


def new_findings(findings: Iterable[Finding], accepted: Mapping[Identity, int]) -> list[Finding]:
    """The findings that a baseline does not accept."""
    left = Counter(accepted)
    new = []
    for finding in findings:
        key = identity(finding)
        if left[key] > 0:
            left[key] -= 1
        else:
            new.append(finding)
    return new
