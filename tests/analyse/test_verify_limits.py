"""The time of `--verify`: what is left out is named, and never passes as verified. No test waits: the clock counts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sssgen.analyse.verify.branch_outcomes import Outcomes
from sssgen.analyse.verify.few_lanes import FEWEST
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.machines import Machines
from sssgen.analyse.verify.rounded_floats import round_floats, seed_errors
from sssgen.analyse.verify.rounding_limits import RoundingLimits
from sssgen.analyse.verify.rounding_noise import RoundedRun
from sssgen.analyse.verify.time_limit import TimeLimit, TimeOverError
from sssgen.analyse.verify.verification import load, verify
from sssgen.analyse.verify.verification_report import Comparison, Report, Row
from sssgen.analyse.verify.verified_function import Options
from sssgen.cli.main import main
from sssgen.run.backends import Array

MARCH = """
float scene(vec3 p) { return length(p) - 1.0 + 0.1 * sin(8.0 * p.x); }
float march(vec3 o, vec3 d) {
    float t = 0.0;
    for (int i = 0; i < 60; i++) {
        float h = scene(o + t * d);
        if (h < 0.001 || t > 20.0) break;
        t += h;
    }
    return t;
}
"""
TWO = "float twice(float x) { return 2.0 * x; }\nfloat half_of(float x) { return 0.5 * x; }\n"


class Clock:
    """A clock that goes on by a step whenever it is read."""

    def __init__(self, step: float) -> None:
        self.now, self.step = 0.0, step

    def __call__(self) -> float:
        self.now += self.step
        return self.now


def counted(total: float, each: float) -> TimeLimit:
    """A limit whose seconds are checks."""
    return TimeLimit(total, each, Clock(1.0))


def test_parts_of_a_limit() -> None:
    clock = Clock(0.0)
    limit = TimeLimit(100.0, 10.0, clock)
    with limit.until(0.5):
        clock.now = 4.0
        limit.check()
        clock.now = 5.0
        with pytest.raises(TimeOverError):
            limit.check()
    limit.check()
    assert limit.left == 5.0 and not limit.over
    clock.now = 95.0
    limit.start_function()
    assert limit.left == 5.0
    clock.now = 100.0
    assert limit.over


def test_without_numbers_there_is_no_limit() -> None:
    limit = TimeLimit(clock=Clock(1e9))
    with limit.until(0.1):
        limit.check()
    assert not limit.over


def test_functions_after_the_time_are_listed_and_fail(machines: Machines) -> None:
    limit = TimeLimit(1000.0, 1000.0, Clock(0.0))

    def show(report: Report, row: Row) -> None:
        limit.end = -1.0  # the time ends after the first function

    report = verify(TWO, "two.glsl", Options(20), machines=machines, limit=limit, show=show)
    first, second = report.rows
    assert first.ok and first.complete
    assert not second.complete and second.reason == "not reached"
    assert not report.ok and not report.as_json()["complete"]
    assert "not reached: half_of(float)" in list(report.last_lines())


def test_an_expensive_function_gets_fewer_inputs_and_is_partly_verified(machines: Machines) -> None:
    report = verify(MARCH, "march.glsl", Options(1000, function="march"), machines=machines,
                    limit=counted(1e9, 2000.0))  # fmt: skip
    (row,) = report.rows
    assert row.complete and row.ok and 0 < row.lanes < 1000
    assert "of 1000 inputs; fewer inputs, as each takes long" in row.partly
    assert report.ok and not report.as_json()["complete"]
    assert row.as_json()["partly"] == row.partly
    assert any(line == "partly verified: march(vec3,vec3)" for line in report.last_lines())


def test_a_function_whose_first_run_takes_too_long_is_not_reached(machines: Machines) -> None:
    report = verify(MARCH, "march.glsl", Options(1000, function="march"), machines=machines, limit=counted(1e9, 30.0))
    (row,) = report.rows
    assert row.reason == "not reached: one run of a few inputs takes too long" and not row.complete and not report.ok


def test_rows_are_shown_as_they_are_done(machines: Machines) -> None:
    shown: list[tuple[int, str]] = []
    verify(TWO, "two.glsl", Options(20), machines=machines,
           show=lambda report, row: shown.append((len(report.rows), row.function)))  # fmt: skip
    assert shown == [(1, "twice(float)"), (2, "half_of(float)")]


def test_an_interrupt_keeps_what_is_done(machines: Machines) -> None:
    def progress(done: float, total: int, name: str) -> None:
        if name == "half_of(float)":
            monkeypatch.setattr("sssgen.analyse.verify.verification.Case.row", interrupted)

    def interrupted(case: object) -> Row:
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as monkeypatch:
        report = verify(TWO, "two.glsl", Options(20), machines=machines, progress=progress)
    assert report.interrupted and not report.ok
    assert [row.complete for row in report.rows] == [True, False] and report.rows[0].ok


def test_the_command_prints_what_is_done_when_it_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "two.glsl"
    file.write_text(TWO)
    done = Row("twice(float)", 1, 20, comparisons={"glsl": Comparison(0.0)})
    rest = Row("half_of(float)", 2, reason="not reached", complete=False)

    def verified(*args: object, show: object = None, **options: object) -> Report:
        assert callable(show)
        report = Report([done], {}, ("gl",), 12)
        show(report, done)
        return report._replace(rows=[done, rest], interrupted=True)

    monkeypatch.setattr("sssgen.analyse.verify.verification.verify", verified)
    assert main(["transpile", str(file), "--verify"]) == 130
    out, error = capsys.readouterr()
    assert out.startswith("largest deviation     glsl   of lanes") and "\ntwice(float)             0   20\n" in out
    assert out.endswith("not reached: half_of(float)\n") and error == "interrupted\n"
    assert main(["transpile", str(file), "--verify", "--json"]) == 130
    assert '"complete": false' in capsys.readouterr().out


@pytest.mark.parametrize("option", ["--seconds", "--function-seconds"])
@pytest.mark.parametrize("number", ["-1", "nan", "inf"])
def test_a_time_must_be_a_number(tmp_path: Path, option: str, number: str, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "two.glsl"
    file.write_text(TWO)
    assert main(["transpile", str(file), "--verify", f"{option}={number}"]) == 2
    assert f"{option} {number} is not a time" in capsys.readouterr().err


def deviations(*numbers: float) -> dict[str, Array]:
    return {"result": np.array(numbers)}


def test_deviations_without_time_are_undecided_and_do_not_pass() -> None:
    def measure(lanes: Array, draws: int, at_edges: bool) -> dict[str, Array]:
        raise TimeOverError

    limits = RoundingLimits(measure)
    unexplained, undecided = limits.unexplained(deviations(0.0, 1.0, 1.0), np.array([False, True, True]))
    assert not unexplained.any() and undecided.tolist() == [False, True, True]


def test_some_deviations_are_decided_before_the_others() -> None:
    count, calls = 1000, []

    def measure(lanes: Array, draws: int, at_edges: bool) -> dict[str, Array]:
        if calls:
            raise TimeOverError
        calls.append(len(lanes))
        return {"result": np.full(len(lanes), 10.0)}

    limits = RoundingLimits(measure)
    unexplained, undecided = limits.unexplained({"result": np.ones(count)}, np.ones(count, bool))
    assert 10 < calls[0] < 20 and not unexplained.any() and undecided.sum() == count - calls[0]


def test_limits_are_kept_for_the_next_back_end() -> None:
    calls = []

    def measure(lanes: Array, draws: int, at_edges: bool) -> dict[str, Array]:
        calls.append(len(lanes))
        return {"result": np.where(lanes == 0, 1.0, 0.0)}

    limits = RoundingLimits(measure)
    lanes = np.ones(2, bool)
    assert limits.unexplained(deviations(1.0, 1.0), lanes)[0].tolist() == [False, True]
    assert sum(calls) == 3  # few lanes have all draws at once, and one both outcomes of its comparisons
    assert limits.unexplained(deviations(1.0, 1.0), lanes)[0].tolist() == [False, True]
    assert sum(calls) == 3


def test_a_wrong_translation_fails_although_the_time_is_over(machines: Machines) -> None:
    wrong = MARCH.replace("0.1 * sin", "0.2 * sin")
    report = verify(MARCH, "march.glsl", Options(1000, function="march"), machines=machines, limit=counted(1e9, 2000.0),
                    read=lambda text, shown: load(text.replace("0.1 * sin", "0.2 * sin"), shown))  # fmt: skip
    assert wrong != MARCH and not report.ok and not report.rows[0].ok


def lanes_of(text: str, values: dict[str, Array], kind: type[Run] = Run) -> tuple[Array, Run]:
    program = Program(load(text, "shader.glsl"))
    lanes = next(iter(values.values())).shape[-1]
    run = kind(program, lanes, {}, Outcomes(lanes))
    return np.asarray(run.result(program.module.functions[-1].key, values)), run


LOOPS = """
struct S { float a; vec2 b; };
float shared_sum;
float grow(float x) { shared_sum += x; return x * 1.5; }
float f(float x, int n) {
    S s = S(x, vec2(x, 1.0));
    float w[2] = float[2](x, 1.0);
    for (int i = 0; i < 64; i++) {
        if (i >= n) break;
        if (i == 3 && n > 60) { for (int k = 0; k < 2; k++) { s.b.y += grow(x); if (k == 1 && x > 0.9) return -1.0; } }
        if (i == 5 && n > 61) continue;
        s.a += 1.0 / (float(i) - 40.0 * x);
        w[i & 1] += s.b.y;
    }
    return s.a + s.b.y + w[0] - w[1] + shared_sum;
}
"""


def test_lanes_that_run_alone_have_the_same_results() -> None:
    rng = np.random.default_rng(0)
    count = 2 * FEWEST
    values = {"x": np.round(rng.uniform(0.0, 1.0, count), 1), "n": rng.integers(0, 64, count).astype(np.int32)}
    together, run = lanes_of(LOOPS, values)
    for start in range(0, count, FEWEST // 2):  # too few for a part of them to run alone
        part = {name: value[start : start + FEWEST // 2] for name, value in values.items()}
        alone, small = lanes_of(LOOPS, part)
        lanes = slice(start, start + FEWEST // 2)
        assert np.array_equal(together[lanes], alone, equal_nan=True)
        assert np.array_equal(run.undefined[lanes], small.undefined) and np.array_equal(run.faults[lanes], small.faults)
        assert run.outcomes is not None and small.outcomes is not None
        for lines, outcomes in zip(sorted_masks(run.outcomes, lanes), sorted_masks(small.outcomes), strict=True):
            assert lines == outcomes
    assert 0 < run.undefined.sum() < count


def sorted_masks(outcomes: Outcomes, lanes: slice = slice(None)) -> list[list[bool]]:
    """The lanes of all branches, in an order that does not depend on the ids of nodes."""
    return sorted(mask[lanes].tolist() for mask in outcomes.branches.values())


def test_loops_of_constant_length_are_not_endless() -> None:
    text = """float f(float x) {
    for (int i = 0; i < 90; i++) for (int k = 0; k < 90; k++) x += 0.5;
    return x;
}"""
    result, run = lanes_of(text, {"x": np.zeros(4)})
    assert not run.endless.any() and result.tolist() == [4050.0] * 4


def test_a_driver_makes_the_same_error_for_the_same_result() -> None:
    with seed_errors(0):
        x = round_floats(np.linspace(0.1, 0.2, 100))
        first, second = np.asarray(x * x), np.asarray(x * x)
    with seed_errors(1):
        other = np.asarray(x * x)
    assert np.array_equal(first, second) and not np.array_equal(first, other)


def test_the_errors_of_equal_samples_add() -> None:
    text = (
        "float f(float x) { float s = 0.0; for (int i = 0; i < 200; i++) s += fract(x * 40000.0); return s / 200.0; }"
    )
    with seed_errors(0):
        result, _ = lanes_of(text, {"x": np.full(200, 0.7231)}, RoundedRun)
    assert np.ptp(result) > 0.5 * 40000.0 * 0.7231 * 2.0**-24  # errors that cancel would leave a tenth of it
