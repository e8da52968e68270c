"""Unity's HLSL, run in OpenGL: preprocessed with Unity's headers (or the stand-ins), then as other HLSL.

`whole` draws a whole shader; see `unity_program`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from sssgen.run import compilers
from sssgen.run.backends.backend_interface import Stage, Text, backend_failure
from sssgen.run.backends.hlsl_spirv import HLSL
from sssgen.run.backends.unity_program import UnityProgram
from sssgen.run.compilers import compiler_interface as base
from sssgen.run.compilers import unity_compiler as unity


class UnityHLSL(HLSL):
    """The functions of a Unity target, with the engine's headers."""

    def __init__(self, name: str, target: str, compiler: str) -> None:
        super().__init__(name, target, compiler)
        unity_compiler = compilers.get("unity")
        assert isinstance(unity_compiler, unity.Unity)
        self.unity = unity_compiler
        self.whole = UnityProgram(name, target, compiler)

    def device(self) -> str:
        return f"{self.unity.headers()}, {super().device()}"

    def prepare(self, text: Text) -> Text:
        try:
            return text._replace(text=_preprocess(self.unity, text.text, self.target.name))
        except ValueError as error:
            raise backend_failure(self.name, f"the preprocessor: {error}") from None

    def forward(self, shader: Text, stage: base.Stage, keywords: Sequence[str]) -> Stage:
        """A stage of an emitted shader's forward pass, as `whole` draws it; `keywords` are macros, `NAME=1`."""
        try:
            text, entry = self.unity.forward(shader.text, self.target.name, stage, keywords)
        except ValueError as error:
            raise backend_failure(self.name, f"the preprocessor: {error}") from None
        return Stage(shader._replace(text=text), entry)


@lru_cache(16)
def _preprocess(unity: unity.Unity, text: str, target: str) -> str:
    return unity.preprocess(text, target)
