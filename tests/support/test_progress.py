"""Progress in a log: nothing for quick work, then a line now and then."""

from __future__ import annotations

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
