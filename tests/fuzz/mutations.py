"""Hypothesis strategies for files that are nearly right: a good file with a few edits, each of which shrinks away."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

WORDS = [
    b"", b"\0", b"\xff", b"\xef\xbb\xbf", b"\r\n", b"\r", b"\n", b"\t", b"\xed\xa0\x80", "é".encode(),
    "\u2028".encode(),
    "\u202e".encode(), b"\x1b[31m", b'"', b"'", b'"""', b"'''", b"/*", b"*/", b"//", b"///", b"#", b"#include \"",
    b"\\",
    b"(", b")", b"[", b"]", b"{", b"}", b"[[", b"]]", b"=", b"==", b",", b";", b":", b".", b"?", b"-", b"+", b"!", b"~",
    b"1", b"0", b"-1", b"1.0", b"1e999", b"-1e999", b"1e-999", b"0x", b"0xffffffffff", b"9" * 30, b"nan", b"inf",
    b"NaN", b"Infinity", b"-Infinity", b"true", b"null", b"1979-05-27", b"1979-05-27T07:32:00Z", b"float", b"vec3",
    b"mat4", b"sampler2D", b"void", b"uniform ", b"const ", b"struct ", b"return ", b"if (", b"for (", b"while (",
    b"out ",
    b"discard;", b"break;", b"thickness", b"x", b"\\ud800", b"{}", b"[]", b"@1:1:1-2", b"%s", b"..", b"/", b"../",
]  # fmt: skip
"""What to put in: pieces of the languages, and what upsets readers."""

NESTS = [
    (b"(", b")"),
    (b"[", b"]"),
    (b"{", b"}"),
    (b"-", b""),
    (b"!", b""),
    (b"a.", b""),
    (b"if (x) ", b""),
    (b"a+", b""),
]
DEPTHS = [1, 2, 31, 33, 99, 101, 1000, 10_000]


@st.composite
def mutated(draw: st.DrawFn, seeds: Sequence[bytes], binary: bool = False) -> bytes:
    """One of the files after up to six edits, or, rarely, any bytes at all."""
    if draw(st.integers(0, 19)) == 19:
        return draw(st.binary(max_size=300))
    data = draw(st.sampled_from(seeds))
    for _ in range(draw(st.integers(1, 6))):
        data = _edited(draw, data, seeds, binary)
    return data


def _edited(draw: st.DrawFn, data: bytes, seeds: Sequence[bytes], binary: bool) -> bytes:
    """The file after one edit of a part of it."""
    start = draw(st.integers(0, len(data)))
    end = min(len(data), start + draw(st.integers(0, 40)))
    part = data[start:end]
    kinds = ["cut", "twice", "bytes", "splice", "end"] + (["flip"] * 4 if binary else ["word"] * 4 + ["nest"])
    kind = draw(st.sampled_from(kinds))
    if kind == "word":
        part = draw(st.sampled_from(WORDS))
    elif kind == "cut":
        part = b""
    elif kind == "twice":
        part *= draw(st.sampled_from([2, 3, 50]))
    elif kind == "bytes":
        part = draw(st.binary(max_size=8))
    elif kind == "splice":
        other = draw(st.sampled_from(seeds))
        first = draw(st.integers(0, len(other)))
        part = other[first : first + draw(st.integers(0, 200))]
    elif kind == "end":
        return data[:start]
    elif kind == "flip":
        end, part = start + 1, bytes([draw(st.sampled_from([0, 1, 0x7F, 0x80, 0xFF]) | st.integers(0, 255))])
    else:
        opening, closing = draw(st.sampled_from(NESTS))
        depth = draw(st.sampled_from(DEPTHS))
        part = opening * depth + part + closing * depth
    return data[:start] + part + data[end:]
