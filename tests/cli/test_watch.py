"""`sssgen watch`: what it emits and prints after each change."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from command_line import Run
from folders import ROOT
from sssgen.cli import watch
from sssgen.support.file_memo import FileState, changed_files

MATERIAL = """\
[material]
name = "resin"
[coordinates]
technique = "parallax_refracted"
ior = IOR
[[surface]]
technique = "base_color"
"""
REFLECTION = Path("out/resin.wgsl.reflection.json")


def save(ior: str) -> None:
    Path("resin.toml").write_text(MATERIAL.replace("IOR", ior), encoding="utf-8")


@pytest.fixture
def steps(monkeypatch: pytest.MonkeyPatch) -> list[Callable[[], object]]:
    """What happens to the files, one change after the other; then Ctrl-C."""
    pytest.importorskip("watchfiles")
    steps: list[Callable[[], object]] = []

    def changes(files: Callable[[], Mapping[str, FileState]], messages: object) -> Iterator[set[str]]:
        for step in steps:
            step()
            yield set(changed_files(files()))
        raise KeyboardInterrupt

    monkeypatch.setattr(watch, "changes", changes)
    save("1.5")
    return steps


def test_every_change_is_emitted(run: Run, steps: list[Callable[[], object]]) -> None:
    """An error is printed once, and the last good files stay until it is mended."""
    kept: list[str] = []

    def mend() -> None:
        kept.append(REFLECTION.read_text(encoding="utf-8"))
        save("1.25")

    steps += [
        lambda: save("1.25"),
        lambda: save("="),
        mend,
        lambda: save("1.75"),
    ]
    ran = run("watch", "resin.toml", "-t", "wgsl")
    assert ran.status == 0
    lines = ran.out.splitlines()
    assert lines[:2] == ["wrote out/resin.wgsl", "wrote out/resin.wgsl.reflection.json"]
    assert lines[2].endswith(" files; Ctrl-C ends it")
    assert lines[3:] == [
        *("resin.toml changed", "wrote out/resin.wgsl.reflection.json"),
        "resin.toml changed",
        *("resin.toml changed", "the 2 files in out are the same"),
        *("resin.toml changed", "wrote out/resin.wgsl.reflection.json"),
    ]
    assert ran.err.count("error:") == 1 and "--> resin.toml:5:" in ran.err
    assert ran.err.endswith("watched until Ctrl-C\n")
    assert "1.25" in kept[0] and "1.75" in REFLECTION.read_text(encoding="utf-8")


def test_json_is_a_line_for_each_emission(run: Run, steps: list[Callable[[], object]]) -> None:
    steps += [lambda: save("="), lambda: save("1.25")]
    ran = run("watch", "resin.toml", "-t", "wgsl", "--json")
    reports = [json.loads(line) for line in ran.out.splitlines()]
    assert (ran.status, ran.err, [report["ok"] for report in reports]) == (0, "", [True, False, True])
    assert [row["changed"] for row in reports[2]["files"]] == [False, True]
    assert reports[1]["diagnostics"][0]["line"] == 5


def test_a_faulty_material_does_not_stop_the_others(run: Run, steps: list[Callable[[], object]]) -> None:
    Path("other.toml").write_text(Path("resin.toml").read_text("utf-8").replace('"resin"', '"other"'), "utf-8")
    steps += [lambda: save("=")]
    ran = run("watch", "resin.toml", "other.toml", "-t", "wgsl", "--json")
    first, second = (json.loads(line) for line in ran.out.splitlines())
    assert first["ok"] and len(first["files"]) == 4
    assert not second["ok"] and {row["material"] for row in second["files"]} == {"other"} and second["diagnostics"]


def test_own_templates_are_files_that_the_emission_reads(run: Run, steps: list[Callable[[], object]]) -> None:
    """Also one that is new beside them, in place of a template of sssgen."""
    Path("mine/wgsl").mkdir(parents=True)
    template = Path("mine/wgsl/shader.wgsl.j2")
    steps += [
        lambda: template.write_text("// my template\n", encoding="utf-8"),
        lambda: template.write_text("// my other template\n", encoding="utf-8"),
    ]
    ran = run("watch", "resin.toml", "-t", "wgsl", "--templates", "mine")
    assert ran.out.count("mine/wgsl/shader.wgsl.j2 changed\nwrote out/resin.wgsl\n") == 2
    assert "// my other template" in Path("out/resin.wgsl").read_text(encoding="utf-8")


def test_an_unknown_target_ends_it(run: Run, steps: list[Callable[[], object]]) -> None:
    ran = run("watch", "resin.toml", "-t", "wgls")
    assert (ran.status, ran.out) == (2, "")
    assert "unknown target 'wgls'" in ran.err


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is another signal there")
def test_the_command_itself() -> None:
    """A process that watches: 1000 saves, a file that vanishes, a renamed folder, each of an editor's ways to save."""
    pytest.importorskip("watchfiles")
    folder = Path("mine")
    folder.mkdir()
    file = folder / "resin.toml"

    def text(ior: float) -> str:
        return MATERIAL.replace("IOR", str(ior))

    def wait_for(ior: float) -> None:
        while not (REFLECTION.is_file() and str(ior) in REFLECTION.read_text(encoding="utf-8")):
            assert process.poll() is None
            time.sleep(0.01)

    file.write_text(text(1.5), encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    command = [sys.executable, "-m", "sssgen", "watch", str(file), "-t", "wgsl", "--json"]
    with Path("log").open("w", encoding="utf-8") as log:
        process = subprocess.Popen(command, env=environment, stdout=log)
    try:
        wait_for(1.5)
        for number in range(1000):
            file.write_text(text(1.0 + number / 1024), encoding="utf-8")
        wait_for(1.0 + 999 / 1024)
        assert len(Path("log").read_text(encoding="utf-8").splitlines()) < 1000
        new = folder / "new"
        new.write_text(text(1.125), encoding="utf-8")
        new.replace(file)
        wait_for(1.125)
        file.unlink()
        while '"ok": false' not in Path("log").read_text(encoding="utf-8"):
            time.sleep(0.01)
        wait_for(1.125)
        file.write_text(text(1.25), encoding="utf-8")
        wait_for(1.25)
        folder.rename("away")
        Path("away").rename(folder)
        file.write_text(text(1.375), encoding="utf-8")
        wait_for(1.375)
        process.send_signal(signal.SIGINT)
        assert process.wait() == 0
    finally:
        process.kill()
