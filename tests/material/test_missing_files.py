"""`sssgen emit` warns of the pictures that a material names and that are not there, at their places in the file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sssgen.cli.main import main
from sssgen.material.baked import mesh_key
from sssgen.material.material_loading import load_material
from sssgen.material.missing_files import missing_files

TEXT = """\
[material]
name = "shade"
[[surface]]
technique = "base_color"
base_color_texture = "paint.png"
[thickness]
technique = "thickness_map"
thickness_texture = "thickness.png"
[translucency]
technique = "absorption_tint"
"""


@pytest.fixture
def material(tmp_path: Path) -> Path:
    path = tmp_path / "shade.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_each_missing_file_has_its_place_and_a_remedy(material: Path) -> None:
    baked, painted = missing_files(load_material(str(material)))
    assert (baked.span.line, painted.span.line) == (8, 5)
    assert "'thickness.png'" in baked.message and "sssgen bake thickness MESH -o" in baked.hint
    assert "'paint.png'" in painted.message and material.parent.as_posix() in painted.hint


def test_emit_warns_until_the_file_is_there(material: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["emit", str(material), "--target", "wgsl", "-o", str(material.parent / "out")]
    for missing in (["paint.png", "thickness.png"], ["thickness.png"], []):
        for name in {"paint.png", "thickness.png"} - set(missing):
            (material.parent / name).write_bytes(b"")
        assert main(command) == 0
        warned = capsys.readouterr().err
        assert [name for name in ("paint.png", "thickness.png") if f"'{name}'" in warned] == missing


def test_emit_warns_of_a_bake_of_another_mesh_than_the_one_beside_it(material: Path) -> None:
    folder = material.parent
    for name in ("paint.png", "thickness.png"):
        (folder / name).write_bytes(b"")
    mesh = folder / "body.obj"
    mesh.write_bytes(b"v 0 0 0")
    body = {"name": mesh.name, "key": mesh_key(mesh.read_bytes())}
    facts = {"format": 1, "kind": "thickness", "holds": "thickness", "body": body}
    (folder / "thickness.png.json").write_text(json.dumps(facts), "utf-8")
    assert missing_files(load_material(str(material))) == []
    mesh.write_bytes(b"v 1 0 0")
    (warning,) = missing_files(load_material(str(material)))
    assert warning.span.line == 8 and "baked for another 'body.obj' than the one beside it" in warning.message
    mesh.unlink()
    assert missing_files(load_material(str(material))) == []
