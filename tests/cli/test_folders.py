"""A folder in place of a file: every command says so, and what to name."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.cli.main import WRONG_INPUT, main
from sssgen.support.diagnostics import SssgenError
from sssgen.support.text_files import refuse_folder

COMMANDS = (
    "emit mine -t wgsl -o out", "render mine -o out.png", "transpile mine -t wgsl", "eval mine", "stress mine",
    "lint mine", "show mine", "show mine --kind scene", "fit mine lobe_exp2", "pick mine --max-error 1", "chart mine",
    "bake thickness mine -o out.png", "bake sdf mine -o out.npy", "bake normal mine -o out.png",
    "bake pack --red mine -o out.png", "bake fluence mine --medium wax -o out.npy",
)  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_that_takes_files_refuses_a_folder(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine").mkdir()
    assert main(command.split()) == WRONG_INPUT
    shown = capsys.readouterr().err
    assert shown.startswith("error: this is a folder, not a file\n  --> mine\n  help: it has no file that ends in .")


@pytest.mark.parametrize(
    ("files", "hint"),
    [
        (["readme.md"], "it has no file that ends in .toml or .glsl: name one"),
        (["b.glsl"], "name a file in it, such as mine/b.glsl"),
        (
            ["b.glsl", "a.glsl"],
            "name a file in it, such as mine/a.glsl, or all where the command takes several: mine/*.glsl",
        ),
        (["b.glsl", "b.toml"], "name a file in it, such as mine/b.toml"),
        (["a.toml", "mine.toml"], "name a file in it, such as mine/mine.toml"),
        (["a.toml", "mine.toml", "scene.toml"], "name a file in it, such as mine/scene.toml"),
    ],
)
def test_the_hint_names_a_file(files: list[str], hint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine").mkdir()
    for name in files:
        Path("mine", name).touch()
        refuse_folder(Path("mine", name))  # a file is none
    with pytest.raises(SssgenError) as caught:
        refuse_folder("mine/", (".toml", ".glsl"), "scene.toml")
    assert caught.value.diagnostics[0].hint == hint
