"""`sssgen import` and `sssgen export-gltf` as a user meets them: files that are there, notes, and what to do next."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gltf_files import box, write_gltf
from sssgen.cli.main import main
from sssgen.interchange.mapping_report import short_text
from sssgen.scene.scene_loading import load

GLASS: dict[str, Any] = {
    "name": "glass",
    "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 1.0},
        "KHR_materials_volume": {
            "thicknessFactor": 1.0, "attenuationColor": [0.5, 0.7, 0.9], "attenuationDistance": 1.0,
        },
    },
}  # fmt: skip


def asset(folder: Path, material: dict[str, Any] | None = None, **more: Any) -> Path:
    content, data = box(material or GLASS)
    return write_gltf(folder / "box.glb", {**content, **more}, data)


def run(*arguments: str | Path) -> int:
    return main([str(part) for part in arguments])


def test_an_edited_material_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = asset(tmp_path), tmp_path / "out"
    assert run("import", path, "-o", out) == 0
    assert run("import", path, "-o", out) == 0  # nothing was edited
    written = out / "glass" / "glass.toml"
    before, edited = written.read_text(encoding="utf-8"), "# edited\n" + written.read_text(encoding="utf-8")
    written.write_text(edited, encoding="utf-8")
    (out / "report.md").unlink()
    capsys.readouterr()
    assert run("import", path, "-o", out) == 2
    message = capsys.readouterr().err
    assert "already exists, with another content" in message and "glass/glass.toml" in message and "--force" in message
    assert written.read_text(encoding="utf-8") == edited and not (out / "report.md").exists()
    assert run("import", path, "-o", out, "--force") == 0
    assert written.read_text(encoding="utf-8") == before


def test_a_report_of_something_else_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "report.md").write_text("of last year", encoding="utf-8")
    assert run("import", asset(tmp_path), "-o", tmp_path) == 2
    assert "report.md" in capsys.readouterr().err
    assert not (tmp_path / "glass").exists()
    assert (tmp_path / "report.md").read_text(encoding="utf-8") == "of last year"


def test_the_commands_that_follow_are_printed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    asset(tmp_path, materials=[{"name": "clay"}, GLASS])
    monkeypatch.chdir(tmp_path)
    assert run("import", "box.glb", "-o", "my glass") == 0
    printed = capsys.readouterr().out
    assert "draw it: sssgen render 'my glass/scene.toml' -o box.png\n" in printed
    assert "change it: sssgen preview 'my glass/glass/scene.toml'\n" in printed


@pytest.mark.parametrize(("scale", "reason"), [(0.0, "no triangle has an area"), (1e30, "reaches beyond 1e+09 m")])
def test_a_mesh_that_cannot_be_drawn_is_left_out(
    scale: float, reason: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    nodes = [{"mesh": 0, "scale": [scale] * 3}]
    assert run("import", asset(tmp_path, nodes=nodes), "-o", tmp_path / "out", "--json") == 0
    result = json.loads(capsys.readouterr().out)
    (row,) = [row for row in result["report"]["rows"] if row["outcome"] == "left out"]
    assert row["element"] == "/nodes/0" and reason in row["became"]
    assert load(result["materials"][0]["scene"]).material  # with a ball in place of the mesh


@pytest.mark.parametrize(
    ("material", "reason"),
    [
        ({"name": "clay"}, "the materials: none has a medium that light enters"),
        (GLASS, "glass: thickness: the material has no mesh"),
    ],
)
def test_a_bake_without_effect_says_why(
    material: dict[str, Any], reason: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = asset(tmp_path, material, nodes=[{}])
    assert run("import", path, "-o", tmp_path / "out", "--bake") == 0
    assert f"--bake has no effect on {reason}" in capsys.readouterr().out
    assert "--bake" in (tmp_path / "out" / "report.md").read_text(encoding="utf-8")


def test_values_in_reports_have_no_words_of_python() -> None:
    import numpy as np

    assert short_text({"scale": [2, 2.0], "on": True, "off": None}) == "scale: 2, 2; on: true; off: null"
    assert short_text((np.float32(0.25), np.bool_(False))) == "0.25, false"
    assert short_text(np.array([1.0, 2.0])) == "1, 2"


def test_a_file_that_is_no_glb(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.glb"
    for content, message in ((b"", "the file is empty"), (b"RIFF1234", "this is not a GLB file")):
        path.write_bytes(content)
        assert run("import", path, "-o", tmp_path / "out") == 2
        assert message in capsys.readouterr().err


def test_an_export_without_a_mesh_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("import", asset(tmp_path, nodes=[{}]), "-o", tmp_path / "out") == 0
    material = tmp_path / "out" / "glass" / "glass.toml"
    capsys.readouterr()
    assert run("export-gltf", material, "-o", tmp_path / "back.glb") == 0
    assert "there is no mesh beside it; name one with --mesh" in capsys.readouterr().out
    assert run("export-gltf", material, "-o", tmp_path / "back.glb", "--json") == 0
    assert json.loads(capsys.readouterr().out)["mesh"] is None


def test_a_tiling_beyond_the_range_is_limited(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from gltf_files import data_uri, png
    from sssgen.material.material_loading import load_material

    transform = {"KHR_texture_transform": {"scale": [200.0, 400.0], "offset": [1234.25, 0.0]}}
    material = {"name": "mesh", "normalTexture": {"index": 0, "extensions": transform}}
    pictures = {"images": [{"uri": data_uri(png((128, 128, 255)))}], "textures": [{"source": 0}]}
    assert run("import", asset(tmp_path, material, **pictures), "-o", tmp_path / "out") == 0
    (stage,) = [
        stage
        for stage in load_material(str(tmp_path / "out" / "mesh" / "mesh.toml")).stages
        if stage.technique.name == "uv_transform"
    ]
    assert stage.values["uv_tiling"] == (100.0, 100.0)
    assert stage.values["uv_offset"] == (0.25, 0.0)  # whole repetitions change nothing
    assert "at most 100" in (tmp_path / "out" / "report.md").read_text(encoding="utf-8")


def test_an_import_shows_its_progress(tmp_path: Path) -> None:
    from sssgen.interchange.gltf_reader import read
    from sssgen.interchange.mapping_report import Report
    from sssgen.interchange.material_writer import write_import

    states: list[tuple[float, int, str]] = []
    report = Report("box")
    path = asset(tmp_path, materials=[GLASS, {"name": "clay"}])
    write_import(str(tmp_path / "out"), read(str(path), report), report, progress=lambda *state: states.append(state))
    assert states == [(0, 2, "glass"), (1, 2, "clay")]


def test_a_mesh_with_a_vertex_that_is_no_number_is_not_exported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "nan.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n")
    assert run("export-gltf", "ice", "-o", tmp_path / "ice.glb", "--mesh", tmp_path / "nan.obj") == 2
    assert "a vertex is not a number" in capsys.readouterr().err and not (tmp_path / "ice.glb").exists()
