"""What a text may not have in the version that it names: reserved words, and qualifiers in another order.

The rest of the front end accepts one language, which has all versions of GLSL in it. A text without `#version` follows
no rule of this module: it may be a part that an engine completes.
Source: section 3.8 of GLSL ES 1.00, section 3.9 of GLSL ES 3.00 and 3.7 of 3.10; section 4.7 of GLSL ES 3.00.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from sssgen.ir import out_builtins
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.projective_reads import PROJECTIVE_READS
from sssgen.lang.syntax.tokens import Token
from sssgen.support.diagnostics import Reporter

MOST_LETTERS = 1024
"""Of a name: GLSL ES 3.00, section 3.9."""

_ALWAYS = """
    asm class union enum typedef template this goto inline noinline public static extern external interface
    long short half fixed unsigned superp input output hvec2 hvec3 hvec4 fvec2 fvec3 fvec4 sampler3DRect sizeof cast
    namespace using
"""
_OLD = """
    packed switch default volatile flat double dvec2 dvec3 dvec4 sampler1D sampler1DShadow sampler2DRect
    sampler2DRectShadow
"""
_LATER = """
    attribute varying resource noperspective partition active filter common
    image1D iimage1D uimage1D image1DArray iimage1DArray uimage1DArray sampler1D isampler1D usampler1D sampler1DShadow
    sampler1DArray sampler1DArrayShadow isampler1DArray usampler1DArray sampler2DRect sampler2DRectShadow isampler2DRect
    usampler2DRect double dvec2 dvec3 dvec4
"""
_ONLY_300 = """
    coherent restrict readonly writeonly volatile atomic_uint patch sample subroutine
    image2D iimage2D uimage2D image3D iimage3D uimage3D imageCube iimageCube uimageCube image2DArray iimage2DArray
    uimage2DArray imageBuffer iimageBuffer uimageBuffer samplerBuffer isamplerBuffer usamplerBuffer
    sampler2DMS isampler2DMS usampler2DMS sampler2DMSArray isampler2DMSArray usampler2DMSArray
"""
RESERVED = {
    100: frozenset(f"{_ALWAYS} {_OLD}".split()),
    300: frozenset(f"{_ALWAYS} {_LATER} {_ONLY_300}".split()),
    310: frozenset(f"{_ALWAYS} {_LATER}".split()),
}
"""Version of GLSL ES → the words that no text may have."""

_NEWER = "write #version 300 es"
OTHER_NAME = "choose another name"
_BEFORE_KEYWORDS = frozenset({";", "{", "}", ")", ":", "else", "invariant"})
_INSTEAD = {
    "attribute": "write 'in'",
    "varying": "write 'out' in a vertex shader, 'in' in a fragment shader",
    **dict.fromkeys(("switch", "default", "flat"), _NEWER),
}
"""What is written in place of a word that another version has, where it stands for what it means there."""

_LATER_OPERATORS = frozenset({"%", "~", "<<", ">>", "&", "|", "^", "%=", "<<=", ">>=", "&=", "|=", "^="})
"""What GLSL ES 1.00 reserves."""

_LATER_TYPES = frozenset(["uint", "uvec2", "uvec3", "uvec4", *(f"mat{a}x{b}" for a in "234" for b in "234" if a != b)])
"""What GLSL ES 1.00 does not have."""

_ORDER = {
    "invariant": 0, "flat": 1, "smooth": 1, "const": 2, "centroid": 2, "uniform": 3, "attribute": 3, "varying": 3,
    "in": 3, "out": 3, "inout": 3, "lowp": 4, "mediump": 4, "highp": 4,
}  # fmt: skip
"""The place of a qualifier among others, up to GLSL ES 3.00."""


def _instead(before: Token | None, token: Token) -> str:
    """What to do about a reserved word: it is a name, unless a statement or declaration begins with it."""
    begins = before is None or before.text in _BEFORE_KEYWORDS
    return _INSTEAD.get(token.text, OTHER_NAME) if begins else OTHER_NAME


def check_version(tokens: Sequence[Token], version: int, profile: str, reporter: Reporter) -> None:
    """Reports what the version of a text does not have."""
    for token in tokens:
        if len(token.text) > MOST_LETTERS:
            reporter.error(token.span, f"a name has at most {MOST_LETTERS} letters, but this has {len(token.text)}")
    if version and profile == "es":
        shown = f"GLSL ES {version // 100}.{version % 100:02}"
        reserved = RESERVED[310 if version > 300 else version]
        for before, token in zip([None, *tokens], tokens, strict=False):
            if token.text in reserved:
                reporter.error(token.span, f"'{token.text}' is a reserved word of {shown}", _instead(before, token))
        for token in _keywords_as_names(tokens, version):
            reporter.error(token.span, f"'{token.text}' is a keyword of {shown}", OTHER_NAME)
        if version == 100:
            for token in tokens:
                if token.text in _LATER_OPERATORS:
                    reporter.error(token.span, f"{shown} has no operator '{token.text}'", _NEWER)
                elif token.text in _LATER_TYPES:
                    reporter.error(token.span, f"{shown} has no type '{token.text}'", _NEWER)
        if version < 310:
            for token in _misplaced(tokens):
                reporter.error(
                    token.span,
                    f"'{token.text}' is too late among these qualifiers for {shown}",
                    "the order is: invariant, flat, const, in, highp",
                )
    reporter.check()


def first_version(builtin: str) -> int:
    """The first version of GLSL ES that has a builtin function; 0 where none has it."""
    row = BUILTINS.get(builtin)
    if row is not None:
        return row.es
    return 300 if builtin in PROJECTIVE_READS else out_builtins.ES_VERSIONS.get(builtin, 0)


def _keywords_as_names(tokens: Sequence[Token], version: int) -> Iterator[Token]:
    """The keywords of GLSL ES behind a type: the parser takes them for names, as those of older texts."""
    keywords = ("invariant",) if version == 100 else ("flat", "smooth", "centroid", "invariant")
    for before, token in pairwise(tokens):
        if before.type == "TYPE" and token.text in keywords:
            yield token


def _misplaced(tokens: Sequence[Token]) -> Iterator[Token]:
    """The qualifiers that follow one which belongs behind them."""
    last = -1
    for token in tokens:
        place = _ORDER.get(token.text)
        if place is not None and place < last:
            yield token
        last = -1 if place is None else place
