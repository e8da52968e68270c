"""What differs on a terminal: colours of errors, the progress and the time of long commands."""

from __future__ import annotations

import io
import json
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from command_line import Run
from sssgen.cli import chart as chart_command
from sssgen.cli import check as check_command
from sssgen.cli import eval as eval_command
from sssgen.cli import main as cli
from sssgen.cli import show
from sssgen.cli.output import paint
from sssgen.run.check.compile_check import Report, Result
from sssgen.run.check.shader_files import Shader
from sssgen.run.compilers import Message, Source
from sssgen.run.evaluate.deviation import Row
from sssgen.support.progress import ProgressBar

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
    assert paint(TEXT) == SHOWN


@pytest.mark.parametrize(("variable", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_no_colours_by_choice(variable: str, value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    terminal_in_place(monkeypatch)
    monkeypatch.setenv(variable, value)
    assert paint(TEXT) == TEXT


def test_no_colours_in_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert paint(TEXT) == TEXT


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


STEPS = {
    "emit wax.toml --target wgsl,hlsl -o out": ["wax for wgsl", "wax for hlsl"],
    "lint half.glsl wax.toml --no-examples": ["half.glsl", "wax.toml"],
    "check wax.toml --target numpy --compiler python": ["python: wax.py", "python: wax_functions.py"],
    "render paper_lantern --size 16x12 --backend numpy-f32 -o a.png": [
        "compiling the material", "casting the eye's rays", "drawing on numpy-f32",
    ],
    "eval lobe_exp2 --samples 10 --backend numpy-f32,numpy-f16": ["numpy, the oracle", "numpy-f32", "numpy-f16"],
    "ci numbers --backend numpy-f32": ["eval numbers/lobe.eval.json [numpy-f32]"],
    "bake voronoi --size 256 -o cells.npy": ["rows of cells"] * 3,
    "bake normal height.npy -o normals.npy": ["reading height.npy", "normals", "writing normals.npy"],
    "bake pack --red height.npy --green 0.5 -o packed.npy": ["reading height.npy"],
}  # fmt: skip
"""Command → the names of the steps of its progress."""


@pytest.mark.parametrize("command", STEPS)
def test_the_progress_of_a_command(command: str, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("half.glsl").write_text("float halved(float x) { return 0.5 * x; }\n", encoding="utf-8")
    np.save("height.npy", np.zeros((4, 4)))
    Path("numbers").mkdir()
    numbers = {"technique": "lobe_gdc2011", "inputs": {"N": [[0, 0, 1]]}, "tolerance": 1e-5}
    Path("numbers/lobe.eval.json").write_text(json.dumps(numbers), encoding="utf-8")
    shown: list[tuple[float, int, str]] = []
    monkeypatch.setattr(ProgressBar, "__call__", lambda _, *state: shown.append(state))
    assert run(*command.split()).err == ""
    assert [name for _, _, name in shown] == STEPS[command]
    (total,) = {total for _, total, _ in shown}
    done = [done for done, _, _ in shown]
    assert done == sorted(done)
    assert done[0] >= 0 and done[-1] <= total


LONG = "a version of a compiler on a device (with all that it tells of itself, and more)"
SOURCE = Source("x", "wgsl")
RESULTS = [
    Result(Shader(f"{'f' * length}.wgsl", "x", (SOURCE,)), SOURCE, "naga", [Message("warning", 0, 0, LONG)])
    for length in (5, 45)
]
REPORT = Report({"naga": LONG}, {"tint": LONG}, RESULTS)
ROWS = [Row("webgpu", LONG, None, LONG, missing=True)]
POINT = {"scene": "s", "role": "material", "front": True, "failed": "", "baseline": True, "label": LONG}
CHART = {
    "hypervolume": [{"scene": "s", "role": "material", "ours": 1.0, "baselines": 0.5}],
    "points": [{**POINT, "error": {"value": 0.5}, "cost": {"value": 10.0}}],
}


def table(name: str) -> None:
    """Prints one of the tables of results."""
    if name == "check":
        shaders = [result.shader for result in REPORT.results] + [Shader("a.txt", "", (Source("", "gdshader"),))]
        check_command._print(REPORT, shaders, verbose=False)
    elif name == "eval":
        eval_command._print_rows(ROWS)
    else:
        print(chart_command.summary(CHART))


@pytest.mark.parametrize("name", ["check", "eval", "chart"])
def test_tables_fit_a_narrow_terminal_and_are_one_line_each_in_a_pipe(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    table(name)
    piped = capsys.readouterr().out
    monkeypatch.setenv("COLUMNS", "60")
    terminal = Terminal()
    monkeypatch.setattr(sys, "stdout", terminal)
    table(name)
    lines = terminal.getvalue().splitlines()
    assert LONG in piped and LONG not in terminal.getvalue()
    assert [line for line in lines if len(line) >= 60] == []
    assert "".join(terminal.getvalue().split()) == "".join(piped.split())
