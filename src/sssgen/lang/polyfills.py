"""Instantiates the intrinsic table's polyfills: source in our own language, parsed by the same front end."""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence

from ..ir.intrinsics import BUILTINS
from ..ir.nodes import Module
from ..ir.signatures import instantiate, overload
from ..ir.types import Matrix, Type, components, spell

_GENERIC = re.compile(r"\b(?:(?:gen|vec)[FIUB]|mat)\b")


def polyfill(name: str, types: Sequence[Type]) -> Module:
    """The module whose last function is the polyfill of the builtin `name` for arguments of these types.

    Raises KeyError where the table has none.
    """
    return _polyfill(name, tuple(types))


@functools.cache
def _polyfill(name: str, types: tuple[Type, ...]) -> Module:
    from .loader import load_text

    found = overload(name, types)
    if found is None:
        raise KeyError(name)
    size = max(type_.size if isinstance(type_, Matrix) else components(type_) for type_ in types)
    for source in _definitions(BUILTINS[name].polyfill):
        text = _GENERIC.sub(lambda match: _spelled(match.group(), size), source)
        params = re.search(rf"\b{name}\(([^)]*)\)", text)
        if params is None:
            continue
        wanted = [param.split()[0] for param in params.group(1).split(",")]
        if wanted == [spell(type_) for type_ in types]:
            return load_text(text, f"intrinsics/{name}")
    raise KeyError(name, *types)


def _spelled(generic: str, size: int) -> str:
    """A generic type's name at one size; '' where it has no such size, which then matches nothing."""
    type_ = instantiate(generic, size)
    return spell(type_) if type_ is not None else ""


def _definitions(source: str) -> list[str]:
    """The functions of a polyfill text, one by one: each ends with a brace in the first column or on its line."""
    parts, depth, start = [], 0, 0
    for index, char in enumerate(source):
        depth += (char == "{") - (char == "}")
        if char == "}" and depth == 0:
            parts.append(source[start : index + 1].strip())
            start = index + 1
    return parts
