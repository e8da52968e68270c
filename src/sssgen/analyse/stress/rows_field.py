"""Rows of the dangerous table about distance fields and marches through them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from sssgen.analyse.stress.base_inputs import angles, mix, plain
from sssgen.analyse.stress.contract_inputs import TEXELS
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import Trial
from sssgen.ir.types import kind_of
from sssgen.material import library, slots
from sssgen.run.backends import Array
from sssgen.targets.runtime.numpy_textures import Texture


def _bound(specimen: Specimen, shape: str) -> Specimen | None:
    """The technique with the library's body of a shape in the first slot that it fits."""
    for slot in library.load(specimen.technique).slots if specimen.slots else ():
        function = slots.body(shape, slot.params[0].quantity if slot.params else "")
        if function in slots.candidates(slot):
            return specimen.rebound(slot.name, function)
    return None


def _measures(specimen: Specimen) -> bool:
    """Whether the technique computes thickness or thinness from a distance field."""
    return bool(specimen.slots) and specimen.quantity("result") in ("thickness", "thinness")


def not_lipschitz(specimen: Specimen) -> Iterator[Trial]:
    """A field that is not a distance: random texels, a hundred times too steep."""
    if not _measures(specimen) or (steep := _bound(specimen, "texture")) is None:
        return
    rng = np.random.default_rng(17)
    texels = Texture(rng.integers(0, 2, (TEXELS,) * 3 + (1,)).astype(np.float16), wrap="clamp")
    lanes = 512
    positions = rng.uniform(-1.0, 1.0, (3, lanes))
    axes = [(0, 0, 1), (0.6, 0, 0.8), (0, -1, 0)]
    changes = {"distance_map": texels, "distance_range": 100.0, "P": positions, "P_object": positions}
    turned = mix(steep, dict.fromkeys(("N", "L", "V_object", "L_object"), axes), lanes).values
    yield Trial("", steep, plain(steep, lanes, {**turned, **changes}))


def medial_axis(specimen: Specimen) -> Iterator[Trial]:
    """Over the face of a box, across its diagonals: no jump. A jump of the slope is documented by the technique."""
    if _measures(specimen) and (boxed := _bound(specimen, "box")):
        along = np.linspace(-0.45, 0.45, 2001)
        positions = np.stack([along, np.full_like(along, 0.2), np.full_like(along, 0.5)])
        yield Trial("", boxed, plain(boxed, len(along), {"P": positions, "P_object": positions}), path=True)


def hit_offset(specimen: Specimen) -> Iterator[Trial]:
    """A hit a little inside or outside the surface: nearly the result of the surface itself."""
    if _measures(specimen) and (boxed := _bound(specimen, "box")):
        off = np.linspace(-2e-3, 2e-3, 1001)
        positions = np.stack([np.full_like(off, 0.1), np.full_like(off, 0.2), 0.5 + off])
        yield Trial("", boxed, plain(boxed, len(off), {"P": positions, "P_object": positions}), path=True)


def grazing_march(specimen: Specimen) -> Iterator[Trial]:
    """A march that starts on the surface of a ball and turns through its tangent."""
    if _measures(specimen) and (ball := _bound(specimen, "sphere")):
        sine, cosine = angles(-5.0, 5.0)
        light = np.stack([cosine, 0.0 * sine, sine])
        changes = {"P": (0, 0, 1), "P_object": (0, 0, 1), "L": light, "L_object": light, "V_object": -light}
        yield Trial("", ball, plain(ball, len(sine), changes), path=True)


def flat_box(specimen: Specimen) -> Iterator[Trial]:
    """A texture's box that is flat, a point, or all above 0."""
    if not {"box_min", "box_max"} <= specimen.subject.params.keys():
        return
    places = [(0, 0, 0), (0.5, 0.5, 0.5), (2, 2, 2), (-1, 1, 0)]
    choices: dict[str, list[Any]] = {
        "box_min": [(0, 0, 0), (-1, -1, 0), (1, 1, 1), (0.5, 0.25, 2)],
        "box_max": [(0, 0, 0), (1, 1, 0), (1, 1, 1), (2, 2, 2)],
        "P_object": places, "p": places, "P": places,
    }  # fmt: skip
    axes = [(0, 0, 1), (1, 0, 0), (0.6, 0, 0.8), (0, 0, 0)]
    yield Trial("", specimen, mix(specimen, {**choices, "V_object": axes, "L_object": axes}, 2048))


def concave(specimen: Specimen) -> Iterator[Trial]:
    """A line through both sides of a ring, radius 1 and 0.25: the sum of two chords of 0.5."""
    lit = {"L", "L_object"} & specimen.subject.params.keys()
    if not _measures(specimen) or not lit or specimen.quantity("result") != "thickness":
        return
    if ring := _bound(specimen, "torus"):
        large_count, small_count = np.array([128], np.int32), np.array([64], np.int32)
        changes = {
            "P": (-1.25, 0, 0), "P_object": (-1.25, 0, 0), "L": (1, 0, 0), "L_object": (1, 0, 0),
            "V_object": (-1, 0, 0), "reach": 4.0, "steps": large_count, "view_steps": small_count,
            "light_steps": small_count,
            "box_min": (-1.3, -0.3, -1.3), "box_max": (1.3, 0.3, 1.3),
        }  # fmt: skip
        yield Trial("", ring, plain(ring, 4, changes), expected={"result": np.ones(1)}, tolerance=0.02)


def few_steps(specimen: Specimen) -> Iterator[Trial]:
    """Step counts of 0, 1 and below 0; and a single step that is larger than the body."""
    uniforms = specimen.subject.uniforms
    kinds = {name: kind_of(uniform.type) for name, uniform in uniforms.items() if name not in specimen.settings}
    counts = {
        name: {"int": np.int32, "uint": np.uint32}[kind] for name, kind in kinds.items() if kind in ("int", "uint")
    }
    for count in (0, 1, -1) if counts else ():
        changes: dict[str, Any] = {}
        for name, dtype in counts.items():
            changes[name] = np.full(1, max(count, 0) if dtype is np.uint32 else count, dtype)
        far = {"reach": np.array([0.1, 0.4, 10.0])} if "reach" in uniforms else {}
        yield Trial("", specimen, plain(specimen, 3, {**changes, **far}), counts=count >= 0)


def coincidences(specimen: Specimen) -> Iterator[Trial]:
    """Two points that coincide: the ends of an axis, and a position exactly at the site of a Voronoi cell."""
    params = specimen.subject.params
    if "start" in params and "end" in params:
        point = np.array([[0.3], [-0.2], [0.1]])
        yield Trial("", specimen, plain(specimen, 1, {"start": point, "end": point}))
        yield Trial("", specimen, plain(specimen, 1, {"start": point, "end": point, "p": point}))
    if "cell_count" in params and "uv" in params:
        site = _site().astype(np.float32)
        steps = np.array([[x, y] for x in (-1, 0, 1) for y in (-1, 0, 1)], np.float32).T
        near = site[:, None] + steps * np.spacing(site)[:, None]
        changes = {"uv": near, "cell_count": np.ones(1), "relief": np.ones(1)}
        yield Trial("", specimen, plain(specimen, near.shape[1], changes))


def _site() -> Array:
    """The site in the cell at the origin, by the formula of common/voronoi.sss."""
    seed = _hash(_hash(1))
    shift = np.array([_hash(seed + 1) >> 8, _hash(seed + 2) >> 8], np.float32) / np.float32(2**24) - np.float32(0.5)
    return (np.float32(0.5) + np.float32(0.6) * shift).astype(np.float64)


def _hash(x: int) -> int:
    """`hash_bits` of common/hash.sss, on 32 bits."""
    x &= 0xFFFFFFFF
    x = ((x ^ (x >> 16)) * 0x7FEB352D) & 0xFFFFFFFF
    x = ((x ^ (x >> 15)) * 0x846CA68B) & 0xFFFFFFFF
    return x ^ (x >> 16)
