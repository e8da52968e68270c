"""A run of `sssgen ci` as JUnit's XML, for Jenkins, GitLab and GitHub."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Sequence

from sssgen.support.diagnostics import visible
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix
from sssgen.testing.project_run import CaseResult

SUITE = "sssgen ci"


def write(path: str, results: Sequence[CaseResult]) -> None:
    """Writes the report atomically. Raises SssgenError where it cannot be written."""
    folder, name = os.path.split(path)
    write_files(folder, {name: document(results)})


def document(results: Sequence[CaseResult]) -> bytes:
    """The report: one suite, one test case for each case, in UTF-8."""
    count = Counter(result.outcome.state for result in results)
    counts = {
        "name": SUITE, "tests": str(len(results)), "failures": str(count["failed"]), "errors": "0",
        "skipped": str(count["skipped"]), "time": f"{sum(result.seconds for result in results):.3f}",
    }  # fmt: skip
    top = ET.Element("testsuites", counts)
    suite = ET.SubElement(top, "testsuite", counts)
    for result in results:
        suite.append(_case(result))
    ET.indent(top)
    text: bytes = ET.tostring(top, "utf-8", xml_declaration=True)
    return text + b"\n"


def _case(result: CaseResult) -> ET.Element:
    case, outcome = result.case, result.outcome
    facts = {"classname": case.kind, "name": case.name, "file": posix(case.path), "time": f"{result.seconds:.3f}"}
    element = ET.Element("testcase", {key: _clean(value) for key, value in facts.items()})
    message = {"message": _clean(outcome.message)}
    if outcome.state == "failed":
        ET.SubElement(element, "failure", {**message, "type": case.kind}).text = _clean(outcome.text)
    elif outcome.state == "skipped":
        ET.SubElement(element, "skipped", message)
    if outcome.state != "failed":
        ET.SubElement(element, "system-out").text = _clean(outcome.text)
    return element


def _clean(text: str) -> str:
    """Text without the characters that XML does not allow; a compiler's messages may contain them."""
    return "\n".join(visible(line) for line in text.split("\n"))
