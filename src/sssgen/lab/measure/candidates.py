"""What is charted: every technique of the library at several settings, and every source as published.

The settings are the technique's counts (steps, taps, rays), which trade speed for accuracy, over their `hint_range`;
its other parameters are fitted. A new technique is charted as soon as its file is there.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, kind_of
from sssgen.lab.measure.measured_chain import Stage
from sssgen.lab.scene.scene_body import Body
from sssgen.lang.check.quantities import SCALARS
from sssgen.material import library, slots
from sssgen.material.library import Technique

ROLES = ("coordinates", "thickness", "translucency", "material")
"""The roles that have a reference. A surface's look (masks, waves, colours) is the artist's own: nothing is wrong."""

COUNTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
"""What a technique's counts are set to, up to its default and one more."""

PROBES = os.path.join(os.path.dirname(__file__), "probes")

PUBLISHED = os.path.join(os.path.dirname(__file__), "published.toml")
"""The published baselines as whole chains."""


class Candidate(NamedTuple):
    """One point of a chart before it is measured."""

    role: str
    """coordinates, thickness, translucency or material"""
    name: str
    """The technique, or of a material its chain or its source"""
    label: str
    settings: tuple[tuple[str, int], ...]
    techniques: tuple[str, ...]
    """The chain's techniques, in order; empty: the role is left out"""
    baseline: bool = False

    def stages(self, body: Body) -> tuple[Stage, ...]:
        """The chain's stages for a scene's body."""
        return tuple(self._stage(name, body) for name in self.techniques)

    def _stage(self, name: str, body: Body) -> Stage:
        technique = load(name)
        section = "thickness" if technique.role == "conversion" else technique.role
        uniforms = {uniform.name for uniform in technique.uniforms}
        fixed = tuple((key, value) for key, value in self.settings if key in uniforms)
        bind, values = [], []
        for slot in technique.slots:
            in_world = slot.params[0].quantity == "world_position"
            bind.append((slot.name, body.function if in_world else slots.body("texture", slot.params[0].quantity)))
            values += list(body.parameters.items()) if in_world else []
        own = {key for key, _ in fixed}
        given = (*fixed, *((key, value) for key, value in values if key not in own))
        return Stage(section, path_of(name), given, tuple(key for key, _ in given), tuple(bind))


def load(name: str) -> Technique:
    """A technique of the library, or a probe of the lab's. Raises SssgenError."""
    return library.load(path_of(name))


def path_of(name: str) -> str:
    """What a material calls a technique: its name, or a probe's file."""
    probe = os.path.join(PROBES, f"{name}.sss")
    return probe if os.path.isfile(probe) else name


def coordinates() -> list[Candidate]:
    """The techniques that move texture coordinates, and none."""
    found = [Candidate("coordinates", "none", "none", (), ("shown_uv",))]
    for technique in of_role("coordinates"):
        found += [
            Candidate("coordinates", technique.name, label(technique.name, given), given, (technique.name, "shown_uv"),
                      technique.baseline)
            for given in settings(technique)
        ]  # fmt: skip
    return found


def thickness() -> list[Candidate]:
    """The techniques that say how much matter there is, brought to a length."""
    found = []
    for technique in of_role("thickness"):
        for to_length in routes(technique.function.quantity, "thickness"):
            for given in settings(technique):
                chain = (technique.name, *to_length, "shown_thickness")
                legends = [load(name).attributes.legend for name in to_length]
                shown = ", ".join([label(technique.name, given), *filter(None, legends)])
                found.append(Candidate("thickness", technique.name, shown, given, chain, technique.baseline))
    return found


def translucency() -> list[Candidate]:
    """The techniques that say how much light comes through, after the exact thickness; and none."""
    found = [Candidate("translucency", "none", "none", (), ())]
    for technique in of_role("translucency"):
        wanted = quantity_taken(technique)
        for route in routes("thickness", wanted) if wanted else [()]:
            before = ("exact_thickness", *route) if wanted else ()
            chain, baseline = (*before, technique.name), technique.baseline
            found.append(Candidate("translucency", technique.name, technique.name, (), chain, baseline))
    return found


def materials(lengths: Sequence[Candidate]) -> list[Candidate]:
    """Whole chains: each thickness candidate given, with each translucency technique; the published ones; and none."""
    found = [Candidate("material", "none", "no translucency", (), ())]
    for name, chain in published().items():
        found.append(Candidate("material", name, name, (), chain, True))
    for light in of_role("translucency"):
        if is_published(light):
            continue
        wanted = quantity_taken(light)
        if not wanted:
            found.append(Candidate("material", light.name, light.name, (), (light.name,)))
            continue
        for length in lengths:
            first = load(length.techniques[0])
            if is_published(first):
                continue
            to_length = length.techniques[1:-1]
            for route in _onwards(first.function.quantity, to_length, wanted):
                chain = (first.name, *route, light.name)
                shown = " → ".join((label(first.name, length.settings), *route, light.name))
                found.append(Candidate("material", " → ".join(chain), shown, length.settings, chain))
    kept: dict[tuple[tuple[str, ...], Any], Candidate] = {}
    for one in found:  # a published chain that is also one of ours stays the published one
        kept.setdefault((one.techniques, one.settings), one)
    return list(kept.values())


@cache
def published() -> dict[str, tuple[str, ...]]:
    """The published baselines: name → techniques."""
    with open(PUBLISHED, "rb") as file:
        return {one["name"]: tuple(one["techniques"]) for one in tomllib.load(file)["chain"]}


def _onwards(quantity: str, to_length: tuple[str, ...], wanted: str) -> Iterator[tuple[str, ...]]:
    """The ways from a technique's quantity to the one wanted: by its length, or straight."""
    if wanted == quantity:
        yield ()
        return
    for route in routes("thickness", wanted):
        yield (*to_length, *route)
    yield from routes(quantity, wanted)


def routes(quantity: str, wanted: str) -> list[tuple[str, ...]]:
    """The conversions from one quantity to another: each way that the library has."""
    if quantity == wanted:
        return [()]
    found: list[tuple[str, ...]] = []
    for technique in of_role("conversion"):
        takes = quantity_taken(technique)
        if takes == quantity and technique.function.quantity == wanted:
            found.append((technique.name,))
    return found


def needs(technique: Technique) -> str:
    """What whoever uses a technique must have beside its parameters, in words; '' where that is nothing."""
    found = []
    for slot in technique.slots:
        texture = slot.params[0].quantity != "world_position"
        found.append(
            "the body as a distance texture (sssgen bake sdf)" if texture else "the body as a distance function"
        )
    for uniform in technique.uniforms:
        if isinstance(uniform.type, Sampler) and not technique.slots:
            holds = dict(uniform.hints).get("holds")
            found.append(f"a baked {holds[0]} map" if holds else f"the {uniform.name.replace('_', ' ')}")
    return " and ".join(found)


def is_constant(technique: Technique) -> bool:
    """Whether a thickness technique knows nothing of the place: it gives the same everywhere."""
    return technique.role == "thickness" and not technique.function.params and not needs(technique)


def quantity_taken(technique: Technique) -> str:
    """The scalar quantity that a technique reads, or ''."""
    return next((param.quantity for param in technique.function.params if param.quantity in SCALARS), "")


def of_role(role: str) -> list[Technique]:
    """The library's techniques of a role that are charted, the published ones last."""
    loaded = [library.load(name) for name in library.index()]
    of_it = [technique for technique in loaded if technique.role == role and not technique.attributes.uncharted]
    return sorted(of_it, key=lambda technique: is_published(technique))


def is_published(technique: Technique) -> bool:
    """Whether a technique is a source's own form, kept only for comparison."""
    return bool(technique.attributes.superseded_by)


def settings(technique: Technique) -> list[tuple[tuple[str, int], ...]]:
    """The values of a technique's counts to chart; two counts go together."""
    counts = [uniform for uniform in technique.uniforms if kind_of(uniform.type) == "int"]
    if not counts:
        return [()]
    usual = int(counts[0].default[0])
    most = next((count for count in COUNTS if count > usual), COUNTS[-1])
    values = [count for count in COUNTS if count <= most and all(_within(uniform, count) for uniform in counts)]
    return [tuple((uniform.name, count) for uniform in counts) for count in values]


def _within(uniform: Uniform, count: int) -> bool:
    limits = dict(uniform.hints).get("hint_range")
    return limits is None or float(limits[0]) <= count <= float(limits[1])


def most_counts(candidate: Candidate) -> tuple[tuple[str, int], ...]:
    """The candidate's counts so large that its setting may be taken as converged: 64, and of two counts 20 each."""
    uniforms = {one.name: one for name in candidate.techniques for one in load(name).uniforms}
    limits = {name: dict(uniforms[name].hints).get("hint_range", (1, 64)) for name, _ in candidate.settings}
    many = 64 if len(limits) == 1 else 20
    return tuple((name, min(many, int(float(limits[name][1])))) for name, _ in candidate.settings)


def label(name: str, given: Sequence[tuple[str, int]]) -> str:
    """What a chart calls a technique at a setting: `march_light, 8 steps`."""
    if not given:
        return name
    counts = {count for _, count in given}
    if len(given) > 1 and len(counts) == 1:
        return f"{name}, {given[0][1]} × {given[1][1]} steps"
    return f"{name}, " + ", ".join(f"{count} {key.replace('_', ' ')}" for key, count in given)
