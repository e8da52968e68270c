"""A back end in its own process: a driver that crashes or hangs there does not affect this process.

gpu = BackendProcess("gl")
gpu.run(text, calls)          # as any back end; SssgenError where the process died or took too long
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.run import backends
from sssgen.run.backends import Array, Backend, Call, CompilerMissing, Drawing, DrawingBackend, Text
from sssgen.run.backends.backend_interface import backend_failure
from sssgen.support.diagnostics import SssgenError
from sssgen.support.worker_process import LostError, Process
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

SECONDS = 300.0
"""How long one answer may take; software drivers compile large shaders slowly."""


class _Facts(NamedTuple):
    """The attributes of the back end in the other process."""

    device: str
    target: str
    top_first: bool


class BackendProcess(DrawingBackend):
    """The proxy of a back end in another process, which is restarted after it was lost.

    Raises CompilerMissing where this machine lacks the back end, SssgenError where it does not start.
    """

    def __init__(self, name: str, seconds: float = SECONDS) -> None:
        self.name = name
        self.process = Process(__name__, name, seconds=seconds)
        try:
            self.facts: _Facts = self.process.start()
        except LostError as reason:
            raise backend_failure(name, f"the back end {reason} as it started") from None
        self.target = registry.load(self.facts.target)
        self.top_first = self.facts.top_first

    def device(self) -> str:
        return self.facts.device

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        results: list[Array] = self._ask("run", text, calls, textures)
        return results

    def draw(self, drawing: Drawing) -> Array:
        picture: Array = self._ask("draw", drawing)
        return picture

    def apply(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of `function(back end, *arguments)`, computed in the other process."""
        return self._ask("apply", function, arguments)

    def limit_time(self, seconds: float) -> None:
        """How long each further answer may take."""
        self.process.seconds = seconds

    def close(self) -> None:
        """Ends the process."""
        self.process.close()

    def _ask(self, method: str, *arguments: Any) -> Any:
        try:
            return self.process.ask((method, arguments))
        except LostError as reason:
            raise backend_failure(self.name, f"the back end {reason}", "the others continue without it") from None


def start_backend(name: str) -> Backend:
    """The back end of that name, in its own process if a driver computes. Raises CompilerMissing, or SssgenError."""
    return BackendProcess(name) if backends.BACKENDS[name].driver else backends.get(name)


def serve(name: str) -> tuple[_Facts, Callable[[tuple[str, tuple[Any, ...]]], Any]]:
    """The first answer of the other process, and its function for questions. Raises CompilerMissing."""
    backend = backends.get(name)

    def answer(question: tuple[str, tuple[Any, ...]]) -> Any:
        method, arguments = question
        try:
            if method == "apply":
                function, rest = arguments
                return function(backend, *rest)
            return getattr(backend, method)(*arguments)
        except (SssgenError, CompilerMissing):
            raise
        except Exception as error:
            raise backend_failure(name, f"{type(error).__name__}: {error}") from None

    return _Facts(backend.device(), backend.target.name, getattr(backend, "top_first", False)), answer
