"""A file named .vert or .vs is a vertex shader, also where it does not write gl_Position."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source

TEXT = "in vec3 normal; out vec3 tint; void main() { tint = normal * 0.5; }"
ENTRIES = {"glsl-330": "main", "glsl-es-300": "main", "hlsl": "vertex_main", "wgsl": "vertex_main"}


@pytest.mark.parametrize("suffix", ["vert", "vs"])
@pytest.mark.parametrize("target", ENTRIES)
def test_the_suffix_decides(suffix: str, target: str, assert_compiles: Callable[[Source], None]) -> None:
    compiled = transpile(load_glsl_text(TEXT, f"case.{suffix}").module, target, "case", keep=True)
    (text,) = [content for name, content in compiled.files.items() if not name.endswith(".json")]
    assert compiled.reflection["files"][0]["stages"] == {"vertex": ENTRIES[target]}
    assert_compiles(Source(text, target, "vertex", ENTRIES[target], f"case.{suffix}"))


@pytest.mark.parametrize("name", ["case.frag", "case.fs", "case.glsl"])
def test_others_are_fragment_shaders(name: str) -> None:
    text = "in vec3 normal; out vec4 color; void main() { color = vec4(normal, 1.0); }"
    compiled = transpile(load_glsl_text(text, name).module, "wgsl", "case", keep=True)
    assert compiled.reflection["files"][0]["stages"] == {"fragment": "fragment_main"}


def test_a_library_of_vertex_functions_has_no_position() -> None:
    module = load_glsl_text("float twice(float x) { return x * 2.0; }", "case.vert").module
    assert not module.variables
