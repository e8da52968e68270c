"""The overloads of the builtins, from the signatures of the intrinsic table; each is read when it is first needed.

There are no implicit conversions: an overload matches when every type is the same.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import product
from typing import NamedTuple

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import BY_NAME, Matrix, Type, vector_of

_SHAPED = re.compile(r"(mat|vec)([CR2-4]?[CR])")
"""Names with C for a number of columns and R for one of rows: matCR, mat2R, vecR."""
_KINDS = {"F": "float", "I": "int", "U": "uint", "B": "bool"}


class Overload(NamedTuple):
    """One overload: its result, and the parameters of the signature it comes from, as in `genF,float`."""

    result: Type
    params: str


_overloads: dict[str, dict[tuple[Type, ...], Overload]] = {}


def overloads(name: str) -> Mapping[tuple[Type, ...], Overload]:
    """All overloads of the builtin `name` by their parameters; none if there is no such builtin."""
    expanded = _overloads.get(name)
    if expanded is None:
        expanded = _overloads[name] = _expand(name)
    return expanded


def overload(name: str, types: Sequence[Type]) -> Overload | None:
    """The overload of the builtin `name` for exactly these types; None if there is none or no such builtin."""
    return overloads(name).get(tuple(types))


def resolve(name: str, types: Sequence[Type]) -> Type | None:
    """The result type of the builtin `name` for exactly these types; None if it has no such overload."""
    match = overload(name, types)
    return match.result if match else None


def candidates(name: str) -> list[str]:
    """The signatures of the builtin for messages, as in `genF mix(genF, genF, float)`; empty if there is none."""
    row = BUILTINS.get(name)
    return [signature.replace("(", f" {name}(", 1) for signature in row.signatures] if row else []


def text(name: str, language: str, types: Sequence[Type]) -> str:
    """How this overload is written in a language or dialect: an entry of `Builtin.texts`.

    Looks for the dialect's text of the overload, the dialect's, then the same for the language before the first `-`.
    Raises KeyError where there is no such overload.
    """
    match = overload(name, types)
    if match is None:
        raise KeyError(name, *types)
    return _text(name, language, match.params)


def texts(name: str, language: str) -> dict[str, str]:
    """How each signature of a builtin is written in a language or dialect, by the signature's parameters."""
    signatures = [",".join(parse(signature)[1:]) for signature in BUILTINS[name].signatures]
    return {params: _text(name, language, params) for params in signatures}


def _text(name: str, language: str, params: str) -> str:
    texts = BUILTINS[name].texts
    base = language.partition("-")[0]
    for key in (f"{language}/{params}", language, f"{base}/{params}", base):
        if key in texts:
            return texts[key]
    return name


def parse(signature: str) -> list[str]:
    """The type names of a signature, the result first: `"genF(genF, float)"` gives genF, genF, float."""
    result, _, params = signature.rstrip(")").partition("(")
    return [result, *(param.strip() for param in params.split(",") if param.strip())]


def instantiate(name: str, size: int, rows: int = 0) -> Type | None:
    """The type that a name of a signature means at one size; None if it has no such size, as vecF at 1.

    Of the names with C and R, `size` is the number of columns and `rows` that of rows, `size` if it is 0.
    """
    family, kind = name[:-1], _KINDS.get(name[-1])
    if kind and family in ("gen", "vec"):
        return vector_of(kind, size) if size > 1 or family == "gen" else None
    if name == "mat":
        return Matrix(size, size) if size > 1 else None
    shape = _SHAPED.fullmatch(name)
    if shape is None:
        return BY_NAME[name]
    counts = [{"C": size, "R": rows or size}.get(letter) or int(letter) for letter in shape[2]]
    if min(counts) == 1:
        return None
    return Matrix(counts[0], counts[1]) if shape[1] == "mat" else vector_of("float", counts[0])


def _expand(name: str) -> dict[tuple[Type, ...], Overload]:
    overloads: dict[tuple[Type, ...], Overload] = {}
    row = BUILTINS.get(name)
    for signature in row.signatures if row else ():
        names = parse(signature)
        is_shaped = any(map(_SHAPED.fullmatch, names))
        shapes = product((2, 3, 4), repeat=2) if is_shaped else ((size, size) for size in (1, 2, 3, 4))
        for size, rows in shapes:
            result, *params = (instantiate(type_name, size, rows) for type_name in names)
            if result is not None and None not in params:
                key = tuple(param for param in params if param is not None)
                overloads.setdefault(key, Overload(result, ",".join(names[1:])))
    return overloads
