"""Save as: a material with its scene and files under another name, below the folder where the server was started."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from slow_cases import some_slow
from sssgen.material.material_loading import examples, load_material
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import folder

pytest.importorskip("tomlkit")
pytest.importorskip("igl")


@pytest.fixture(autouse=True)
def here(in_folder: Path) -> Path:
    return in_folder


def save_as(talk: PageMessages, name: str, **more: object) -> str:
    return talk.answer({"kind": "save_as", "name": name, "values": {}, **more})


def test_an_example_becomes_a_material_of_the_user_which_the_page_follows() -> None:
    talk = PageMessages(Pane("jade_ring"))
    head = talk.messages()[0]["picture"]
    assert head["saves"] and head["copies"]
    said = save_as(talk, "rings/my_jade", values={"surfaceRoughness": [0.4]})
    assert "rings/my_jade/my_jade.toml" in said
    head = talk.messages()[0]["picture"]
    assert (head["name"], head["title"], head["saves"]) == ("my_jade", "My jade", "")
    scene = load("rings/my_jade/scene.toml")
    assert scene.material == "rings/my_jade/my_jade.toml"
    material = load_material(scene.material)
    (value,) = [stage.values["surface_roughness"] for stage in material.stages if "surface_roughness" in stage.values]
    assert value == pytest.approx((0.4,))
    original = Path(examples()["jade_ring"]).read_text(encoding="utf-8").splitlines()
    comments = [line for line in original if line.startswith("#")]
    assert comments and set(comments) <= set(Path(scene.material).read_text(encoding="utf-8").splitlines())
    talk.answer({"kind": "save", "values": {"surfaceRoughness": [0.5]}})
    assert "surface_roughness = 0.5" in Path(scene.material).read_text(encoding="utf-8")
    talk.answer({"kind": "undo"})
    assert "surface_roughness = 0.4" in Path(scene.material).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", some_slow(["paper_lantern", "wax_mouse", "candle"], "wax_mouse"))
def test_the_files_of_an_example_come_with_it(name: str) -> None:
    talk = PageMessages(Pane(name))
    before = talk.messages()[0]["picture"]
    save_as(talk, "own")
    after = talk.messages()[0]["picture"]
    assert not after.get("missing") and after["body"] == before["body"]
    assert [row.get("texels") for row in after["textures"]] == [row.get("texels") for row in before["textures"]]
    outside = [file for file in talk.files if "examples" in Path(file).parts and Path(file).is_file()]
    assert not outside, "nothing is read from the example any more"


def test_what_is_elsewhere_is_put_beside_the_material() -> None:
    shutil.copytree(folder("examples") / "surroundings", "pictures")
    Path("mine").mkdir()
    (picture,) = Path("pictures").rglob("studio.png")
    Path("mine/stone.toml").write_text(
        '[material]\nname = "stone"\n[[surface]]\ntechnique = "base_color"\n'
        f'base_color_texture = "../{picture.as_posix()}"  # a photo\n',
        encoding="utf-8",
    )
    talk = PageMessages(Pane("mine/stone.toml"))
    assert not talk.messages()[0]["error"]
    save_as(talk, "other")
    assert sorted(path.name for path in Path("other").iterdir()) == ["other.toml", "studio.png"]
    assert 'base_color_texture = "studio.png"  # a photo' in Path("other/other.toml").read_text(encoding="utf-8")
    assert not talk.messages()[0]["error"]


def test_files_are_replaced_after_a_confirmation_only() -> None:
    talk = PageMessages(Pane("jade_ring"))
    Path("own").mkdir()
    Path("own/scene.toml").write_text("# mine\n", encoding="utf-8")
    Path("own/notes.txt").write_text("mine\n", encoding="utf-8")
    answer = talk.reply({"kind": "existing", "name": "own"})
    assert answer == {"kind": "existing", "name": "own", "files": ["scene.toml"]}
    with pytest.raises(SssgenError, match=r"the folder has scene\.toml already"):
        save_as(talk, "own")
    assert sorted(path.name for path in Path("own").iterdir()) == ["notes.txt", "scene.toml"]
    assert Path("own/scene.toml").read_text(encoding="utf-8") == "# mine\n"
    save_as(talk, "own", replace=True)
    assert load("own/scene.toml").material == "own/own.toml" and Path("own/notes.txt").is_file()


@pytest.mark.parametrize("name", ["../own", "/tmp/own", "a/../../own", "", "C:/own", "own/", "1st", "con"])
def test_a_name_that_leaves_the_folder_or_names_no_material_is_refused(name: str, here: Path) -> None:
    talk = PageMessages(Pane("jade_ring"))
    with pytest.raises(SssgenError):
        save_as(talk, name)
    with pytest.raises(SssgenError):
        talk.reply({"kind": "existing", "name": name})
    assert list(here.iterdir()) == []


def test_a_link_that_leaves_the_folder_is_refused(here: Path) -> None:
    talk = PageMessages(Pane("jade_ring"))
    (here / "out").symlink_to(here.parent, target_is_directory=True)
    with pytest.raises(SssgenError, match="link that leaves"):
        save_as(talk, "out/own")


def test_the_installation_is_never_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder("examples"))
    talk = PageMessages(Pane("jade_ring"))
    with pytest.raises(SssgenError, match="comes with sssgen"):
        save_as(talk, "own")
    assert not Path("own").exists()


def test_a_technique_and_plain_glsl_are_not_copied() -> None:
    Path("f.glsl").write_text("float f(vec2 p) { return p.x; }\n", encoding="utf-8")
    for name in ("lobe_exp2", "f.glsl"):
        with pytest.raises(SssgenError, match="cannot be saved under another name"):
            save_as(PageMessages(Pane(name)), "own")
