"""GLSL as another compiler reads it, in the same driver: glslang makes SPIR-V, of which spirv-cross makes GLSL.

Where the driver gives the same for both texts, two compilers that share nothing read the author's text alike.
"""

from __future__ import annotations

from sssgen.run.backends.backend_interface import Array, Drawing, Text, backend_failure
from sssgen.run.backends.hlsl_spirv import cross_compile
from sssgen.run.backends.opengl import OpenGL
from sssgen.run.compilers import CompilerMissing, glslang


def draw_reread(backend: OpenGL, drawing: Drawing) -> Array:
    """The picture of a drawing whose fragment stage is GLSL. Raises SssgenError, also where a program is missing."""
    try:
        module = glslang.find().opengl_spirv(drawing.fragment.text.text, "fragment")
        text, log = cross_compile(module)
    except (ValueError, CompilerMissing) as error:
        raise backend_failure(backend.name, f"glslang: {error}") from None
    if not text:
        raise backend_failure(backend.name, f"spirv-cross: {log}")
    return backend.draw(drawing._replace(fragment=drawing.fragment._replace(text=Text(text))))
