"""What goes wrong while the preview runs: files, folders, pages and browsers; the server watches real files."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from sssgen.preview import preview_server
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.preview.preview_server import PreviewServer
from sssgen.run.web_library import Library

aiohttp = pytest.importorskip("aiohttp")
pytest.importorskip("watchfiles")
pytest.importorskip("igl")

MATERIAL = """[material]
name = "stone"
shading = "lit"
[[surface]]
technique = "base_color"
[[surface]]
technique = "pbr_constants"
surface_roughness = 0.5
"""
SECONDS = 20.0


@pytest.fixture
def stone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(preview_server, "library", lambda: Library({}, {}))
    folder = tmp_path / "stones"
    folder.mkdir()
    path = folder / "stone.toml"
    path.write_text(MATERIAL, encoding="utf-8")
    return path


class Page:
    """A page without a browser: it reads the messages."""

    def __init__(self, socket: Any) -> None:
        self.socket, self.messages = socket, 0

    async def until(self, holds: Callable[[dict[str, Any]], bool], seconds: float = SECONDS) -> dict[str, Any]:
        """The first message of which this is true."""
        end = time.monotonic() + seconds
        while True:
            message: dict[str, Any] = await asyncio.wait_for(self.socket.receive_json(), end - time.monotonic())
            self.messages += 1
            if holds(message):
                return message

    async def roughness(self, value: float, seconds: float = SECONDS) -> dict[str, Any]:
        """The first message whose picture has this value and no error."""

        def holds(message: dict[str, Any]) -> bool:
            return not message["error"] and roughness_of(message) == pytest.approx(value)

        return await self.until(holds, seconds)


def roughness_of(message: dict[str, Any]) -> float:
    controls = message["picture"]["controls"]
    return float(next(control["value"][0] for control in controls if control["label"] == "surface_roughness"))


def watched(stone: Path, pages: int, work: Callable[..., Awaitable[None]], opened: bool = False) -> list[str]:
    """Runs `work` with pages of a server that watches the files; what the server said."""
    said: list[str] = []

    async def run() -> None:
        server, ready = PreviewServer(PageMessages(Pane(str(stone)))), asyncio.Event()

        def hear(line: str) -> None:
            said.append(line)
            ready.set()

        running = asyncio.create_task(server.run(0, opened, hear))
        await asyncio.wait_for(ready.wait(), SECONDS)
        async with aiohttp.ClientSession() as client, contextlib.AsyncExitStack() as stack:
            connected = []
            for _ in range(pages):
                page = Page(await stack.enter_async_context(client.ws_connect(server.url + "events")))
                await page.roughness(0.5)
                connected.append(page)
            await work(*connected)
        running.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await running

    asyncio.run(run())
    return said


def save(stone: Path, value: float) -> None:
    stone.write_text(MATERIAL.replace("0.5", str(value)), encoding="utf-8")


def test_two_pages_show_each_save(stone: Path) -> None:
    async def work(one: Page, other: Page) -> None:
        save(stone, 0.625)
        assert (await one.roughness(0.625))["version"] == (await other.roughness(0.625))["version"] == 2

    watched(stone, 2, work)


def test_a_choice_on_one_page_is_shown_on_both(stone: Path) -> None:
    async def work(one: Page, other: Page) -> None:
        await one.socket.send_json({"kind": "shape", "shape": "cube"})
        for page in (one, other):
            await page.until(lambda message: message["picture"]["shape"] == "cube")

    watched(stone, 2, work)


def test_a_page_that_closes_does_not_keep_the_other_from_its_pictures(stone: Path) -> None:
    async def work(one: Page, other: Page) -> None:
        one.socket._response.connection.transport.abort()
        save(stone, 0.625)
        await other.roughness(0.625)
        await other.socket.send_json({"kind": "text", "target": "wgsl", "form": "shader"})
        await other.until(lambda message: message["kind"] == "text")

    watched(stone, 2, work)


def test_a_file_that_vanishes_is_an_error_until_it_is_back(stone: Path) -> None:
    async def work(page: Page) -> None:
        stone.unlink()
        lost = await page.until(lambda message: message["error"] != "")
        assert "stone" in lost["error"] and lost["picture"]["name"] == "stone"
        save(stone, 0.625)
        await page.roughness(0.625)

    watched(stone, 1, work)


def test_a_renamed_folder(stone: Path) -> None:
    async def work(page: Page) -> None:
        away = stone.parent.rename(stone.parent.with_name("away"))
        await page.until(lambda message: message["error"] != "")
        (away / "stone.toml").write_text(MATERIAL.replace("0.5", "0.625"), encoding="utf-8")
        away.rename(stone.parent)
        await page.roughness(0.625)
        save(stone, 0.75)
        await page.roughness(0.75)

    watched(stone, 1, work)


def test_a_half_written_file_ends_in_the_whole_picture(stone: Path) -> None:
    async def work(page: Page) -> None:
        text = MATERIAL.replace("0.5", "0.625")
        with stone.open("w", encoding="utf-8") as file:
            for start in range(0, len(text), 40):
                file.write(text[start : start + 40])
                file.flush()
                await asyncio.sleep(0.02)
        await page.roughness(0.625)

    watched(stone, 1, work)


def test_a_file_that_is_exchanged_for_another(stone: Path) -> None:
    """Editors write beside the file and rename."""

    async def work(page: Page) -> None:
        new = stone.with_suffix(".new")
        new.write_text(MATERIAL.replace("0.5", "0.625"), encoding="utf-8")
        new.replace(stone)
        await page.roughness(0.625)

    watched(stone, 1, work)


@pytest.mark.parametrize("saves", [40, pytest.param(1000, marks=pytest.mark.slow)])
def test_saves_at_a_thousand_a_minute(stone: Path, saves: int) -> None:
    async def work(page: Page) -> None:
        async def write() -> None:
            for number in range(saves):
                save(stone, 0.001 + 0.0005 * number)
                await asyncio.sleep(0.06 if saves > 100 else 0.005)

        writing = asyncio.create_task(write())
        await page.roughness(0.001 + 0.0005 * (saves - 1), SECONDS + saves * 0.1)
        await writing
        assert page.messages <= saves + 1

    watched(stone, 1, work)


def test_without_a_browser_the_address_is_to_be_opened(stone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("webbrowser.open", lambda _: False)

    async def work(_: Page) -> None:
        await asyncio.sleep(0.05)

    said = watched(stone, 1, work, opened=True)
    assert said[0].startswith("http://127.0.0.1:") and "no browser was found" in said[1]


def test_a_page_that_takes_nothing_does_not_hold_up_the_others(stone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    send, sent = aiohttp.web.WebSocketResponse.send_json, dict[int, int]()

    async def held(self: Any, message: Any) -> None:
        """The first page takes one picture only."""
        sent[id(self)] = sent.get(id(self), 0) + 1
        if id(self) == next(iter(sent)) and sent[id(self)] > 1:
            await asyncio.sleep(SECONDS)
        await send(self, message)

    monkeypatch.setattr(aiohttp.web.WebSocketResponse, "send_json", held)

    async def work(_: Page, other: Page) -> None:
        for value in (0.625, 0.75):
            save(stone, value)
            await other.roughness(value)

    watched(stone, 2, work)
    assert [*sent.values()] == [2, 3]
