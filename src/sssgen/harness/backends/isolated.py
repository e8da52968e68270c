"""A back end in a process of its own: a driver that crashes or hangs there does not take this process down.

gpu = isolated("gl")
gpu.run(text, calls)          # as any back end; SssgenError where the process died or took too long
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.harness import backends
from sssgen.harness.backends import Array, Backend, Call, CompilerMissing, Drawing, DrawingBackend, Text
from sssgen.harness.backends.backend_interface import gave_up
from sssgen.support.diagnostics import SssgenError
from sssgen.support.worker_process import LostError, Process
from sssgen.targets import registry
from sssgen.targets.numpy_textures import Texture

SECONDS = 300.0
"""How long one answer may take; software drivers compile large shaders slowly."""


class _Facts(NamedTuple):
    """What a back end says of itself."""

    device: str
    target: str
    top_first: bool


class Isolated(DrawingBackend):
    """Stands for a back end in another process, which is started anew after it was lost."""

    def __init__(self, name: str, seconds: float = SECONDS) -> None:
        self.name = name
        self.process = Process(__name__, name, seconds=seconds)
        try:
            self.facts: _Facts = self.process.start()
        except LostError as reason:
            raise gave_up(name, f"the back end {reason} as it started") from None
        self.target = registry.load(self.facts.target)
        self.top_first = self.facts.top_first

    def device(self) -> str:
        return self.facts.device

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        found: list[Array] = self._ask("run", text, calls, textures)
        return found

    def draw(self, drawing: Drawing) -> Array:
        found: Array = self._ask("draw", drawing)
        return found

    def apply(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of `function(back end, *arguments)`, computed in the other process."""
        return self._ask("apply", function, arguments)

    def close(self) -> None:
        """Ends the process."""
        self.process.close()

    def _ask(self, what: str, *given: Any) -> Any:
        try:
            return self.process.ask((what, given))
        except LostError as reason:
            raise gave_up(self.name, f"the back end {reason}", "the rest goes on without it") from None


def isolated(name: str, seconds: float = SECONDS) -> Isolated:
    """The back end of that name in a process of its own. Raises CompilerMissing where this machine lacks it."""
    return Isolated(name, seconds)


def started(name: str) -> Backend:
    """A back end whose driver cannot harm this process; NumPy has none. Raises as `isolated` does."""
    return isolated(name) if backends.BACKENDS[name].driver else backends.get(name)


def serve(name: str) -> tuple[_Facts, Callable[[tuple[str, tuple[Any, ...]]], Any]]:
    """What the other process says first, and what answers. Raises CompilerMissing."""
    backend = backends.get(name)

    def answer(question: tuple[str, tuple[Any, ...]]) -> Any:
        what, given = question
        try:
            if what == "apply":
                function, arguments = given
                return function(backend, *arguments)
            return getattr(backend, what)(*given)
        except (SssgenError, CompilerMissing):
            raise
        except Exception as error:
            raise gave_up(name, f"{type(error).__name__}: {error}") from None

    return _Facts(backend.device(), backend.target.name, getattr(backend, "top_first", False)), answer
