"""The stage of the page in a headless Chromium: surroundings, ground, lamps, turntable, and what is saved of them."""

from __future__ import annotations

import itertools
import zipfile
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from panoramas import exr_bytes, hdr_bytes
from preview_page import NEEDS, Shown, browser
from webm_files import read_webm

pytest.importorskip("aiohttp")
pytest.importorskip("watchfiles")
pytest.importorskip("playwright.sync_api")
Image = pytest.importorskip("PIL.Image")

__all__ = ["browser"]
pytestmark = NEEDS

SCENE = """material = "stone.toml"
background = [[0.0, 0.0, 0.2], [0.0, 0.0, 0.2]]
[geometry]
kind = "ball"
[camera]
position = [0.0, 1.6, 6.0]
[[light]]  # from the left
direction = [-1.0, 1.0, 0.0]
color = [2.0, 2.0, 2.0]
"""
MATERIAL = """[material]
name = "stone"
shading = "lit"
[[surface]]
technique = "base_color"
tint = [0.6, 0.6, 0.6, 1.0]
[[surface]]
technique = "pbr_constants"
surface_roughness = 1.0
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    path = tmp_path / "scene.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


@pytest.fixture(params=["webgl2", "webgl"])
def drawn(browser: Any, scene: Path, request: pytest.FixtureRequest) -> Iterator[Shown]:
    """The page with each renderer."""
    shown = Shown(browser, str(scene), renderer=request.param)
    yield shown
    shown.close()


@pytest.fixture
def shown(browser: Any, scene: Path) -> Iterator[Shown]:
    shown = Shown(browser, str(scene))
    yield shown
    shown.close()


def drop(shown: Shown, name: str, data: bytes) -> None:
    """Drops a file on the page."""
    shown.page.evaluate(
        """([name, data]) => {
          const files = new DataTransfer();
          files.items.add(new File([new Uint8Array(data)], name));
          document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: files, bubbles: true, cancelable: true }));
        }""",
        [name, list(data)],
    )


def sides(picture: Any) -> tuple[Any, Any]:
    """The mean colours of the left and the right half of the ball."""
    height, width = picture.shape[:2]
    rows = picture[2 * height // 5 : 3 * height // 5]
    left, right = (rows[:, width // 2 + off - 8 : width // 2 + off + 8] for off in (-height // 8, height // 8))
    return left.mean(axis=(0, 1)), right.mean(axis=(0, 1))


def without_lamps(shown: Shown) -> None:
    shown.page.evaluate("preview.stage.lamps.lights = [], preview.stage.ask()")


def test_surroundings_light_the_body_and_are_its_background(drawn: Shown) -> None:
    without_lamps(drawn)
    dark = drawn.picture()
    assert np.mean(sides(dark)) < 3.0
    for kind in ("studio", "sky"):
        drawn.page.click("#tool-surroundings")
        drawn.page.select_option("#surroundings", kind)
        lit = drawn.picture()
        assert np.mean(sides(lit)) > 40.0, kind
        assert lit[4, 4] == pytest.approx(dark[4, 4], abs=2.0)  # the background of the scene
        drawn.page.check("#surroundings-background")
        assert np.abs(drawn.picture()[4, 4] - dark[4, 4]).max() > 20.0, kind
        drawn.page.uncheck("#surroundings-background")
        drawn.page.keyboard.press("Escape")
    drawn.page.evaluate("preview.bar.light({ strength: 0 })")
    assert np.mean(sides(drawn.picture())) < 3.0
    assert not drawn.faults


@pytest.mark.parametrize("renderer", ["webgl2", "webgl"])
def test_the_scenes_own_surroundings(browser: Any, scene: Path, renderer: str) -> None:
    """They shine from the right and from above."""
    panorama = np.zeros((16, 32, 3), np.uint8)
    panorama[:8, 12:20] = 255
    Image.fromarray(panorama).save(scene.parent / "around.png")
    around = '[environment]\nfile = "around.png"\nintensity = 0.8\n'
    scene.write_text(SCENE.replace("[geometry]", around + "[geometry]"), encoding="utf-8")
    shown = Shown(browser, str(scene), renderer=renderer)
    try:
        without_lamps(shown)
        picture = shown.picture().mean(axis=-1)
        height, width = picture.shape
        body = picture[height // 2 - height // 8 : height // 2 + height // 8, width // 2 - height // 8 :][
            :, : height // 4
        ]
        top, bottom = np.array_split(body, 2)
        (left, _), (_, right) = (np.array_split(body, 2, axis=1) for _ in range(2))
        assert top.mean() > bottom.mean() + 10.0 and right.mean() > left.mean() + 10.0
        shown.page.evaluate("preview.bar.light({ strength: 0 })")
        assert shown.picture().mean(axis=-1)[height // 2, width // 2] < 3.0 and not shown.faults
    finally:
        shown.close()


def test_a_dropped_panorama_lights_from_its_sides_and_turns(drawn: Shown) -> None:
    without_lamps(drawn)
    texels = np.zeros((16, 32, 3), np.float32)
    texels[:, :16, 1] = 0.5  # the left half is behind the body, as the middle is at +x
    texels[:, 16:, 0] = 0.5
    texels[:8, :, 2] = 0.5
    for name, data in (("room.hdr", hdr_bytes(texels)), ("room.exr", exr_bytes(texels))):
        drop(drawn, name, data)
        drawn.until(lambda name=name: drawn.page.evaluate("preview.bar.file.textContent") == name)
        drawn.page.evaluate("preview.bar.light({ turn: 0 })")
        front = drawn.picture()
        height, width = front.shape[:2]
        above, middle, below = (front[row, width // 2] for row in (2 * height // 5, height // 2, 3 * height // 5))
        assert middle[0] > 1.5 * middle[1] and above[2] > 1.2 * below[2], name
        drawn.page.evaluate("preview.bar.light({ turn: 90 })")
        left, right = sides(drawn.picture())
        drawn.page.evaluate("preview.bar.light({ turn: -90 })")
        other_left, other_right = sides(drawn.picture())
        assert left[1] > 1.2 * left[0] and right[0] > 1.2 * right[1], name
        assert left == pytest.approx(other_right, abs=6.0) and right == pytest.approx(other_left, abs=6.0), name
    assert not drawn.faults


def test_a_file_that_is_no_panorama_is_named(shown: Shown) -> None:
    for name, data in (("a.hdr", b"nothing"), ("b.exr", b"\x00" * 64), ("c.exr", b"")):
        drop(shown, name, data)
        shown.until(lambda name=name: f"{name} cannot be read as a panorama" in shown.page.inner_text("#status"))
    assert shown.page.evaluate("preview.bar.settings.light.kind") == "none"
    assert not shown.faults


def ground_at(shown: Shown, x: float, z: float) -> float:
    """How bright the ground is at a place, 0 to 255."""
    place = shown.page.evaluate(
        f"(() => {{ const {{ ball, camera, ground }} = preview.stage; const at = ball.center.clone();"
        f" at.set(at.x + {x} * ball.radius, ground.mesh.position.y, at.z + {z} * ball.radius); at.project(camera);"
        " return [at.x, at.y]; })()"
    )
    picture = shown.picture()
    height, width = picture.shape[:2]
    column, row = round((place[0] + 1) / 2 * width), round((1 - place[1]) / 2 * height)
    return float(picture[row - 1 : row + 2, column - 1 : column + 2].mean())


def test_the_ground_has_the_shadow_of_the_lamp(drawn: Shown) -> None:
    drawn.page.click("#tool-ground")
    lit, shadow = ground_at(drawn, -1.3, 0.3), ground_at(drawn, 1.3, 0.3)
    assert lit > 60.0 and shadow < 0.3 * lit
    drawn.page.evaluate(
        "preview.stage.lamps.lights = [{ position: [3, 4, 0, 1], color: [40, 40, 40] }], preview.bar.change({})"
    )
    assert ground_at(drawn, -1.3, 0.3) < 0.4 * ground_at(drawn, 1.3, 0.3)  # that of a lamp at a place
    drawn.page.click("#tool-ground")
    assert drawn.picture()[-6, 20] == pytest.approx(drawn.picture()[6, 20], abs=3.0)
    assert not drawn.faults


def test_the_ground_is_darker_below_the_body_in_surroundings(drawn: Shown) -> None:
    without_lamps(drawn)
    drawn.page.evaluate("preview.bar.change({ ground: true }), preview.bar.light({ kind: 'studio' })")
    near, far = ground_at(drawn, 0.0, 0.75), ground_at(drawn, -1.5, 0.75)
    assert far > 30.0 and near < 0.8 * far
    assert not drawn.faults


def test_lamps_are_added_coloured_removed_and_saved(shown: Shown, scene: Path) -> None:
    page = shown.page
    page.click("#tool-lamps")
    lamps = page.locator(".sheet .remove")
    shown.until(lambda: lamps.count() == 1)
    before = shown.picture()
    for count in (2, 3, 4):
        page.click("#add-lamp")
        assert lamps.count() == count
    assert page.is_disabled("#add-lamp")
    assert np.abs(shown.picture() - before).mean() > 0.5
    for _ in range(2):
        lamps.last.click()
    page.locator(".sheet:popover-open input[type=color]").last.evaluate(
        "(field) => { field.value = '#ff0000'; field.dispatchEvent(new Event('input')); }"
    )
    page.locator(".sheet:popover-open .number").last.fill("3")
    page.click("#save-lamps")
    shown.until(lambda: "Saved: 2 lamps" in page.inner_text("#status"))
    text = scene.read_text(encoding="utf-8")
    assert text.count("[[light]]") == 2 and "# from the left" in text and "color = [3.0, 0.0, 0.0]" in text
    shown.until(lambda: shown.version() >= 2)  # the save renews the picture, and so may the change of the file
    assert page.evaluate("preview.stage.lamps.all.length") == 2
    assert not shown.faults


def test_lamps_of_two_panes_are_the_same(shown: Shown) -> None:
    shown.page.select_option("#beside", "start")
    shown.until(lambda: shown.page.evaluate("preview.panes[1]?.stage?.drafts.sharp"))
    shown.page.click("#tool-lamps")
    shown.page.click("#add-lamp")  # which waits for the sheet
    lights = "preview.panes[{}].stage.lamps.lights"
    shown.until(lambda: shown.page.evaluate(lights.format(1) + ".length") == 2)
    assert shown.page.evaluate(lights.format(0)) == shown.page.evaluate(lights.format(1))


def test_a_lamp_without_a_depth_map_is_named(browser: Any) -> None:
    shown = Shown(browser, "jade_ring")
    try:
        shown.page.click("#tool-lamps")
        shown.page.wait_for_selector("#add-lamp")
        shown.page.evaluate(
            "preview.stage.lamps.lights = [[0, 0, -1, 0], [0, 1, 0, 0]].map((position, index) =>"
            " ({ position, color: [index + 1, 1, 1] })), preview.bar.listLamps(preview.stage)"
        )
        assert "No depth map: 1." in shown.page.inner_text(".sheet:popover-open")
    finally:
        shown.close()


def test_the_body_turns_and_reset_turns_it_back(shown: Shown) -> None:
    shown.page.select_option("#shape", "cube")
    shown.until(lambda: shown.version() == 2)
    before = shown.picture()
    eye = shown.page.evaluate("preview.stage.camera.position.toArray()")
    shown.page.click("#tool-turntable")
    shown.until(lambda: shown.page.evaluate("preview.stage.angle") > 0.3)
    assert shown.page.evaluate("preview.stage.camera.position.toArray()") == eye
    shown.page.click("#tool-turntable")
    assert np.abs(shown.picture() - before).mean() > 1.0
    shown.page.click("#tool-view")
    shown.page.click("#view-against")
    assert shown.page.evaluate("preview.stage.camera.position.x") > 1.0  # the lamp is on the left
    shown.page.click("#view-scene")
    shown.page.keyboard.press("Escape")
    assert shown.picture() == pytest.approx(before, abs=3.0)


def saved(shown: Shown, button: str) -> Path:
    with shown.page.expect_download(timeout=60e3) as started:
        shown.page.click(button)
    return Path(started.value.path())


@pytest.mark.parametrize("transparent", [False, True])
def test_a_picture_has_its_size_and_its_background(drawn: Shown, transparent: bool) -> None:
    before = drawn.picture()
    drawn.page.click("#tool-picture")
    drawn.page.fill("#picture-width", "640")
    drawn.page.fill("#picture-height", "400")
    drawn.page.set_checked("#picture-transparent", transparent)
    picture = np.asarray(Image.open(saved(drawn, "#save-picture")).convert("RGBA"), float)
    assert picture.shape == (400, 640, 4)
    assert picture[3, 3, 3] == (0.0 if transparent else 255.0) and picture[200, 320, 3] == 255.0
    if not transparent:
        assert picture[3, 3, :3] == pytest.approx(before[3, 3], abs=2.0)
    left, right = sides(picture[..., :3])
    assert left[0] > 1.5 * right[0]
    edge = np.abs(np.diff(picture[200, :, :3].mean(axis=1)))
    assert edge.max() > 20.0  # drawn in this size: a picture that is enlarged is smooth
    drawn.page.keyboard.press("Escape")
    assert drawn.picture() == pytest.approx(before, abs=2.0)
    assert not drawn.faults


def test_a_picture_that_is_too_large_is_refused(shown: Shown) -> None:
    shown.page.click("#tool-picture")
    shown.page.fill("#picture-width", "40000")
    shown.page.click("#save-picture")
    shown.until(lambda: "A side has 16 to 4096 pixels here." in shown.page.inner_text(".sheet:popover-open"))


def film(shown: Shown, kind: str) -> bytes:
    """A turn of half a second in 12 frames of 64 × 48."""
    shown.page.select_option("#shape", "cube")
    shown.until(lambda: shown.version() == 2)
    shown.picture()
    shown.page.click("#tool-film")
    for field, value in (("seconds", "0.5"), ("width", "64"), ("height", "48")):
        shown.page.fill(f"#film-{field}", value)
    shown.page.select_option("#film-rate", "24")
    shown.page.select_option("#film-kind", kind)
    data = saved(shown, "#save-film").read_bytes()
    assert "12 frames" in shown.page.inner_text(".sheet:popover-open") and not shown.faults
    return data


def test_a_film_has_each_frame_at_its_time(browser: Any, shown: Shown) -> None:
    data = film(shown, "webm")
    read = read_webm(data)
    assert (read.width, read.height, read.duration) == (64, 48, 500.0)
    assert read.times == [round(1000 * index / 24) for index in range(12)]
    page = browser.new_page()  # which has no policy for the contents of a page
    plays = page.evaluate(
        """async (data) => {
          const video = document.createElement('video');
          const colors = [];
          video.src = URL.createObjectURL(new Blob([new Uint8Array(data)], { type: 'video/webm' }));
          await new Promise((done, failed) => Object.assign(video, { onloadeddata: done, onerror: failed }));
          const context = new OffscreenCanvas(64, 48).getContext('2d', { willReadFrequently: true });
          for (const time of [0.02, 0.1, 0.47]) {
            video.currentTime = time;
            await new Promise((done) => { video.onseeked = done; });
            context.drawImage(video, 0, 0);
            colors.push([...context.getImageData(0, 24, 64, 1).data]);
          }
          return { duration: video.duration, colors };
        }""",
        list(data),
    )
    page.close()
    assert plays["duration"] == pytest.approx(0.5, abs=0.01)
    rows = np.array(plays["colors"], float)
    assert rows[:, 32 * 4 : 32 * 4 + 3].mean() > 20.0  # the body is there
    assert np.abs(rows[1] - rows[0]).max() > 10.0  # and turns


def test_frames_are_pictures_in_a_zip(shown: Shown) -> None:
    with zipfile.ZipFile(BytesIO(film(shown, "zip"))) as files:
        assert files.namelist() == [f"{index:04}.png" for index in range(12)]
        frames = [np.asarray(Image.open(BytesIO(files.read(name))).convert("RGB"), float) for name in files.namelist()]
    assert {frame.shape for frame in frames} == {(48, 64, 3)}
    for before, after in itertools.pairwise(frames):
        assert np.abs(after - before).max() > 8.0
    # after a quarter of a turn a cube looks as before, but for its lamps, which do not turn
    assert frames[3] == pytest.approx(frames[0], abs=3.0)


def test_a_film_of_a_browser_without_an_encoder_is_frames(shown: Shown) -> None:
    shown.page.evaluate("delete globalThis.VideoEncoder")
    with zipfile.ZipFile(BytesIO(film(shown, "webm"))) as files:
        assert len(files.namelist()) == 12


def test_a_flat_picture_has_no_bar(browser: Any, tmp_path: Path) -> None:
    path = tmp_path / "plain.frag"
    path.write_text("void main() { gl_FragColor = vec4(1.0, 0.5, 0.0, 1.0); }\n", encoding="utf-8")
    shown = Shown(browser, str(path))
    try:
        shown.until(lambda: not shown.page.is_visible("#stage-bar"))
        assert not shown.error()
    finally:
        shown.close()
