"""Findings as SARIF 2.1.0, the format in which code review tools take the results of analysers.

Source: OASIS, Static Analysis Results Interchange Format (SARIF) Version 2.1.0; sections are noted where they matter.
"""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from sssgen.analyse.lint.finding_baseline import identity
from sssgen.analyse.lint.lint_findings import PROVEN, Finding, Report, explanation
from sssgen.ir.intrinsics import KINDS
from sssgen.ir.spans import Span
from sssgen.lang.source_lines import source_text, whole
from sssgen.version import VERSION

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_RULES = {
    "nan": "An operation may give NaN, which makes every value that is computed from it NaN.",
    "division": "A divisor may be 0: the result is infinite, or NaN for 0/0.",
    "undefined": "The language defines no result here: devices compute different ones.",
    "range": "A number or an index may be outside of the range that other code relies on.",
    "overflow": "A result may be too large for a float: it is infinite, or NaN if it is subtracted from another one.",
}


def sarif(reports: Sequence[Report], new: Collection[int] | None = None) -> dict[str, Any]:
    """The log of a run. `new` are the identities (`id`) of the findings that no baseline accepts, if there is one."""
    equal: Counter[str] = Counter()
    results = []
    for report in reports:
        for finding in report.findings:
            if finding.verdict != PROVEN:
                state = None if new is None else "new" if id(finding) in new else "unchanged"
                results.append(_result(finding, equal, state))
    rules = [
        {
            "id": kind,
            "name": "".join(word.capitalize() for word in name.split()),
            "shortDescription": {"text": name},
            "fullDescription": {"text": _RULES[kind]},
            "defaultConfiguration": {"level": "warning"},
        }
        for kind, name in KINDS.items()
    ]
    assumed = [{"input": report.name} | fact.as_json() for report in reports for fact in report.assumptions]
    run = {
        "tool": {"driver": {"name": "sssgen", "semanticVersion": VERSION, "rules": rules}},
        "columnKind": "unicodeCodePoints",
        "results": results,
        "properties": {"assumptions": assumed},
    }
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(finding: Finding, equal: Counter[str], state: str | None) -> dict[str, Any]:
    """A result (3.27). Equal findings of a function differ in their fingerprints by their order alone."""
    key = "\n".join(identity(finding))
    equal[key] += 1
    mark = hashlib.sha256(f"{key}\n{equal[key]}".encode()).hexdigest()[:32]
    message = f"{finding.message}. {'Emitted' if finding.guarded else 'Write'}: {finding.remedy}"
    location = _location(finding.span, "")
    if finding.site.function:
        location["logicalLocations"] = [{"name": finding.site.function, "kind": "function"}]
    result = {
        "ruleId": finding.kind,
        "ruleIndex": list(KINDS).index(finding.kind),
        "level": finding.severity,
        "message": {"text": message},
        "locations": [location],
        "partialFingerprints": {"sssgenFinding/v1": mark},
        "properties": {"operation": finding.site.operation, "found": finding.found},
    }
    if state is not None:
        result["baselineState"] = state
    if finding.why:
        steps = [(whole(step.span), explanation(step)) for step in reversed(finding.why)]
        flow = [*steps, (finding.span, finding.message)]
        result["codeFlows"] = [
            {"threadFlows": [{"locations": [{"location": _location(span, text)} for span, text in flow]}]}
        ]
        shown = finding.shown_steps()
        result["relatedLocations"] = [
            _location(whole(step.span), explanation(step)) | {"id": index} for index, step in enumerate(shown, 1)
        ]
    return result


def _location(span: Span, message: str) -> dict[str, Any]:
    """A location (3.28), with the text of its region."""
    region: dict[str, Any] = {
        "startLine": max(span.line, 1), "startColumn": max(span.column, 1),
        "endLine": max(span.end_line, span.line, 1), "endColumn": max(span.end_column, 1),
    }  # fmt: skip
    text = source_text(span)
    if text:
        region["snippet"] = {"text": text}
    location: dict[str, Any] = {
        "physicalLocation": {"artifactLocation": {"uri": uri(span.file)}, "region": region},
    }
    return location | ({"message": {"text": message}} if message else {})


def uri(file: str) -> str:
    """A file as a URI reference: relative to the working folder, where it is below it."""
    path = Path(file)
    if path.is_absolute():
        relative = os.path.relpath(path)
        if relative.startswith(".."):
            return path.as_uri()
        path = Path(relative)
    return quote(path.as_posix())
