"""What GLSL ES requires of precisions, which no other language has: that every type has one, and no other type.

Source: section 4.5 of GLSL ES 1.00 and 3.00, section 4.7 of 3.10 and 3.20. A text without `main` is a part of a shader,
whose precisions may be set elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from sssgen.lang.syntax.tokens import Token
from sssgen.support.diagnostics import Reporter

_LOW = frozenset(("sampler2D", "samplerCube", "samplerExternalOES", "atomic_uint"))
"""The opaque types that have a default precision in each stage."""
_END = frozenset(("SEMICOLON", "LBRACE", "RBRACE", "COMMA", "TYPE"))
"""The terminals after which a precision no longer applies."""


def check_precisions(tokens: Sequence[Token], is_fragment: bool, reporter: Reporter) -> None:
    """Reports types without a precision in a shader of GLSL ES, and precisions of types that have none."""
    is_whole = any(name.text == "main" and mark.text == "(" for name, mark in pairwise(tokens))
    defaults: list[set[str]] = [set() if is_fragment else {"float"}]
    """The types with a default precision, of each scope"""
    has_precision, is_default = False, False
    for token, after in pairwise(tokens):
        kind = token.type
        if kind == "TYPE":
            base = _base(token.text)
            if (is_default and base != token.text) or ((has_precision or is_default) and not base):
                hint = "only float, int, their vectors and matrices, and textures have one"
                reporter.error(token.span, f"'{token.text}' cannot have a precision here", hint)
            elif is_default:
                defaults[-1].add(base)
            elif is_whole and after.type == "NAME" and not has_precision and _is_without(base, defaults):
                defaults[0].add(base)  # reported once
                where = "fragment shaders of GLSL ES" if base == "float" else "GLSL ES"
                hint = f"write precision highp {base}; above it"
                reporter.error(token.span, f"'{base}' has no default precision in {where}", hint)
        if kind == "LBRACE":
            defaults.append(set())
        elif kind == "RBRACE" and len(defaults) > 1:
            defaults.pop()
        if kind == "PRECISION":
            has_precision = True
        elif kind == "DEFAULT_PRECISION":
            is_default = True
        elif kind in _END:
            has_precision = is_default = False


def _is_without(base: str, defaults: Sequence[set[str]]) -> bool:
    """Whether a type needs a precision, and none of these scopes has a default for it."""
    return base not in ("", "int", *_LOW) and not any(base in scope for scope in defaults)


def _base(name: str) -> str:
    """The type whose default precision a type has: `float` for `vec3`; '' for a type without precisions."""
    if name == "float" or name.startswith(("vec", "mat")):
        return "float"
    if name in ("int", "uint") or name.startswith(("ivec", "uvec")):
        return "int"
    return name if "sampler" in name or "image" in name or name == "atomic_uint" else ""
