"""The classes of programs that drivers refuse and sssgen accepts, each with its reason."""

from __future__ import annotations

import re
from typing import NamedTuple


class Lenience(NamedTuple):
    """A class."""

    cases: str
    """A regular expression for the names of its cases"""
    why: str


OTHER = "other"
LENIENCE = {
    "precision": Lenience(
        r"precision_conflict|unspecified_precision|differing_precision",
        "no other language has precisions: they are left out, so that those of two stages need not agree",
    ),
    "locations of uniforms": Lenience(
        r"uniform_location", "the places of uniforms are chosen anew: those of the text have no effect"
    ),
    "gl_FragData and gl_FragColor": Lenience(
        r"fragdata", "what both write is one output in the translation; the desktop's drivers accept more than one"
    ),
    "const of a parameter": Lenience(
        r"argument(_array)?_const|const_arg", "the constness of a parameter is not a part of a function's type here"
    ),
    "interfaces that differ": Lenience(
        r"interpolation_mismatch|layout_qualifier_mismatch|io_block|patch_(in|out)_usage|global_layout|invalid_type_",
        "stages are joined by the names of what they pass; what differs otherwise follows the fragment shader",
    ),
    "preprocessor": Lenience(
        r"preprocessor", "white space in macros, names that begin with GL_, and signs in `#if` are as in C"
    ),
    OTHER: Lenience("", "no reason: to be refused"),
}
"""Name → class; the last one has all other cases."""


def class_of(case: str) -> str:
    """The class of a case by its name."""
    return next(name for name, lenience in LENIENCE.items() if re.search(lenience.cases, case))
