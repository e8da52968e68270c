"""Unity's HLSL, run in OpenGL: preprocessed with Unity's headers (or the stand-ins), then as other HLSL.

Functions are run here; `whole` draws a whole shader (see `sssgen.harness.unity_shell`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from sssgen.harness import compilers
from sssgen.harness.backends.backend_interface import Stage, Text, gave_up
from sssgen.harness.backends.hlsl_spirv import HLSL
from sssgen.harness.backends.unity_program import UnityProgram
from sssgen.harness.compilers import compiler_interface as base
from sssgen.harness.compilers import unity_compiler as unity


class UnityHLSL(HLSL):
    """The functions of a Unity target, inside what the engine includes around them."""

    def __init__(self, name: str, target: str, compiler: str) -> None:
        super().__init__(name, target, compiler)
        found = compilers.get("unity")
        assert isinstance(found, unity.Unity)
        self.unity = found
        self.whole = UnityProgram(name, target, compiler)

    def device(self) -> str:
        return f"{self.unity.headers()}, {super().device()}"

    def prepared(self, text: Text) -> Text:
        try:
            return text._replace(text=_preprocessed(self.unity, text.text, self.target.name))
        except ValueError as error:
            raise gave_up(self.name, f"the preprocessor: {error}") from None

    def forward(self, shader: Text, stage: base.Stage, keywords: Sequence[str]) -> Stage:
        """A stage of an emitted shader's forward pass, as `whole` draws it; `keywords` are macros, `NAME=1`."""
        try:
            text, entry = self.unity.forward(shader.text, self.target.name, stage, keywords)
        except ValueError as error:
            raise gave_up(self.name, f"the preprocessor: {error}") from None
        return Stage(shader._replace(text=text), entry)


@lru_cache(16)
def _preprocessed(unity: unity.Unity, text: str, target: str) -> str:
    return unity.preprocessed(text, target)
