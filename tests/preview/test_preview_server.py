"""The server answers its own page only."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from sssgen.cli.main import main
from sssgen.preview import preview_server
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.preview.preview_server import FILES, HOST, PAGE, PreviewServer
from sssgen.run.web_library import Library
from sssgen.support.diagnostics import SssgenError

aiohttp = pytest.importorskip("aiohttp")
pytest.importorskip("watchfiles")
pytest.importorskip("igl")

MATERIAL = '[material]\nname = "stone"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'


@pytest.fixture
def server(tmp_path: Path) -> PreviewServer:
    path = tmp_path / "stone.toml"
    path.write_text(MATERIAL, encoding="utf-8")
    return PreviewServer(PageMessages(Pane(str(path))))


def asked(server: PreviewServer, ask: Callable[[Any], Awaitable[Any]]) -> Any:
    """The result of `ask` with a client of the running server."""

    async def run() -> Any:
        runner = server.web.AppRunner(server.application())
        await runner.setup()
        site = server.web.TCPSite(runner, HOST, 0)
        await site.start()
        server.port = site._server.sockets[0].getsockname()[1]
        try:
            async with aiohttp.ClientSession() as client:
                return await ask(client)
        finally:
            await runner.cleanup()

    return asyncio.run(run())


def status(server: PreviewServer, path: str, **headers: str) -> int:
    async def ask(client: Any) -> int:
        async with client.get(f"http://{HOST}:{server.port}/{path}", headers=headers) as answer:
            return int(answer.status)

    return int(asked(server, ask))


def test_the_page_and_its_files_are_served(server: PreviewServer) -> None:
    assert status(server, f"{server.token}/") == 200
    assert {status(server, f"{server.token}/page/{name}") for name in FILES} == {200}
    assert {path.name for path in PAGE.iterdir()} == set(FILES)
    assert status(server, f"{server.token}/piece/{server.talk.panes[0].picture.head['body']}") == 200


def test_the_policy_lets_nothing_out(server: PreviewServer) -> None:
    async def ask(client: Any) -> Any:
        async with client.get(server.url) as answer:
            return answer.headers

    headers = asked(server, ask)
    assert "default-src 'none'" in headers["Content-Security-Policy"] and headers["Referrer-Policy"] == "no-referrer"


@pytest.mark.parametrize("path", ["", "page/index.html", "wrong/", "wrong/page/preview.js", "wrong/events"])
def test_without_the_token_nothing_is_answered(server: PreviewServer, path: str) -> None:
    assert status(server, path) == 403 if "/" in path else status(server, path) in (403, 404)


@pytest.mark.parametrize(
    "headers",
    [{"Origin": "http://evil.example"}, {"Origin": "http://127.0.0.1:1"}, {"Origin": "null"}, {"Host": "evil.example"}],
)
def test_other_pages_are_refused(server: PreviewServer, headers: dict[str, str]) -> None:
    assert status(server, f"{server.token}/", **headers) == 403
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13"}
    assert (
        status(server, f"{server.token}/events", **headers, **upgrade, **{"Sec-WebSocket-Key": "A" * 22 + "=="}) == 403
    )


@pytest.mark.parametrize("name", ["page/..%2fpreview_server.py", "page/__init__.py", "library/..%2f..%2fx", "piece/0"])
def test_no_other_file_is_read(server: PreviewServer, name: str) -> None:
    assert status(server, f"{server.token}/{name}") == 404


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"kind": "save"}', '{"kind": "save", "values": {"tint": "x"}}',
                                  '{"kind": "shape", "shape": "../x"}', '{"kind": "other"}'])  # fmt: skip
def test_faulty_messages_do_no_harm(server: PreviewServer, text: str) -> None:
    async def ask(client: Any) -> list[Any]:
        async with client.ws_connect(server.url + "events") as socket:
            first = await socket.receive_json()
            await socket.send_str(text)
            return [first, await socket.receive_json()]

    first, second = asked(server, ask)
    assert (first["kind"], second["kind"]) == ("picture", "error")


def test_another_shape_is_another_body(server: PreviewServer) -> None:
    async def ask(client: Any) -> list[Any]:
        async with client.ws_connect(server.url + "events") as socket:
            first = await socket.receive_json()
            await socket.send_json({"kind": "shape", "shape": "cube"})
            return [first, await socket.receive_json()]

    first, second = asked(server, ask)
    assert second["picture"]["shape"] == "cube" and second["picture"]["body"] != first["picture"]["body"]


def test_a_port_in_use_is_an_error(server: PreviewServer, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import socket

    monkeypatch.setattr(preview_server, "library", lambda: Library({}, {}))
    with socket.socket() as taken:
        taken.bind((HOST, 0))
        taken.listen()
        with pytest.raises(SssgenError, match="cannot be used"):
            asyncio.run(server.run(taken.getsockname()[1], False, print))


def test_the_address_as_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    async def run(self: PreviewServer, port: int, opened: bool, ready: Callable[[str], None], make: None) -> None:
        ready(self.url)
        ready("no browser was found: open this address in one")

    monkeypatch.setattr(PreviewServer, "run", run)
    (tmp_path / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    assert main(["preview", str(tmp_path / "stone.toml"), "--json"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert json.loads(line)["address"].startswith(f"http://{HOST}")


def test_a_page_that_is_there_before_the_picture_gets_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "stone.toml"
    path.write_text(MATERIAL, encoding="utf-8")
    monkeypatch.setattr(preview_server, "library", lambda: Library({}, {}))
    server, connected = PreviewServer(), threading.Event()

    def make() -> PageMessages:
        assert connected.wait(30)
        return PageMessages(Pane(str(path)))

    async def run() -> dict[str, Any]:
        listening = asyncio.Event()
        serving = asyncio.create_task(server.run(0, False, lambda _: listening.set(), make))
        await listening.wait()
        async with aiohttp.ClientSession() as client, client.ws_connect(f"{server.url}events") as events:
            connected.set()
            message: dict[str, Any] = await events.receive_json(timeout=30)
        serving.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await serving
        return message

    message = asyncio.run(run())
    assert message["kind"] == "picture" and message["picture"]["name"] == "stone"


def test_pictures_that_cannot_be_made_end_the_server(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(preview_server, "library", lambda: Library({}, {}))

    def make() -> PageMessages:
        return PageMessages(Pane(str(tmp_path / "nothing.toml")))

    with pytest.raises(SssgenError, match=r"nothing\.toml"):
        asyncio.run(PreviewServer().run(0, False, print, make))
