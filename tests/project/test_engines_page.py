"""docs/engines.md has a row for each engine and back end that draws; the examples in pages say what they need."""

from __future__ import annotations

import re
import runpy
from collections.abc import Callable
from typing import Any

import pytest

import sssgen
from folders import ROOT
from sssgen.run import backends
from sssgen.run.backends import BACKENDS, Backend

pytest.importorskip("PIL", reason="Pillow is missing: pip install -e '.[dev]'")


def page() -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "docs" / "engines.py"))


def test_every_engine_has_a_row() -> None:
    text, engines = (ROOT / "docs" / "engines.md").read_text(encoding="utf-8"), page()
    rows = re.findall(r"^\| ([^|]+) \| (?:ours|the engine's)", text, re.MULTILINE)
    titles = [record.description for record in BACKENDS.values() if record.scenes_only]
    expected = [*engines["TITLES"].values(), *(title.removesuffix(", in a headless Chromium") for title in titles)]
    assert sorted(rows) == sorted(expected)
    assert "not run" not in text.partition(engines["START"])[2]


def test_the_scene_is_that_of_shadertoy(backend: Callable[[str], Backend]) -> None:
    """The page compares Shadertoy's own shell with a scene of this project."""
    backend("gl")
    engines = page()
    scene = engines["scene_loading"].load(str(engines["FOLDER"] / "scene.toml"))
    reference = engines["render"](scene, backends.get("numpy"), (48, 36)).encoded
    drawn = engines["_shadertoy"]((48, 36), scene.samples)
    tile = engines["_compared"]("Shadertoy", "ours", drawn, reference, True)
    assert reference.max() - reference.min() > 0.5 and tile.difference < 2.0 / 255.0


@pytest.mark.parametrize("target", ["threejs", "babylonjs", "playcanvas"])
def test_example_pages_name_the_module_that_they_import(target: str) -> None:
    """A page whose module is missing gives the command that writes it."""
    folder = ROOT / "examples" / "engines" / target
    named = re.search(
        r"'(\S+)': 'sssgen emit ice --target (\w+) -o (\S+),", (folder / "index.html").read_text(encoding="utf-8")
    )
    imported = re.findall(r"from '\./(\S+)'", (folder / "main.js").read_text(encoding="utf-8"))
    assert named is not None
    assert imported == [named[1]]
    assert named.groups()[1:] == (target, f"examples/engines/{target}")
    assert named[1] in sssgen.compile("ice", target=target).files


@pytest.mark.parametrize("name", ["paper_lantern", "ice"])
def test_the_page_of_shadertoy_finds_the_pictures_of_an_example(name: str) -> None:
    """The page reads from the head of the text which picture a channel shows."""
    page_text = (ROOT / "examples" / "engines" / "shadertoy" / "index.html").read_text(encoding="utf-8")
    assert r"`// iChannel${channel} is (\\w+)_texture`" in page_text
    compiled = sssgen.compile(name, "shadertoy")
    pictures = re.findall(r"// iChannel\d is (\w+)_texture", compiled.files[f"{name}.shadertoy.glsl"])
    assert len(pictures) == len(compiled.reflection["textures"]) > 0
    for picture in pictures:
        assert (ROOT / "examples" / name / "textures" / f"{picture}.png").is_file()
