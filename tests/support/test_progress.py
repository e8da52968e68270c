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
    assert capsys.readouterr() == ("", "40 of 100: item 39\n80 of 100: item 79\n")


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
