"""Unity's HLSL, run in OpenGL: preprocessed with Unity's headers (or the stand-ins), then as other HLSL."""

from __future__ import annotations

from functools import lru_cache

from .. import compilers
from ..compilers import unity
from .base import Text, gave_up
from .hlsl import HLSL


class UnityHLSL(HLSL):
    """The functions of a Unity target, inside what the engine includes around them."""

    def __init__(self, name: str, target: str, compiler: str) -> None:
        super().__init__(name, target, compiler)
        found = compilers.get("unity")
        assert isinstance(found, unity.Unity)
        self.unity = found

    def device(self) -> str:
        return f"{self.unity.headers()}, {super().device()}"

    def prepared(self, text: Text) -> Text:
        return text._replace(text=self._preprocessed(text.text))

    @lru_cache(16)  # noqa: B019 - a back end lives as long as the process
    def _preprocessed(self, text: str) -> str:
        try:
            return self.unity.preprocessed(text, self.target.name)
        except ValueError as error:
            raise gave_up(self.name, f"the preprocessor: {error}") from None
