"""What `sssgen lint` advises is accepted by it: each advice, written into the shader, is proven safe."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sssgen.cli.main import main

ADVISED = [
    "vec3 f(vec3 a) { return normalize(a); }",
    "float f(float a, float b) { return a / b; }",
    "vec3 f(vec3 a, vec3 b) { return a / b; }",
    "float f(float a) { return sqrt(a); }",
    "float f(float a) { return inversesqrt(a); }",
    "float f(float a, float b) { return pow(a, b); }",
    "vec2 f(vec2 a) { return log2(a); }",
    "float f(float a) { return acos(a); }",
    "float f(float a) { return acosh(a); }",
    "float f(float a) { return atanh(a); }",
    "float f(float a, float b) { return atan(a, b); }",
    "vec2 f(vec2 a, vec2 b) { return atan(a, b); }",
    "float f(float a, float b) { return mod(a, b); }",
    "int f(int a, int b) { return a / b; }",
    "int f(int a, int b) { return a % b; }",
    "float f(int b) { float v[3] = float[3](1.0, 2.0, 3.0); return v[b]; }",
]
"""A function whose last operation may fail; the advice is about its last argument, or about the call."""


@pytest.mark.parametrize("text", ADVISED)
def test_the_advice_is_accepted(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "shader.glsl"
    file.write_text(text)
    assert main(["lint", str(file), "--no-examples"]) == 1
    advice = re.search(r"write: (.*) in place of (the call|\w+)", capsys.readouterr().out)
    assert advice is not None
    new, old = advice[1], advice[2]
    head, _, body = text.rpartition("return ")
    if old == "the call":
        call = re.match(r"\w+\(.*\)(?=;)", body)
        assert call is not None
        body = f"({new}){body[call.end() :]}"
    else:
        *_, name = re.finditer(rf"\b{old}\b", body)
        body = f"{body[: name.start()]}({new}){body[name.end() :]}"
    file.write_text(f"{head}return {body}")
    assert main(["lint", str(file), "--no-examples"]) == 0, capsys.readouterr().out
