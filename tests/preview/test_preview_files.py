"""Files that are dropped on the page, or chosen by its buttons."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from preview_page import NEEDS, Shown, browser

pytest.importorskip("aiohttp")
pytest.importorskip("playwright.sync_api")
trimesh = pytest.importorskip("trimesh")

__all__ = ["browser"]
pytestmark = NEEDS

STONE = (
    '[material]\nname = "stone"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\ntint = [0.8, 0.1, 0.1, 1.0]\n'
)
DROP = """([selector, name, content]) => {
  const bytes = Uint8Array.from(atob(content), (one) => one.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], name));
  for (const kind of ['dragenter', 'dragover', 'drop']) document.querySelector(selector)
    .dispatchEvent(new DragEvent(kind, { dataTransfer, bubbles: true, cancelable: true }));
}"""


def drop(shown: Shown, selector: str, name: str, data: bytes) -> None:
    shown.page.evaluate(DROP, [selector, name, base64.b64encode(data).decode()])


@pytest.fixture
def shown(browser: Any, tmp_path: Path) -> Iterator[Shown]:
    path = tmp_path / "stone.toml"
    path.write_text(STONE, encoding="utf-8")
    shown = Shown(browser, str(path))
    yield shown
    shown.close()


def test_a_dropped_mesh_is_drawn_and_a_faulty_one_keeps_the_picture(shown: Shown) -> None:
    ball = shown.picture()
    drop(shown, "main", "bar.glb", trimesh.creation.box((0.2, 2.0, 0.2)).export(file_type="glb"))
    shown.until(lambda: shown.page.input_value("#shape") == "mesh" and shown.version() == 2)
    assert shown.page.locator("#shape option:checked").inner_text() == "bar.glb"
    bar = shown.picture()
    middle = ball.shape[1] // 2
    changed = np.abs(bar - ball).mean(axis=(0, 2))
    assert changed[middle - 50 : middle - 25].mean() > 20.0 and changed[:30].max() < 2.0
    drop(shown, "main", "bar.glb", b"glTF and no more")
    shown.until(lambda: "not a valid .glb" in shown.page.inner_text("#status"))
    drop(shown, "main", "notes.txt", b"x")
    shown.until(lambda: "notes.txt: only .glb" in shown.page.inner_text("#status"))
    assert np.abs(shown.picture() - bar).max() < 3.0 and not shown.error() and not shown.faults


def test_a_mesh_is_chosen_by_the_button_and_the_list_leads_back(shown: Shown, tmp_path: Path) -> None:
    ball = shown.picture()
    (tmp_path / "cone.obj").write_text(trimesh.creation.cone(0.2, 1.0).export(file_type="obj"), encoding="utf-8")
    with shown.page.expect_file_chooser() as chooser:
        shown.page.click("#choose-mesh")
    chooser.value.set_files(str(tmp_path / "cone.obj"))
    shown.until(lambda: shown.version() == 2)
    assert np.abs(shown.picture() - ball).mean() > 2.0
    shown.page.select_option("#shape", "")
    shown.until(lambda: shown.version() == 3)
    assert np.abs(shown.picture() - ball).mean() < 0.5


def test_the_head_is_a_body_in_the_middle(shown: Shown) -> None:
    shown.page.select_option("#shape", "head")
    shown.until(lambda: shown.version() == 2)
    head = shown.picture()
    background = head[:, :3].mean(axis=1, keepdims=True)
    covered = np.abs(head - background).max(axis=2) > 12.0
    rows, columns = np.nonzero(covered)
    assert rows.min() > 3 and rows.max() < head.shape[0] - 3  # wholly in the picture
    assert 0.25 < covered.mean() * head.shape[1] / head.shape[0] < 0.7
    assert abs(columns.mean() - head.shape[1] / 2) < 12.0


def test_a_picture_in_a_slot_is_shown_at_once_and_saved(shown: Shown, tmp_path: Path) -> None:
    from sssgen.scene.pictures.images import png_bytes

    red = shown.picture()[130:170, 130:170].mean(axis=(0, 1))
    drop(shown, "[data-property=baseColorTexture]", "black.png", png_bytes(np.zeros((4, 4, 3))))
    shown.until(lambda: shown.page.locator(".slot.changed").count() == 1)
    assert shown.page.inner_text(".slot .file") == "black.png"
    shown.page.wait_for_timeout(100)
    pixel = "[...document.querySelector('.slot canvas').getContext('2d').getImageData(9, 9, 1, 1).data]"
    assert shown.page.evaluate(pixel) == [0, 0, 0, 255]
    dark = shown.picture()[130:170, 130:170].mean(axis=(0, 1))
    assert dark[0] < 0.5 * red[0]
    shown.page.click("#save")
    shown.until(lambda: "black.png is written" in shown.page.inner_text("#status"))
    assert 'base_color_texture = "black.png"' in (tmp_path / "stone.toml").read_text(encoding="utf-8")
    assert shown.page.locator(".slot.changed").count() == 0 and not shown.faults
