"""What a program uses of its target's frame, and the functions and values that the used texts name in braces."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.surface_fields import NAMES
from sssgen.lang.check.quantities import SCALARS
from sssgen.support.diagnostics import UnsupportedError, failure
from sssgen.targets.descriptor import Target
from sssgen.targets.frame import LIGHT, SURFACE, stage_of, used_parts

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
    texts: list[tuple[str, str]] = []
    """Each with its stage."""
    for kind, names in entries.items() if shell is None else [("", shell)]:
        stage = LIGHT if kind in PER_LIGHT else SURFACE if kind == SURFACE else ""
        own = in_light if stage == LIGHT else target.inputs
        texts += [(stage, own.get(name, name)) for name in names]
    places = {**target.surface, **target.absent}
    sinks = {place: _rows(target, place, fields) if "color" not in entries else [] for place in places}
    of_sinks = [(stage_of(place), row) for place, rows in sinks.items() for row in rows]
    parts = {**target.frame, "ports": {name: name for name in target.ports}}
    frame = used_parts(parts, target.reads, [*texts, *of_sinks])
    surface = {place: "\n".join(rows) for place, rows in sinks.items()}
    return UsedFrame(target, facts, frame, surface, [text for _, text in texts])


def check_inputs(target: Target, entries: Mapping[str, Sequence[str]]) -> None:
    """Raises UnsupportedError for a value that a chain reads and an engine's shell does not have.

    It needs an expression, a part of the frame, or a port. `target` has its variants for the material.
    """
    declared = {name for texts in target.frame.values() for names in texts for name in names.split()}
    for kind, names in entries.items():
        own = {**target.inputs, **(target.light_inputs if kind in PER_LIGHT else {}), **target.ports}
        missing = [name for name in names if name not in own and name not in declared]
        if missing:
            hint = "leave out the stages that read it; in a target of your own, give it an expression in [inputs]"
            raise UnsupportedError(failure(f"{target.title} does not have the value '{missing[0]}'", hint).diagnostics)


def _chain_facts(entries: Mapping[str, Sequence[str]], fields: Collection[str]) -> set[str]:
    """Those of the descriptor's `FACTS` that a chain has."""
    facts = {kind for kind in PER_LIGHT if kind in entries}
    if "translucency" in entries:
        facts.add("subsurface" if OF_A_LIGHT.isdisjoint(entries["translucency"]) else "per_light")
    facts |= {"normal_mapped"} if "normal" in fields else set()
    framed = "normal" in fields or any(name in ("T", "B") for names in entries.values() for name in names)
    return facts | ({"tangent_frame"} if framed else set())


def _rows(target: Target, place: str, fields: Collection[str]) -> list[str]:
    """The texts of a place for the values of the surface, in the order of their table; then those for the lights."""
    given, absent = target.surface.get(place, {}), target.absent.get(place, {})
    texts = [given.get(name, "") if name in fields else absent.get(name, "") for name in (*NAMES, *SCALARS)]
    return [text for text in texts if text]


def named(used: UsedFrame, whole: bool = True) -> Iterator[str]:
    """The names in braces in all used texts; without the shell (`whole` is false), in what is passed to the chain."""
    shell = (*used.frame.values(), *used.surface.values()) if whole else ()
    for text in (*shell, *used.expressions):
        yield from _NAMED.findall(text)


def named_per_light(used: UsedFrame) -> Iterator[str]:
    """The same in the texts of the loop over the lights."""
    for place, text in (*used.frame.items(), *used.surface.items()):
        if stage_of(place) == LIGHT:
            yield from _NAMED.findall(text)


def with_names(text: str, names: Mapping[str, str]) -> str:
    """A text with these texts in place of the names in braces. Other braces stay."""
    return _NAMED.sub(lambda match: names.get(match[1], match[0]), text)
