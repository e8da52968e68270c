"""Each example scene gives a good picture, the same on every back end; the gallery shows it."""

from __future__ import annotations

import dataclasses
import json
import re
import runpy
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from example_cases import example_cases
from folders import ROOT
from slow_cases import diagonal
from sssgen.jobs.executor import Item, run
from sssgen.jobs.result_store import Store
from sssgen.material.material_loading import examples
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.scene import body_identity
from sssgen.scene.measured import measured_scene
from sssgen.scene.pictures import images
from sssgen.scene.scene_loading import load
from sssgen.support.value_bytes import encode

SMALL = (64, 48)
LOOP = "light_around.webp"


@cache
def render_example(name: str, backend: str, samples: int = 1) -> RenderedPicture:
    """A small picture of an example's scene, by an available back end."""
    scene = load(ROOT / "examples" / name / "scene.toml")
    return render(dataclasses.replace(scene, size=SMALL, samples=samples), backends.get(backend))


@pytest.mark.parametrize("name", example_cases("marble_idol"))
def test_an_example_is_a_picture(name: str, backend: Callable[[str], Backend]) -> None:
    backend("gl")
    picture = render_example(name, "gl")
    assert np.isfinite(picture.linear).all()
    covered_pixels = picture.encoded[picture.covered > 0.5]
    share = len(covered_pixels) / picture.covered.size
    assert 0.2 < share <= 1.0
    # the picture and its parts are not too dark or overexposed; it has contrast and colour
    assert 0.2 < covered_pixels.mean() < 0.75
    assert np.percentile(covered_pixels.max(axis=1), 5) > 0.03
    assert (covered_pixels.min(axis=1) > 0.99).mean() < 0.03
    assert covered_pixels.mean(axis=1).std() > 0.08
    assert (covered_pixels.max(axis=1) - covered_pixels.min(axis=1)).mean() > 0.04


DRAWN = diagonal(example_cases("marble_idol"), ["gl", "webgpu", "browser", "hlsl"])


@pytest.mark.parametrize(("name", "compared"), DRAWN)
def test_every_back_end_draws_the_same(name: str, compared: str, backend: Callable[[str], Backend]) -> None:
    backend(compared)
    far = np.abs(render_example(name, compared).encoded - render_example(name, "numpy").encoded)
    assert 255.0 * far.max() < 1.0


def test_light_comes_through() -> None:
    """Thin parts are brighter than thick parts if the lamp is behind them."""
    wax = render_example("wax_mouse", "numpy").encoded
    ear, belly = wax[10, 39], wax[30, 33]
    assert ear.mean() > belly.mean() + 0.15
    lantern = render_example("paper_lantern", "numpy").encoded.mean(axis=2)
    assert lantern[8:34, 32].max() > lantern[8:34, 32].min() + 0.4  # the paper is brighter than a hoop


def test_the_baked_light_is_that_of_the_scene() -> None:
    """The body, the medium, and the settings in the command that the scene names."""
    folder = ROOT / "examples" / "marble_idol"
    scene = measured_scene.load(str(folder / "scene.toml"))
    assert scene.medium is not None
    command = re.search(r"bake fluence .* --voxels (\d+) --photons (\d+)", (folder / "scene.toml").read_text())
    assert command is not None
    files = sorted(folder.glob("volumes/*.json"))
    assert len(files) == 3 and sum(file.stat().st_size for file in folder.glob("volumes/*")) < 300_000
    for file in files:
        facts = json.loads(file.read_text(encoding="utf-8"))
        assert facts["body"]["key"] == body_identity.key(scene.geometry)
        assert facts["medium"]["extinction"] == pytest.approx(scene.medium.extinction)
        assert facts["medium"]["albedo"] == pytest.approx(scene.medium.albedo)
        assert max(facts["texels"]) == int(command[1]) and facts["photons"] == int(command[2])


def test_the_textures_equal_the_output_of_their_script(tmp_path: Path) -> None:
    script = runpy.run_path(str(ROOT / "examples" / "textures.py"))
    cached = set((ROOT / "examples").glob("*/textures/*"))
    for example in script["EXAMPLES"]:
        for name, picture in example().items():
            file = ROOT / "examples" / example.__name__ / "textures" / f"{name}.png"
            cached.remove(file)
            stored = _picture(file)[::-1]
            expected = np.clip(picture, 0.0, 1.0).reshape(stored.shape)
            assert np.abs(stored - expected).max() < 1.5 / 255.0, file  # versions of NumPy round differently
    assert not cached
    script["write"](tmp_path / "new" / "step.png", np.array([[0.0, 0.0], [1.0, 1.0]]))
    assert _picture(tmp_path / "new" / "step.png")[:, 0, 0].tolist() == [
        1.0,
        0.0,
    ]  # row 0 of the array is at the bottom


def test_textures_tile() -> None:
    """In a repeating texture, differences across the edge are not larger than inside."""
    for name in ("paper_lantern/textures/base_color", "paper_lantern/textures/normal", "ice/textures/packed"):
        texels = _picture(ROOT / "examples" / f"{name}.png")
        inside = np.abs(np.diff(texels, axis=1)).mean(axis=(0, 2))
        assert np.abs(texels[:, 0] - texels[:, -1]).mean() <= inside.max()


def test_every_example_has_a_scene() -> None:
    for name in examples():
        assert load(ROOT / "examples" / name / "scene.toml").material == name


def test_the_gallery_shows_every_example() -> None:
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    linked = re.findall(r"\]\(gallery/(\w+\.\w+)\)", page)
    assert sorted(linked) == sorted([*(f"{name}.png" for name in examples()), LOOP])
    assert sorted(linked) == sorted(path.name for path in (ROOT / "docs" / "gallery").iterdir())
    for name in examples():
        assert f"`sssgen render {name} -o {name}.png`" in page
        assert re.search(rf"^\| `{name}` \|( 0\.\d{{3}} \|){{4}}$", page, re.MULTILINE), "a difference is 1/255 or more"


def test_the_gallery_names_the_scene_of_each_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs")
    from gallery_items import PICTURED

    page = " ".join((ROOT / "docs" / "gallery.md").read_text(encoding="utf-8").split())
    for name, file in PICTURED.items():
        assert f"`sssgen render examples/{name}/{file} -o {name}.png`" in page
        assert file != "scene.toml" and (ROOT / "examples" / name / file).is_file()


def test_the_gallery_is_small() -> None:
    files = list((ROOT / "docs" / "gallery").iterdir())
    assert sum(file.stat().st_size for file in files) < 1_600_000
    for file in (file for file in files if file.name != LOOP):
        with Image.open(file) as picture:
            assert (picture.format, picture.mode, picture.size) == ("PNG", "RGB", (640, 480))


def test_the_light_goes_around() -> None:
    """The loop goes on for ever, and its light moves in even steps, also from the last frame to the first."""
    frames = []
    with Image.open(ROOT / "docs" / "gallery" / LOOP) as loop:
        assert loop.format == "WEBP" and loop.info["loop"] == 0
        for number in range(getattr(loop, "n_frames", 1)):
            loop.seek(number)
            frames.append(np.asarray(loop.convert("RGB"), np.float64) / 255.0)
    assert len(frames) >= 16
    steps = [np.abs(frames[number] - frames[number - 1]).mean() for number in range(len(frames))]
    assert min(steps) > 0.002 and max(steps) < 4.0 * np.median(steps)


@pytest.mark.parametrize("name", example_cases("ice"))
def test_the_gallery_is_current(name: str, backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch) -> None:
    """A small picture of the scene equals the scaled picture of the gallery."""
    monkeypatch.syspath_prepend(ROOT / "docs")
    from gallery_items import pictured

    scene = dataclasses.replace(pictured(name), size=SMALL, samples=4)
    drawn = render(scene, backend("gl")).encoded
    stored = images.decode_srgb(_picture(ROOT / "docs" / "gallery" / f"{name}.png"))
    small = stored.reshape(48, 10, 64, 10, 3).mean(axis=(1, 3))
    # the samples differ, so edges may differ, but not the mean
    far = np.abs(images.encode_srgb(small) - drawn)
    assert far.mean() < 0.006


def _picture(path: Path) -> npt.NDArray[np.float64]:
    return images.read(path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["before_after.png", "gallery_traced.png"])
def test_the_comparison_with_path_tracing_is_current(name: str, backend: Callable[[str], Backend]) -> None:
    """The pictures of `docs/before_after.py`; few paths of light are as bright on average as many."""
    backend("gl")
    script = runpy.run_path(str(ROOT / "docs" / "before_after.py"))
    (width, height), gap, head = script["PANEL"], script["GAP"], script["HEAD"]
    with Image.open(script["FOLDER"] / name) as picture:
        stored = np.asarray(picture.convert("RGB"), np.float64) / 255.0
    for row, compared in enumerate(script["PICTURES"][name]):
        top = head + row * (height + gap)
        for column, panel in enumerate(script["panels"](compared._replace(samples=16))):
            left = column * (width + gap)
            expected = stored[top : top + height, left : left + width]
            if script["COLUMNS"][column] == "path traced":
                assert abs(panel.mean() - expected.mean()) < 0.02
            else:
                assert np.abs(panel - expected).mean() < 1.0 / 255.0


def test_processes_give_the_same_differences_of_back_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs")
    jobs = [Item("gallery_items:compare_backends", ("resin_inlay", ("numpy-f32", "numpy"), (32, 24), 1))]
    [[single, same]] = results = run(jobs, processes=0, store=Store(""))
    assert 0.0 < single.worst < 1.0 and single.differing == 0 and same == (0.0, 0)
    assert encode(run(jobs, processes=1, store=Store(""))) == encode(results)
