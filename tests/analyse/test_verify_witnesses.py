"""`sssgen transpile --verify` says who disagrees with whom: the driver, the translations, or sssgen's reading."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from sssgen.analyse.verify.machines import Machines
from sssgen.analyse.verify.verification import load, verify
from sssgen.analyse.verify.verification_report import Report
from sssgen.analyse.verify.verified_function import Options
from sssgen.ir.nodes import Module
from sssgen.run.backends import Array, Drawing

TEXT = "float doubled(float x, int n) { return float(n) + x * 2.0; }"
WRONG = 123.0
Read = Callable[[str, str], Module]


class Faulty:
    """A back end that gives a wrong number in the first lane of what it draws, or of what it runs."""

    def __init__(self, machine: Any, draws: bool = False, runs: bool = False, alone: bool = True) -> None:
        self.machine, self.draws, self.runs = machine, draws, runs
        self.alone = alone
        """Whether also where all lanes have the same inputs."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self.machine, name)

    def draw(self, drawing: Drawing) -> Array:
        picture: Array = np.array(self.machine.draw(drawing))
        same = all(
            (part == part[:1, :1]).all() for part in np.split(np.asarray(drawing.textures["sssgen_data"].data), 2)
        )
        if self.draws and (self.alone or not same):
            picture[0, 0] = np.float32(WRONG).view(np.uint32)
        return picture

    def run(self, *arguments: Any) -> list[Array]:
        results = [np.array(result) for result in self.machine.run(*arguments)]
        if self.runs:
            results[0][..., 0] = WRONG
        return results


def report_of(machines: Machines, read: Read | None = None, target: str = "", **faulty: Any) -> Report:
    """The report where one back end is faulty."""
    running = dict(machines.running)
    for name, fault in faulty.items():
        running[name] = fault(running[name])
    return verify(TEXT, "text.glsl", Options(100, target=target), read, Machines(running, machines.missing))


@pytest.mark.parametrize("target", ["", "wgsl"])
def test_a_driver_that_misreads_the_text_is_at_fault(machines: Machines, target: str) -> None:
    report = report_of(machines, target=target, gl=partial(Faulty, draws=True))
    (row,) = report.rows
    assert report.ok and row.ok, list(report.lines())
    assert row.finding is not None and row.finding.driver and row.finding.lanes == 1
    assert row.finding.agreeing[:2] == ("interpreter", "oracle") and "wgsl" in row.finding.agreeing
    assert "glslang's reading" in row.finding.evidence
    assert row.comparisons["wgsl"].driver == 1
    text = "\n".join(report.lines())
    assert "the driver is wrong in 1 lane: interpreter, oracle" in text and "the driver gives result[0] = 123.0" in text
    assert "the driver is wrong, not the translation: doubled(float,int)" in text
    data = report.as_json()
    assert data["driver_findings"] == ["doubled(float,int)"]
    assert data["functions"][0]["finding"]["blamed"] == "driver"
    assert ("hlsl" in row.comparisons) == (not target) and ("oracle" in row.comparisons) == (not target)


def test_a_driver_that_computes_a_lane_right_when_it_is_alone_is_at_fault(machines: Machines) -> None:
    (row,) = report_of(machines, gl=partial(Faulty, draws=True, alone=False)).rows
    assert row.ok and row.finding is not None and "all lanes have these inputs" in row.finding.evidence


def test_a_wrong_translation_disagrees_with_every_witness(machines: Machines) -> None:
    report = report_of(machines, webgpu=partial(Faulty, runs=True))
    (row,) = report.rows
    assert not report.ok and row.finding is None
    assert [name for name, one in row.comparisons.items() if not one.ok] == ["wgsl"]
    assert row.comparisons["wgsl"].against == ("driver", "oracle", "interpreter")
    assert "it disagrees with the author's text in the driver and NumPy and the interpreter" in "\n".join(
        report.lines()
    )


def test_a_wrong_oracle_is_at_fault_alone(machines: Machines) -> None:
    (row,) = report_of(machines, numpy=partial(Faulty, runs=True)).rows
    assert not row.ok and row.comparisons["oracle"].against == ("driver", "interpreter") and row.finding is None


def test_what_the_front_end_misreads_is_no_fault_of_the_driver(machines: Machines) -> None:
    report = report_of(machines, lambda text, shown: load(text.replace("x * 2.0", "x * 2.5"), shown))
    (row,) = report.rows
    assert not report.ok and not any(one.ok for one in row.comparisons.values())
    assert row.finding is not None and not row.finding.driver
    assert row.finding.evidence == "so sssgen reads the text in another way: glslang reads the text as the driver does"
    assert report.driver_findings == []


def test_a_driver_that_misreads_two_texts_is_at_fault(machines: Machines, monkeypatch: pytest.MonkeyPatch) -> None:
    """Then the interpreter says whether sssgen and glslang read the text alike."""
    with monkeypatch.context() as patch:
        patch.setattr("sssgen.analyse.verify.driven_function.draw_reread", _wrong)
        (row,) = report_of(machines, gl=partial(Faulty, draws=True)).rows
    assert row.ok and row.finding is not None and row.finding.driver
    assert row.finding.evidence == "as does the interpreter with glslang's reading of the text"


def _wrong(backend: Any, drawing: Drawing) -> Array:
    picture: Array = np.array(backend.draw(drawing))
    picture[0, 0] = np.float32(WRONG).view(np.uint32)
    return picture


def test_without_a_second_reader_the_driver_is_not_blamed(machines: Machines, monkeypatch: pytest.MonkeyPatch) -> None:
    """The translations share one front end, which may be at fault."""
    faulty = partial(Faulty, draws=True)
    with monkeypatch.context() as patch:
        patch.setattr("sssgen.analyse.verify.driven_function.draw_reread", _missing)
        patch.setattr("sssgen.analyse.verify.verified_function.reread", _missing)
        report = report_of(machines, gl=faulty)
    assert not report.ok and report.rows[0].finding is not None and not report.rows[0].finding.driver


def _missing(*_: Any) -> Array:
    from sssgen.run.backends.backend_interface import backend_failure

    raise backend_failure("gl", "glslang is missing")


def test_the_report_names_the_drivers(machines: Machines) -> None:
    report = report_of(machines)
    assert report.devices.keys() == machines.running.keys()
    assert report.devices["gl"].startswith("OpenGL ") and " on " in report.devices["gl"]
    assert report.as_json()["devices"] == report.devices
    assert any(line.startswith("ran on: ") and report.devices["webgpu"] in line for line in report.lines())
