"""The parity of the techniques: each of the library on each back end, on random inputs, against NumPy in float64.

    for case in cases():
        measure(case, backends.get("gl"), lanes=10_000)

What may be beyond `deviation.GOAL` stands in `KNOWN`, with its reason.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from sssgen.harness.backends import Array, Backend, get
from sssgen.harness.evaluate.deviation import GOAL, Deviation, blur, deviation
from sssgen.harness.evaluate.evaluation import Inputs, fitted, run
from sssgen.harness.evaluate.probes import Subject, subject
from sssgen.harness.evaluate.random_inputs import samples
from sssgen.material import library, slots

BACKENDS = ("gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "unity", "unity-urp")
LANES, SEED = 10_000, 1
BOUND_LANES = 2_000
"""For a technique with other functions in its slots, where the technique itself has had its `LANES`."""

SHARE = 0.005
"""The share of lanes that may be excused for any technique: a few lie just where a decision turns."""


class Case(NamedTuple):
    """A technique, and what is bound to its slots (slot, function) where that is not the first that fits."""

    technique: str
    bind: tuple[tuple[str, str], ...] = ()


class Known(NamedTuple):
    """What is known to be beyond the goal, and why."""

    techniques: tuple[str, ...]
    reason: str
    backends: tuple[str, ...] = BACKENDS
    largest: float = GOAL
    """The largest deviation of lanes that are not excused."""
    share: float = SHARE
    """The largest share of lanes that are."""
    bound_share: float = SHARE
    """The same, where other functions are bound to the slots."""


KNOWN = (
    Known(
        ("standard",),
        "A mirror's peak, thousands high: at roughness 0.045 the last bits of N and H are 3e-5 of its width.",
    ),
    Known(
        ("alpha_erosion", "normal_from_height"),
        "Slopes are differences of texture reads a texel apart, divided by that texel.",
    ),
    Known(
        ("depth_map_absorption",),
        "A baseline: exp(-sigma_t x), where x is a difference of lengths and sigma_t up to 100. It may be large.",
    ),
    Known(("parallax_refracted",), "Near the critical angle, on the way into a thinner body: a square root near 0."),
    Known(
        ("distance_texture",), "The difference 2 texel - 1 near the surface, times a `distance_range` of up to 100."
    ),
    Known(
        ("march_distance_texture", "studio"), "A way that just touches a surface, or the side of the box."
    ),
    Known(
        ("distance_field_march",), "With a `stored_range` of 0.001 what is stored is steep: its step at 0.5 moves."
    ),
    Known(("alisavakis_lobe",), "A power below 1 is steep where the lobe begins."),
    Known(
        ("voronoi_thickness", "voronoi_normal"),
        "The last bit of `uv * cell_count` (up to 400 cells) is 3e-5 of a cell, and the slopes of narrow bevels are "
        "steep.",
        share=0.15,
    ),
    Known(
        ("raymarch",),
        "Its normal is made of differences of distances 0.001 apart, so that the roundings of these turn it by up to "
        "1e-4 on most of a curved body (2e-4 from a texture), and on 1 % of a box; more on an edge. P, where a ray "
        "goes far and meets nothing.",
        largest=1e-4,
        share=0.02,
        bound_share=1.0,
    ),
    Known(
        ("cheap_sss_raymarch",),
        "A baseline without a far limit: where the ray meets nothing P grows beyond float32.",
        share=0.3,
    ),
    Known(
        ("xt95_thickness",),
        "A baseline with a hash from `fract(sin(n) * 3538.5453)`, as published: it multiplies what the sine rounds.",
        largest=1e-3,
        share=0.7,
    ),
    Known(
        ("xt95_thickness",), "The same, with the browser's coarse sine.", ("browser",), largest=0.5, share=0.7
    ),
    Known(
        ("camera_orbit",),
        "SwiftShader's sine and cosine are off by up to 2e-4; WGSL allows 5e-4.",
        ("browser",),
        largest=2e-3,
        share=0.05,
    ),
)  # fmt: skip


def cases() -> list[Case]:
    """Every technique, and again with each other function of the library that fits one of its slots (no baseline)."""
    found = []
    for technique in library.load_all():
        found.append(Case(technique.name))
        for slot in technique.slots if not technique.baseline else ():
            found += [Case(technique.name, ((slot.name, function),)) for function in slots.candidates(slot)[1:]]
    return found


def known(technique: str, backend: str) -> Known:
    """What is known of a technique on a back end; the later entries are the more special ones."""
    found = [one for one in KNOWN if technique in one.techniques and backend in one.backends]
    return found[-1] if found else Known((technique,), "")


def measure(case: Case, backend: Backend, lanes: int = LANES, seed: int = SEED) -> Deviation:
    """How far a back end is from the oracle. Raises SssgenError where the driver refuses."""
    prepared = _prepared(case, lanes, seed)
    return deviation(run(prepared.subject, prepared.inputs, backend), prepared.oracle, prepared.blurred)


def excess(case: Case, backend: str, found: Deviation, lanes: int) -> str:
    """What of a deviation is neither within the goal nor known, in words; nothing where all is well."""
    limit = known(case.technique, backend)
    title = " ".join([case.technique, *("=".join(pair) for pair in case.bind)])
    if not found.largest <= limit.largest:
        where = f"{found.output}[{found.lane}] is {found.got.tolist()}, not {found.wanted.tolist()}"
        return f"{title} on {backend}: {found.largest:.2g} where at most {limit.largest:g} is right: {where}"
    share = limit.bound_share if case.bind else limit.share
    if found.excused > share * lanes + 3:  # few lanes have their luck
        return f"{title} on {backend}: {found.excused} of {lanes} lanes are blurred, of which {share:.1%} may be"
    return ""


class _Prepared:
    """What the back ends share; the blur is measured once, where one of them asks."""

    def __init__(self, case: Case, lanes: int, seed: int) -> None:
        self.subject: Subject = subject(case.technique, dict(case.bind))
        self.inputs: Inputs = fitted(self.subject, samples(self.subject, lanes, seed))
        self.oracle: Mapping[str, Array] = run(self.subject, self.inputs, get("numpy"))
        self._blur: Any = None

    def blurred(self) -> Mapping[str, Array]:
        if self._blur is None:
            self._blur = blur(self.subject, self.inputs, self.oracle)
        found: Mapping[str, Array] = self._blur
        return found


@lru_cache(4)
def _prepared(case: Case, lanes: int, seed: int) -> _Prepared:
    return _Prepared(case, lanes, seed)
