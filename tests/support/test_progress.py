"""Progress: in a log nothing for quick work, then a line now and then; on a terminal a bar."""

from __future__ import annotations

import io
import re
import time

import pytest

from sssgen.support import progress


def test_a_log_gets_few_lines(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    clock = [100.0]
    monkeypatch.setattr("sssgen.support.progress.time.monotonic", lambda: clock[0])
    with progress.ProgressBar() as bar:
        for item in range(100):
            clock[0] += 0.25
            bar(item + 1, 100, f"item {item}")
    assert capsys.readouterr() == (
        "", "40 of 100: item 39; about 15 s left\n80 of 100: item 79; about 5 s left\n",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [
        (0.04, ""),  # 4 s in all
        (0.25, "5 of 100: item 4; about 24 s left\n"),  # one line, after a second of work
        (20.0, "2 of 100: item 1; about 33 min left\n"),  # there is no estimate before the second item has ended
    ],
)
def test_one_line_has_the_time_left(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], seconds: float, expected: str
) -> None:
    clock = [100.0]
    monkeypatch.setattr("sssgen.support.progress.time.monotonic", lambda: clock[0])
    monkeypatch.setattr(progress, "QUIET", 1000.0)
    with progress.ProgressBar(one_line=True) as bar:
        for item in range(100):
            clock[0] += seconds
            bar(item + 1, 100, f"item {item}")
    assert capsys.readouterr() == ("", expected)


def test_one_line_tells_the_item_where_nothing_can_be_estimated(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress, "DELAY", 0.01)
    monkeypatch.setattr(progress, "QUIET", 0.03)
    with progress.ProgressBar(one_line=True) as bar:
        bar(0, 1, "texture coordinates")
        assert bar.ended.wait(0.3) is False
    assert capsys.readouterr() == ("", "0 of 1: texture coordinates\n")


def test_the_time_left_is_that_of_the_current_stage(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = [0.0]
    monkeypatch.setattr("sssgen.support.progress.time.monotonic", lambda: clock[0])
    with progress.ProgressBar(one_line=True) as bar:
        bar(1, 1, "quick stage")
        for item in range(3):
            clock[0] += 2.0
            bar(item, 10, "slow stage")
    assert capsys.readouterr().err == "1 of 10: slow stage; about 18 s left\n"


def test_each_step_has_its_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    clock = [0.0]
    monkeypatch.setattr("sssgen.support.progress.time.monotonic", lambda: clock[0])
    with progress.ProgressBar(one_line=True) as bar:
        for step, total in ((1, 10), (2, 20)):
            for item in range(total):
                clock[0] += 2.0
                bar(item, total, f"step {step} of 2")
    lines = ["1 of 10: step 1 of 2; about 18 s left", "1 of 20: step 2 of 2; about 38 s left"]
    assert capsys.readouterr().err.splitlines() == lines


def test_a_log_shows_an_item_that_takes_long(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The line comes although no item ends."""
    monkeypatch.setattr(progress, "DELAY", 0.01)
    monkeypatch.setattr(progress, "QUIET", 0.03)
    with progress.ProgressBar() as bar:
        bar(1, 3, "slow")
        assert bar.ended.wait(1.0) is False
    lines = capsys.readouterr().err.splitlines()
    assert 3 <= len(lines) <= 40
    assert set(lines) == {"1 of 3: slow"}


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_quick_command_has_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    with progress.ProgressBar() as bar:
        bar(1, 2, "cube")
    assert (terminal.getvalue(), bar.bar) == ("", None)


def test_the_bar_comes_by_itself_and_is_erased_for_output(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rich")
    terminal, printed = Terminal(), io.StringIO()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr("sys.stdout", printed)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(progress, "DELAY", 0.01)
    with progress.ProgressBar() as bar:
        bar(1, 2, "slow cube")
        deadline = time.monotonic() + 10.0
        while bar.bar is None and time.monotonic() < deadline:
            bar.ended.wait(0.01)
        with bar.hide():
            print("ok slow cube")
    shown = terminal.getvalue()
    assert "1/2" in shown and "slow cube" in shown
    assert not re.search(r"\x1b\[[0-9;]*[0-9]m", shown.replace("\x1b[0m", "")), "NO_COLOR"
    assert printed.getvalue() == "ok slow cube\n"
