"""A scene refers to the files beside it first, and no command changes the files that come with sssgen."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from sssgen.cli.main import main
from sssgen.material.material_loading import examples, load_material
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.pictures.images import png_bytes
from sssgen.scene.preview_scene import scene_of
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError
from sssgen.support.file_memo import noted_files
from sssgen.support.installed_files import is_installed
from sssgen.support.paths import folder

pytest.importorskip("tomlkit")
pytest.importorskip("igl")

JADE = Path(examples()["jade_ring"])
SCENE = 'material = "jade_ring"\n[geometry]\nkind = "ball"\n'


@pytest.fixture(autouse=True)
def installed(in_folder: Path) -> Iterator[None]:
    """Afterwards the example is as it was."""
    before = {path: path.read_bytes() for path in JADE.parent.rglob("*") if path.is_file()}
    yield
    assert {path: path.read_bytes() for path in JADE.parent.rglob("*") if path.is_file()} == before


def save(name: str, **values: list[float]) -> str:
    return PageMessages(Pane(name)).answer({"kind": "save", "values": values})


def test_a_copied_folder_is_shown_and_saved_in_itself() -> None:
    shutil.copytree(JADE.parent, "ring")
    shutil.copytree(folder("examples") / "surroundings", "surroundings")
    own = Path("ring/jade_ring.toml")
    own.write_text(own.read_text(encoding="utf-8").replace("[0.035, ", "[0.5, "), "utf-8")
    shown = Pane("ring/scene.toml")
    values = {control["label"]: control["value"] for control in shown.picture.head["controls"]}
    assert load("ring/scene.toml").material == "ring/jade_ring.toml" and values["tint"][0] == 0.5
    assert shown.picture.head["saved_in"] == "Save writes ring/jade_ring.toml." and not shown.picture.head["saves"]
    roughness = values["surface_roughness"][0] + 0.1
    assert save("ring/scene.toml", surfaceRoughness=[roughness]) == "Saved: surface_roughness in ring/jade_ring.toml."


def test_the_file_beside_a_scene_is_found_when_it_is_made_and_lost_when_it_goes() -> None:
    Path("scene.toml").write_text(SCENE, encoding="utf-8")
    with noted_files() as read:
        assert load("scene.toml").material == "jade_ring"
    assert str(Path("jade_ring.toml").absolute()) in read, "a preview renews the picture when the file is made"
    shutil.copy(JADE, "jade_ring.toml")
    assert load("scene.toml").material == "jade_ring.toml"
    Path("jade_ring.toml").write_text("[material\n", encoding="utf-8")
    with pytest.raises(SssgenError, match=r"jade_ring\.toml:1"):
        Pane("scene.toml")


def test_a_scene_with_a_materials_name_is_no_material() -> None:
    for name in ("jade_ring.toml", "other.toml"):
        Path(name).write_text(SCENE, encoding="utf-8")
        assert load(name).material == "jade_ring"


def test_the_example_itself_keeps_its_name() -> None:
    assert load("jade_ring").material == scene_of("jade_ring").material == "jade_ring"


def test_a_file_that_is_no_example_is_named_with_its_ending() -> None:
    shutil.copy(JADE, "stone.toml")
    Path("scene.toml").write_text(SCENE.replace("jade_ring", "stone"), encoding="utf-8")
    with pytest.raises(SssgenError, match=r"did you mean 'stone\.toml'\?"):
        load("scene.toml")


@pytest.mark.parametrize("name", ["jade_ring", str(JADE), str(JADE.with_name("scene.toml"))])
def test_an_installed_material_is_not_saved_and_the_page_says_what_to_do(name: str) -> None:
    reason = Pane(name).picture.head["saves"]
    assert f"{JADE.name} comes with sssgen and is not changed" in reason
    assert "sssgen new jade_ring --copy jade_ring" in reason and "jade_ring/scene.toml" in reason
    with pytest.raises(SssgenError, match="nothing can be saved here"):
        save(name, surfaceRoughness=[0.7])


def test_the_advice_of_the_page_works(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "jade_ring", "--copy", "jade_ring"]) == 0
    written = capsys.readouterr().out
    assert "wrote jade_ring/jade_ring.toml\n" in written and "wrote jade_ring/scene.toml\n" in written
    assert "in jade_ring/jade_ring.toml" in save("jade_ring/scene.toml", surfaceRoughness=[0.7])
    assert main(["new", "jade_ring", "--copy", "jade_ring"]) == 2
    assert "the folder already exists" in capsys.readouterr().err
    assert main(["new", "x", "--copy", "jade_rin"]) == 2
    assert "did you mean 'jade_ring'?" in capsys.readouterr().err


@pytest.mark.parametrize("name", examples())
def test_every_example_can_be_copied_whole(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "sub/own", "--copy", name, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["file"] == f"sub/own/{name}.toml" and all(Path(file).is_file() for file in report["files"])
    scene = load("sub/own/scene.toml")
    assert scene.material == f"sub/own/{name}.toml"
    file = scene.measured.get("environment", {}).get("file", "")
    assert not file or Path("sub/own", file).is_file()
    load_material(scene.material)


def test_the_scene_of_a_person_gets_the_changes_of_an_installed_material() -> None:
    Path("scene.toml").write_text(SCENE, encoding="utf-8")
    talk = PageMessages(Pane("scene.toml"))
    head = talk.messages()[0]["picture"]
    assert head["saved_in"].startswith("Save writes scene.toml; ") and "comes with sssgen" in head["saved_in"]
    rows = [row for row in head["textures"] if row["type"] == "sampler2D" and not row["page_draws"]]
    texture = {"kind": "texture", "slot": rows[0]["property"], "name": "red.png"}
    talk.answer(texture, png_bytes(np.full((2, 4, 3), [1.0, 0.0, 0.0])))
    said = talk.answer({"kind": "save", "values": {"surfaceRoughness": [0.7]}})
    assert said == "Saved: surface_roughness in scene.toml. red.png is written, and scene.toml names it."
    scene = load("scene.toml")
    assert scene.parameters == {"surface_roughness": 0.7} and list(scene.textures) == [rows[0]["source_name"]]
    assert not Pane("scene.toml").error


@pytest.mark.parametrize(
    ("command", "file"),
    [
        (["emit", "jade_ring", "-t", "wgsl", "-o"], JADE.parent),
        (["bake", "voronoi", "--size", "8", "-o"], JADE.with_name("cells.png")),
        (["transpile", "f.glsl", "-t", "wgsl", "-o"], folder("templates") / "f.wgsl"),
        (["schema", "scene", "-o"], JADE),
    ],
)
def test_no_command_writes_into_the_installation(
    command: list[str], file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("f.glsl").write_text("float f(float x) { return x; }\n", encoding="utf-8")
    assert main([*command, str(file)]) == 2
    error = "this file comes with sssgen, which does not change it" if file.is_file() else "this folder comes with"
    assert error in capsys.readouterr().err


def test_links_to_folders_are_followed_and_links_to_files_are_replaced() -> None:
    Path("linked").symlink_to(JADE.parent)
    Path("jade.toml").symlink_to(JADE)
    assert is_installed("linked/jade_ring.toml") and is_installed("linked/new.png")
    assert not is_installed("jade.toml") and not is_installed(".")
    with pytest.raises(SssgenError, match="nothing can be saved"):
        save("linked/jade_ring.toml", surfaceRoughness=[0.7])
    save("jade.toml", surfaceRoughness=[0.7])
    assert not Path("jade.toml").is_symlink()
