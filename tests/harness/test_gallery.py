"""The example scenes: each is a picture, the same on every back end, and the gallery shows it."""

from __future__ import annotations

import dataclasses
import re
import runpy
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from folders import ROOT
from sssgen.harness import backends
from sssgen.harness.backends import Backend
from sssgen.harness.pictures import images
from sssgen.harness.render.scene_render import Rendered, render
from sssgen.harness.scenes.scene_loading import load
from sssgen.material.material_loading import examples

SMALL = (64, 48)


@cache
def drawn(name: str, backend: str, samples: int = 1) -> Rendered:
    """An example's scene, small. The back end is there."""
    scene = load(ROOT / "examples" / name / "scene.toml")
    return render(dataclasses.replace(scene, size=SMALL, samples=samples), backends.get(backend))


@pytest.mark.parametrize("name", examples())
def test_an_example_is_a_picture(name: str, backend: Callable[[str], Backend]) -> None:
    backend("gl")
    picture = drawn(name, "gl")
    assert np.isfinite(picture.linear).all()
    shown = picture.encoded[picture.covered > 0.5]
    share = len(shown) / picture.covered.size
    assert 0.2 < share <= 1.0
    # not dark or overexposed, as a whole and in parts; not flat; not gray
    assert 0.2 < shown.mean() < 0.75
    assert np.percentile(shown.max(axis=1), 5) > 0.03
    assert (shown.min(axis=1) > 0.99).mean() < 0.03
    assert shown.mean(axis=1).std() > 0.08
    assert (shown.max(axis=1) - shown.min(axis=1)).mean() > 0.04


@pytest.mark.parametrize("name", examples())
@pytest.mark.parametrize("other", ["gl", "webgpu", "browser", "hlsl"])
def test_every_back_end_draws_the_same(name: str, other: str, backend: Callable[[str], Backend]) -> None:
    backend(other)
    far = np.abs(drawn(name, other).encoded - drawn(name, "numpy").encoded)
    assert 255.0 * far.max() < 1.0


def test_light_comes_through() -> None:
    """What the pictures are for: thin parts are brighter than thick ones with the lamp behind them."""
    wax = drawn("wax_mouse", "numpy").encoded
    ear, belly = wax[10, 39], wax[30, 33]
    assert ear.mean() > belly.mean() + 0.15
    lantern = drawn("paper_lantern", "numpy").encoded.mean(axis=2)
    assert lantern[8:34, 32].max() > lantern[8:34, 32].min() + 0.4  # paper, and a hoop


def test_the_textures_equal_the_output_of_their_script(tmp_path: Path) -> None:
    script = runpy.run_path(str(ROOT / "examples" / "textures.py"))
    cached = set((ROOT / "examples").glob("*/textures/*"))
    for example in script["EXAMPLES"]:
        for name, picture in example().items():
            file = ROOT / "examples" / example.__name__ / "textures" / f"{name}.png"
            cached.remove(file)
            stored = _picture(file)[::-1]
            expected = np.clip(picture, 0.0, 1.0).reshape(stored.shape)
            assert np.abs(stored - expected).max() < 1.5 / 255.0, file  # another NumPy rounds another way
    assert not cached
    script["write"](tmp_path / "new" / "step.png", np.array([[0.0, 0.0], [1.0, 1.0]]))
    assert _picture(tmp_path / "new" / "step.png")[:, 0, 0].tolist() == [1.0, 0.0]  # row 0 is the lowest


def test_textures_tile() -> None:
    """Across the edge of a texture that repeats a step is no larger than inside."""
    for name in ("paper_lantern/textures/base_color", "paper_lantern/textures/normal", "ice/textures/packed"):
        texels = _picture(ROOT / "examples" / f"{name}.png")
        inside = np.abs(np.diff(texels, axis=1)).mean(axis=(0, 2))
        assert np.abs(texels[:, 0] - texels[:, -1]).mean() <= inside.max()


def test_every_example_has_a_scene() -> None:
    for name in examples():
        assert load(ROOT / "examples" / name / "scene.toml").material == name


def test_the_gallery_shows_every_example() -> None:
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    shown = re.findall(r"\]\(gallery/(\w+)\.png\)", page)
    assert sorted(shown) == sorted(examples())
    assert sorted(shown) == sorted(path.stem for path in (ROOT / "docs" / "gallery").iterdir())
    for name in shown:
        assert f"`sssgen render {name} -o {name}.png`" in page
        assert re.search(rf"^\| `{name}` \|( 0\.\d{{3}} \|){{4}}$", page, re.MULTILINE), "a difference is 1/255 or more"


def test_the_gallery_is_small() -> None:
    files = list((ROOT / "docs" / "gallery").iterdir())
    assert sum(file.stat().st_size for file in files) < 1_500_000
    for file in files:
        with Image.open(file) as picture:
            assert (picture.format, picture.mode, picture.size) == ("PNG", "RGB", (640, 480))


def test_the_gallery_is_current(backend: Callable[[str], Backend]) -> None:
    """The scene drawn small equals the gallery's picture scaled down."""
    backend("gl")
    for name in examples():
        stored = images.decode_srgb(_picture(ROOT / "docs" / "gallery" / f"{name}.png"))
        small = stored.reshape(48, 10, 64, 10, 3).mean(axis=(1, 3))
        # of other samples, so that edges may be off, and the mean may not
        far = np.abs(images.encode_srgb(small) - drawn(name, "gl", 4).encoded)
        assert far.mean() < 0.006, name


def _picture(path: Path) -> npt.NDArray[np.float64]:
    return images.read(path)
