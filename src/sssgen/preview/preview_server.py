"""The server of the live preview: a page, and an event for it whenever a file that the picture depends on changes.

It listens on 127.0.0.1 only. The URL has a random token, and requests of pages of other origins are refused, so that
another page in the same browser can neither read the picture nor write a file.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import hmac
import secrets
import threading
import webbrowser
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from sssgen.preview.page_frames import MOST_BYTES, MOST_TEXT, parse, unpack
from sssgen.run.web_library import Library, library
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.extras import need
from sssgen.support.file_changes import changes

if TYPE_CHECKING:
    from sssgen.preview.page_messages import PageMessages

HOST = "127.0.0.1"
MOST_PORT = 65535
PAGE = Path(__file__).with_name("page")
TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
FILES = {path.name: TYPES[path.suffix] for path in sorted(PAGE.iterdir())}
"""The files of the page and their types."""
POLICY = (
    "default-src 'none'; script-src 'self' 'unsafe-inline' blob:; style-src 'self' 'unsafe-inline'; "
    "connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Nothing is fetched from elsewhere, and no other page shows this one in a frame. The import map is inline."""
IMPORT_MAP = '{"imports": {}}'
"""The text in index.html that the server replaces by the import map."""


MODULES = "<!-- modules -->"
"""The text in index.html in place of which all modules are named: a browser then asks for all at once."""


class PreviewServer:
    """The pages of one preview, and the pictures that they show.

    Where it gets none at first, `run` makes them while a browser starts and loads the page.
    """

    talk: PageMessages
    """The pictures; read with the lock `_making`, which is held while they are made"""

    def __init__(self, talk: PageMessages | None = None) -> None:
        self.web = need("aiohttp.web", "aiohttp", "preview")
        self.token, self.port = secrets.token_urlsafe(16), 0
        if talk is not None:
            self.talk = talk
        self.pages: dict[Any, asyncio.Event] = {}
        """Each page, with the event that it has not got the newest pictures."""
        self.library = Library({}, {})
        self._making = asyncio.Lock()

    @property
    def url(self) -> str:
        return f"http://{HOST}:{self.port}/{self.token}/"

    def application(self) -> Any:
        """The aiohttp application."""

        async def check_request(request: Any, handler: Callable[[Any], Awaitable[Any]]) -> Any:
            return await self._check_request(request, handler)

        application = self.web.Application(middlewares=[self.web.middleware(check_request)])
        application.router.add_get("/{token}/", self._index)
        application.router.add_get("/{token}/page/{name}", self._page_file)
        application.router.add_get("/{token}/library/{name:.+}", self._library_file)
        application.router.add_get("/{token}/piece/{digest}", self._piece)
        application.router.add_get("/{token}/events", self._events)
        return application

    async def run(
        self, port: int, opened: bool, ready: Callable[[str], None], make: Callable[[], PageMessages] | None = None
    ) -> None:
        """Serves until it is cancelled. `make` makes the pictures, in a thread, once the address is `ready`.

        Raises SssgenError where the port is in use or three.js is missing, and as `make` does.
        """
        self.library = library()
        if not 0 <= port <= MOST_PORT:
            raise failure(
                f"{port} is not a port", f"leave out --port, and a free one is taken; ports end at {MOST_PORT}"
            )
        runner = self.web.AppRunner(self.application())
        await runner.setup()
        try:
            site = self.web.TCPSite(runner, HOST, port)
            try:
                await site.start()
            except OSError as error:
                hint = "leave out --port, and a free one is taken"
                raise failure(f"port {port} cannot be used: {error.strerror or error}", hint) from None
            self.port = site._server.sockets[0].getsockname()[1]
            ready(self.url)
            opening = asyncio.create_task(self._open_browser(ready)) if opened else None
            if make is not None:
                async with self._making:
                    self.talk = await asyncio.to_thread(make)
            if opening is not None:
                await opening
            await self._watch()
        finally:
            for page in list(self.pages):
                with contextlib.suppress(Exception):
                    await page.close()
            await runner.cleanup()

    async def _open_browser(self, ready: Callable[[str], None]) -> None:
        if not await asyncio.to_thread(webbrowser.open, self.url):
            ready("no browser was found: open this address in one")

    # Requests

    async def _check_request(self, request: Any, handler: Callable[[Any], Awaitable[Any]]) -> Any:
        """Refuses what does not come from this page: another host, another origin, another token."""
        own = {f"{HOST}:{self.port}", f"localhost:{self.port}"}
        origin = request.headers.get("Origin")
        foreign = origin is not None and urlsplit(origin).netloc not in own
        token = request.match_info.get("token", "")
        if (
            request.headers.get("Host") not in own
            or foreign
            or not hmac.compare_digest(token.encode(), self.token.encode())
        ):
            raise self.web.HTTPForbidden(text="not this page")
        response = await handler(request)
        if not response.prepared:  # that of a web socket is
            response.headers.update(
                {
                    "Content-Security-Policy": POLICY,
                    "X-Content-Type-Options": "nosniff",
                    "Referrer-Policy": "no-referrer",
                    "Cross-Origin-Resource-Policy": "same-origin",
                    "Cache-Control": "no-store",
                }
            )
        return response

    async def _index(self, request: Any) -> Any:
        files = [
            *(f"library/{name}" for name in self.library.files),
            *(f"page/{name}" for name in FILES if name.endswith(".js")),
        ]
        named = "\n".join(f'<link rel="modulepreload" href="{file}">' for file in files)
        text = (PAGE / "index.html").read_text(encoding="utf-8")
        text = text.replace(IMPORT_MAP, self.library.import_map()).replace(MODULES, named)
        return self.web.Response(text=text, content_type=FILES["index.html"], charset="utf-8")

    async def _page_file(self, request: Any) -> Any:
        name = request.match_info["name"]
        if name not in FILES:
            raise self.web.HTTPNotFound
        return self._file(PAGE / name, FILES[name])

    async def _library_file(self, request: Any) -> Any:
        path = self.library.files.get(request.match_info["name"])
        if not path:
            raise self.web.HTTPNotFound
        return self._file(path, "text/javascript")

    def _file(self, path: Path, type_: str) -> Any:
        return self.web.Response(body=path.read_bytes(), content_type=type_, charset="utf-8")

    async def _piece(self, request: Any) -> Any:
        async with self._making:
            data = self.talk.piece(request.match_info["digest"])
        if data is None:  # of a picture that is no longer shown
            raise self.web.HTTPNotFound
        return self.web.Response(body=data, content_type="application/octet-stream")

    async def _events(self, request: Any) -> Any:
        """The messages of a page, until it closes."""
        page = self.web.WebSocketResponse(max_msg_size=MOST_BYTES + MOST_TEXT, heartbeat=20.0, compress=False)
        await page.prepare(request)
        self.pages[page] = asyncio.Event()
        self.pages[page].set()
        sending = asyncio.create_task(self._send(page, self.pages[page]))
        try:
            async for frame in page:
                try:
                    message, data = unpack(frame.data) if isinstance(frame.data, bytes) else (parse(frame.data), b"")
                    async with self._making:
                        reply = await asyncio.to_thread(self.talk.reply, message)
                    if reply:
                        await page.send_json(reply)
                    elif text := await self._change(functools.partial(self._answer, message, data)):
                        await page.send_json({"kind": "said", "text": text})
                except (ValueError, TypeError, KeyError, AttributeError):
                    await page.send_json({"kind": "error", "text": "the page sent a message that is not understood"})
                except SssgenError as error:
                    await page.send_json({"kind": "error", "text": str(error)})
        finally:
            sending.cancel()
            del self.pages[page]
        return page

    def _answer(self, message: dict[str, Any], data: bytes) -> str:
        return self.talk.answer(message, data)

    async def _send(self, page: Any, fresh: asyncio.Event) -> None:
        """Sends the newest pictures whenever there are new ones; a slow page misses those in between."""
        with contextlib.suppress(ConnectionError, RuntimeError):  # a page that closes
            while await fresh.wait():
                fresh.clear()
                async with self._making:
                    messages = self.talk.messages()
                for message in messages:
                    await page.send_json(message)

    # Changes

    async def _change(self, work: Callable[[], str | None]) -> str | None:
        """Does some work on the pictures, and sends them, or their errors, to all pages; the work's own result."""
        async with self._making:
            result = await asyncio.to_thread(work)
        for fresh in self.pages.values():
            fresh.set()
        return result

    async def _watch(self) -> None:
        """Renews the picture after each change of the files that it was made of, until it is cancelled."""
        loop, stop = asyncio.get_running_loop(), threading.Event()

        def wait() -> None:
            for _ in changes(lambda: self.talk.files, stop):
                asyncio.run_coroutine_threadsafe(self._change(self.talk.renew), loop).result()

        try:
            await asyncio.to_thread(wait)
        finally:
            stop.set()
