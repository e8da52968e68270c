"""`sssgen emit` warns of the pictures that a material names and that are not there, at their places in the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.cli.main import main
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
