"""Shadertoy's convention (its page "How To"): `mainImage(out vec4, in vec2)` and its uniforms."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.lang.syntax.lexer import scan
from sssgen.lang.syntax.tokens import Token
from sssgen.support.diagnostics import failure

FILE = "shadertoy"
"""The name in messages for the lines that are added around a file's own."""

UNIFORMS = {
    "iResolution": "uniform vec3 iResolution : hint_range(1.0, 16384.0) = vec3(1.0);"
    "  // of the picture, in pixels; z is the pixels' aspect",
    "iTime": "uniform float iTime : hint_range(0.0, 1e6);  // seconds",
    "iGlobalTime": "uniform float iGlobalTime : hint_range(0.0, 1e6);  // iTime, as it was called",
    "iTimeDelta": "uniform float iTimeDelta;  // seconds for the last frame",
    "iFrameRate": "uniform float iFrameRate;  // frames a second",
    "iFrame": "uniform int iFrame;  // frames so far",
    "iChannelTime": "uniform float iChannelTime[4];  // seconds of each channel",
    "iChannelResolution": "uniform vec3 iChannelResolution[4];  // of each channel, in pixels",
    "iMouse": "uniform vec4 iMouse;  // xy where it is, zw where it was clicked, in pixels",
    "iDate": "uniform vec4 iDate;  // year, month, day, seconds",
    "iSampleRate": "uniform float iSampleRate;  // of sound",
    **{f"iChannel{n}": f"uniform sampler2D iChannel{n};" for n in range(4)},
}
"""Each is declared if a file uses it and does not declare it."""

_ENTRY = """out vec4 shadertoy_color;

void main() {
    mainImage(shadertoy_color, gl_FragCoord.xy);
}
"""


def is_scene(tokens: Sequence[Token]) -> bool:
    """Whether a file has a mainImage and no main of its own."""
    names = {token.text for token in tokens if token.type == "NAME"}
    return "mainImage" in names and "main" not in names


def with_entry(tokens: Sequence[Token], label: str) -> tuple[list[Token], str]:
    """A file's tokens between its uniforms and its `main()`, and the text that was added.

    Raises SssgenError for a file without a mainImage.
    """
    names = {token.text for token in tokens if token.type == "NAME"}
    if "mainImage" not in names:
        hint = "write void mainImage(out vec4 color, in vec2 coordinates) { … }"
        raise failure("there is no mainImage in this file", hint, label)
    own = {
        tokens[index + 2].text
        for index, token in enumerate(tokens[:-2])
        if token.type == "UNIFORM" and tokens[index + 2].type == "NAME"
    }
    after = "" if "main" in names else _ENTRY  # the file may have its own
    before = "\n".join([line for name, line in UNIFORMS.items() if name in names and name not in own])
    text = f"{before}\n{after}"
    lines = before.count("\n") + 2 if before else 2
    first, _ = scan(before, FILE)
    last, _ = scan(after, FILE, lines)
    return [*first, *tokens, *last], text
