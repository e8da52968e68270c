"""`textureGatherOffsets`: four gathers, each with its own offset, of which one texel is taken."""

from __future__ import annotations

import pytest

from qualification.suites.compiled_texts import complaint
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError

CORNERS = "const ivec2 corners[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 2));\n"
SHADER = f"""#version 450
uniform sampler2D map;
uniform sampler2DShadow shade;
uniform isampler2DArray ids;
{CORNERS}
layout(location = 0) in vec4 p;
layout(location = 0) out vec4 color;
void main() {{
    color = textureGatherOffsets(map, p.xy * 2.0, corners) + textureGatherOffsets(map, p.xy, corners, 2);
    color += textureGatherOffsets(shade, p.xy, 0.5, corners) + vec4(textureGatherOffsets(ids, p.xyz, corners, 1));
}}
"""


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330", "glsl-es-300"])
def test_compilers_accept_them(target: str) -> None:
    files = transpile(load_glsl_text(SHADER, "a.frag").module, target, "a").files
    assert complaint({name: text for name, text in files.items() if not name.endswith(".json")}) == ""


def test_each_component_has_its_own_offset() -> None:
    text = next(iter(transpile(load_glsl_text(SHADER, "a.frag").module, "wgsl", "a").files.values()))
    assert "let place = p.xy * 2.0;" in text
    for offset in ("(-1, 0)", "(1, 0)", "(0, -1)", "(0, 2)"):
        assert f"textureGather(2, map, map_sampler, place_2, vec2i{offset}).a" in text


def test_offsets_are_constant() -> None:
    text = SHADER.replace("corners, 2)", "ivec2[4](ivec2(p.xy), ivec2(0), ivec2(1), ivec2(2)), 2)")
    with pytest.raises(SssgenError, match="the offset of textureGatherOffset must be a constant expression"):
        load_glsl_text(text, "a.frag")
    with pytest.raises(SssgenError, match=r"no overload of textureGatherOffsets takes \(sampler2D, vec2, ivec2\)"):
        load_glsl_text(SHADER.replace("corners, 2)", "corners[0])"), "a.frag")
