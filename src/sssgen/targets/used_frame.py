"""What a program uses of its target's frame, and the functions and values that the used texts name in braces."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.surface_fields import NAMES
from sssgen.targets.descriptor import Target
from sssgen.targets.frame import LIGHT, stage_of, used_parts

PER_LIGHT = ("translucency", "lighting")
"""The kinds of the entries that a shell calls once per light."""
OF_A_LIGHT = frozenset({"L", "L_object", "light_color", "light_nearness"})
"""The inputs that differ from light to light."""

_NAMED = re.compile(r"\{(\w+)\}", re.ASCII)


class UsedFrame(NamedTuple):
    """The texts by place in the templates."""

    target: Target
    """The target with its variants for the material's chain."""
    facts: Collection[str]
    """The properties of this chain."""
    frame: Mapping[str, str]
    """The used parts of the frame."""
    surface: Mapping[str, str]
    """What gives the values of the surface to the engine."""
    expressions: Sequence[str]
    """What the shell passes to the chain."""


def used_frame(
    target: Target, entries: Mapping[str, Sequence[str]], shell: Sequence[str] | None, fields: Collection[str]
) -> UsedFrame:
    """What a program uses of the frame.

    `entries` are the inputs of the chain's functions by kind, `shell` the values that the shell of a target without an
    engine reads, `fields` the values of the surface.
    """
    facts = _chain_facts(entries, fields)
    target = target.for_material(facts)
    in_light = {**target.inputs, **target.light_inputs}
    if shell is not None:
        texts, light_texts = [target.inputs.get(name, name) for name in shell], []
    else:
        others = [name for kind, names in entries.items() if kind not in PER_LIGHT for name in names]
        texts = [target.inputs.get(name, name) for name in others]
        light_texts = [in_light.get(name, name) for kind in PER_LIGHT for name in entries.get(kind, ())]
    expressions = [*texts, *light_texts]
    sinks = {place: _rows(target, place, fields) for place in {**target.surface, **target.absent}}
    for place, rows in sinks.items():
        (light_texts if stage_of(place) == LIGHT else texts).extend(rows)
    frame = used_parts(target.frame, target.reads, texts, light_texts)
    return UsedFrame(target, facts, frame, {place: "\n".join(rows) for place, rows in sinks.items()}, expressions)


def _chain_facts(entries: Mapping[str, Sequence[str]], fields: Collection[str]) -> set[str]:
    """Those of the descriptor's `FACTS` that a chain has."""
    facts = {kind for kind in PER_LIGHT if kind in entries}
    if "translucency" in entries:
        facts.add("subsurface" if OF_A_LIGHT.isdisjoint(entries["translucency"]) else "per_light")
    return facts | ({"normal_mapped"} if "normal" in fields else set())


def _rows(target: Target, place: str, fields: Collection[str]) -> list[str]:
    """The texts of a place for the values of the surface, in the order of their table."""
    given, absent = target.surface.get(place, {}), target.absent.get(place, {})
    texts = [given.get(name, "") if name in fields else absent.get(name, "") for name in NAMES]
    return [text for text in texts if text]


def named(used: UsedFrame) -> Iterator[str]:
    """The names in braces in all used texts."""
    for text in (*used.frame.values(), *used.surface.values(), *used.expressions):
        yield from _NAMED.findall(text)


def named_per_light(used: UsedFrame) -> Iterator[str]:
    """The same in the texts of the loop over the lights."""
    for place, text in (*used.frame.items(), *used.surface.items()):
        if stage_of(place) == LIGHT:
            yield from _NAMED.findall(text)


def with_names(text: str, names: Mapping[str, str]) -> str:
    """A text with these texts in place of the names in braces. Other braces stay."""
    return _NAMED.sub(lambda match: names.get(match[1], match[0]), text)
