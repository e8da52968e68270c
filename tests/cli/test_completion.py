"""Completion: the scripts, and what the shell offers for a word."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import argcomplete
import pytest

from command_line import Run
from documents import programs
from folders import ROOT
from sssgen.cli import candidates
from sssgen.cli.commands import COMMANDS, command_parser
from sssgen.cli.completion import SHELLS
from sssgen.material import library
from sssgen.material.material_loading import examples
from sssgen.run.backend_registry import BACKENDS, SCENES
from sssgen.targets import registry


def offered(line: str) -> list[str]:
    """What argcomplete offers at the end of a line, without the space after a word that is complete."""
    start, _, prefix = line.rpartition(" ")
    finder = argcomplete.CompletionFinder(candidates.completed_parser(line), always_complete_options=False)
    words = finder._get_completions(start.split(), prefix, "", None)
    return [word.rstrip() for word in words]


@pytest.mark.parametrize("shell", SHELLS)
def test_the_script_of_a_shell(shell: str, run: Run, tmp_path: Path) -> None:
    ran = run("completion", shell)
    assert (ran.status, ran.err) == (0, "")
    assert "sssgen" in ran.out
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    path = tmp_path / "script"
    path.write_text(ran.out, encoding="utf-8")
    subprocess.run([shell, "-n", str(path)], check=True)


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_bash_completes(tmp_path: Path) -> None:
    lines = {"sssgen em": ["emit "], "sssgen emit wax.toml -t wgsl,unity-u": ["wgsl,unity-urp "]}
    script = 'eval "$(sssgen completion bash)"\n'
    for line in lines:
        script += f"COMP_LINE='{line}'; COMP_POINT=${{#COMP_LINE}}; COMP_TYPE=9; COMPREPLY=()\n"
        script += '_python_argcomplete sssgen; (IFS=,; echo "${COMPREPLY[*]}")\n'
    path = f"{programs(tmp_path / 'programs')}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout.splitlines() == [",".join(words) for words in lines.values()], done.stderr


def test_commands_and_options() -> None:
    assert offered("sssgen ") == list(COMMANDS)
    assert offered("sssgen help ba") == ["bake"]
    assert offered("sssgen emit ice --gua") == ["--guards"]
    assert offered("sssgen emit ice --guards ") == ["auto", "all", "none"]
    assert offered("sssgen bake view") == ["view_thickness"]


def test_names() -> None:
    assert offered("sssgen emit jade") == [name for name in examples() if name.startswith("jade")]
    assert offered("sssgen emit ice --target ") == [*registry.names(), "all"]
    assert offered("sssgen eval beer") == [name for name in library.index() if name.startswith("beer")]
    assert offered("sssgen render ice --backend ") == list(SCENES)
    assert offered("sssgen ci . -b gl,") == [f"gl,{name}" for name in BACKENDS]
    assert offered("sssgen emit ice --shell tone_mapping=a") == ["tone_mapping=aces", "tone_mapping=agx"]
    assert offered("sssgen bake fluence a.obj --medium marb") == ["marble"]
    assert offered("sssgen show norma") == ["normal_from_height", "normal_map", "normal_map_directx", "normalize"]


def test_files() -> None:
    """Files of the endings that the argument takes, and folders."""
    for name in ("wood.toml", "wood.png", ".hidden.toml", "sub/deep.toml"):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).touch()
    assert offered("sssgen emit w") == ["wax_mouse", "wax.toml", "wood.toml"]
    assert offered("sssgen emit su") == ["sub/"]
    assert offered("sssgen emit sub/") == ["sub/deep.toml"]
    assert offered("sssgen new wo") == ["wood.png", "wood.toml"]  # a file to write: any


def test_every_row_of_the_table_is_an_argument() -> None:
    """A row that names no argument would complete nothing."""
    used = set()
    for name in COMMANDS:
        parsers = [command_parser(name)]
        for parser in parsers:
            for action in parser._actions:
                parsers += action.choices.values() if isinstance(action.choices, dict) else []
                values = candidates.values_of(action, name)
                used |= {key for key, row in candidates.VALUES.items() if row is values}
    assert used == candidates.VALUES.keys()
