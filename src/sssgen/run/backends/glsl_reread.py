"""GLSL as another compiler reads it, in the same driver: glslang makes SPIR-V, of which spirv-cross makes GLSL.

Where the driver gives the same for both texts, two compilers that share nothing read the author's text alike.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from sssgen.run.backends import call_program as calls
from sssgen.run.backends.backend_interface import Array, Call, Drawing, Stage, Text, backend_failure
from sssgen.run.backends.hlsl_spirv import cross_compile
from sssgen.run.backends.opengl import _SCREEN, HEADS, OpenGL
from sssgen.run.compilers import CompilerMissing, glslang


def reread(text: str) -> str:
    """The GLSL that spirv-cross makes of a fragment shader as glslang reads it.

    Raises ValueError with a log, and CompilerMissing.
    """
    text = re.sub(r"^#version 300 es", "#version 310 es", text)  # the first that SPIR-V has
    glsl, log = cross_compile(glslang.find().opengl_spirv(text, "fragment"))
    if not glsl:
        raise ValueError(f"spirv-cross: {log}")
    return glsl


def draw_reread(backend: OpenGL, drawing: Drawing) -> Array:
    """The picture of a drawing whose fragment stage is GLSL. Raises SssgenError, also where a program is missing."""
    try:
        text = Text(reread(backend.stages(drawing)[1]))
    except (ValueError, CompilerMissing) as error:
        raise backend_failure(backend.name, f"glslang: {error}") from None
    vertex = Stage(Text(HEADS["glsl-330"] + _SCREEN))
    return backend.draw(drawing._replace(vertex=vertex, fragment=drawing.fragment._replace(text=text)))


def run_reread(backend: OpenGL, text: Text, of: Sequence[Call]) -> list[Array]:
    """The results of calls of functions without textures."""
    drawing, layout = calls.drawing(backend.target, text, of, {})
    return calls.results(of, layout, draw_reread(backend, drawing))
