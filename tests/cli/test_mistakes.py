"""Mistakes of users at the command line: what can be done is done, the rest is an error that says what it is."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import pytest

from sssgen.cli.main import main
from sssgen.scene import mesh_files
from sssgen.support.diagnostics import SssgenError


def test_a_target_that_cannot_express_a_material_does_not_hide_the_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["emit", "wax_mouse", "--target", "wgsl,shadertoy", "-o", str(tmp_path)]) == 1
    assert (tmp_path / "wax_mouse.wgsl").exists()
    error = "error: wax_mouse is not emitted for shadertoy: Shadertoy cannot supply 'distance_map': it has no sampler3D"
    assert error in capsys.readouterr().err


def test_a_single_target_that_cannot_express_a_material_is_an_error(tmp_path: Path) -> None:
    assert main(["emit", "wax_mouse", "--target", "shadertoy", "-o", str(tmp_path / "out")]) == 2
    assert not (tmp_path / "out").exists()


def test_repeated_targets_are_all_emitted(tmp_path: Path) -> None:
    assert main(["emit", "ice", "--target", "wgsl", "-t", "hlsl", "-o", str(tmp_path)]) == 0
    assert {path.name for path in tmp_path.iterdir()} >= {"ice.wgsl", "ice.hlsl"}


def test_a_scene_is_no_material(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text('material = "wax.toml"\nsize = [4, 4]\n')
    assert main(["emit", str(scene), "--target", "wgsl", "-o", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.count("error:") == 1 and "this is a scene, and no material" in error
    assert "help: its material is wax.toml" in error


def glb(document: dict[str, object]) -> bytes:
    text = json.dumps({"asset": {"version": "2.0"}, **document}).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<IIIII", 0x46546C67, 2, 20 + len(text), len(text), 0x4E4F534A) + text


@pytest.mark.parametrize("name", ["KHR_draco_mesh_compression", "EXT_meshopt_compression"])
def test_compressed_triangles_are_refused(tmp_path: Path, name: str) -> None:
    mesh = tmp_path / "mesh.glb"
    mesh.write_bytes(glb({"extensionsRequired": [name]}))
    with pytest.raises(SssgenError, match=f"its triangles are compressed by {name}, which is not read"):
        mesh_files.read(str(mesh))


def test_a_missing_buffer_is_named(tmp_path: Path) -> None:
    mesh = tmp_path / "mesh.gltf"
    buffers = {"buffers": [{"byteLength": 36, "uri": "gone.bin"}]}
    mesh.write_text(json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], **buffers}))
    with pytest.raises(SssgenError, match=r"there is no file 'gone\.bin' beside this one"):
        mesh_files.read(str(mesh))


def test_a_folder_that_one_may_not_write_to_is_refused_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from sssgen.support import file_writer

    file_writer.check_folder(str(tmp_path / "new"))
    monkeypatch.setattr(file_writer.os, "access", lambda path, mode: False)
    with pytest.raises(SssgenError, match="you may not write to this folder"):
        file_writer.check_folder(str(tmp_path / "new"))


@pytest.mark.parametrize(
    "command",
    ["emit jade -t wgsl -o out", "render jade", "new mine --copy jade", "pick jade --max-error 1", "check jade"],
)
def test_the_name_of_a_preset_is_explained(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command.split()) == 2
    error = capsys.readouterr().err
    assert "'jade' is a preset: `sssgen use jade MESH -o DIR`" in error and "sssgen new my_jade --from jade" in error


@pytest.mark.parametrize(
    "command",
    ["render ice -o {}/ice.png", "import ice.glb -o {}", "chart inlay_plate -o {}/chart", "use wax body.obj -o {}"],
)
def test_a_place_that_cannot_be_written_is_noticed_before_the_work(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    for work in ("run.render.scene_render.render", "interchange.format_readers.read", "presets.used_mesh.used_mesh"):
        monkeypatch.setattr(f"sssgen.{work}", lambda *_, **__: pytest.fail("it works"))
    assert main(command.format(tmp_path / "file").split()) == 2
    assert "this is not a folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("materials", "hint"),
    [
        ([], "it has none: leave --material out"),
        ([{"name": "Skin"}, {}], "materials: Skin, or a number from 0"),
        ([{}], "materials: without names, or a number from 0"),
        ([{"name": "Eye"}, {"name": "Skin"}], "did you mean 'Skin'?"),
    ],
)
def test_a_material_that_a_file_lacks(
    materials: list[object], hint: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "head.glb"
    path.write_bytes(glb({"materials": materials}))
    name = "Skinn" if len(materials) == 2 and materials[1] else "none"
    assert main(["import", str(path), "--material", name, "-o", str(tmp_path / "out")]) == 2
    assert f"help: {hint}" in capsys.readouterr().err


def test_functions_are_never_standalone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["emit", "ice", "--form", "functions", "--standalone", "-t", "threejs", "-o", "out"]) == 2
    assert "--standalone is for whole modules" in capsys.readouterr().err and not Path("out").exists()


@pytest.mark.parametrize("command", ["render {}", "emit {} -t wgsl -o out", "preview {}", "pick {} --max-error 1"])
@pytest.mark.parametrize(
    ("name", "message", "hint"),
    [
        ("my cow.obj", "this is a mesh, and not a TOML file", 'sssgen use wax "my cow.obj" -o DIR'),
        ("paint.png", "this is a picture, and not a TOML file", "name a material or a scene"),
        ("index.html", "this is HTML, and not a TOML file", "name the .toml file of a material or a scene"),
        ("wax.js", "this is JavaScript, and not a TOML file", "name the .toml file of a material or a scene"),
    ],
)
def test_other_kinds_of_files_are_no_materials_and_no_scenes(
    command: str, name: str, message: str, hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path(name).write_bytes(b"v 0 0 0\n")
    assert main([name if word == "{}" else word for word in command.split()]) == 2
    printed, error = capsys.readouterr()
    assert error.count("error:") == 1 and message in error and hint in error and not printed


@pytest.mark.parametrize(
    ("words", "message", "hint"),
    [
        ("use wax scene.toml -o out", "this is a TOML file, and a mesh is needed", "ends in .obj, .ply, .stl"),
        (
            "use mine.toml cow.obj -o out",
            "this is a TOML file, and no preset",
            "`sssgen preview mine.toml --mesh cow.obj`",
        ),
    ],
)
def test_use_takes_no_toml_file(words: str, message: str, hint: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words.split()) == 2
    error = capsys.readouterr().err
    assert message in error and hint in error and "did you mean" not in error


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.glb", b"\x89PNG\r\n\x1a\n", "this is a PNG picture, not a .glb file"),
        ("a.obj", b"\x89PNG\r\n\x1a\n", "this is a PNG picture, not an .obj file"),
        ("a.stl", b"\xff\xd8\xff\xe0", "this is a JPEG picture, not an .stl file"),
        ("a.stl", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "this is not an .stl file"),
        ("a.obj", b"solid a\nendsolid a\n", "this is an .stl file, not an .obj file"),
        ("a.ply", bytes(84), "this is an .stl file, not a .ply file"),
        ("a.obj", b"words\n", "this is not an .obj file"),
        ("a.stl", bytes(84), "the file holds no triangles"),
        ("a.stl", b"solid a\nendsolid a\n", "the file holds no triangles"),
    ],
)
def test_a_file_of_another_kind_is_named(name: str, content: bytes, message: str) -> None:
    Path(name).write_bytes(content)
    with pytest.raises(SssgenError, match=message):
        mesh_files.read(name)


def test_missing_surroundings_are_noticed_before_the_work(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sssgen.run.render.scene_render.render", lambda *_, **__: pytest.fail("it works"))
    Path("scene.toml").write_text('material = "ice"\n[environment]\nfile = "sky.png"\n', encoding="utf-8")
    assert main(["render", "scene.toml"]) == 2
    error = capsys.readouterr().err
    assert "cannot find the file 'sky.png'" in error and "--> scene.toml:3:8" in error
    assert "it is searched for next to the scene" in error
