"""A Shadertoy shader as a whole GLSL program: the uniforms that the site declares before it, and a main() behind it."""

from __future__ import annotations

import re

from sssgen.run.compilers.compiler_interface import Source

LANGUAGE = "shadertoy"
CHANNELS = 4

_HEAD = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp samplerCube;
uniform vec3 iResolution;
uniform float iTime;
uniform float iTimeDelta;
uniform float iFrameRate;
uniform int iFrame;
uniform float iChannelTime[4];
uniform vec3 iChannelResolution[4];
uniform vec4 iMouse;
uniform vec4 iDate;
uniform float iSampleRate;
"""
_MAIN = """
out vec4 sssgen_shown;
void main() {
    sssgen_shown = vec4(0.0);
    mainImage(sssgen_shown, gl_FragCoord.xy);
}
"""


def as_program(source: Source) -> str:
    """The text of a source; a Shadertoy shader with what the site adds, so that line numbers stay as they were."""
    if source.language != LANGUAGE or source.stage != "fragment":
        return source.text
    return program(source.text)


def program(text: str) -> str:
    """A fragment shader that calls `mainImage`; a channel is a cube map where the text's head says so."""
    cubes = set(re.findall(r"^// iChannel(\d) is \w+, a cube map\.", text, re.MULTILINE))
    kinds = {str(number): "samplerCube" if str(number) in cubes else "sampler2D" for number in range(CHANNELS)}
    channels = "".join([f"uniform {kind} iChannel{number};\n" for number, kind in kinds.items()])
    return f"{_HEAD}{channels}#line 1\n{text}{_MAIN}"
