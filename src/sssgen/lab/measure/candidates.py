"""The candidates of a chart: every technique of the library at several settings, and the published baselines.

The settings are the technique's counts (steps, taps, rays), which trade speed for accuracy, over their `hint_range`;
its other parameters are fitted. Charts include a new technique of the library without further changes.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple

from sssgen.ir.nodes import Function, Uniform
from sssgen.ir.types import Sampler, kind_of
from sssgen.lab.measure.measured_chain import MaterialSection
from sssgen.lab.scene.scene_body import Body
from sssgen.lang.check.quantities import SCALARS
from sssgen.material import library, slots
from sssgen.material.library import Technique

ROLES = ("coordinates", "thickness", "translucency", "material")
"""The roles that have a reference. A surface's look (masks, waves, colours) is the artist's choice: it has no error."""

COUNTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
"""The values of a technique's counts: those up to its default, and the next larger one."""

PROBES = os.path.join(os.path.dirname(__file__), "probes")

PUBLISHED = os.path.join(os.path.dirname(__file__), "published.toml")
"""The file of the published baselines, which are complete chains."""


class Candidate(NamedTuple):
    """A point of a chart before it is measured."""

    role: str
    """coordinates, thickness, translucency or material"""
    name: str
    """The technique; for a material its chain, or the baseline's name"""
    label: str
    settings: tuple[tuple[str, int], ...]
    techniques: tuple[str, ...]
    """The chain's techniques, in order; empty for a chart's point without the role"""
    baseline: bool = False
    path: str = ""
    """The function of the length inside the body from a point in it, for techniques with a slot for it"""

    def stages(self, body: Body) -> tuple[MaterialSection, ...]:
        """The chain's stages, bound to a scene's body."""
        return tuple(self._stage(name, body) for name in self.techniques)

    def _stage(self, name: str, body: Body) -> MaterialSection:
        technique = load(name)
        section = "thickness" if technique.role == "conversion" else technique.role
        uniforms = {uniform.name for uniform in technique.uniforms}
        bind: list[tuple[str, str]] = []
        body_values: list[tuple[str, object]] = []
        waiting = list(technique.slots)
        while waiting:
            slot = waiting.pop()
            if is_path(slot):
                bind.append((slot.name, self.path))
                bound = load(self.path.partition(":")[0])
                uniforms |= {uniform.name for uniform in bound.uniforms}
                waiting += bound.slots
                continue
            in_world = slot.params[0].quantity == "world_position"
            bind.append((slot.name, body.function if in_world else slots.body("texture", slot.params[0].quantity)))
            body_values += body.parameters.items() if in_world else ()
        fixed = tuple((key, value) for key, value in self.settings if key in uniforms)
        values: dict[str, object] = dict(fixed)
        for key, value in body_values:
            values.setdefault(key, value)
        return MaterialSection(section, path_of(name), tuple(values.items()), tuple(values), tuple(bind))


def is_path(slot: Function) -> bool:
    """Whether a slot takes the length inside the body from a point in it, towards a light."""
    return len(slot.params) == 2 and slot.quantity == "thickness"


def load(name: str) -> Technique:
    """A technique of the library, or a probe of the lab. Raises SssgenError."""
    return library.load(path_of(name))


def path_of(name: str) -> str:
    """The reference to a technique in a material: the technique's name, or the path of a probe's file."""
    probe = os.path.join(PROBES, f"{name}.sss")
    return probe if os.path.isfile(probe) else name


def coordinates() -> list[Candidate]:
    """The techniques that move texture coordinates, and the candidate without one."""
    result = [Candidate("coordinates", "none", "none", (), ("shown_uv",))]
    for technique in of_role("coordinates"):
        result += [
            Candidate(
                "coordinates", technique.name, label(technique.name, counts), counts,
                (technique.name, "shown_uv"), technique.baseline,
            )
            for counts in settings(technique)
        ]  # fmt: skip
    return result


def thickness() -> list[Candidate]:
    """The techniques of a thickness, each converted to a length."""
    result = []
    for technique in of_role("thickness"):
        for to_length in routes(technique.function.quantity, "thickness"):
            for counts in settings(technique):
                chain = (technique.name, *to_length, "shown_thickness")
                legends = [load(name).attributes.legend for name in to_length]
                text = ", ".join([label(technique.name, counts), *filter(None, legends)])
                result.append(Candidate("thickness", technique.name, text, counts, chain, technique.baseline))
    return result


def translucency() -> list[Candidate]:
    """The techniques of translucency, after the exact thickness, and the candidate without one."""
    result = [Candidate("translucency", "none", "none", (), ())]
    for technique in of_role("translucency"):
        needed = quantity_read(technique)
        for route in routes("thickness", needed) if needed else [()]:
            thickness_chain = ("exact_thickness", *route) if needed else ()
            chain, baseline = (*thickness_chain, technique.name), technique.baseline
            result.append(Candidate("translucency", technique.name, technique.name, (), chain, baseline))
    return result


def materials(lengths: Sequence[Candidate]) -> list[Candidate]:
    """Complete chains: each thickness in `lengths` with each translucency, the published chains, the empty chain."""
    result = [Candidate("material", "none", "no translucency", (), ())]
    for name, chain in published().items():
        result.append(Candidate("material", name, name, (), chain, True))
    for light in of_role("translucency"):
        if is_published(light):
            continue
        needed = quantity_read(light)
        if not needed:
            result.append(Candidate("material", light.name, light.name, (), (light.name,)))
            continue
        for length in lengths:
            first = load(length.techniques[0])
            if is_published(first):
                continue
            to_length = length.techniques[1:-1]
            for route in _conversions(first.function.quantity, to_length, needed):
                chain = (first.name, *route, light.name)
                text = " → ".join((label(first.name, length.settings), *route, light.name))
                result.append(Candidate("material", " → ".join(chain), text, length.settings, chain))
    unique: dict[tuple[tuple[str, ...], Any], Candidate] = {}
    for candidate in result:  # the published chain of several equal ones comes first
        unique.setdefault((candidate.techniques, candidate.settings), candidate)
    return list(unique.values())


@cache
def published() -> dict[str, tuple[str, ...]]:
    """The published baselines: name → techniques."""
    with open(PUBLISHED, "rb") as file:
        return {chain["name"]: tuple(chain["techniques"]) for chain in tomllib.load(file)["chain"]}


def _conversions(quantity: str, to_length: tuple[str, ...], needed: str) -> Iterator[tuple[str, ...]]:
    """The conversions of a technique's quantity to the needed one: through a length, or directly."""
    if needed == quantity:
        yield ()
        return
    for route in routes("thickness", needed):
        yield (*to_length, *route)
    yield from routes(quantity, needed)


def routes(quantity: str, needed: str) -> list[tuple[str, ...]]:
    """The library's conversions from one quantity to another."""
    if quantity == needed:
        return [()]
    return [
        (technique.name,)
        for technique in of_role("conversion")
        if quantity_read(technique) == quantity and technique.function.quantity == needed
    ]


def needs(technique: Technique) -> str:
    """The data that a technique needs besides its parameters, as text; '' for none."""
    parts = []
    for slot in technique.slots:
        texture = slot.params[0].quantity != "world_position"
        parts.append(
            "the body as a distance texture (sssgen bake sdf)" if texture else "the body as a distance function"
        )
    for uniform in technique.uniforms:
        if isinstance(uniform.type, Sampler) and not technique.slots:
            holds = dict(uniform.hints).get("holds")
            parts.append(f"a baked {holds[0]} map" if holds else f"the {uniform.name.replace('_', ' ')}")
    return " and ".join(parts)


def is_constant(technique: Technique) -> bool:
    """Whether a thickness technique has the same value at every point."""
    return technique.role == "thickness" and not technique.function.params and not needs(technique)


def quantity_read(technique: Technique) -> str:
    """The scalar quantity that a technique reads, or ''."""
    return next((param.quantity for param in technique.function.params if param.quantity in SCALARS), "")


def of_role(role: str) -> list[Technique]:
    """The techniques of a role that charts show; the published techniques are last."""
    loaded = [library.load(name) for name in library.index()]
    techniques = [technique for technique in loaded if technique.role == role and not technique.attributes.uncharted]
    return sorted(techniques, key=lambda technique: is_published(technique))


def is_published(technique: Technique) -> bool:
    """Whether a technique has the form of a publication and serves only for comparison."""
    return bool(technique.attributes.superseded_by)


def settings(technique: Technique) -> list[tuple[tuple[str, int], ...]]:
    """The values of a technique's counts to chart; several counts have the same value."""
    counts = [uniform for uniform in technique.uniforms if kind_of(uniform.type) == "int"]
    if not counts:
        return [()]
    default = int(counts[0].default[0])
    largest = next((count for count in COUNTS if count > default), COUNTS[-1])
    values = [count for count in COUNTS if count <= largest and all(_within(uniform, count) for uniform in counts)]
    return [tuple((uniform.name, count) for uniform in counts) for count in values]


def _within(uniform: Uniform, count: int) -> bool:
    limits = dict(uniform.hints).get("hint_range")
    return limits is None or float(limits[0]) <= count <= float(limits[1])


def converged_counts(candidate: Candidate) -> tuple[tuple[str, int], ...]:
    """Counts at which the candidate should have converged: 64, or 20 each if there are two."""
    uniforms = {uniform.name: uniform for name in candidate.techniques for uniform in load(name).uniforms}
    limits = {name: dict(uniforms[name].hints).get("hint_range", (1, 64)) for name, _ in candidate.settings}
    count = 64 if len(limits) == 1 else 20
    return tuple((name, min(count, int(float(limits[name][1])))) for name, _ in candidate.settings)


def label(name: str, counts: Sequence[tuple[str, int]]) -> str:
    """The label of a technique at a setting: `march_light, 8 steps`."""
    if not counts:
        return name
    if len(counts) > 1 and len({count for _, count in counts}) == 1:
        return f"{name}, {counts[0][1]} × {counts[1][1]} steps"
    return f"{name}, " + ", ".join(f"{count} {key.replace('_', ' ')}" for key, count in counts)
