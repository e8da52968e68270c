"""A page in a headless browser: how the browser is found, started and ended, and how messages reach the page.

This process serves the page on a port of 127.0.0.1 under a random path, and keeps the WebSocket that the page opens.
When either side ends, the other notices at once: the page then closes, and the browser with it.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import queue
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import weakref
from collections.abc import Iterator, Mapping, Sequence
from http import HTTPStatus
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:
    from websockets.http11 import Request, Response
    from websockets.sync.server import Server, ServerConnection

START = 60.0
"""Seconds that a browser has to start; one takes about one second."""

_QUIET = """--headless --no-first-run --no-default-browser-check --disable-quic --disable-sync --disable-extensions
 --disable-background-networking --disable-component-update --disable-breakpad --mute-audio"""
_HTML = (
    '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">'
    '<script type="importmap">{imports}</script><script type="module">{script}</script>'
)
WEBGPU = "--enable-unsafe-webgpu", "--use-webgpu-adapter={adapter}"
"""The switches of a page that uses WebGPU."""
WEBGL = "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"
"""Those of a page that uses WebGL on the CPU; with them, WebGPU has no adapter."""
_SILENT = logging.getLogger("sssgen.browser")
"""For the server, which reports every connection that a browser opens ahead of need and never uses."""
_SILENT.addHandler(logging.NullHandler())
_SILENT.propagate = False


FIREFOX = {
    "dom.webgpu.enabled": True,
    "gfx.webgpu.force-enabled": True,
    "gfx.webgpu.ignore-blocklist": True,
    "dom.allow_scripts_to_close_windows": True,
    "app.update.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
}
"""Firefox's preferences: WebGPU also on a driver that computes on the CPU, and no requests of its own."""


class LostError(Exception):
    """The page or its browser is gone; the message states the reason and follows the browser's name."""


class Page:
    """A browser with one page that runs `script`; both end with `close`, with this object, and with this process.

    `switches` are Chromium's, or None: the program is Firefox. `modules` are the files that the script may import, by
    their names in it. Raises LostError where the browser does not start.
    """

    def __init__(
        self,
        program: str,
        adapter: str,
        script: str,
        switches: Sequence[str] | None = WEBGPU,
        modules: Mapping[str, Path] = {},
    ) -> None:
        from websockets.exceptions import WebSocketException

        self._failures = (OSError, ValueError, WebSocketException)
        folder = tempfile.mkdtemp(prefix="sssgen-browser-")
        ending = contextlib.ExitStack()
        self.close = weakref.finalize(self, ending.close)
        path = f"/{secrets.token_urlsafe()}"
        connections: queue.Queue[ServerConnection] = queue.Queue()
        with tempfile.TemporaryFile() as log:
            try:
                files = {f"{path}/{file.name}": file for file in modules.values()}
                imports = json.dumps({"imports": {name: f"{path}/{file.name}" for name, file in modules.items()}})
                page = _HTML.format(imports=imports, script=script)
                server = _server(path, page, files, connections, ending)
                url = f"http://127.0.0.1:{server.socket.getsockname()[1]}{path}"
                flags = _firefox_flags(folder) if switches is None else _flags(folder, adapter, switches)
                self.process = _launch([program, *flags, url], folder, log)
                ending.callback(_end, self.process, folder)
                self._connection = self._first(connections)
            except BaseException as error:
                self.close()
                if isinstance(error, LostError):
                    raise LostError(f"{error}{_last_line(log)}") from None
                raise

    def alive(self) -> bool:
        """Whether the browser still runs."""
        # while another thread ends it, `poll` knows nothing
        return self.close.alive and self.process.poll() is None

    def send(self, head: str, data: bytes, seconds: float) -> None:
        """Sends a text and bytes to the page. Raises LostError."""
        with self._time_limit(seconds):
            self._connection.send(head)
            self._connection.send(data)

    def receive(self, seconds: float) -> tuple[dict[str, Any], bytes]:
        """The page's answer: JSON and bytes. Raises LostError, also where it takes longer."""
        with self._time_limit(seconds):
            return json.loads(self._connection.recv()), bytes(self._connection.recv(decode=False))

    def _first(self, connections: queue.Queue[ServerConnection]) -> ServerConnection:
        """The page's connection, once it is open."""
        deadline = time.monotonic() + START
        while time.monotonic() < deadline:
            if not self.alive():
                raise LostError(f"ended as it started (exit status {self.process.returncode})")
            with contextlib.suppress(queue.Empty):
                return connections.get(timeout=0.1)
        raise LostError(f"did not open its page within {START:g} seconds")

    @contextlib.contextmanager
    def _time_limit(self, seconds: float) -> Iterator[None]:
        """Ends the browser when a transfer takes longer or is interrupted: its rest would be read as the next one."""
        timed_out = threading.Event()

        def end() -> None:
            timed_out.set()
            self.close()

        timer = threading.Timer(seconds, end)
        timer.daemon = True
        timer.start()
        try:
            yield
        except self._failures:
            self.close()
            if timed_out.is_set():
                raise LostError(f"did not answer within {seconds:.3g} seconds, and was ended") from None
            raise LostError("crashed, or was ended by another program") from None
        except BaseException:
            self.close()
            raise
        finally:
            timer.cancel()


def _server(
    path: str,
    page: str,
    files: Mapping[str, Path],
    connections: queue.Queue[ServerConnection],
    ending: contextlib.ExitStack,
) -> Server:
    """A server that answers a GET of `path` with the page, and adds its WebSocket to `connections`."""
    from websockets.datastructures import Headers
    from websockets.http11 import Response
    from websockets.sync.server import serve

    closed = threading.Event()

    def respond(connection: ServerConnection, request: Request) -> Response | None:
        if request.path in files:
            return answer(files[request.path].read_bytes(), "text/javascript")
        if request.path != path:
            return connection.respond(HTTPStatus.NOT_FOUND, "")
        if "Upgrade" in request.headers:
            return None
        return answer(page.encode(), "text/html")

    def answer(body: bytes, kind: str) -> Response:
        fields = {"Content-Type": kind, "Content-Length": str(len(body)), "Connection": "close"}
        return Response(HTTPStatus.OK, "OK", Headers(fields), body)

    def hold(connection: ServerConnection) -> None:
        connections.put(connection)
        closed.wait()

    server = serve(
        hold, "127.0.0.1", 0, process_request=respond, compression=None, max_size=None, ping_interval=None,
        logger=_SILENT,
    )  # fmt: skip
    # The threads of the connections inherit that they are daemons.
    threading.Thread(target=server.serve_forever, daemon=True).start()
    # `shutdown` closes connections in a thread pool, which cannot start at the interpreter's exit; `hold` ends without.
    ending.callback(server.shutdown, close_connections=False)
    ending.callback(closed.set)
    return server


def _flags(folder: str, adapter: str, switches: Sequence[str]) -> list[str]:
    flags = [*_QUIET.split(), f"--user-data-dir={folder}", *(switch.format(adapter=adapter) for switch in switches)]
    if adapter != "swiftshader" and sys.platform == "linux":
        flags.append("--enable-features=Vulkan")
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    container = any(Path(mark).exists() for mark in ("/.dockerenv", "/run/.containerenv"))
    ci = os.environ.get("CI", "") not in ("", "0", "false")
    if root or container or ci:  # the sandbox does not start there, and shared memory may be 64 MB
        flags += ["--no-sandbox", "--disable-dev-shm-usage"]
    return flags


def _firefox_flags(folder: str) -> list[str]:
    """The command line; the profile in `folder` gets the preferences."""
    lines = [f'user_pref("{name}", {json.dumps(value)});\n' for name, value in FIREFOX.items()]
    Path(folder, "user.js").write_text("".join(lines), encoding="utf-8")
    return ["--headless", "--no-remote", "--profile", folder]


# A link in the profile leads to another folder of the browser, for a socket.
_RUN_AND_REMOVE = """
"$@"; status=$?
socket=$(readlink "$0/SingletonSocket") && case "$socket" in */org.chromium.*/*) rm -rf "${socket%/*}";; esac
rm -rf "$0"; exit $status
"""


def _launch(command: list[str], folder: str, log: IO[bytes]) -> subprocess.Popen[bytes]:
    """Starts the browser in a new session, so that all its processes can be ended and Ctrl-C does not reach it.

    A shell waits for it and removes its folder, as this process may be killed before.
    """
    posix = os.name == "posix"
    command = ["/bin/sh", "-c", _RUN_AND_REMOVE, folder, *command] if posix else command
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=log, start_new_session=posix)


def _end(process: subprocess.Popen[bytes], folder: str) -> None:
    if hasattr(os, "killpg"):
        with contextlib.suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()
    process.wait()
    with contextlib.suppress(OSError):
        socket_folder = Path(os.readlink(Path(folder) / "SingletonSocket")).parent
        if socket_folder.name.startswith("org.chromium."):
            shutil.rmtree(socket_folder, ignore_errors=True)
    for _ in range(20):  # processes of the browser may still write as they end
        shutil.rmtree(folder, ignore_errors=True)
        if not Path(folder).exists():
            break
        time.sleep(0.05)


def _last_line(log: IO[bytes]) -> str:
    """The last line that the browser wrote before it ended."""
    log.seek(0)
    lines = log.read().decode("utf-8", "replace").strip().splitlines()
    return f": {lines[-1][-300:]}" if lines else ""
