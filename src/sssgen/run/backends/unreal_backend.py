"""Unreal's HLSL, run in OpenGL: behind the stand-in for the engine, then as other HLSL."""

from __future__ import annotations

from sssgen.run.backends.backend_interface import Text
from sssgen.run.backends.hlsl_spirv import HLSL
from sssgen.run.compilers import unreal_node


class UnrealHLSL(HLSL):
    """The functions of the target `unreal`, with the names that the engine declares."""

    def prepare(self, text: Text) -> Text:
        return text._replace(text=unreal_node.before(text.text))
