"""What differs on a terminal: colours of errors, the time of long commands."""

from __future__ import annotations

import io
import sys
import time

import pytest

from sssgen.cli import main as cli
from sssgen.cli import show
from sssgen.cli.output import coloured

TEXT = "error: no such file\n  --> a.toml\n  help: an error: as a word"
SHOWN = "\033[1;31merror:\033[0m no such file\n  --> a.toml\n  \033[1;36mhelp:\033[0m an error: as a word"


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def with_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)


def terminal_in_place(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """In a test's body, as pytest has its own streams for fixtures."""
    stream = Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    return stream


def test_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal_in_place(monkeypatch)
    assert coloured(TEXT) == SHOWN


@pytest.mark.parametrize(("variable", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_no_colours_by_choice(variable: str, value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    terminal_in_place(monkeypatch)
    monkeypatch.setenv(variable, value)
    assert coloured(TEXT) == TEXT


def test_no_colours_in_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert coloured(TEXT) == TEXT


def test_no_colours_in_json(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    terminal = terminal_in_place(monkeypatch)
    assert cli.main(["show", "zzz", "--json"]) == 2
    assert "\033" not in capsys.readouterr().out
    assert cli.main(["show", "zzz"]) == 2
    assert terminal.getvalue().startswith("\033[1;31merror:\033[0m nothing is called 'zzz'")


def test_the_time_of_a_long_command(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = terminal_in_place(monkeypatch)
    clock = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])

    def work(seconds: float) -> int:
        clock[0] += seconds
        return 0

    monkeypatch.setattr(show, "run", lambda _: work(1.9))
    cli.main(["show", "x"])
    assert terminal.getvalue() == ""
    monkeypatch.setattr(show, "run", lambda _: work(12.34))
    cli.main(["show", "x"])
    assert terminal.getvalue() == "12.3 s\n"
