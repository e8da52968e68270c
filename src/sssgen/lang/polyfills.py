"""Compiles the polyfills and guards of the builtin table, which are written in the language of techniques."""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence

from sssgen.ir.formats import Format
from sssgen.ir.intrinsics import BUILTINS, Guard, by_column, with_constants
from sssgen.ir.nodes import Module
from sssgen.ir.signatures import instantiate, overload
from sssgen.ir.types import Matrix, Scalar, Type, column_size, spell
from sssgen.lang.loader import load_text

_GENERIC = re.compile(r"\b(?:(?:gen|vec)[FIUB]|vecR|mat[234]R|mat)\b")


def polyfill(name: str, types: Sequence[Type]) -> Module:
    """The module whose last function is the polyfill of the builtin `name` for arguments of these types.

    Raises KeyError where the table has none.
    """
    return _polyfill(name, tuple(types))


@functools.cache
def _polyfill(name: str, types: tuple[Type, ...]) -> Module:
    if overload(name, types) is None:
        raise KeyError(name)
    size, rows = max(map(column_size, types)), column_size(types[0])
    for source in _definitions(BUILTINS[name].polyfill):
        text = _GENERIC.sub(lambda match: _spelled(match.group(), size, rows), source)
        params = re.search(rf"\b{name}\(([^)]*)\)", text)
        if params is None:
            continue
        param_types = [param.split()[0] for param in params.group(1).split(",")]
        if param_types == [spell(type_) for type_ in types]:
            return load_text(text, f"intrinsics/{name}")
    raise KeyError(name, *types)


def guard(
    row: Guard, name: str, types: Sequence[Type], result: Type, format: Format, limits: tuple[float, float]
) -> tuple[Module, str]:
    """The function of a guard's text, and the letters of the arguments that it takes.

    `types` are those of the guarded operation's arguments, `result` that of its result. The function is called after
    the operation, `name`, and is to be called with the arguments named.
    """
    letters = "x" if row.replaces == "result" else "xyz"[: len(types)]
    type_of = {"x": result} if row.replaces == "result" else dict(zip(letters, types, strict=True))
    replaced = type_of.get(row.replaces, result)
    text = row.scalar if row.scalar and isinstance(replaced, Scalar) else row.text
    used = "".join(letter for letter in letters if re.search(rf"\b{letter}\b", text))
    text = with_constants(text, format, limits)
    if isinstance(replaced, Matrix):
        text = by_column(text, replaced, "".join(key for key, type_ in type_of.items() if isinstance(type_, Matrix)))
    text = text.replace("genF", spell(replaced))
    params = ", ".join(f"{spell(type_of[letter])} {letter}" for letter in used)
    body = text if text.startswith("{") else f"{{ return {text}; }}"
    doc = f"/// {row.doc}\n" if row.doc else ""
    return _guard(f"{doc}{spell(replaced)} {name}({params}) {body}", name), used


@functools.cache
def _guard(text: str, name: str) -> Module:
    return load_text(text, f"guards/{name}")


def _spelled(generic: str, size: int, rows: int) -> str:
    """A generic type's name at one size; '' where there is no such type."""
    type_ = instantiate(generic, size, rows)
    return spell(type_) if type_ is not None else ""


def _definitions(source: str) -> list[str]:
    """The function definitions in a polyfill's text."""
    parts, depth, start = [], 0, 0
    for index, char in enumerate(source):
        depth += (char == "{") - (char == "}")
        if char == "}" and depth == 0:
            parts.append(source[start : index + 1].strip())
            start = index + 1
    return parts
