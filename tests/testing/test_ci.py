"""`sssgen ci`: the files that it finds in a folder, its messages for faulty ones, and its report."""

from __future__ import annotations

import json
import os
import signal
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sssgen.cli import main as cli
from sssgen.cli.output import CHECK_FAILED
from sssgen.run.backends import Backend
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.support.diagnostics import SssgenError
from sssgen.support.file_writer import write_files
from sssgen.testing import junit
from sssgen.testing.outcome import Outcome
from sssgen.testing.project_run import Case, CaseResult, Run, cases

MATERIAL = '[material]\nname = "lamp"\ndoc = "A lamp."\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'
SCENE = 'material = "lamp.toml"\nsize = [24, 18]\n[geometry]\nkind = "ball"\n'
HALF = {"technique": "beer_lambert", "inputs": {"d": [0.0, 0.5], "attenuation_distance": 0.5}}


pytestmark = pytest.mark.usefixtures("in_folder", "outside_ci")


def test_cases_are_collected_from_folders() -> None:
    write_files(
        ".",
        {
            "a/lamp.toml": MATERIAL,
            "a/scene.toml": SCENE,
            "a/half.eval.json": "{}",
            "a/data.json": "{}",
            "broken_material.toml": "[material]\nname = \n",
            "broken_scene.toml": 'material = "lamp.toml"\nsize = [\n',
            "broken_other.toml": "[tool]\nmaterial = \n",
            "latin.toml": b"\xff\xfe\xe9",
            "misspelt.toml": '[materail]\nname = "a"\n[translucency]\ntechnique = "lobe_exp2"\n',
            "without_material.toml": "[camera]\nfield_of_view = 30.0\n",
            "pyproject.toml": '[project]\nname = "a"\n',
            ".hidden/lamp.toml": MATERIAL,
            "node_modules/lamp.toml": MATERIAL,
            "env/pyvenv.cfg": "",
            "sssgen-shaders/.git": "gitdir: elsewhere",
            "sssgen-shaders/examples/lamp.toml": MATERIAL,
            "env/lib/lamp.toml": MATERIAL,
        },
    )
    results = {
        (case.kind, Path(case.path).as_posix(), case.backends, case.first) for case in cases(".", ["webgpu", "gl"])
    }
    assert results == {
        ("compile", "a/lamp.toml", (), True),
        ("render", "a/scene.toml", ("webgpu",), True),
        ("render", "a/scene.toml", ("gl",), False),
        ("eval", "a/half.eval.json", ("webgpu", "gl"), True),
        ("compile", "broken_material.toml", (), True),
        ("compile", "broken_other.toml", (), True),  # its owner is unknown
        ("compile", "misspelt.toml", (), True),
        ("render", "without_material.toml", ("webgpu",), True),
        ("render", "without_material.toml", ("gl",), False),
        ("render", "broken_scene.toml", ("webgpu",), True),
        ("render", "broken_scene.toml", ("gl",), False),
        ("compile", "latin.toml", (), True),
    }
    assert [case.backends for case in cases("a")] == [(), (), ("gl",)]


def test_folders_with_nothing_to_check() -> None:
    write_files(".", {"empty/readme.txt": "nothing"})
    for folder, message in (
        ("empty", "nothing to check"),
        ("none", "no such folder"),
        ("empty/readme.txt", "not a folder"),
    ):
        with pytest.raises(SssgenError, match=message):
            cases(folder)
        assert cli.main(["ci", folder]) == cli.WRONG_INPUT


def test_faulty_files_fail_and_the_others_still_run(capsys: pytest.CaptureFixture[str]) -> None:
    write_files(".", {"all/broken.toml": "[material]\nname = \n", "all/half.eval.json": json.dumps(HALF)})
    status = cli.main(["ci", "all", "--backend", "numpy-f32", "--json", "--junit", "report.xml"])
    report = json.loads(capsys.readouterr().out)
    assert status == CHECK_FAILED and report["ok"] is False
    assert [(case["kind"], case["outcome"]) for case in report["cases"]] == [("compile", "failed"), ("eval", "passed")]
    assert "all/broken.toml:2" in report["cases"][0]["detail"]
    assert [len(ET.parse("report.xml").findall(f".//{name}")) for name in ("testcase", "failure")] == [2, 1]


@pytest.mark.parametrize(
    ("change", "state", "message"),
    [
        ({}, "passed", "as in float64 on numpy-f32"),
        ({"outputs": {"result": [1.0, 0.36787944]}}, "passed", "as in float64"),
        ({"outputs": {"result": [1.0, 0.4]}}, "failed", "the oracle deviates by 0.032, more than 1e-05"),
        ({"outputs": {"result": [1.0, 2.0, 3.0]}}, "failed", "output 'result' cannot be compared"),
        ({"outputs": {"out": 1.0}}, "failed", "there is no output 'out'"),
        ({"inputs": {}, "samples": 100}, "passed", "as in float64 on numpy-f32"),
        ({"inputs": "numbers.json"}, "passed", "as in float64 on numpy-f32"),
        ({"technique": "own.sss"}, "passed", "as in float64 on numpy-f32"),
        ({"technique": "own.sss:own"}, "passed", "as in float64 on numpy-f32"),
        ({"tolerance": 0.0}, "failed", "1 of 1 back ends failed"),
        ({"tolerance": -1.0}, "failed", "-1.0 is not a tolerance"),
        ({"tolerance": "1"}, "failed", "'tolerance' must be int or float"),
        ({"samples": 0}, "failed", "'samples' must be from 1"),
        ({"sample": 1}, "failed", "unknown key 'sample'"),
        ({"technique": "beer_lamber"}, "failed", "unknown technique 'beer_lamber'"),
        ({"inputs": {"x": 1.0}}, "failed", "has no input 'x'"),
        ({"bind": {"x": "y"}}, "failed", "has no slot 'x'"),
    ],
)
def test_numbers(change: dict[str, Any], state: str, message: str) -> None:
    own = (
        "/** Half.\n * role: conversion */\ntransmittance own(thickness d)\n{\n    return transmittance(d / 3.0);\n}\n"
    )
    values = {**HALF, **change}
    if "own" in values["technique"]:
        values["inputs"] = {"d": 0.7}
    numbers = json.dumps(HALF["inputs"])
    write_files("in", {"own.sss": own, "numbers.json": numbers, "half.eval.json": json.dumps(values)})
    with Run() as run:
        outcome = run(Case("eval", "in/half.eval.json", ("numpy-f32",))).outcome
    assert (outcome.state, message in outcome.message) == (state, True), outcome


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", "[" * 100000, '"a"'])
def test_invalid_numbers_fail(text: str) -> None:
    write_files(".", {"bad.eval.json": text})
    with Run() as run:
        assert run(Case("eval", "bad.eval.json")).outcome.state == "failed"


def test_a_back_end_that_dies_fails_one_case(backend: Callable[[str], Backend]) -> None:
    backend("gl")
    write_files(".", {"lamp.toml": MATERIAL, "scene.toml": SCENE})
    case = Case("render", "scene.toml", ("gl",))
    with Run(update=True) as run:
        assert run(case).outcome.message == "wrote golden/scene.png"
        gpu = run.started.get("gl")
        assert isinstance(gpu, BackendProcess) and gpu.process.process is not None
        os.kill(gpu.process.process.pid, signal.SIGKILL)
        assert "crashed (SIGKILL)" in run(case).outcome.message
        assert run(case).outcome.state == "passed"


def test_the_report_is_valid_xml_for_any_message() -> None:
    message = "a\x00b\x1b[31m <&> ]]> \ud800 \ufffe\nsecond line"
    results = [
        CaseResult(Case("compile", "odd \x01 <name>.toml"), Outcome("failed", message, message), 0.25),
        CaseResult(Case("render", "scene.toml", ("gl",)), Outcome("skipped", "gl is missing"), 0.5),
        CaseResult(Case("eval", "half.eval.json"), Outcome("passed", "good", "more"), 1.0),
    ]
    top = ET.fromstring(junit.document(results))
    suite = top.find("testsuite")
    assert suite is not None
    assert (suite.attrib["tests"], suite.attrib["failures"], suite.attrib["skipped"]) == ("3", "1", "1")
    assert suite.attrib["time"] == "1.750"
    failed, skipped, passed = suite
    assert failed.find("failure").text.endswith("second line")
    assert skipped.find("skipped").attrib["message"] == "gl is missing"
    assert passed.find("system-out").text == "good\nmore"


def test_an_empty_report() -> None:
    assert ET.fromstring(junit.document([])).find("testsuite") is not None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--backend", "gll"], "did you mean 'gl'"),
        (["--flip", "2"], "not a threshold for FLIP"),
        (["--flip", "much"], "--flip: expected a number, not 'much'"),
        (["--junit", "lamp.toml/report.xml"], "cannot write"),
    ],
)
def test_wrong_options(options: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    write_files(".", {"lamp.toml": MATERIAL})
    assert cli.main(["ci", ".", *options]) == cli.WRONG_INPUT
    assert message in capsys.readouterr().err
