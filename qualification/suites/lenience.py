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
    "interpolation": Lenience(
        r"interpolation_mismatch",
        "the fragment shader decides on the interpolation, as in GLSL from 4.40 on",
    ),
    "Vulkan and OpenGL": Lenience(
        r"glslang/(nonVulkan|spv\.|vk\.|glspv)", "a text may have what OpenGL's GLSL and what Vulkan's has"
    ),
    OTHER: Lenience("", "no reason: to be refused"),
}
"""Name → class; the last one has all other cases."""


def class_of(case: str) -> str:
    """The class of a case by its name."""
    return next(name for name, lenience in LENIENCE.items() if re.search(lenience.cases, case))
