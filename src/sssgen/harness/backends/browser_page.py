"""A page of ours in a headless browser: how the browser is found, started and ended, and how bytes go to and fro.

This process listens on a port of 127.0.0.1 under a random path, serves the page there, and keeps the page's WebSocket
(RFC 6455). Either side sees in it at once that the other is gone: the page then closes, and the browser with it.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import selectors
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import weakref
from base64 import b64encode
from collections.abc import Iterator
from hashlib import sha1
from pathlib import Path
from typing import IO, Any

import numpy as np

START = 60.0
"""Seconds that a browser has to start; one takes about one second."""

_QUIET = """--headless --no-first-run --no-default-browser-check --disable-quic --disable-sync --disable-extensions
 --disable-background-networking --disable-component-update --disable-breakpad --mute-audio --enable-unsafe-webgpu"""
_HTML = '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><script type="module">{script}</script>'
_KEY = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
"""By which a WebSocket server shows that it is one (RFC 6455, 1.3)."""
_TEXT, _BYTES, _CLOSE, _CONTROL = 1, 2, 8, 8


class LostError(Exception):
    """The page or its browser is gone; the text says how, and goes after the browser's name."""


def find() -> str:
    """The browser's program: $SSSGEN_CHROMIUM if it is set, else one that is installed; '' where there is none."""
    named = os.environ.get("SSSGEN_CHROMIUM")
    if named:
        return shutil.which(named) or ""
    roots = [os.environ.get(name, "") for name in ("ProgramFiles", "ProgramFiles(x86)", "LocalAppData")]
    places = [
        *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"),
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
        "/Applications/Chromium.app/Contents/MacOS/Chromium",
        *(rf"{root}\Google\Chrome\Application\chrome.exe" for root in roots if root),
    ]
    return next((found for place in places if (found := shutil.which(place))), "")


class Page:
    """A browser with one page that runs `script`; both end with `close`, with this object, and with this process.

    Raises LostError where the browser does not start.
    """

    def __init__(self, program: str, adapter: str, script: str) -> None:
        folder = tempfile.mkdtemp(prefix="sssgen-browser-")
        ending = contextlib.ExitStack()
        self.close = weakref.finalize(self, ending.close)
        with socket.create_server(("127.0.0.1", 0)) as listener, tempfile.TemporaryFile() as said:
            path = f"/{secrets.token_urlsafe()}"
            url = f"http://127.0.0.1:{listener.getsockname()[1]}{path}"
            self.process = _launch([program, *_flags(folder, adapter), url], folder, said)
            ending.callback(_end, self.process, folder)
            try:
                self._socket = ending.enter_context(self._connection(listener, path, _HTML.format(script=script)))
            except BaseException as error:
                self.close()
                if isinstance(error, LostError):
                    raise LostError(f"{error}{_last_words(said)}") from None
                raise

    def alive(self) -> bool:
        """Whether the browser still runs."""
        return self.process.poll() is None

    def send(self, head: str, data: bytes, seconds: float) -> None:
        """A text and bytes for the page. Raises LostError."""
        self._socket.settimeout(seconds)
        with self._losing(seconds):
            for kind, message in ((_TEXT, head.encode()), (_BYTES, data)):
                self._socket.sendall(_header(kind, len(message)))
                self._socket.sendall(message)

    def receive(self, seconds: float) -> tuple[dict[str, Any], bytearray]:
        """What the page answers: JSON and bytes. Raises LostError, also where that takes longer."""
        until = time.monotonic() + seconds
        with self._losing(seconds):
            head = json.loads(self._message(until))
            return head, self._message(until)

    def _connection(self, listener: socket.socket, path: str, page: str) -> socket.socket:
        """The page's WebSocket, once the page was served; connections that ask for nothing are left waiting."""
        until = time.monotonic() + START
        with contextlib.ExitStack() as closing, selectors.DefaultSelector() as asking:
            asking.register(listener, selectors.EVENT_READ)
            while time.monotonic() < until:
                if not self.alive():
                    raise LostError(f"ended as it started (exit status {self.process.returncode})")
                for key, _ in asking.select(0.1):
                    if key.fileobj is listener:
                        asking.register(closing.enter_context(listener.accept()[0]), selectors.EVENT_READ)
                        continue
                    connection = key.fileobj
                    assert isinstance(connection, socket.socket)
                    asking.unregister(connection)
                    answer = _answer(_request(connection), path, page.encode())
                    with contextlib.suppress(OSError):
                        connection.sendall(answer)
                    if answer.startswith(b"HTTP/1.1 101"):
                        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                        return connection.dup()
                    connection.close()
        raise LostError(f"did not open its page within {START:g} seconds")

    def _message(self, until: float) -> bytearray:
        """The next message; a browser sends a long one in many frames."""
        parts = []
        while True:
            first, second = self._read(2, until)
            size = second & 127
            if size > 125:
                size = int.from_bytes(self._read(2 if size == 126 else 8, until), "big")
            mask = np.frombuffer(self._read(4, until), np.uint32)  # what comes from a browser is masked
            data = self._read(size, until)
            if first & 15 == _CLOSE:
                raise ConnectionError
            if first & _CONTROL:
                continue
            numbers = np.frombuffer(data, np.uint8)
            numbers ^= np.full(size // 4 + 1, mask[0]).view(np.uint8)[:size]
            parts.append(data)
            if first & 128:
                return parts[0] if len(parts) == 1 else bytearray().join(parts)

    def _read(self, size: int, until: float) -> bytearray:
        data = bytearray(size)
        view = memoryview(data)
        while view:
            self._socket.settimeout(max(until - time.monotonic(), 1e-3))
            got = self._socket.recv_into(view)
            if not got:
                raise ConnectionError
            view = view[got:]
        return data

    @contextlib.contextmanager
    def _losing(self, seconds: float) -> Iterator[None]:
        """Ends the browser where a transfer is broken off for any reason: the rest of it would be read as the next."""
        try:
            yield
        except TimeoutError:
            self.close()
            raise LostError(f"did not answer within {seconds:.3g} seconds, and was ended") from None
        except (OSError, ValueError):
            self.close()
            raise LostError("crashed, or was ended by somebody else") from None
        except BaseException:
            self.close()
            raise


def _flags(folder: str, adapter: str) -> list[str]:
    flags = [*_QUIET.split(), f"--user-data-dir={folder}", f"--use-webgpu-adapter={adapter}"]
    if adapter != "swiftshader" and sys.platform == "linux":
        flags.append("--enable-features=Vulkan")
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    container = any(Path(mark).exists() for mark in ("/.dockerenv", "/run/.containerenv"))
    ci = os.environ.get("CI", "") not in ("", "0", "false")
    if root or container or ci:  # where the sandbox cannot be made, and shared memory may be 64 MB
        flags += ["--no-sandbox", "--disable-dev-shm-usage"]
    return flags


# Beside its profile the browser has a folder for a socket, to which a link in the profile leads.
_RUN_AND_REMOVE = """
"$@"; status=$?
socket=$(readlink "$0/SingletonSocket") && case "$socket" in */org.chromium.*/*) rm -rf "${socket%/*}";; esac
rm -rf "$0"; exit $status
"""


def _launch(command: list[str], folder: str, said: IO[bytes]) -> subprocess.Popen[bytes]:
    """Starts the browser in a session of its own, so that all its processes can be ended, and Ctrl-C is not its matter.

    A shell waits for it and removes its folder: this process may be killed before.
    """
    posix = os.name == "posix"
    command = ["/bin/sh", "-c", _RUN_AND_REMOVE, folder, *command] if posix else command
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=said, start_new_session=posix)


def _end(process: subprocess.Popen[bytes], folder: str) -> None:
    if hasattr(os, "killpg"):
        import signal

        with contextlib.suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()
    process.wait()
    with contextlib.suppress(OSError):
        socket_folder = Path(os.readlink(Path(folder) / "SingletonSocket")).parent
        if socket_folder.name.startswith("org.chromium."):
            shutil.rmtree(socket_folder, ignore_errors=True)
    for _ in range(20):  # processes of the browser may still write as they go
        shutil.rmtree(folder, ignore_errors=True)
        if not Path(folder).exists():
            break
        time.sleep(0.05)


def _last_words(said: IO[bytes]) -> str:
    """The last line of what the browser wrote before it ended."""
    said.seek(0)
    lines = said.read().decode("utf-8", "replace").strip().splitlines()
    return f": {lines[-1][-300:]}" if lines else ""


def _request(connection: socket.socket) -> bytes:
    """The head of an HTTP request; what there is of it where it does not come whole."""
    connection.settimeout(5.0)
    head = b""
    with contextlib.suppress(OSError):
        while b"\r\n\r\n" not in head and len(head) < 65536 and (part := connection.recv(65536)):
            head += part
    return head


def _answer(request: bytes, path: str, page: bytes) -> bytes:
    """What a request gets: the page, or the agreement to a WebSocket (101)."""
    first, *rest = request.decode("latin-1").split("\r\n")
    if first.split(" ")[:2] != ["GET", path]:
        return b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
    fields = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in rest)}
    if fields.get("upgrade", "").lower() != "websocket":
        head = f"Content-Type: text/html\r\nContent-Length: {len(page)}\r\nConnection: close"
        return f"HTTP/1.1 200 OK\r\n{head}\r\n\r\n".encode() + page
    accept = b64encode(sha1((fields.get("sec-websocket-key", "") + _KEY).encode()).digest()).decode()
    head = f"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}"
    return f"HTTP/1.1 101 Switching Protocols\r\n{head}\r\n\r\n".encode()


def _header(kind: int, size: int) -> bytes:
    """The head of a frame that is a whole message."""
    if size < 126:
        return bytes([128 | kind, size])
    return (
        bytes([128 | kind, 126]) + size.to_bytes(2, "big")
        if size < 65536
        else (bytes([128 | kind, 127]) + size.to_bytes(8, "big"))
    )
