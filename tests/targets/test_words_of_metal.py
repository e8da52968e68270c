"""The Metal printer: words of C++ that GLSL allows as names."""

from __future__ import annotations

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile


@pytest.mark.parametrize("word", ["asm", "char16_t", "char32_t", "register"])
def test_a_word_of_cpp_gets_another_name(word: str) -> None:
    text = f"#version 330\nfloat f(float {word}) {{ return {word} * {word}; }}\n"
    files = transpile(load_glsl_text(text, "case.glsl").module, "metal", "case").files
    assert f"{word}_ * {word}_" in files["case.functions.metal"]
