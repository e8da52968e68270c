"""The scene of a material that is named alone."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sssgen.cli.main import main
from sssgen.material.material_loading import examples
from sssgen.scene.geometry import Ball, Torus
from sssgen.scene.preview_scene import scene_of
from sssgen.support.diagnostics import SssgenError

TORUS = 'material = "{}"\n[geometry]\nkind = "torus"\n'


@pytest.fixture
def ice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copy(examples()["ice"], 'my "own".toml'))


def test_a_material_alone_is_a_ball_lit_from_behind(ice: Path) -> None:
    scene = scene_of(str(ice))
    assert isinstance(scene.geometry, Ball) and scene.material == str(ice.absolute())
    direction = scene.lights[0].direction
    assert direction is not None and direction[2] < 0.0 < scene.camera.position[2]


def test_the_scene_beside_a_material_is_taken_if_it_is_of_this_material(ice: Path) -> None:
    Path("scene.toml").write_text(TORUS.format("ice"), encoding="utf-8")
    scene = scene_of(str(ice))
    assert isinstance(scene.geometry, Torus) and scene.material == str(ice.absolute())
    for other in (TORUS.format("candle"), '[geometry]\nkind = "torus"\n[medium]\nname = "wax"\n'):
        Path("scene.toml").write_text(other, encoding="utf-8")
        assert isinstance(scene_of(str(ice)).geometry, Ball)
    Path("scene.toml").write_text(TORUS.format("ice") + "minr = 1.0\n", encoding="utf-8")
    with pytest.raises(SssgenError, match="minr"):
        scene_of(str(ice))


def test_scenes_and_examples_are_what_they_are(ice: Path) -> None:
    Path("other.toml").write_text(TORUS.format("ice"), encoding="utf-8")
    assert scene_of("other.toml").material == "ice"
    assert scene_of("ice").document.reporter.file.endswith("scene.toml")
    with pytest.raises(SssgenError, match="unknown scene 'icee'"):
        scene_of("icee")
    Path("headless.toml").write_text('[translucency]\ntechnique = "lobe_simple"\n', encoding="utf-8")
    with pytest.raises(SssgenError, match=r"no \[material\] section"):
        scene_of("headless.toml")


def test_a_material_with_rays_of_its_own_has_no_body(ice: Path) -> None:
    assert scene_of(shutil.copy(examples()["jelly_cubes"], "cubes.toml")).geometry is None


def test_render_draws_a_material(ice: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["render", str(ice), "--size", "16x12", "--samples", "1", "--backend", "numpy-f32", "-o", "own.png"]) == 0
    )
    assert "wrote own.png: 16 × 12" in capsys.readouterr().out
