"""The table of dangerous inputs, as data: what each row tests, what it requires, and its inputs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from sssgen.analyse.stress import rows_field as field
from sssgen.analyse.stress import rows_light as light
from sssgen.analyse.stress import rows_surface as surface
from sssgen.analyse.stress.contract_inputs import is_direction, outer_contract
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import Trial
from sssgen.ir.formats import FLOAT32, Format
from sssgen.run.backends import Array
from sssgen.support.diagnostics import did_you_mean, failure

LONGEST = 100.0
"""The greatest component of a direction in half precision."""

Makes = Callable[[Specimen], Iterator[Trial]]


class DangerousRow(NamedTuple):
    """A row of the table."""

    name: str
    inputs: str
    requires: str
    trials: Makes | None
    """None if the row does not test a technique."""
    elsewhere: str = ""
    """What tests it instead."""
    alike: bool = True
    """Whether the back ends must agree; False if drivers may choose mip levels or blend infinities freely."""


ROWS = (
    DangerousRow(
        "powers", "pow(0, 0), pow(0, negative), pow(negative, p)",
        "a saturated base, the documented limit at 0, an exponent above 0", light.powers,
    ),
    DangerousRow(
        "large-power", "a large power in half precision", "a finite lobe", light.large_powers,
    ),
    DangerousRow(
        "zero-vectors", "L + distortion N = 0; zero or non-unit V, L, N", "finite", light.zero_vectors,
    ),
    DangerousRow(
        "lamp-at-surface", "a point light at the surface", "a bounded falloff, no direction to it",
        light.lamp_at_surface,
    ),
    DangerousRow("long-vectors", "|L| > 255 in half precision", "normalised without overflow", light.long_vectors),
    DangerousRow(
        "quantities", "thickness, thinness, transmittance < 0, > 1", "finite; the technique clamps its result",
        light.wrong_quantities,
    ),
    DangerousRow(
        "texels", "texels < 0, > 1, NaN in maps that hold a quantity", "clamped at the typed boundary",
        surface.bad_texels,
    ),
    DangerousRow(
        "thick-matter", "sigma d huge, sigma infinite, attenuation distance 0",
        "T(0) = 1 exactly; a distance of 0 is opaque", light.thick_matter,
    ),
    DangerousRow(
        "view-lengths", "d_view 0, below 0, infinite; V = L; no normal; P far from the body",
        "finite; no light along a ray that does not enter", light.lengths_of_the_eye,
    ),
    DangerousRow(
        "black-attenuation", "attenuation colour component 0 with thickness 0", "T(0) = 1", light.black_attenuation,
    ),
    DangerousRow("anisotropy", "g towards -1 and 1", "clamped", light.extreme_anisotropy),
    DangerousRow(
        "grazing-view", "the view goes to grazing, without refraction",
        "a documented maximum, fading to the base coordinates", surface.grazing_view,
    ),
    DangerousRow(
        "critical-angle", "past the critical angle", "the base coordinates, with a smooth fade",
        surface.past_the_critical_angle,
    ),
    DangerousRow("from-behind", "the view from behind, bent normals", "finite, continuous", surface.from_behind),
    DangerousRow(
        "tangent-frame", "mirrored, sheared, zero tangent frames", "a true inverse; no tangent, no offset",
        surface.bad_frames,
    ),
    DangerousRow(
        "seams", "a seam in the texture coordinates, a jump of derivatives", "finite", surface.seams, alike=False,
    ),
    DangerousRow("lipschitz", "a field that is not a distance", "each tap is clamped", field.not_lipschitz),
    DangerousRow(
        "medial-axis", "across the medial axis", "no jump; a change of the slope is documented", field.medial_axis,
    ),
    DangerousRow("hit-offset", "a hit a little inside", "at least 0, as on the surface", field.hit_offset),
    DangerousRow("grazing-march", "a march from the surface itself, grazing", "no jump", field.grazing_march),
    DangerousRow(
        "flat-box", "a flat bounding box, or one above 0", "the box is padded, and its lowest corner is subtracted",
        field.flat_box,
    ),
    DangerousRow(
        "meshes", "open, non-manifold, self-intersecting, inverted meshes", "signed by the winding number, or refused",
        None,
        "a scene's mesh: the sign is that of the winding number, and an invalid mesh is rejected with a message",
    ),
    DangerousRow("concave", "concave bodies, gaps", "the sum of the intervals inside", field.concave),
    DangerousRow("eight-bits", "an 8-bit distance or thickness", "an error of at most half a step", surface.eight_bits),
    DangerousRow("coinciding", "two points in one place: an axis' ends, a cell's site", "finite", field.coincidences),
    DangerousRow("few-steps", "steps of 0 and 1, or larger than the body", "at least one step", field.few_steps),
    DangerousRow(
        "fast-math", "NaN tests under fast-math", "the tests read the bits: no NaN remains",
        surface.fast_math, alike=False,
    ),
)  # fmt: skip


def check_rows(names: Sequence[str]) -> tuple[str, ...]:
    """The names, if there are such rows. Raises SssgenError."""
    row_names = [row.name for row in ROWS]
    for name in names:
        if name not in row_names:
            raise failure(f"unknown row '{name}'", did_you_mean(name, row_names) or f"rows: {', '.join(row_names)}")
    return tuple(names)


def trials(specimen: Specimen, names: Sequence[str] = (), format: Format = FLOAT32) -> Iterator[Trial]:
    """The trials of the rows (all, if none is named) that apply to a technique, in the range of a format."""
    for row in ROWS:
        if row.trials is not None and (not names or row.name in names):
            for trial in row.trials(specimen):
                named = trial._replace(name=row.name, compared=row.alike)
                yield named if format is FLOAT32 else _in_half(named, format)


def _in_half(trial: Trial, half: Format) -> Trial:
    """A trial in half precision: contract values and directions are clamped to the narrower contract."""
    values = {}
    for name, value in trial.inputs.values.items():
        if value.dtype.kind == "f":
            value = np.clip(value, -half.largest, half.largest)
            ends = outer_contract(trial.specimen, name, half)
            if is_direction(name, ends):  # products of such lengths are still numbers
                value = value if trial.name == "long-vectors" else np.clip(value, -LONGEST, LONGEST)
            elif not _is_outside(trial.specimen, name, value):
                value = np.clip(value, np.float32(ends.low), np.float32(ends.high))
            value = value.astype(np.float16).astype(np.float32)
        values[name] = value
    expected = {name: value.astype(np.float16).astype(np.float64) for name, value in trial.expected.items()}
    tolerance = trial.tolerance + 4.0 * half.epsilon if trial.tolerance else 0.0
    inputs = trial.inputs._replace(values=values)
    return trial._replace(inputs=inputs, expected=expected, tolerance=tolerance, path=False, compared=False)


def _is_outside(specimen: Specimen, name: str, value: Array) -> bool:
    """Whether a row has values that no format's contract allows."""
    ends = outer_contract(specimen, name, FLOAT32)
    return bool((value < np.float32(ends.low)).any() or (value > np.float32(ends.high)).any())
