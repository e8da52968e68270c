"""What GLSL ES requires of precisions, which no other language has: that every type has one, and no other type.

Source: section 4.5 of GLSL ES 1.00 and 3.00, section 4.7 of 3.10 and 3.20. A text without `main` is a part of a shader,
whose precisions may be set elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from sssgen.ir.spans import Span
from sssgen.lang.syntax.tokens import Token
from sssgen.support.diagnostics import Reporter

_LOW = frozenset(("sampler2D", "samplerCube", "samplerExternalOES", "atomic_uint"))
"""The opaque types that have a default precision in each stage."""
_END = frozenset(("SEMICOLON", "LBRACE", "RBRACE", "COMMA", "TYPE"))
"""The terminals after which a precision no longer applies."""


def check_precisions(tokens: Sequence[Token], is_fragment: bool, reporter: Reporter) -> dict[Span, str]:
    """Reports types without a precision in a shader of GLSL ES, and precisions of types that have none.

    Gives the precision of each type that is followed by a name.
    """
    is_whole = any(name.text == "main" and mark.text == "(" for name, mark in pairwise(tokens))
    defaults = [{"int": "mediump"} if is_fragment else {"float": "highp", "int": "highp"}]
    """The precisions of types, of each scope"""
    defaults[0] |= dict.fromkeys(_LOW, "lowp")
    precisions: dict[Span, str] = {}
    own, is_default = "", False
    for token, after in pairwise(tokens):
        kind = token.type
        if kind == "TYPE":
            base = _base(token.text)
            default = next((scope[base] for scope in reversed(defaults) if base in scope), "")
            if (is_default and base != token.text) or ((own or is_default) and not base):
                hint = "only float, int, their vectors and matrices, and textures have one"
                reporter.error(token.span, f"'{token.text}' cannot have a precision here", hint)
            elif is_default:
                defaults[-1][base] = own
            elif after.type == "NAME" and base:
                precisions[token.span] = own or default
                if is_whole and not (own or default):
                    defaults[0][base] = "highp"  # reported once
                    where = "fragment shaders of GLSL ES" if base == "float" else "GLSL ES"
                    hint = f"write precision highp {base}; above it"
                    reporter.error(token.span, f"'{base}' has no default precision in {where}", hint)
        if kind == "LBRACE":
            defaults.append({})
        elif kind == "RBRACE" and len(defaults) > 1:
            defaults.pop()
        if kind == "PRECISION":
            own = token.text
        elif kind == "DEFAULT_PRECISION":
            is_default = True
        elif kind in _END:
            own, is_default = "", False
    return precisions


def _base(name: str) -> str:
    """The type whose default precision a type has: `float` for `vec3`; '' for a type without precisions."""
    if name == "float" or name.startswith(("vec", "mat")):
        return "float"
    if name in ("int", "uint") or name.startswith(("ivec", "uvec")):
        return "int"
    return name if "sampler" in name or "image" in name or name == "atomic_uint" else ""
