"""The SARIF log of `sssgen lint`, against the rules of the specification that its readers depend on."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from sssgen.cli.main import main
from sssgen.ir.intrinsics import KINDS

TEXT = {"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}}
POSITION = {"type": "integer", "minimum": 1}
LOCATION = {
    "type": "object",
    "required": ["physicalLocation"],
    "properties": {
        "id": {"type": "integer", "minimum": 0},
        "message": TEXT,
        "physicalLocation": {
            "type": "object",
            "required": ["artifactLocation", "region"],
            "properties": {
                "artifactLocation": {
                    "type": "object",
                    "required": ["uri"],
                    "properties": {"uri": {"type": "string", "pattern": r"^[^\\ ]+$"}},
                },
                "region": {
                    "type": "object",
                    "required": ["startLine", "startColumn", "endLine", "endColumn"],
                    "additionalProperties": False,
                    "properties": {
                        **dict.fromkeys(("startLine", "startColumn", "endLine", "endColumn"), POSITION),
                        "snippet": TEXT,
                    },
                },
            },
        },
        "logicalLocations": {
            "type": "array",
            "items": {"type": "object", "required": ["name"], "properties": {"kind": {"const": "function"}}},
        },
    },
}
RESULT = {
    "type": "object",
    "required": ["ruleId", "message", "locations", "partialFingerprints"],
    "properties": {
        "ruleId": {"enum": list(KINDS)},
        "ruleIndex": {"type": "integer", "minimum": 0},
        "level": {"enum": ["none", "note", "warning", "error"]},
        "message": TEXT,
        "locations": {"type": "array", "items": LOCATION, "minItems": 1},
        "relatedLocations": {"type": "array", "items": LOCATION},
        "baselineState": {"enum": ["new", "unchanged", "updated", "absent"]},
        "partialFingerprints": {"type": "object", "additionalProperties": {"type": "string"}},
        "codeFlows": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["threadFlows"],
                "properties": {
                    "threadFlows": {
                        "type": "array",
                        "minItems": 1,
                        "items": {
                            "type": "object",
                            "required": ["locations"],
                            "properties": {
                                "locations": {
                                    "type": "array",
                                    "minItems": 1,
                                    "items": {
                                        "type": "object",
                                        "required": ["location"],
                                        "properties": {"location": LOCATION},
                                    },
                                }
                            },
                        },
                    }
                },
            },
        },
    },
}
RULE = {
    "type": "object",
    "required": ["id", "shortDescription", "fullDescription"],
    "properties": {
        "id": {"type": "string"},
        "name": {"type": "string", "pattern": "^[A-Za-z0-9]+$"},
        "shortDescription": TEXT,
        "fullDescription": TEXT,
    },
}
LOG = {
    "type": "object",
    "required": ["version", "runs"],
    "additionalProperties": False,
    "properties": {
        "$schema": {"type": "string", "format": "uri"},
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["tool", "results"],
                "properties": {
                    "tool": {
                        "type": "object",
                        "required": ["driver"],
                        "properties": {
                            "driver": {
                                "type": "object",
                                "required": ["name", "rules"],
                                "properties": {"rules": {"type": "array", "items": RULE, "uniqueItems": True}},
                            }
                        },
                    },
                    "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                    "results": {"type": "array", "items": RESULT},
                },
            },
        },
    },
}

SOURCE = """\
uniform float width; // sssgen: assume 0 <= width <= 1
float share(float x) { return x / width; }
float root(float x)
{
    float rest = 1.0 - x * x;
    return sqrt(rest) + sqrt(rest - 1.0);
}
"""


def log_of(path: Path, *options: str) -> Any:
    target = path.parent / "log.sarif"
    main(["lint", str(path), "--no-examples", "--sarif", str(target), *options])
    log = json.loads(target.read_text(encoding="utf-8"))
    jsonschema.validate(log, LOG)
    return log["runs"][0]


@pytest.fixture
def source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my shaders").mkdir()
    path = tmp_path / "my shaders" / "share.glsl"
    path.write_text(SOURCE, encoding="utf-8")
    return path


def test_a_result_has_its_rule_its_place_and_its_way(source: Path) -> None:
    run = log_of(source)
    rules = run["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == list(KINDS)
    division, first, _ = run["results"]
    assert rules[division["ruleIndex"]]["id"] == division["ruleId"] == "division"
    place = division["locations"][0]
    assert place["physicalLocation"]["artifactLocation"]["uri"] == "my%20shaders/share.glsl"
    assert place["physicalLocation"]["region"] == {
        "startLine": 2, "startColumn": 31, "endLine": 2, "endColumn": 40, "snippet": {"text": "x / width"},
    }  # fmt: skip
    assert place["logicalLocations"] == [{"name": "share", "kind": "function"}]
    flow = first["codeFlows"][0]["threadFlows"][0]["locations"]
    lines = [step["location"]["physicalLocation"]["region"]["startLine"] for step in flow]
    assert lines[0] == 3 and lines[-1] == 6  # from the parameter to the operation
    assert any("widens" in related["message"]["text"] for related in first["relatedLocations"])
    assert run["properties"]["assumptions"][0] | {"text": ""} == {
        "input": str(source), "name": "width", "text": "", "source": "comment", "because": "",
    }  # fmt: skip


def test_fingerprints_stay_where_lines_move(source: Path) -> None:
    before = [result["partialFingerprints"] for result in log_of(source)["results"]]
    assert len({json.dumps(mark) for mark in before}) == len(before) == 3
    source.write_text("// A comment.\n\n" + SOURCE.replace("    return", "\n    return  "), encoding="utf-8")
    assert [result["partialFingerprints"] for result in log_of(source)["results"]] == before


def test_results_of_a_baseline_are_unchanged(source: Path) -> None:
    known = str(source.parent / "known.json")
    log_of(source, "--baseline", known, "--write-baseline")
    source.write_text(SOURCE + "float other(float x) { return sqrt(x); }\n", encoding="utf-8")
    states = [result["baselineState"] for result in log_of(source, "--baseline", known)["results"]]
    assert states == ["unchanged", "unchanged", "unchanged", "new"]
