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

from sssgen.ir.frame_passes import DISTANT_VIEWS, pass_name
from sssgen.ir.nodes import Function, Uniform
from sssgen.ir.types import Sampler, kind_of
from sssgen.lab.measure.fluence_inputs import INNER, PREFIX
from sssgen.lang.check.quantities import SCALARS
from sssgen.material import library, slots
from sssgen.material.library import Technique
from sssgen.material.material_text import MaterialSection
from sssgen.scene.measured.scene_body import Body

ROLES = ("coordinates", "thickness", "view_thickness", "translucency", "material")
"""The roles that have a reference. A surface's look (masks, waves, colours) is the artist's choice: it has no error."""

VIEW = "view_thickness"
"""The quantity of the length along the eye's ray, and the role of the techniques that give it."""

COUNTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
"""The values of a technique's counts: those up to its default, and the next larger one."""

INDEX = "ior"
"""The parameter for the refractive index of a medium."""

PROBES = os.path.join(os.path.dirname(__file__), "probes")

PUBLISHED = os.path.join(os.path.dirname(__file__), "published.toml")
"""The file of the published baselines, which are complete chains."""


class Candidate(NamedTuple):
    """A point of a chart before it is measured."""

    role: str
    """One of ROLES"""
    name: str
    """The technique; for a material its chain, or the baseline's name"""
    label: str
    settings: tuple[tuple[str, int], ...]
    techniques: tuple[str, ...]
    """The chain's techniques, in order; empty for a chart's point without the role"""
    baseline: bool = False
    path: str = ""
    """The function of the length inside the body from a point in it, for techniques with a slot for it"""
    path_settings: tuple[tuple[str, int], ...] = ()
    """The counts of `path`, which may have the same names as those of the chain"""

    def stages(self, body: Body) -> tuple[MaterialSection, ...]:
        """The chain's stages, bound to a scene's body."""
        return tuple(self._stage(name, body) for name in self.techniques)

    def _stage(self, name: str, body: Body) -> MaterialSection:
        technique = load(name)
        section = "thickness" if technique.role == "conversion" else technique.role
        fixed = _counts(technique, self.settings)
        spans = _spans(technique)
        bind: list[tuple[str, str]] = []
        body_values: list[tuple[str, object]] = []
        waiting = list(technique.slots)
        while waiting:
            slot = waiting.pop()
            if is_path(slot):
                bind.append((slot.name, self.path))
                bound = load(self.path.partition(":")[0])
                fixed |= _counts(bound, self.path_settings)
                spans += _spans(bound)
                waiting += bound.slots
                continue
            in_world = slot.params[0].quantity == "world_position"
            bind.append((slot.name, body.function if in_world else slots.body("texture", slot.params[0].quantity)))
            body_values += body.parameters.items() if in_world else ()
        values: dict[str, object] = {**fixed, **dict.fromkeys(spans, body.span)}
        for key, value in body_values:
            values.setdefault(key, value)
        return MaterialSection(section, path_of(name), tuple(values.items()), tuple(values), tuple(bind))


def _counts(technique: Technique, settings: Sequence[tuple[str, int]]) -> dict[str, object]:
    """The settings that are a technique's own."""
    names = {uniform.name for uniform in technique.uniforms}
    return {key: value for key, value in settings if key in names}


def _spans(technique: Technique) -> list[str]:
    """The parameters that the scene's body sets: lengths that span it."""
    return [uniform.name for uniform in technique.uniforms if "spans_body" in dict(uniform.hints)]


def reaches(candidate: Candidate, span: float) -> bool:
    """Whether the techniques can be set to the length that spans a body."""
    names = [*candidate.techniques, *filter(None, [candidate.path.partition(":")[0]])]
    ranges = [
        hints["hint_range"]
        for name in names
        for uniform in load(name).uniforms
        if "spans_body" in (hints := dict(uniform.hints)) and "hint_range" in hints
    ]
    return all(float(low) <= span <= float(high) for low, high, *_ in ranges)


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
        if technique.function.quantity != VIEW:
            for to_length in routes(technique.function.quantity, "thickness"):
                result += _suppliers("thickness", technique, to_length)
    return result


def view_thickness() -> list[Candidate]:
    """The techniques of the length along the eye's ray: its own, and maps and constants with a conversion."""
    result = []
    for technique in of_role("thickness"):
        quantity = technique.function.quantity
        if quantity == VIEW:
            result += _suppliers(VIEW, technique, ())
        elif not _is_directed(technique):
            for to_length in routes(quantity, "thickness"):
                for to_view in routes("thickness", VIEW):
                    result += _suppliers(VIEW, technique, (*to_length, *to_view))
    return result


def _is_directed(technique: Technique) -> bool:
    """Whether a thickness depends on more than the place on the surface, such as a direction towards a light."""
    return any(param.quantity != "uv_position" for param in technique.function.params)


def _suppliers(role: str, technique: Technique, conversions: tuple[str, ...]) -> list[Candidate]:
    """The candidates of a length: a technique at each setting, and conversions."""
    chain = (technique.name, *conversions, f"shown_{role}")
    legends = [load(name).attributes.legend for name in conversions]
    return [
        Candidate(
            role, technique.name, ", ".join([label(technique.name, counts), *filter(None, legends)]), counts, chain,
            technique.baseline,
        )
        for counts in settings(technique)
    ]  # fmt: skip


def fits_path(candidate: Candidate) -> bool:
    """Whether a candidate of thickness is a function that measures from a point inside the body, too."""
    if candidate.role != "thickness" or len(candidate.techniques) != 2:
        return False
    return any(
        candidate.name in slots.candidates(slot)
        for technique in of_role("translucency")
        for slot in technique.slots
        if is_path(slot)
    )


def default_paths() -> list[Candidate]:
    """The functions of a length from a point inside the body, with the default counts."""
    result = []
    for candidate in filter(fits_path, thickness()):
        default = {uniform.name: uniform.default for uniform in load(candidate.name).uniforms}
        if all(count == int(default[name][0]) for name, count in candidate.settings):
            result.append(candidate)
    return result


def translucency(paths: Sequence[Candidate] | None = None) -> list[Candidate]:
    """The techniques of translucency after the exact lengths, and the candidate without one.

    A technique that measures from a point inside the body does so with each of `paths`.
    """
    paths = default_paths() if paths is None else paths
    result = [Candidate("translucency", "none", "none", (), ())]
    for technique in of_role("translucency"):
        needed = quantity_read(technique)
        exact = VIEW if needed == VIEW else "thickness"
        for route in routes(exact, needed) if needed else [()]:
            lengths = (f"exact_{exact}", *route) if needed else ()
            chain, baseline = (*lengths, technique.name), technique.baseline
            whole = Candidate("translucency", technique.name, technique.name, (), chain, baseline)
            result += _with_paths(whole, technique, paths)
    return result


def _with_paths(candidate: Candidate, technique: Technique, paths: Sequence[Candidate]) -> list[Candidate]:
    """The candidate with each path for the slot of its last technique; the candidate itself if there is no slot."""
    slot = next((slot for slot in technique.slots if is_path(slot)), None)
    if slot is None:
        return [candidate]
    fitting = slots.candidates(slot)
    return [
        candidate._replace(
            label=f"{candidate.label} by {label(path.name, path.settings)}",
            path=path.name,
            path_settings=path.settings,
        )
        for path in paths
        if path.name in fitting
    ]


def materials(
    lengths: Sequence[Candidate], views: Sequence[Candidate] = (), paths: Sequence[Candidate] = ()
) -> list[Candidate]:
    """Complete chains: each translucency with each length that it reads, the published chains, the empty chain.

    `lengths` are thicknesses, `views` lengths along the eye's ray, `paths` lengths from a point inside the body.
    """
    result = [Candidate("material", "none", "no translucency", (), ())]
    for name, chain in baselines().items():
        result.append(Candidate("material", name, name, (), chain, True))
    for light in of_role("translucency"):
        if is_published(light):
            continue
        needed = quantity_read(light)
        if not needed:
            alone = Candidate("material", light.name, light.name, (), (light.name,))
            result += _with_paths(alone, light, paths)
            continue
        if needed == VIEW:
            for view in views:
                chain = (*view.techniques[:-1], light.name)
                text = " → ".join((label(chain[0], view.settings), *chain[1:]))
                whole = Candidate("material", " → ".join(chain), text, view.settings, chain)
                result += _with_paths(whole, light, paths)
            continue
        for length in lengths:
            first = load(length.techniques[0])
            if is_published(first):
                continue
            to_length = length.techniques[1:-1]
            for route in _conversions(first.function.quantity, to_length, needed):
                chain = (first.name, *route, light.name)
                text = " → ".join((label(first.name, length.settings), *route, light.name))
                whole = Candidate("material", " → ".join(chain), text, length.settings, chain)
                result += _with_paths(whole, light, paths)
    unique: dict[tuple[Any, ...], Candidate] = {}
    for candidate in result:  # the published chain of several equal ones comes first
        key = (candidate.techniques, candidate.settings, candidate.path, candidate.path_settings)
        unique.setdefault(key, candidate)
    return list(unique.values())


@cache
def baselines() -> dict[str, tuple[str, ...]]:
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
        if not is_path(slot):
            in_world = slot.params[0].quantity == "world_position"
            as_texture = "texture (sssgen bake sdf)"
            parts.append(f"the body as a distance {'function' if in_world else as_texture}")
    for uniform in technique.uniforms:
        if isinstance(uniform.type, Sampler) and not technique.slots:
            holds = dict(uniform.hints).get("holds")
            parts.append(f"a baked {holds[0]} map" if holds else f"the {uniform.name.replace('_', ' ')}")
    return " and ".join(parts)


def is_constant(technique: Technique) -> bool:
    """Whether a thickness technique has the same value at every point."""
    return technique.role == "thickness" and not technique.function.params and not needs(technique)


def complete(roles: Sequence[str]) -> tuple[str, ...]:
    """The roles with those whose results they need, in order: whole chains use the charted lengths."""
    needed = {"thickness", VIEW} if "material" in roles else set()
    return tuple(role for role in ROLES if role in {*roles, *needed})


def quantity_read(technique: Technique) -> str:
    """The scalar quantity that a technique reads, or ''."""
    return next((param.quantity for param in technique.function.params if param.quantity in SCALARS), "")


def reads_fluence(candidate: Candidate) -> bool:
    """Whether a chain reads textures of the light inside the body."""
    uniforms = [uniform for name in candidate.techniques for uniform in load(name).uniforms]
    return any(isinstance(uniform.type, Sampler) and uniform.name.startswith((PREFIX, INNER)) for uniform in uniforms)


def refracts(candidate: Candidate) -> bool:
    """Whether a technique of the chain has the refractive index: without refraction, one that has not is the same."""
    return any(uniform.name == INDEX for name in candidate.techniques for uniform in load(name).uniforms)


def is_for_matched(candidate: Candidate) -> bool:
    """Whether the chain is for a body with a matched boundary."""
    return not refracts(candidate) or any(load(name).attributes.matched for name in candidate.techniques)


def is_calibrated(candidate: Candidate) -> bool:
    """Whether a bake has the scale of the chain's light, so that nothing is fitted."""
    return bool(candidate.techniques) and load(candidate.techniques[-1]).attributes.calibrated


def needs_distant_light(candidate: Candidate) -> bool:
    """Whether the chain reads a texture that a program draws for a light from afar."""
    names = [*candidate.techniques, *([candidate.path.partition(":")[0]] if candidate.path else [])]
    uniforms = [uniform for name in names for uniform in load(name).uniforms]
    return any(pass_name(uniform) in DISTANT_VIEWS for uniform in uniforms)


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
    # a single step over the whole body ends outside of it
    least = 2 if _spans(technique) else 1
    values = [count for count in COUNTS if least <= count <= largest and all(_within(part, count) for part in counts)]
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
