"""The frame of a shell: what a target declares and computes so that the values exist which a program reads.

A descriptor has the frame as parts: a name and its text, grouped by the place of the template where the text goes
(`[frame.varyings]`, `[frame.vertex]`, …). A part is used if a used text mentions its name; the first texts are the
expressions of the values that the program reads. So the order of a place's parts is that of the descriptor, and a
template asks for a place, never for a value. What a varying needs in the vertex shader are parts of the same name in
places of the stage `vertex`. A section may list several places, which then have the same parts, each used by itself.

    [inputs]
    T = "T"

    [frame.varyings]
    v_tangent = "in vec4 v_tangent;"

    [frame.fragment]
    T = "vec3 T = safe_normalize(v_tangent.xyz);"
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeAlias

Parts: TypeAlias = Mapping[str, Mapping[str, str]]
"""Place → name of a part, or several names → its text."""

LIGHT = "light"
"""The stage inside the loop over the lights; its places begin with this word."""
VERTEX = "vertex"
"""The stage of the vertices, likewise. Texts of all three stages see their own places first, then those outside."""
SURFACE = "surface"
"""The stage of a function that computes the surface, where several passes of an engine call it."""
LIBRARY = "library"
"""The place of what the compiler's own text mentions: functions and types that the language does not have. Names of
this text are looked up here alone."""
VARYINGS = "varyings"
"""The place of what the vertex shader passes on: parts of the same names in its places compute it."""

_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*", re.ASCII)
"""A name, with those of its members."""


class Variant(NamedTuple):
    """What a descriptor has in addition, or in place of the same keys, for some materials."""

    inputs: Mapping[str, str] = {}
    light_inputs: Mapping[str, str] = {}
    frame: Mapping[str, Mapping[str, str]] = {}
    surface: Mapping[str, Mapping[str, str]] = {}
    absent: Mapping[str, Mapping[str, str]] = {}
    reads: tuple[str, ...] = ()
    """Names of parts that the template itself mentions."""

    def with_variant(self, other: Variant) -> Variant:
        """Both, where the keys of `other` win."""
        return Variant(
            {**self.inputs, **other.inputs},
            {**self.light_inputs, **other.light_inputs},
            _merged(self.frame, other.frame),
            _merged(self.surface, other.surface),
            _merged(self.absent, other.absent),
            self.reads + other.reads,
        )


def _merged(first: Parts, second: Parts) -> Parts:
    return {place: {**first.get(place, {}), **second.get(place, {})} for place in {**first, **second}}


def stage_of(place: str) -> str:
    """The stage of a place: that with whose name it begins, else that of the fragment."""
    first = place.partition("_")[0]
    return first if first in (LIGHT, VERTEX, SURFACE) else ""


def used_parts(parts: Parts, reads: Iterable[str], texts: Iterable[tuple[str, str]]) -> dict[str, str]:
    """The texts of the used parts by place, in the order of the descriptor.

    `reads` are names of parts that the template mentions, of the fragment or else of any stage; `texts` are the first
    texts that are used, each with its stage.
    """
    named: dict[str, list[tuple[str, str]]] = {}
    """Name → the keys of the parts that have it."""
    for place, texts_of_place in parts.items():
        for names in texts_of_place:
            for name in names.split():
                named.setdefault(name, []).append((place, names))
    used: set[tuple[str, str]] = set()
    pending = [key for name in reads for key in [*_mentioned(named, name, "")] or named.get(name, [])]
    pending += [key for stage, text in texts for key in _mentioned(named, text, stage)]
    while pending:
        place, names = key = pending.pop()
        if key not in used:
            used.add(key)
            pending += _mentioned(named, parts[place][names], stage_of(place))
    return {
        place: "\n".join([text for names, text in texts_of_place.items() if text and (place, names) in used])
        for place, texts_of_place in parts.items()
    }


def library(parts: Parts, printed: Iterable[str]) -> str:
    """The parts of the place `library` that the compiler's own texts mention."""
    own = parts.get(LIBRARY)
    return used_parts({LIBRARY: own}, (), [("", text) for text in printed])[LIBRARY] if own else ""


def _mentioned(named: Mapping[str, list[tuple[str, str]]], text: str, stage: str) -> Iterator[tuple[str, str]]:
    """The keys of the parts that a text of a stage mentions."""
    for path in _PATH.findall(text):
        members = path.split(".")
        for end in range(1, len(members) + 1):
            keys = named.get(".".join(members[:end]), [])
            visible = [key for key in keys if stage_of(key[0]) == stage]
            visible = visible or [key for key in keys if stage_of(key[0]) == ""]
            yield from visible
            if stage != VERTEX and any(place == VARYINGS for place, _ in visible):
                yield from [key for key in keys if stage_of(key[0]) == VERTEX]
